"""`hapticgiant simulate` and `run --device-address` as a user sees them, and the Python client.

    remote_commands_test.py PROGRAM
"""

import contextlib
import json
import math
import os
import pathlib
import re
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples" / "python"))
import device_client  # noqa: E402

PROGRAM = None
CLIENT = ROOT / "examples" / "python" / "device_client.py"


def read_until(stream, is_there):
    """The lines up to the first one for which `is_there` holds; fails where the text ends before."""
    said = ""
    while True:
        line = stream.readline()
        said += line
        if not line:
            raise AssertionError("the text has ended: " + said)
        if is_there(line):
            return said


class Server:
    """`hapticgiant simulate` at a free port."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [PROGRAM, "simulate", "--listen", "127.0.0.1:0", *arguments], cwd=ROOT, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        head = read_until(self.process.stdout, lambda line: line.startswith("stop"))
        self.address = re.search(r"^address +(\S+)$", head, re.MULTILINE)[1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def session(self):
        """The closing lines of a session that has ended or will."""
        return read_until(self.process.stdout, lambda line: line.startswith("  truth"))

    def close(self):
        """Ctrl-C; its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.communicate(timeout=60)
        return self.process.returncode


def run(*arguments):
    return subprocess.run([PROGRAM, "run", "--no-recording", "--no-viewer", *arguments], cwd=ROOT,
                          text=True, capture_output=True, timeout=200)


