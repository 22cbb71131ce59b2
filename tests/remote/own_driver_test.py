"""The driver that users begin with (examples/driver/python), against the program and against clients
that do what none should.

    own_driver_test.py PROGRAM
"""

import math
import os
import pathlib
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "examples" / "python"), str(ROOT / "examples" / "driver" / "python")]
import device_client as dc  # noqa: E402
import driver  # noqa: E402

PROGRAM = None
DRIVER = ROOT / "examples" / "driver" / "python" / "driver.py"
ARM = (b"example arm", 0, 6, 250.0, 1, 1)  # what a client of the driver in lock-step expects
PATIENT = ("--timeout-s", "100")  # so that a slow computer is no silence


class Driver:
    """driver.py at a free port; `code` runs before its main()."""

    def __init__(self, *arguments, code=None):
        start = [DRIVER]
        if code is not None:
            start = ["-c", f"import sys; sys.path.insert(0, {str(DRIVER.parent)!r}); import driver\n"
                           f"{code}\ndriver.main()"]
        self.process = subprocess.Popen(
            [sys.executable, *start, "--listen", "127.0.0.1:0", "--simulated", *arguments],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.head = self.process.stdout.readline()
        self.address = self.head.split(" at ")[1].split(": ")[0]
        self.port = int(self.address.rsplit(":", 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def client(self, name="test", key=None):
        return dc.Client("127.0.0.1", self.port, name, key)

    def session(self):
        """The closing line of a session that has ended or will."""
        while line := self.process.stdout.readline():
            if line.startswith("  "):
                return line
        raise AssertionError("the driver has ended")

    def close(self):
        """Ctrl-C; what it says."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        return self.process.communicate(timeout=60)[0]


class Raw:
    """A client that can say anything."""

    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.socket.settimeout(60.0)
        self.session = self.number = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, kind, *values):
        self.number += 1
        self.socket.send(dc.encode(kind, self.session, self.number, *values))

    def receive(self, kind):
        """The fields of the next message of this type."""
        while True:
            message = dc.decode(self.socket.recv(2048))
            if message[0] == kind:
                if kind == dc.WELCOME:
                    self.session = message[1]
                return message[3]

    def hello(self, *expected, nonce=7):
        """Refusal and reason of the answer."""
        self.send(dc.HELLO, nonce, *expected, b"raw")
        welcome = self.receive(dc.WELCOME)
        return welcome[1], dc.text(welcome[11])


def command(client, sequence, enable, q_m):
    zeros = [0.0] * client.n_m
    return dc.pack_command(sequence, enable, q_m, zeros, zeros, [], [0.0] * client.n_p)


def goodbye(client):
    for _ in range(3):
        client.send(dc.GOODBYE, 1, 0, b"done")
    client.socket.close()


def answer(client, sensors, enable=1, q_m=None):
    """The frame after one that is answered with this command."""
    client.send(dc.COMMAND, *command(client, sensors["sequence"], enable, q_m or sensors["q_m"]))
    return client.sensors(60.0)


class WithTheProgram(unittest.TestCase):
    def run_there(self, served, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            return subprocess.run(
                [PROGRAM, "run", "free_space", "--device", "models/examples/arm.yaml", "--twin",
                 "free_space", "--fast", "--rate-hz", "250", "--no-recording", "--recordings", folder,
                 "--device-address", served.address, *arguments],
                cwd=ROOT, text=True, capture_output=True, timeout=200)

    def test_the_stand_in_is_led_by_the_program(self):
        with Driver("--fast") as served:
            self.assertEqual(served.head, f"example arm at {served.address}: 6 joints, 0 gantry axes, "
                                          "250 Hz, position, lock-step, simulated\n")
            for _ in range(2):  # the second one begins where the first has left it
                result = self.run_there(served, "--duration", "6")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertIn("limits       all held", result.stdout)
                self.assertRegex(result.stdout, r"force +mean [23]\.\d N, max 5\.0 N")
                self.assertRegex(served.session(),
                                 r"^  the client left: done; 1\d\d\d samples; ignored: nothing\n$")

    def test_another_name_or_rate_is_refused(self):
        with Driver("--fast", "--name", "other arm", "--rate-hz", "500") as served:
            result = self.run_there(served)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertEqual(result.stderr, f"{served.address}: the device refuses: device: other arm, "
                                            "expected example arm\n")
        with Driver("--fast", "--rate-hz", "500") as served:
            self.assertIn("rate in Hz: 500, expected 250", self.run_there(served).stderr)
            self.assertRegex(served.close(), r"refused 127\.0\.0\.1:\d+: rate in Hz: 500, expected 250")

    def test_a_key_keeps_out_who_has_none(self):
        with tempfile.TemporaryDirectory() as folder:
            key = pathlib.Path(folder, "key")
            key.write_bytes(os.urandom(32))
            key.chmod(0o600)
            with Driver("--fast", "--key-file", key) as served:
                self.assertIn("its key is another one, or none was given (--key-file)",
                              self.run_there(served).stderr)
                result = self.run_there(served, "--key-file", key, "--duration", "1")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertIn("ignored: nothing", served.session())
            with Driver("--fast") as served:
                self.assertIn("it has no key (--key-file), and none may be given",
                              self.run_there(served, "--key-file", key).stderr)


class LockStep(unittest.TestCase):
    def test_it_follows_with_the_drives_on_only(self):
        with Driver("--fast") as served:
            client = served.client()
            self.assertEqual((client.n_p, client.n_m, client.rate_Hz, client.interface,
                              client.is_lock_step), (0, 6, 250.0, 1, 1))
            sensors = first = client.sensors()
            self.assertEqual((first["sequence"], first["answered_sequence"]), (1, 0))
            goal = [q + 0.1 for q in first["q_m"]]
            for _ in range(5):
                sensors = answer(client, sensors, 0, goal)
            self.assertEqual(sensors["q_m"], first["q_m"])
            self.assertEqual((sensors["sequence"], sensors["answered_sequence"]), (6, 5))
            self.assertFalse(sensors["dead_man"])
            for _ in range(250):
                sensors = answer(client, sensors, 1, goal)
            for q, q_goal in zip(sensors["q_m"], goal):
                self.assertAlmostEqual(q, q_goal, places=4)
            self.assertTrue(sensors["dead_man"])
            sensors = answer(client, sensors, 0, first["q_m"])
            self.assertEqual(sensors["dq_m"], (0.0,) * 6)
            goodbye(client)
            self.assertIn("the client left: done", served.session())

    def test_what_is_no_good_command_is_ignored_and_counted(self):
        with Driver("--fast") as served:
            client = served.client()
            sensors = client.sensors()
            good = command(client, 1, 1, sensors["q_m"])
            nan = list(good)
            nan[15] = math.nan
            five = command(client, 1, 1, sensors["q_m"][:5])
            for bad in (nan, five, command(client, 2, 1, sensors["q_m"])):
                client.send(dc.COMMAND, *bad)
            torques = list(good)
            torques[13 + 3 * 9] = 6
            client.send(dc.COMMAND, *torques)
            client.socket.send(dc.encode(dc.COMMAND, client.session + 2, 99, *good))
            client.socket.send(dc.encode(dc.SENSORS, client.session, 99, *[0] * 11, *4 * dc.vector([]),
                                         *dc.vector([], 2), *[0.0] * 12, *dc.vector([])))
            broken = bytearray(dc.encode(dc.COMMAND, client.session, 99, *good))
            broken[60] ^= 1
            client.socket.send(broken)
            with Raw(served.port) as other:
                other.session = client.session
                other.send(dc.COMMAND, *good)
            ready = dc.encode(dc.READY, client.session, client.number + 1)
            client.number += 1
            client.socket.send(ready)
            client.socket.send(ready)
            after = answer(client, sensors)
            while after["sequence"] == 1:  # the frame was repeated for the ready
                after = client.sensors(60.0)
            self.assertEqual((after["sequence"], after["answered_sequence"]), (2, 1))
            goodbye(client)
            said = served.session()
            for count in ("4 malformed", "1 wrong session", "2 broken or foreign", "1 from others",
                          "1 duplicate"):
                self.assertIn(count, said)

    def test_an_overtaken_or_old_command_moves_nothing(self):
        with Driver("--fast") as served:
            client = served.client()
            sensors = client.sensors()
            sensors = answer(client, answer(client, sensors))
            self.assertEqual(sensors["sequence"], 3)
            client.send(dc.COMMAND, *command(client, 2, 1, sensors["q_m"]))
            self.assertEqual(client.sensors(60.0), sensors)  # sent again
            goodbye(client)

    def test_a_second_client_is_refused_with_the_name_of_the_first(self):
        with Driver("--fast") as served, Raw(served.port) as raw:
            client = served.client("first")
            client.sensors()
            self.assertEqual(raw.hello(*ARM), (1, "first has the device"))
            self.assertEqual(raw.session, 0)
            goodbye(client)
            self.assertIn("1 refused", served.session())
            self.assertEqual(raw.hello(*ARM), (0, ""))

    def test_the_first_that_is_ready_gets_the_device(self):
        with Driver("--fast") as served, Raw(served.port) as one, Raw(served.port) as two:
            self.assertEqual(one.hello(*ARM), (0, ""))
            self.assertEqual(two.hello(*ARM), (0, ""))
            self.assertNotEqual(one.session, two.session)
            two.send(dc.READY)
            self.assertEqual(two.receive(dc.SENSORS)[0], 1)
            self.assertEqual(dc.text(one.receive(dc.GOODBYE)[2]), "raw has the device")

    def test_who_guesses_a_session_gets_none(self):
        with Driver("--fast") as served, Raw(served.port) as one, Raw(served.port) as two:
            one.hello(*ARM)
            two.session = one.session
            two.send(dc.READY)
            one.send(dc.READY)
            self.assertEqual(one.receive(dc.SENSORS)[0], 1)

    def test_who_is_forgotten_after_many_hellos_is_still_welcome(self):
        with Driver("--fast") as served, Raw(served.port) as one:
            one.hello(*ARM)
            for _ in range(20):
                with Raw(served.port) as other:
                    other.hello(*ARM)
            one.send(dc.READY)
            self.assertEqual(one.receive(dc.SENSORS)[0], 1)

    def test_what_differs_is_named(self):
        with Driver("--fast") as served, Raw(served.port) as raw:
            for expected, reason in (
                    ((b"arm", *ARM[1:]), "device: example arm, expected arm"),
                    ((*ARM[:1], 2, *ARM[2:]), "gantry axes: 0, expected 2"),
                    ((*ARM[:2], 7, *ARM[3:]), "joints: 6, expected 7"),
                    ((*ARM[:3], 1000.0, *ARM[4:]), "rate in Hz: 250, expected 1000"),
                    ((*ARM[:4], 2, *ARM[5:]), "interface (1 position, 2 torque): 1, expected 2"),
                    ((*ARM[:5], 0), "lock-step: 1, expected 0")):
                self.assertEqual(raw.hello(*expected), (3, reason))
            newer = bytearray(dc.encode(dc.HELLO, 0, 1, 7, *ARM, b"raw"))
            struct.pack_into("<H", newer, 4, 3)
            struct.pack_into("<I", newer, len(newer) - 4, zlib.crc32(newer[:-4]))
            raw.socket.send(newer)
            welcome = raw.receive(dc.WELCOME)
            self.assertEqual((welcome[1], dc.text(welcome[11])), (2, "protocol: version 2, expected 3"))


class RealTime(unittest.TestCase):
    def test_it_follows_and_the_newest_command_stays_in_effect(self):
        with Driver(*PATIENT) as served:
            client = served.client()
            self.assertEqual(client.is_lock_step, 0)
            first = client.sensors(60.0)
            goal = [q + 0.1 for q in first["q_m"]]
            client.send(dc.COMMAND, *command(client, first["sequence"], 1, goal))
            sensors = first
            for _ in range(250):
                after = client.sensors(60.0)
                self.assertGreater(after["sequence"], sensors["sequence"])
                self.assertGreater(after["time_s"], sensors["time_s"])
                sensors = after
            for q, q_goal in zip(sensors["q_m"], goal):
                self.assertAlmostEqual(q, q_goal, places=4)
            self.assertEqual(sensors["answered_sequence"], first["sequence"])
            goodbye(client)
            self.assertIn("the client left: done", served.session())

    def check_silence(self, served, client, send):
        """That the session ends after few frames, each followed by what `send` gets to send."""
        with self.assertRaisesRegex(SystemExit, "says goodbye: no command came in time: drives off, "
                                                "brakes closed"):
            for _ in range(1000):
                send(client.sensors(60.0))
        client.socket.close()
        self.assertIn("no command came in time: drives off, brakes closed", served.session())

    def test_silence_ends_the_session_and_the_next_client_is_welcome(self):
        with Driver() as served:
            for _ in range(2):
                self.check_silence(served, served.client(), lambda sensors: None)

    def test_nan_and_late_commands_are_silence(self):
        with Driver() as served:
            for change in ({"q_m": [math.nan] * 6}, {"sequence": 1}):
                client = served.client()
                self.check_silence(served, client, lambda sensors: client.send(
                    dc.COMMAND, *command(client, **{"sequence": sensors["sequence"], "enable": 1,
                                                    "q_m": sensors["q_m"]} | change)))

    def test_datagrams_without_end_do_not_keep_a_period_from_ending(self):
        class Flood:
            reads = 0

            def recvfrom(self, _):
                self.reads += 1
                if self.reads > 10000:
                    raise AssertionError("it reads on and on")
                return b"", ("127.0.0.1", 1)

        server = driver.Server(driver.read_options(["--listen", "127.0.0.1:0", "--simulated"]), None)
        with server.socket:
            flood, due_s = Flood(), time.monotonic()
            with unittest.mock.patch.object(server, "socket", flood), \
                    unittest.mock.patch("driver.select.select", lambda *_: ([1], [], [])):
                self.assertIsNone(server.receive(due_s))
            self.assertGreater(flood.reads, 0)
            with unittest.mock.patch("driver.select.select", lambda *_: ([], [], [])):
                for _ in range(100):  # nor does a long wait make it deaf
                    self.assertIsNone(server.receive(due_s))
            with Raw(server.socket.getsockname()[1]) as raw:
                raw.send(dc.HELLO, 7, *ARM[:5], 0, b"raw")
                server.receive(time.monotonic() + 0.5)
                raw.socket.settimeout(0.0)
                self.assertEqual(raw.receive(dc.WELCOME)[1], 0)

    def test_ctrl_c_is_a_goodbye(self):
        with Driver(*PATIENT) as served:
            client = served.client()
            client.sensors(60.0)
            served.process.send_signal(signal.SIGINT)
            with self.assertRaisesRegex(SystemExit, "says goodbye: the server was stopped"):
                while True:
                    client.sensors(60.0)
            client.socket.close()
            self.assertRegex(served.close(), "the server was stopped(.*\n)*stopped: drives off\n$")
            self.assertEqual(served.process.returncode, 0)


class OwnRobot(unittest.TestCase):
    def test_a_read_that_fails_switches_the_drives_off(self):
        robot = """
class Bad(driver.Robot):
    def read(self):
        sensors = super().read()
        if self.on_s > 0.1:
            sensors.q_m = sensors.q_m[:5]
        return sensors
    def write(self, command):
        super().write(command)
        if not command.enable:
            print('drives off', flush=True)
driver.Robot = Bad
"""
        with Driver("--fast", code=robot) as served:
            client = served.client()
            sensors = client.sensors()
            with self.assertRaisesRegex(SystemExit, "says goodbye: the driver has failed: ValueError"):
                while True:
                    sensors = answer(client, sensors)
            client.socket.close()
            said = served.process.communicate(timeout=60)[0]
            self.assertIn("drives off\n", said)
            self.assertIn("read() gives 5 values of q_m, expected 6", said)
            self.assertNotEqual(served.process.returncode, 0)

    def test_the_example_of_the_page_leads_an_arm(self):
        page = (ROOT / "docs" / "start" / "own_driver.md").read_text()
        example, = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
        robot = f"""
import types
class Arm:  # counts in degrees
    angles, is_on = [30.0] * 6, False
    def newest_state(self):
        return types.SimpleNamespace(angles=self.angles, speeds=[0.0] * 6, force=[0.0] * 3,
            torque=[0.0] * 3, button=self.is_on, is_stopped=False, has_error=False)
    def on(self): self.is_on = True
    def off(self): self.is_on = False
    def follow(self, angles): self.angles = angles
driver.maker_arm = types.SimpleNamespace(connect=lambda address: Arm())
exec({example!r}, driver.__dict__)
"""
        with Driver("--fast", code=robot) as served:
            client = served.client()
            sensors = client.sensors()
            self.assertAlmostEqual(sensors["q_m"][5], math.radians(30.0))
            near = [q + 0.04 for q in sensors["q_m"]]
            sensors = answer(client, sensors, 0, near)
            self.assertAlmostEqual(sensors["q_m"][5], math.radians(30.0))
            sensors = answer(client, sensors, 1, near)
            self.assertAlmostEqual(sensors["q_m"][5], near[5])
            self.assertEqual((sensors["dead_man"], sensors["driver_fault"]), (1, 0))
            far = [*near[:5], near[5] + 0.06]
            for enable, q_m, is_on, fault in ((1, far, 0, 113), (1, near, 0, 113), (0, near, 0, 0),
                                              (1, near, 1, 0)):
                sensors = answer(client, sensors, enable, q_m)
                self.assertAlmostEqual(sensors["q_m"][5], near[5])
                self.assertEqual((sensors["dead_man"], sensors["driver_fault"]), (is_on, fault))
            goodbye(client)

    def test_options_that_cannot_be_are_refused(self):
        for arguments, reason in ((("--fast",), "a machine keeps its own time"),
                                  (("--rate-hz", "0"), "100..20000"),
                                  (PATIENT, "a machine is switched off within 0.05 s"),
                                  (("--listen", "nowhere"), "expected HOST:PORT")):
            result = subprocess.run([sys.executable, DRIVER, *arguments], text=True, capture_output=True,
                                    timeout=60)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(reason, result.stderr)

    def test_it_says_whether_it_is_a_machine(self):
        code = "driver.sys.argv.remove('--simulated')"
        for options, is_simulated in (({}, 1), ({"code": code}, 0)):
            with Driver(**options) as served, Raw(served.port) as raw:
                raw.send(dc.HELLO, 7, *ARM[:5], 0, b"raw")
                self.assertEqual(raw.receive(dc.WELCOME)[2], is_simulated)
                self.assertIn("simulated" if is_simulated else "A MACHINE", served.head)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
