"""The HapticGiant on a simulated segment: `hapticgiant bus check`, and `run door` through the whole
bus, with the plant of our simulator behind the drives.

    machine_test.py PROGRAM SEGMENT

Needs network namespaces, virtual interfaces and raw sockets; where the kernel forbids them it is
skipped (exit code 77).
"""

import contextlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

import bus

ROOT = pathlib.Path(__file__).resolve().parents[2]
LAYOUT = ROOT / "tests" / "ethercat" / "haptic_giant.txt"
FILE = ROOT / "models" / "haptic_giant" / "machine.yaml"
SIMULATION = ROOT / "models" / "haptic_giant" / "simulation.yaml"
SKIPPED = 77
PATIENCE = 100  # s
FAULT_FRAME = 2600  # at about 2.5 s of a run: the hand leans against the locked door
PROGRAM = SEGMENT = None


@contextlib.contextmanager
def segment(layout=LAYOUT, plant=None):
    one = bus.Segment(SEGMENT, layout, plant)
    try:
        yield one
    finally:
        one.close()


@contextlib.contextmanager
def plant(scenario="door", *arguments):
    """The address of a simulated machine."""
    server = subprocess.Popen([PROGRAM, "simulate", scenario, "--fast", "--listen", "127.0.0.1:0",
                               *arguments], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    try:
        for line in server.stdout:
            if line.startswith("address"):
                yield line.split()[1]
                break
    finally:
        server.terminate()
        server.communicate(timeout=PATIENCE)


@contextlib.contextmanager
def haptic_giant(scenario="door"):
    """The same for the HapticGiant. Its commands are valid at once: the bus is the latency."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "simulation.yaml")
        text, count = re.subn(r"\n  latency: 1 .*", "\n  latency: 0.001", SIMULATION.read_text())
        assert count == 1
        file.write_text(text)
        with plant(scenario, "--simulation", file) as address:
            yield address


def that_keeps_time():
    """The shipped machine as one that is no simulation: with times of its own."""
    text = FILE.read_text()
    for key, value in (("moves_with_frames", "false"), ("watchdog_s", "0.05"),
                       ("answer_s", "0.0005")):
        text = re.sub(f"\n{key}: .*", f"\n{key}: {value}", text)
    return text


class Run:
    """A run of the door, or of another scenario, in a process of its own."""

    def __init__(self, *arguments, scenario="door"):
        self.folder = tempfile.TemporaryDirectory()
        self.summary_file = pathlib.Path(self.folder.name, "summary.json")
        self.process = subprocess.Popen(
            [PROGRAM, "run", scenario, "--fast", "--no-recording", "--flight-recorder", "off",
             "--summary", self.summary_file, *arguments], cwd=ROOT, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True)

    def wait(self):
        """Exit code, what it said, its summary."""
        said, _ = self.process.communicate(timeout=PATIENCE)
        has_summary = self.summary_file.exists()
        summary = json.loads(self.summary_file.read_text()) if has_summary else None
        self.folder.cleanup()
        return self.process.returncode, said, summary


def over_the_bus(*arguments, **scenario):
    return Run("--device-address", f"ethercat://{bus.MASTER_END}", *arguments, **scenario)


def expect_same_events(test, summary, expected):
    test.assertEqual([(event["name"], event["what"]) for event in summary["events"]],
                     [(event["name"], event["what"]) for event in expected["events"]])
    for event, wanted in zip(summary["events"], expected["events"]):
        test.assertAlmostEqual(event["time_s"], wanted["time_s"], delta=0.005, msg=event["name"])
    test.assertTrue(summary["limits_held"])
    test.assertEqual(summary["allocations_in_loop"], 0)


class Door(unittest.TestCase):
    def test_the_events_are_those_of_the_run_without_a_bus(self):
        code, said, expected = Run().wait()
        self.assertEqual(code, 0, said)
        with haptic_giant() as address, segment(plant=address) as one:
            run = over_the_bus()
            has_opened_brakes = False
            while run.process.poll() is None and not has_opened_brakes:
                has_opened_brakes = one.show()[10]["outputs"] == 2
            code, said, summary = run.wait()
            self.assertEqual(code, 0, said)
            self.assertTrue(has_opened_brakes)
            states = one.show()
        expect_same_events(self, summary, expected)
        # the drives were left off, and the slaves in PRE-OP
        self.assertEqual([slave["status"] for slave in states], [2] * 11)
        self.assertTrue(all(slave["brake_is_closed"] for slave in states[:8]))
        self.assertEqual(states[10]["outputs"], 0)


class Recording(unittest.TestCase):
    def test_has_the_file_of_the_machine_and_is_replayed(self):
        with haptic_giant() as address, segment(plant=address), \
                tempfile.TemporaryDirectory() as folder:
            ran = subprocess.run(
                [PROGRAM, "run", "door", "--fast", "--duration", "0.5", "--recordings", folder,
                 "--device-address", f"ethercat://{bus.MASTER_END}"], cwd=ROOT,
                capture_output=True, text=True, timeout=PATIENCE)
            file = pathlib.Path(folder, "latest.mcap")
            self.assertTrue(file.exists(), ran.stdout + ran.stderr)
            self.assertIn(b"models/haptic_giant/machine.yaml", file.read_bytes())
            replayed = subprocess.run([PROGRAM, "replay", file], cwd=ROOT, capture_output=True,
                                      text=True, timeout=PATIENCE)
            self.assertEqual(replayed.returncode, 0, replayed.stdout + replayed.stderr)


class Positions(unittest.TestCase):
    """An arm whose drives follow positions: a Franka FR3 with drives of another maker."""

    JOINTS = [f"fr3_joint{i}" for i in range(1, 8)]
    TURN = 2 ** 28
    SCENARIO = "fr3/open_drawer"
    DEVICE = ("--device", "fr3/fci")

    def layout(self):
        lines = [f"drive {name} product=0x130 joint={i} turn={self.TURN}"
                 for i, name in enumerate(self.JOINTS, 1)]
        return "\n".join(lines + ["force wrist product=0x302", "io panel product=0x401"])

    def machine(self):
        scale = 2 * math.pi / self.TURN
        drives = [{"name": name, "vendor": 0x00FFFF00, "product": 0x130, "revision": 1,
                   "joint": name, "mode": "csp", "synchronous": True,
                   "settings": [  # another mapping than the drive has at first
                       {"object": 0x1C12, "bits": 8, "value": 0},
                       {"object": 0x1C12, "subindex": 1, "bits": 16, "value": 0x1601},
                       {"object": 0x1C12, "bits": 8, "value": 1}],
                   "outputs": [
                       {"object": 0x6060, "bits": 8, "is": "mode"}, {"bits": 8},
                       {"object": 0x6040, "bits": 16, "is": "control_word"},
                       {"object": 0x607A, "bits": 32, "is": "target_position", "scale": scale},
                       {"object": 0x60B2, "bits": 16}],
                   "inputs": [
                       {"object": 0x6041, "bits": 16, "is": "status_word"},
                       {"object": 0x6064, "bits": 32, "is": "link_position", "scale": scale},
                       {"object": 0x606C, "bits": 32, "is": "link_velocity", "scale": scale},
                       {"object": 0x6077, "bits": 16},
                       {"object": 0x6061, "bits": 8, "is": "mode_now"}, {"bits": 8}]}
                  for name in self.JOINTS]
        text = FILE.read_text()
        sensors = text[text.index("  - name: wrist"):text.index("  - name: imu")]
        panel = text[text.index("  - name: panel"):]
        head = "name: arm\nmoves_with_frames: true\nwatchdog_s: 2\nanswer_s: 0.25\nslaves:\n"
        return head + "".join(f"  - {json.dumps(drive)}\n" for drive in drives) + sensors + panel

    def test_the_events_are_those_of_the_run_without_a_bus(self):
        code, said, expected = Run(*self.DEVICE, scenario=self.SCENARIO).wait()
        self.assertEqual(code, 0, said)
        with tempfile.TemporaryDirectory() as folder:
            layout, machine = pathlib.Path(folder, "layout.txt"), pathlib.Path(folder, "machine.yaml")
            layout.write_text(self.layout())
            machine.write_text(self.machine())
            with plant(self.SCENARIO, *self.DEVICE) as address, segment(layout, address):
                code, said, summary = over_the_bus("--machine", machine, *self.DEVICE,
                                                   scenario=self.SCENARIO).wait()
        self.assertEqual(code, 0, said)
        expect_same_events(self, summary, expected)


class Check(unittest.TestCase):
    def check(self, file=FILE):
        tried = subprocess.run([PROGRAM, "bus", "check", file, bus.MASTER_END],
                               capture_output=True, text=True, timeout=PATIENCE)
        return tried.returncode, tried.stdout + tried.stderr

    def check_with(self, old, new):
        """The file with a change that the bus does not have."""
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            text = FILE.read_text()
            self.assertIn(old, text)
            file.write(text.replace(old, new, 1))
            file.flush()
            return self.check(file.name)

    def test_the_shipped_machine_is_the_segment(self):
        with segment() as one:
            code, said = self.check()
            self.assertEqual(code, 0, said)
            self.assertIn("11 slaves on master0 are those of", said)
            self.assertEqual([slave["status"] for slave in one.show()], [2] * 11)
            self.assertIn("slave 3 (m1): quick stop (0x605a): slows down on its quick stop ramp; "
                          "shutdown (0x605b): power off at once; ", said)
            wire = bus.Wire()
            for address in [*range(0x1000, 0x1008), 0x100A]:  # 2 s in units of 100 us
                self.assertEqual(wire.exchange(bus.FPRD, (address, 0x0420), b"\0\0"),
                                 ((20000).to_bytes(2, "little"), 1))
            wire.close()

    def test_each_difference_is_one_sentence(self):
        with segment():
            for old, new, sentence in (
                    ("product: 0x110", "product: 0x111",
                     "slave 1 (ppu1): product 0x00000110 found, expected is 0x00000111"),
                    ("value: 1956", "value: 5000",
                     "slave 3 (m1): object 0x6072:0 does not take 5000: abort code 0x06090030: "
                     "Value range"),
                    ("- {object: 0x6072, bits: 16, value: 1956}",
                     "- {object: 0x605C, bits: 16, value: -1}",
                     "slave 3 (m1): object 0x605c:0, what the drive does at 'disable operation', "
                     "is -1, expected is 0 to 1"),
                    ("{object: 0x6071, bits: 16, is: target_torque, scale: 0.06}",
                     "{object: 0x60FF, bits: 32, is: target_torque, scale: 0.06}",
                     "slave 5 (m3): entry 2 of its outputs is 0x6071:0 of 16 bits, expected is "
                     "0x60ff:0 of 32 bits\nslave 6 (m4): entry 2"),
                    ("is: sensor_fault}\n      - {object: 0x6020, bits: 32, is: sample_counter}",
                     "is: sensor_fault}",
                     "slave 9 (wrist): its inputs have 8 entries, expected are 7"),
                    ("slaves:\n", "slaves:\n  - {name: new, vendor: 0x00FFFF02, product: 1, revision: 1}\n",
                     "11 slaves found, expected are 12\nslave 1 (new): vendor 0x00ffff00 found")):
                with self.subTest(sentence):
                    code, said = self.check_with(old, new)
                    self.assertEqual(code, 1, said)
                    self.assertIn(sentence, said)

    def test_faults_of_the_file_have_their_place(self):
        code, said = self.check_with("is: motor_position", "is: moter_position")
        self.assertEqual(code, 2, said)
        self.assertRegex(said, r":\d+:\d+: slaves\[2\]\.inputs\[4\]\.is: .*did you mean "
                               "'motor_position'")


class Faults(unittest.TestCase):
    """What goes wrong during a run ends it with a safe machine and a message."""

    def run_until(self, command, *words):
        with haptic_giant() as address, segment(plant=address) as one:
            one.command(f"after {FAULT_FRAME} {command}")
            code, said, summary = over_the_bus().wait()
            self.assertEqual(code, 3, said)
            for word in words:
                self.assertIn(word, said)
            self.assertEqual(summary["allocations_in_loop"], 0)
            self.expect_brakes(one)
            self.states = one.show()

    def expect_brakes(self, one):
        """Drives that are not reached any more are stopped by their watchdogs."""
        until = time.monotonic() + PATIENCE
        while not all(slave["brake_is_closed"] for slave in one.show()[:8]):
            self.assertLess(time.monotonic(), until, one.show())
            time.sleep(0.1)

    def test_lost_frames(self):
        self.run_until("lose 3", "fieldbus answers are missing",
                       "3 exchanges in a row were incomplete: working counter 0 of 29")

    def test_two_lost_frames_do_no_harm(self):
        with haptic_giant() as address, segment(plant=address) as one:
            one.command("after 9600 lose 2")  # the door pops open
            one.command("after 12000 lose 2")  # it falls shut
            code, said, summary = over_the_bus().wait()
        self.assertEqual(code, 0, said)
        self.assertEqual(summary["missing_events"], [], said)
        self.assertTrue(summary["limits_held"], said)
        self.assertEqual((summary["link"]["lost"], summary["link"]["held"]), (4, 4), said)

    def test_silence(self):
        """No slave answers, but all hear that they must stop, long before their watchdogs act."""
        self.run_until("lose 1000000 any", "fieldbus answers are missing",
                       "master0: no answer to 10 frames in a row")
        self.assertEqual([(slave["drive"], slave["error"]) for slave in self.states[:8]],
                         [("SwitchOnDisabled", 0)] * 8)

    def test_late_frames(self):
        self.run_until("late 3 400000", "fieldbus answers are missing",
                       "3 exchanges in a row were incomplete: working counter 0 of 29")

    def test_a_wrong_counter(self):
        self.run_until("miscount m2 50", "fieldbus answers are missing",
                       "3 exchanges in a row were incomplete: working counter 26 of 29")

    def test_a_drive_that_falls_out(self):
        self.run_until("fall m2 safeop 0x001B", "drive reports a fault",
                       "slave 4 (m2), address 0x1003: has left OP: SAFE-OP + error, AL status code "
                       "0x001b: Sync")

    def test_a_sensor_that_falls_out(self):
        self.run_until("fall wrist preop 0x0050", "fieldbus answers are missing",
                       "slave 9 (wrist), address 0x1008: has left OP: PRE-OP + error, AL status "
                       "code 0x0050")

    def test_an_open_cable(self):
        self.run_until("open m4", "drive reports a fault",
                       "slave 7 (m5), address 0x1006: does not answer")

    def test_a_drive_that_trips(self):
        self.run_until("trip m1 0x3210", "drive reports a fault",
                       "slave 3 (m1), address 0x1002: the drive has failed: ", "error 0x3210")

    def test_a_drive_that_no_longer_follows(self):
        self.run_until("brake m3", "drive reports a fault",
                       "slave 5 (m3), address 0x1004: the drive no longer follows its commands: "
                       "'operation enabled'")

    def test_a_sensor_that_is_broken(self):
        self.run_until("trip wrist 7", "fieldbus answers are missing",
                       "slave 9 (wrist), address 0x1008: the sensor reports fault 0x0007")


class Recovery(unittest.TestCase):
    """An operator resets at 4 s, and lets the machine run again."""

    PANEL = """
panel:
  - {at_s: 4.0, reset: true}
  - {at_s: 4.5, request: reset}
  - {at_s: 4.7, request: arm}
  - {at_s: 5.0, request: run}
"""

    def scenario(self, folder):
        text = (ROOT / "models" / "scenarios" / "door.yaml").read_text()
        file = pathlib.Path(folder, "reset.yaml")
        file.write_text(text.replace("../", f"{ROOT}/models/") + self.PANEL)
        return file

    def expect_recovery(self, command, fault="113 drive reports a fault"):
        with haptic_giant() as address, segment(plant=address) as one, \
                tempfile.TemporaryDirectory() as folder:
            one.command(f"after {FAULT_FRAME} {command}")
            code, said, summary = over_the_bus("--duration", "6",
                                               scenario=self.scenario(folder)).wait()
        self.assertEqual(code, 3, said)  # there was a fault
        self.assertIn(fault, said)
        self.assertEqual([event["name"] for event in summary["events"]],
                         ["locked", "handle pressed", "pulled"], said)
        self.assertTrue(summary["limits_held"], said)

    def test_a_drive_that_has_tripped_is_reset(self):
        self.expect_recovery("trip m1 0x3210")

    def test_a_sensor_that_has_fallen_is_called_back(self):
        self.expect_recovery("fall wrist safeop 0x001B", "109 fieldbus answers are missing")

    def test_a_drive_that_has_fallen_is_called_back(self):
        self.expect_recovery("fall m2 safeop 0x001B")


class Start(unittest.TestCase):
    """A bus that is not the machine is not driven."""

    def refused(self, *words, arguments=()):
        code, said, _ = over_the_bus(*arguments).wait()
        self.assertEqual(code, 2, said)
        for word in words:
            self.assertIn(word, said)

    def test_of_another_segment_is_refused(self):
        with segment(bus.MACHINE):
            self.refused("master0: the bus is not HapticGiant:", "9 slaves found, expected are 11",
                         "slave 1 (ppu1): product 0x00000101 found, expected is 0x00000110")

    def test_of_slaves_that_would_not_stop_by_themselves_is_refused(self):
        for key, sentence in (
                ("watchdog", "slave 4 (m2): its watchdog is switched off (bit 6 of the control byte "
                 "0x24 of sync manager 2): without frames it would go on with its last outputs"),
                ("pulses", "slave 4 (m2): its sync pulses do not come (register 0x0990 stands)")):
            with self.subTest(key), tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
                file.write(re.sub(r"(drive +m2 .*)", rf"\1 {key}=off", LAYOUT.read_text()))
                file.flush()
                with segment(file.name):
                    self.refused(sentence)

    def test_of_a_machine_that_says_it_were_a_simulation_is_refused(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(FILE.read_text().replace("vendor: 0x00FFFF00", "vendor: 0x00000002", 1))
            file.flush()
            self.refused("moves_with_frames: slave 'ppu1' is no simulated one",
                         arguments=("--machine", file.name))

    def test_of_a_machine_keeps_time_and_needs_a_start_test(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            text = that_keeps_time()
            file.write(text)
            file.flush()
            self.refused("--fast: HapticGiant keeps its own time",
                         arguments=("--machine", file.name))
            with tempfile.TemporaryDirectory() as folder:
                tried = subprocess.run(
                    [PROGRAM, "run", "door", "--device-address", f"ethercat://{bus.MASTER_END}",
                     "--machine", file.name, "--no-viewer", "--recordings", folder], cwd=ROOT,
                    capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(tried.returncode, 2, tried.stdout)
            self.assertIn("no start test of HapticGiant that counts: there is none", tried.stderr)
            pathlib.Path(file.name).write_text(text.replace("answer_s: 0.0005", "answer_s: 0.0015"))
            self.refused("answer_s: must be at most a period, 0.001 s, got 0.0015",
                         arguments=("--machine", file.name))

    def test_with_a_file_that_does_not_fit_the_device_is_refused(self):
        for old, new, sentence in (
                ("is: joint_torque", "is: nothing", "slave 'm1': input 'joint_torque' is missing, "
                 "which the control of HapticGiant needs"),
                ("is: angular_rate_z", "is: nothing", "no slave has the input 'angular_rate_z'"),
                ("is: dead_man", "is: nothing", "no slave has the input 'dead_man'"),
                ("mode: csv", "mode: cst", "the target of its mode is missing"),
                ("joint: m1", "joint: m2", "joint 'm1' must have one drive, got 0")):
            with self.subTest(sentence), tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
                text = FILE.read_text()
                self.assertIn(old, text)
                file.write(text.replace(old, new, 1))
                file.flush()
                self.refused(sentence, arguments=("--machine", file.name))

    def test_that_cannot_be_read_is_refused(self):
        self.refused("nothing.yaml: no such file", arguments=("--machine", "nothing.yaml"))


def main():
    global PROGRAM, SEGMENT
    if bus.INSIDE not in os.environ:
        print(f"ethercat_machine: skipped, {bus.enter_namespace()}")
        return SKIPPED
    bus.make_interfaces()
    PROGRAM, SEGMENT = sys.argv[1:3]
    result = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
