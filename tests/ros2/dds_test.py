"""`hapticgiant bridge ros2` on this computer, seen by a DDS that is none of ours: Cyclone DDS.

    dds_test.py PROGRAM

Cyclone DDS (PyPI, 40 MB with what it needs) is installed into build/dds_venv; where that fails, or the
bridge was not built, it is skipped (exit code 77). Depends on no time: it waits for a number of messages.
"""

import contextlib
import os
import pathlib
import random
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


def main():
    ros2_test.PROGRAM = pathlib.Path(sys.argv[1]).resolve()
    if not ros2_test.PROGRAM.with_name("hapticgiant-ros2").exists():
        print("skipped: hapticgiant-ros2 was not built (Debian: libfastrtps-dev)")
        return SKIPPED
    if why := make_environment(VENV, ROOT / "tools" / "requirements-dds.txt"):
        print("skipped: no Cyclone DDS:", why)
        return SKIPPED
    suite = unittest.TestLoader().loadTestsFromTestCase(Dds)
    return not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
