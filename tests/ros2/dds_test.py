"""`hapticgiant bridge ros2` on this computer, seen by a DDS that is none of ours: Cyclone DDS.

    dds_test.py PROGRAM

Cyclone DDS (PyPI, 40 MB with what it needs) is installed into build/dds_venv; where that fails, or the
bridge was not built, it is skipped (exit code 77). Depends on no time: it waits for a number of messages.
"""

import contextlib
import os
import pathlib
import random
import socket
import subprocess
import sys
import tempfile
import unittest

import ros2_test
from ros2_test import ROOT, SKIPPED, Program, make_environment

VENV = ROOT / "build" / "dds_venv"
COUNT = 50  # messages of each stream


class Dds(unittest.TestCase):
    def setUp(self):
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.environment = {**os.environ, "ROS_DOMAIN_ID": str(random.SystemRandom().randrange(100, 200)),
                            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "XDG_RUNTIME_DIR": str(folder)}

    def start(self, *command):
        return self.stack.enter_context(Program(command, self.environment))

    def peer(self, *arguments):
        return self.start(VENV / "bin" / "python", ROOT / "tests" / "ros2" / "dds_peer.py", *arguments)

    def run_and_bridge(self):
        between = self.start(ros2_test.PROGRAM, "bridge", "ros2")
        between.wait_for("waiting for a run")
        self.start(ros2_test.PROGRAM, "run", "door", "--user", "mouse", "--no-browser", "--no-recording",
                   "--flight-recorder", "off", "--duration", "300")
        between.wait_for("connected")
        return between

    def test_a_run_is_seen_and_can_be_changed(self):
        between = self.run_and_bridge()
        saw = self.peer("watch", COUNT).result()
        for topic, joints in {"/joint_states": 8, "/twin/joint_states": 2}.items():
            messages = saw["joints"][topic]
            self.assertGreaterEqual(len(messages), COUNT, topic)
            stamps = [stamp for stamp, _, _ in messages]
            self.assertEqual(stamps, sorted(set(stamps)), topic)
            self.assertTrue(all(len(names) == len(q) == joints for _, names, q in messages), topic)
        self.assertIn("handle", saw["frames"][-1])
        self.assertIn("<robot", saw["urdf"][0])
        pulled = self.peer("pull").result()
        self.assertNotEqual(pulled["start"], pulled["end"])
        self.assertGreater(sum((a - b)**2 for a, b in zip(pulled["start"], pulled["end"]))**0.5, 0.005)
        self.assertIn("messages out  /joint_states", between.interrupt())


class Alone(unittest.TestCase):
    """Without a DDS of others."""

    def program(self, *arguments):
        return subprocess.run([ros2_test.PROGRAM, "bridge", "ros2", *arguments], capture_output=True,
                              text=True, timeout=ros2_test.PATIENCE)

    def test_bad_input_is_refused_with_its_reason(self):
        device = ["device", "--without-dead-man", "--joints"]
        arm = [*device, ros2_test.JOINTS]
        for arguments, message in (
                ([*arm, "--silence", "nan"], "--silence: expected a number, got 'nan'"),
                ([*arm, "--rate-hz", "0"], "--rate-hz: must be from 1 to 10000, got 0"),
                ([*arm, "--gain", "1001"], "--gain: must be from 0 to 1000, got 1001"),
                ([*device, "a,a,b,c,d,e"], "--joints: names 'a' twice"),
                ([*arm, "--states", "joint states"], "no name of ROS 2"),
                (["--namespace", "my robot!"], "no name of ROS 2"),
                (["--view", *arm], "not possible with device"),
                (["--live", "ws://localhost:1/", *arm], "not possible with device")):
            done = self.program(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(message, done.stderr)

    def test_an_answer_that_is_no_run_is_shown_as_it_came(self):
        for status, message in ((b"404 Not Found", "got HTTP 404 Not Found: a page"),
                                (b"403 Forbidden", "the token is that of another run, or wrong")):
            with socket.create_server(("127.0.0.1", 0)) as server, contextlib.ExitStack() as stack:
                bridge = stack.enter_context(ros2_test.Program(
                    [ros2_test.PROGRAM, "bridge", "ros2", "--local", "--domain", "199", "--live",
                     f"ws://127.0.0.1:{server.getsockname()[1]}/live?token=x"]))
                server.settimeout(ros2_test.PATIENCE)
                connection, _ = server.accept()
                with connection:
                    connection.recv(65536)
                    connection.sendall(b"HTTP/1.1 " + status + b"\r\nContent-Length: 6\r\n\r\na page")
                    bridge.wait_for(message)
                bridge.interrupt()


def main():
    ros2_test.PROGRAM = pathlib.Path(sys.argv[1]).resolve()
    if not ros2_test.PROGRAM.with_name("hapticgiant-ros2").exists():
        print("skipped: hapticgiant-ros2 was not built (Debian: libfastrtps-dev)")
        return SKIPPED
    load = unittest.TestLoader().loadTestsFromTestCase
    if not unittest.TextTestRunner(verbosity=2).run(load(Alone)).wasSuccessful():
        return 1
    if why := make_environment(VENV, ROOT / "tools" / "requirements-dds.txt"):
        print("skipped: no Cyclone DDS:", why)
        return SKIPPED
    return not unittest.TextTestRunner(verbosity=2).run(load(Dds)).wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