class Commands(unittest.TestCase):
    def test_the_door_there_is_the_door_here(self):
        with tempfile.TemporaryDirectory() as folder, Server("door", "--fast") as server:
            here, there = pathlib.Path(folder, "here"), pathlib.Path(folder, "there")
            run("door", "--fast", "--summary", here)
            result = run("door", "--fast", "--device-address", server.address, "--summary", there)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertNotIn("rule 105", result.stdout)
            here, there = json.loads(here.read_text()), json.loads(there.read_text())
            for key in ("events", "limits", "force", "cycles", "sync_error"):
                self.assertEqual(there[key], here[key], key)
            link = there["link"]
            self.assertGreater(link["received"], 10000)
            self.assertEqual(link["lost"], 0)
            self.assertIn("  link         ", result.stdout)
            said = server.session()
            self.assertEqual(server.close(), 0)
            self.assertRegex(said, r"session +hapticgiant run \S+ at 127\.0\.0\.1:\d+, 1\d\.\d s")
            self.assertRegex(said, r"end +the client left: done")
            self.assertRegex(said, r"link +\d+ sent, \d+ received")
            self.assertRegex(said, r"truth +joint limits .*; force of the user at most \d")

    def test_a_leader_there_and_a_remote_arm_elsewhere_are_those_here(self):
        options = ("remote_arm", "--fast", "--duration", "14")
        state = re.compile(r"^  state +(\w+)", re.MULTILINE)
        with Server("remote_arm", "--fast") as leader, Server("remote_arm", "--remote", "--fast") as arm:
            here = run(*options)
            there = run(*options, "--device-address", leader.address, "--set",
                        f"scenario.teleoperation.remote.udp={arm.address}")
            self.assertEqual(there.returncode, here.returncode, there.stdout + there.stderr)
            self.assertIn("pressed", there.stdout)
            self.assertEqual(state.search(there.stdout)[1], state.search(here.stdout)[1])

    def test_what_a_franka_cannot_be_is_refused(self):
        late = ("--despite", "lateness")  # the computer of a test may be busy
        fci = ("fr3/open_drawer", "--device", "fr3/fci", *late, "--device-address")
        no_robot = "franka://127.0.0.1:1"
        for arguments, reason in (
                (("fr3/open_drawer", *late, "--device-address", no_robot), "lists no actuators"),
                (("door", *late, "--device-address", no_robot), "7 joints and no gantry"),
                ((*fci, no_robot), "127.0.0.1:1: the robot refuses the connection: activate FCI"),
                ((*fci, "franka://"), "expected franka://HOST or franka://HOST:PORT"),
                ((*fci, "franka://host/speed"), "with /speeds, got 'franka://host/speed'"),
                ((*fci, "franka://host:port"), "--device-address: expected HOST:PORT"),
                ((*fci, no_robot, "--fast"), "a Franka keeps its own time"),
                ((*fci, no_robot, "--seed", "2"), "--seed")):
            with self.subTest(arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertIn(reason, result.stderr)

    def test_sensors_without_their_described_noise_are_noticed(self):
        with Server("free_space", "--fast", "--sensors", "ideal") as server:
            result = run("free_space", "--fast", "--device-address", server.address)
            self.assertEqual(result.returncode, 3)
            self.assertIn("105 measured value is frozen", result.stdout)

    def test_another_scenario_over_there_is_not_armed(self):
        with Server("door", "--fast") as server:
            result = run("excavator", "--fast", "--duration", "2", "--device-address",
                         server.address)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("not armed: the twin cannot be where the handle is", result.stdout)

    def test_a_device_moves_to_the_start_from_where_it_was_left(self):
        with Server("door", "--fast", "--stays", "--user", "mouse") as server:
            for scenario in ("path", "excavator", "door"):
                result = run(scenario, "--user", "mouse", "--fast", "--duration", "1",
                             "--device-address", server.address, "--move-to-start")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertRegex(result.stdout, r"start +there after \d+\.\d s")
                self.assertNotIn("not armed", result.stdout)

    def test_the_way_to_the_start_is_a_phase_of_its_own(self):
        with Server("door", "--fast", "--stays", "--user", "mouse") as server:
            report, write_end = os.pipe()
            request = {"scenario": "path", "user": "mouse", "fast": True, "duration": 1, "recording": False,
                       "device_address": server.address, "move_to_start": True}
            result = subprocess.run([PROGRAM, "run", "--request", "-", "--report-to", str(write_end)],
                                    input=json.dumps(request), pass_fds=(write_end,), text=True,
                                    capture_output=True, check=False)
            os.close(write_end)
            with open(report, encoding="utf-8") as lines:
                phases = [each["phase"] for each in map(json.loads, lines) if "phase" in each]
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        way = [name == "moving" for name in phases]
        self.assertTrue(way[0])
        self.assertEqual(way, sorted(way, reverse=True))
        self.assertEqual(phases[-1], "over")

    def test_a_start_out_of_reach_is_refused_before_anything_moves(self):
        with Server("door", "--fast", "--stays", "--user", "mouse") as server:
            result = run("path", "--fast", "--duration", "0.3", "--device-address", server.address,
                         "--move-to-start", "--set", "twin.joints.root.start.z_m=1.5")
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn("handle", result.stderr)

    def test_a_description_without_noise_disables_a_rule_with_a_note(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder, "model")
            shutil.copytree("models/haptic_giant", model)
            simulation = model / "simulation.yaml"
            simulation.write_text(re.sub(r"(?m)^sensors:.*\n(?:[ #].*\n|\n)*",
                                         "sensors: {ideal: true}\n", simulation.read_text()))
            arguments = ("free_space", "--fast", "--device", model / "device.yaml")
            with Server(*arguments) as server:
                result = run(*arguments, "--duration", "1", "--device-address", server.address)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("frozen sensors are not noticed (rule 105)", result.stdout)

    def test_seed_step_hand_and_plant_are_arguments_of_simulate(self):
        for world, for_both in [(["--seed", "7", "--step", "0.5e-3", "--hand", "stiff"], []),
                                (["--seed", "7"], ["--plant", "ideal"])]:
            with Server("free_space", "--fast", *world, *for_both) as server:
                there = self.state(*for_both, "--device-address", server.address)
                self.assertEqual(there, self.state(*world, *for_both))
                for at in range(0, len(world), 2):
                    without = world[:at] + world[at + 2:]
                    self.assertNotEqual(there, self.state(*without, *for_both), world[at])
                if for_both:
                    result = run("free_space", "--fast", "--device-address", server.address)
                    self.assertEqual(result.returncode, 2)
                    self.assertIn("drives take positions, expected torques", result.stderr)

    def state(self, *arguments):
        """Hash of the last cycle of three seconds in free space."""
        with tempfile.TemporaryDirectory() as folder:
            summary = pathlib.Path(folder, "summary")
            run("free_space", "--fast", "--duration", "3", "--summary", summary, *arguments)
            return json.loads(summary.read_text())["state_hash"]

    def test_options_of_a_simulation_are_refused_for_a_remote_device(self):
        result = run("door", "--device-address", "127.0.0.1:1", "--seed", "7", "--step", "1e-3",
                     "--hand", "stiff", "--sensors", "ideal")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(
            result.stderr,
            "--seed, --step, --hand, --sensors: the device of --device-address is simulated "
            "elsewhere; give this to 'hapticgiant simulate' there\n")

    def test_a_server_that_goes_is_a_fault_with_exit_code_3(self):
        with Server("door", "--fast") as server:
            process = subprocess.Popen(
                [PROGRAM, "run", "door", "--fast", "--duration", "100000", "--no-recording",
                 "--device-address", server.address], cwd=ROOT, text=True, stdout=subprocess.PIPE)
            process.stdout.readline()
            read_until(process.stdout, lambda line: "s  " in line)  # an event: it is under way
            server.close()
            said = process.communicate(timeout=100)[0]
            self.assertEqual(process.returncode, 3, said)
            self.assertIn("message of the remote device: the server was stopped", said)
            self.assertIn("104 remote device has ended the session", said)

    def test_what_does_not_fit_is_one_clear_sentence(self):
        with Server("door") as server:
            for arguments, sentence in [
                (("--fast",), "the device refuses: time: real time, expected lock-step (--fast)"),
                (("--rate-hz", "2000"), "the device refuses: rate: 1000 Hz, expected 2000 Hz"),
            ]:
                result = run("door", "--device-address", server.address, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertEqual(result.stderr, f"{server.address}: {sentence}\n")
            second = subprocess.run([PROGRAM, "simulate", "--listen", server.address], cwd=ROOT,
                                    text=True, capture_output=True, timeout=100)
            self.assertEqual(second.returncode, 2)
            self.assertEqual(second.stderr,
                             f"{server.address}: cannot listen there: Address already in use\n")
        result = run("door", "--device-address", "there")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--device-address: expected HOST:PORT", result.stderr)

    def make_key(self, folder, name="key", mode=0o600):
        file = pathlib.Path(folder, name)
        file.write_bytes(os.urandom(32))
        file.chmod(mode)
        return file

    def test_a_key_keeps_out_who_has_another_one_or_none(self):
        with tempfile.TemporaryDirectory() as folder:
            key, other = self.make_key(folder), self.make_key(folder, "other")
            with Server("free_space", "--fast", "--key-file", key) as server:
                address = server.address
                short = ("free_space", "--fast", "--duration", "1", "--device-address", address)
                refusal = (f"{address}: the device refuses: its key is another one, or none was given "
                           "(--key-file)\n")
                for arguments in ((), ("--key-file", other)):
                    result = run(*short, *arguments)
                    self.assertEqual((result.returncode, result.stderr), (2, refusal))
                result = run(*short, "--key-file", key)
                self.assertEqual(result.returncode, 1, result.stderr)  # too short for its events
                self.assertRegex(result.stdout, r"allocations +0 in the loop")
                said = server.session()
                self.assertRegex(said, r"link +\d+ sent, \d+ received\n")
                client = subprocess.run(
                    [sys.executable, CLIENT, address, "--seconds", "0.1", "--key-file", key],
                    text=True, capture_output=True, timeout=100)
                self.assertEqual(client.returncode, 0, client.stdout + client.stderr)
                client = subprocess.run([sys.executable, CLIENT, address], text=True,
                                        capture_output=True, timeout=100)
                self.assertNotEqual(client.returncode, 0)
                self.assertIn("its key is another one", client.stderr)
            with Server("free_space", "--fast") as server:
                result = run("free_space", "--fast", "--device-address", server.address,
                             "--key-file", key)
                self.assertEqual(result.returncode, 2)
                self.assertIn("it has no key (--key-file), and none may be given", result.stderr)
            open_key = self.make_key(folder, "open", 0o640)
            result = run("door", "--device-address", "127.0.0.1:1", "--key-file", open_key)
            self.assertEqual(result.returncode, 2)
            self.assertIn("the key must be its owner's only, got mode 0640", result.stderr)
            for bad in ("", open_key):
                client = subprocess.run(
                    [sys.executable, CLIENT, "127.0.0.1:1", "--key-file", bad], text=True,
                    capture_output=True, timeout=100)
                self.assertNotEqual(client.returncode, 0)
                self.assertRegex(client.stderr, "cannot be read|its owner's only")
        result = run("door", "--key-file", "key")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--device-address", result.stderr)

    def test_a_capture_on_a_full_disk_is_reported(self):
        with Server("door", "--fast", "--capture", "/dev/full") as server:
            subprocess.run([sys.executable, CLIENT, server.address, "--seconds", "0.1"], check=True,
                           capture_output=True, timeout=100)
            server.session()
            server.process.send_signal(signal.SIGINT)
            said = server.process.stdout.read()
            self.assertEqual(server.process.wait(timeout=60), 4)
            self.assertIn("/dev/full: the capture ended early: No space left on device", said)

    def test_the_python_client_holds_the_arm(self):
        with Server("door", "--fast") as server:
            result = subprocess.run([sys.executable, CLIENT, server.address, "--seconds", "0.5"],
                                    text=True, capture_output=True, timeout=100)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertIn("HapticGiant: 2 gantry axes, 6 joints, 1000 Hz, lock-step", result.stdout)
            moved = float(re.search(r"moved by at most (\S+) rad", result.stdout)[1])
            self.assertLess(moved, 0.02)


class StartTest(unittest.TestCase):
    """`hapticgiant start-test` at a simulated device with a simulated operator, through UDP."""

    def start_test(self, *faults):
        """Its process, what it kept, and the server's words."""
        with tempfile.TemporaryDirectory() as folder:
            text = (ROOT / "models/scenarios/free_space.yaml").read_text()
            text = text.replace(": ../", f": {ROOT}/models/") + "faults:\n"
            scenario = pathlib.Path(folder, "scenario.yaml")
            scenario.write_text(text + "".join(f"  - {fault}\n" for fault in faults)
                                if faults else text.removesuffix("faults:\n"))
            with Server(scenario, "--fast") as server:
                result = subprocess.run(
                    [PROGRAM, "start-test", "--fast", "--device-address", server.address,
                     "--recordings", folder], cwd=ROOT, text=True, capture_output=True, timeout=500)
            file = pathlib.Path(folder, "start_test_HapticGiant_simulated.json")
            kept = json.loads(file.read_text())
        return result, kept, {item["name"]: item for item in kept["items"]}

    def test_a_good_device_passes_and_the_result_is_kept(self):
        result, kept, items = self.start_test()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("with a simulated operator", result.stdout)
        self.assertIn("-> press the emergency stop (30 s)", result.stdout)
        self.assertTrue(kept["passed"])
        self.assertTrue(kept["simulated"])
        self.assertEqual(len(kept["files_sha256"]), 64)
        failed = [name for name, item in items.items() if item["outcome"] == "failed"]
        self.assertEqual(failed, [])
        for name in ("emergency stop", "enabling switch", "override key", "scanner", "brake ppu1",
                     "brake m1", "brake m4"):
            self.assertEqual(items[name]["outcome"], "passed", name)
        self.assertLess(items["brake m1"]["motion_rad_or_m"], 1e-3)
        self.assertGreater(items["brake m1"]["load_Nm_or_N"], 9.6)
        # no hand can twist through the protocol
        self.assertEqual(items["brake m6"]["outcome"], "not tested")

    def test_a_brake_that_does_not_hold_is_named(self):
        result, kept, items = self.start_test("{at_s: 0, fault: brake_weak, of: m1}")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertFalse(kept["passed"])
        self.assertEqual(items["brake m1"]["outcome"], "failed")
        self.assertIn("SLIPS: moved by", items["brake m1"]["found"])
        self.assertIn("brake m1           SLIPS", result.stdout)
        self.assertEqual(items["emergency stop"]["outcome"], "not tested")

    def test_a_wire_of_the_emergency_stop_that_stays_on_is_named(self):
        for of, name in (("stop buttons", "emergency stop"), ("operator enable", "enabling switch")):
            result, kept, items = self.start_test(
                f"{{at_s: 0, fault: safety_channel_stuck, of: {of}}}")
            self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
            failed = [name for name, item in items.items() if item["outcome"] == "failed"]
            self.assertEqual(failed, [name])
            self.assertIn("only one of its two channels did", items[name]["found"])

    def test_a_fault_while_armed_ends_its_item_without_arming_again(self):
        # while it is waited for the emergency stop
        result, kept, items = self.start_test("{at_s: 102.2, for_s: 0.01, fault: drive_fault}")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertEqual(items["emergency stop"]["outcome"], "failed")
        self.assertEqual(items["emergency stop"]["found"], "the drives went off before it was "
                         "operated: drive reports a fault")
        self.assertEqual(items["enabling switch"]["outcome"], "passed", result.stdout)
        self.assertEqual(result.stdout.count("the drives come on"), 2)

    def test_a_server_that_goes_is_exit_code_3(self):
        with tempfile.TemporaryDirectory() as folder:
            with Server("free_space", "--fast") as server, Machine(server.address) as machine:
                process = self.waiting_test(machine, folder)
                file, = pathlib.Path(folder).glob("start_test_HapticGiant_127_0_0_1_*.json")
                self.assertFalse(json.loads(file.read_text())["passed"])  # should it be killed now
                server.close()
                said = process.communicate(timeout=100)[0]
            kept = json.loads(file.read_text())
        self.assertEqual(process.returncode, 3, said)
        self.assertIn("the test has ended early: remote device has ended the session", said)
        self.assertFalse(kept["passed"])

    def waiting_test(self, machine, folder):
        """With an operator who follows its requests."""
        process = subprocess.Popen(
            [PROGRAM, "start-test", "--fast", "--device-address", machine.address, "--recordings",
             folder], cwd=ROOT, text=True, stdout=subprocess.PIPE)
        read_until(process.stdout, lambda line: "->" in line)
        return process

    def test_ctrl_c_is_a_test_that_failed(self):
        with tempfile.TemporaryDirectory() as folder, Server("free_space", "--fast") as server, \
                Machine(server.address) as machine:
            process = self.waiting_test(machine, folder)
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=100)[0]
            self.assertEqual(process.returncode, 1, said)
            self.assertIn("the test has ended early: interrupted", said)
            self.assertIn("the client left: done", server.session())


class Machine:
    """Between a server and its clients: makes a machine of the simulation there, and is the person
    who follows the requests of `start-test`."""

    ACTS = [("turn the override key on", "override_key", 1), ("turn the override key off", "override_key", 0),
            ("step into the field", "is_field_clear", 0), ("leave the field", "is_field_clear", 1),
            ("take the handle", "dead_man", 1), ("let go of the handle", "dead_man", 0),
            ("press the emergency stop", "emergency_stop", 1),
            ("pull the emergency stop out", "emergency_stop", 0),
            ("let go of the enabling switch", "operator_enable", 0),
            ("hold the enabling switch", "operator_enable", 1)]
    FLAGS = ["dead_man", "emergency_stop", "operator_enable", "override_key", "is_field_clear"]
    Q_P = 11 + 4 * 9 + 2  # field of the first gantry axis

    def __init__(self, server):
        self.there = server.rsplit(":", 1)[0], int(server.rsplit(":", 1)[1])
        self.front = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.front.bind(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.front.getsockname()[1]
        self.inputs = {"is_field_clear": 1, "operator_enable": 1}
        self.homing_error = 0.0
        self.backs = {}  # a socket for each client
        self.is_over = False
        self.thread = threading.Thread(target=self.serve)
        self.thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.is_over = True
        self.thread.join()
        for each in (self.front, *self.backs.values()):
            each.close()

    def serve(self):
        while not self.is_over:
            with contextlib.suppress(ConnectionRefusedError):  # the server has gone
                self.pass_on()

    def pass_on(self):
        sockets = [self.front, *self.backs.values()]
        for ready in select.select(sockets, [], [], 0.1)[0]:
            if ready is self.front:
                data, client = ready.recvfrom(2048)
                if client not in self.backs:
                    self.backs[client] = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
                    self.backs[client].connect(self.there)
                self.backs[client].send(data)
            else:
                client = next(c for c, back in self.backs.items() if back is ready)
                self.front.sendto(self.changed(ready.recv(2048)), client)

    def changed(self, data):
        kind, session, number, fields = device_client.decode(data)
        fields = list(fields)
        if kind == device_client.WELCOME:
            fields[2] = 0
        if kind == device_client.SENSORS:
            for at, flag in enumerate(self.FLAGS, 3):
                fields[at] = self.inputs.get(flag, 0)
            fields[self.Q_P] += self.homing_error
        return device_client.encode(kind, session, number, *fields)

    def obey(self, words):
        for begin, flag, value in self.ACTS:
            if words.startswith(begin):
                self.inputs[flag] = value


class MachineTest(unittest.TestCase):
    def test_a_tested_machine_runs_until_its_homing_is_wrong(self):
        with tempfile.TemporaryDirectory() as folder, Server("free_space", "--fast") as server, \
                Machine(server.address) as machine:
            here = ("--fast", "--device-address", machine.address, "--recordings", folder)
            result = run("free_space", *here)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("no start test of HapticGiant that counts: there is none", result.stderr)

            process = subprocess.Popen([PROGRAM, "start-test", *here], cwd=ROOT, text=True,
                                       stdout=subprocess.PIPE)
            said = ""
            with process.stdout:
                for line in process.stdout:
                    said += line
                    if "-> " in line:
                        machine.obey(line.split("-> ")[1])
            self.assertEqual(process.wait(timeout=300), 0, said)
            file, = pathlib.Path(folder).glob("start_test_*.json")
            kept = json.loads(file.read_text())
            self.assertFalse(kept["simulated"])
            self.assertEqual(kept["address"], machine.address)
            self.assertEqual({item["outcome"] for item in kept["items"]}, {"passed"}, said)

            machine.inputs["dead_man"] = 0
            result = run("free_space", *here, "--duration", "1")
            self.assertRegex(result.stdout, r"start test +passed \d{4}-\d\d-\d\d \d\d:\d\d UTC\n")
            self.assertIn("nothing is known of the last run: homing was not compared", result.stdout)
            result = run("free_space", *here, "--duration", "1")
            self.assertIn("stands where the last run has left it", result.stdout, result.stderr)

            machine.homing_error = 0.3
            result = run("free_space", *here, "--duration", "1")
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, r"ppu1: \S+ m, the last run has left it at \S+ m\n")
            self.assertIn("--posture-confirmed ppu1\n", result.stderr)
            result = run("free_space", *here, "--duration", "1", "--posture-confirmed", "ppu1")
            self.assertIn("as was confirmed", result.stdout, result.stderr)

    def test_a_machine_that_goes_leaves_the_posture_of_the_run_before(self):
        with tempfile.TemporaryDirectory() as folder, Server("free_space", "--fast") as server, \
                Machine(server.address) as machine:
            here = ("free_space", "--fast", "--device-address", machine.address, "--recordings",
                    folder, "--without-start-test")
            run(*here, "--duration", "0.1")
            file, = pathlib.Path(folder).glob("posture_HapticGiant_127_0_0_1_*.json")
            kept = file.read_text()
            process = subprocess.Popen(
                [PROGRAM, "run", *here, "--duration", "100000", "--no-viewer", "--no-recording"],
                cwd=ROOT, text=True, stdout=subprocess.PIPE)
            said = read_until(process.stdout, lambda line: "tare" in line)
            server.close()
            said += process.communicate(timeout=100)[0]
            self.assertEqual(process.returncode, 3, said)
            self.assertIn("posture      not kept, because the device has gone", said)
            self.assertEqual(file.read_text(), kept)


class PythonCodec(unittest.TestCase):
    def test_a_datagram_with_a_tag_is_good_with_its_key_only(self):
        key = bytes(range(32))
        document = (ROOT / "docs" / "reference" / "device_protocol.md").read_text()
        shown = re.search(r"```text\n([0-9a-f]{64})\n([0-9a-f]{32})\n([0-9a-f]{8})\n```", document)
        datagram = bytes.fromhex("".join(shown.groups()))
        self.assertEqual(device_client.decode(datagram, key),
                         (device_client.READY, 0x01020305, 2, ()))
        self.assertIsNone(device_client.decode(datagram))
        self.assertIsNone(device_client.decode(datagram, key[1:] + b"x"))
        plain = device_client.encode(device_client.READY, 7, 1)
        self.assertIsNone(device_client.decode(plain, key))
        again = device_client.encode(device_client.GOODBYE, 7, 1, 1, 0, b"done", key=key)
        self.assertEqual(device_client.decode(again, key)[3][2].rstrip(b"\0"), b"done")

    def test_it_understands_a_captured_session_and_writes_the_same_bytes(self):
        data = (ROOT / "tests" / "remote" / "session.pcap").read_bytes()
        at, kinds = 24, []
        while at < len(data):
            size = struct.unpack_from("<IIII", data, at)[2]
            datagram = data[at + 16:at + 16 + size]
            at += 16 + size
            kind, session, number, fields = device_client.decode(datagram)
            kinds.append(kind)
            again = device_client.encode(kind, session, number, *fields)
            self.assertEqual(again[:24] + again[32:-4], datagram[:24] + datagram[32:-4])
            self.assertIsNone(device_client.decode(datagram[:-1]))
            self.assertIsNone(device_client.decode(datagram[:50] + b"\7" + datagram[51:]))
            if kind == device_client.SENSORS:
                sensors = device_client.unpack_sensors(fields)
                self.assertEqual(len(sensors["q_m"]), 6)
                self.assertEqual(len(sensors["q_p"]), 2)
                self.assertAlmostEqual(sensors["q_m"][1], 1.5709, places=3)
                self.assertEqual(len(sensors["omega_S"]), 3)
        self.assertEqual(kinds.count(device_client.SENSORS), 21)

    def test_malformed_messages_are_none(self):
        command = device_client.pack_command(7, 1, [0.1] * 6, [0.2] * 6, [0.3] * 6, [0.4] * 6,
                                             [0.5] * 2)
        unpack = device_client.unpack_command
        good = unpack(command, 6, 2, 2)
        self.assertEqual((good["sequence"], good["enable"]), (7, True))
        self.assertEqual((good["tau_m"], good["dq_p"]), ([0.4] * 6, [0.5] * 2))
        self.assertIsNone(unpack(command, 7, 2, 2))
        self.assertIsNone(unpack(command, 6, 1, 2))
        self.assertIsNone(unpack(command, 6, 2, 1))  # torques for drives that follow q_m
        for at, value in [(1, 2), (2, 2), (3, math.nan), (6, -0.1), (6, 1.1), (6, math.nan), (7, 2),
                          (11, 2), (12, 1), (13, 5), (13, 8), (14, 1), (15, math.inf), (21, 0.1),
                          (40, 0), (42, math.nan), (49, 3), (51, -math.inf)]:
            with self.subTest(at=at, value=value):
                self.assertIsNone(unpack([*command[:at], value, *command[at + 1:]], 6, 2, 2))

        sensors = [7, 0.1, 6, 1, 0, 1, 0, 1, 0, 0, 0, *4 * device_client.vector([0.1] * 6),
                   *device_client.vector([0.2] * 2, 2), *[0.3] * 12, *device_client.vector([40.0] * 6)]
        self.assertEqual(device_client.unpack_sensors(sensors)["omega_S"], [0.3] * 3)
        for at, value in [(1, math.nan), (3, 2), (4, 2), (8, 2), (11, 8), (12, 1), (19, 0.1),
                          (31, math.inf), (40, math.nan), (47, 3), (50, math.nan), (62, math.nan),
                          (63, 8), (65, math.nan)]:
            with self.subTest(at=at, value=value):
                self.assertIsNone(
                    device_client.unpack_sensors([*sensors[:at], value, *sensors[at + 1:]]))

    def test_words_from_the_network_cannot_command_a_terminal(self):
        self.assertEqual(device_client.text(b"Gr\xc3\xbc\xc3\x9fe\x1b[2J\r\xc2\x9b.\0x"),
                         "Gr\u00fc\u00dfe?[2J??.")


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
