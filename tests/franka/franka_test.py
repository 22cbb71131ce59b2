"""`hapticgiant run --device-address franka://...` against independent servers and clients.

    franka_test.py PROGRAM [--franky]

Real time: for a computer that is left alone (`make franka`), none of `make test`. The server
franka-sim and the reference client pylibfranka are installed into an environment of their own,
build/franka_venv (180 MB); where that fails it is skipped (exit code 77). With --franky the server
franky-sim, too (build/franky_venv, 660 MB).
"""

import argparse
import pathlib
import sys
import tempfile
import time
import unittest

import harness
from franky_test import Franky
from harness import FRANKA_SIM, FRANKY_SIM, TOLERANT, Run, patiently, run, server
from reference_test import Reference  # noqa: F401  found by unittest

SKIPPED = 77


class Franka(unittest.TestCase):
    @patiently
    def test_a_hand_opens_the_drawer_and_shuts_it(self):
        with server("--pull", "12", TOLERANT) as address, tempfile.TemporaryDirectory() as folder:
            first = Run(address, 6.5, folder)
            first.wait_for("no start test")  # it has the robot
            code, said, _ = run(address, 1)
            if first.process.poll() is not None:
                self.fail("the first has ended: " + first.wait()[1])
            self.assertEqual(code, 2, said)
            self.assertIn("does another program control the robot?", said)
            code, said, summary = first.wait()
            self.assertEqual(code, 0, said)
            self.assertNotIn("push lightly first", said)  # the weight of the tool was seen
            happened = [(event["name"], event["what"]) for event in summary["events"]]
            self.assertEqual(happened, [("slide", "upper limit reached"),
                                        ("slide", "lower limit reached")], said)
            self.assertEqual(summary["allocations_in_loop"], 0)
            self.assertTrue(summary["limits_held"], said)
            self.assertAlmostEqual(summary["force"]["max_N"], 12, delta=0.5)
            link = summary["link"]
            self.assertGreater(link["received"] + link["held"], 6500)  # every cycle is accounted for
            self.assertLessEqual(link["held"], link["lost"])
            self.assertEqual(link["malformed"] + link["foreign"], 0)
            # the server takes the next one; it stands where it was left
            code, said, _ = run(address, 0.5)
            self.assertEqual(code, 0, said)

    @patiently
    def test_speeds_lead_it_as_well(self):
        with server("--away", "0.05", TOLERANT) as address:
            code, said, _ = run(address + "/speeds", 0.5, "--move-to-start")
            self.assertEqual(code, 0, said)
        with server("--pull", "12", TOLERANT) as address:
            code, said, summary = run(address + "/speeds", 6.5)
            self.assertEqual(code, 0, said)
            self.assertNotIn("robot in mode", said)  # no reflex, not at its end either
            happened = [(event["name"], event["what"]) for event in summary["events"]]
            self.assertEqual(happened, [("slide", "upper limit reached"),
                                        ("slide", "lower limit reached")], said)
            self.assertEqual(summary["allocations_in_loop"], 0)
            self.assertTrue(summary["limits_held"], said)

    @patiently
    def test_it_moves_to_the_start_when_it_is_asked_to(self):
        with server("--away", "0.1", TOLERANT) as address:
            _, said, summary = run(address, 0.5)
            self.assertIn("not armed: the twin cannot be where the handle is", said)
            self.assertEqual(summary["solver"]["status"]["solved"], 0)
            code, said, summary = run(address, 0.5, "--move-to-start")
            self.assertEqual(code, 0, said)
            self.assertNotIn("not armed", said)
            self.assertGreater(summary["solver"]["status"]["solved"], 400)

    @patiently
    def test_a_silent_client_is_stopped_in_the_robots_words(self):
        with server() as address, tempfile.TemporaryDirectory() as folder:
            stopped = Run(address, 5, folder)
            stopped.wait_for("no start test")
            time.sleep(1.5)
            stopped.be_silent(0.3)
            code, said, summary = stopped.wait()
            self.assertEqual(code, 3, said)
            self.assertIn("communication_constraints_violation", said)
            self.assertIn(summary["fault"]["code"], (120, 101, 203), said)
            # and recovers alone for the next run
            code, said, _ = run(address, 0.5)
            self.assertEqual(code, 0, said)

    @patiently
    def test_a_step_of_torque_is_stopped_in_the_robots_words(self):
        with server("--torque-rate", "100", TOLERANT) as address:
            code, said, summary = run(address, 4)
        self.assertEqual(code, 3, said)
        self.assertIn("controller_torque_discontinuity", said)
        self.assertEqual(summary["fault"]["code"], 113)

    @patiently
    def test_an_estimate_that_cannot_be_used_is_refused(self):
        for estimate, reason in (("weight", "contains the weight of the arm"),
                                 ("opposite", "sign or frame of the estimate differ"),
                                 ("none", "exactly zero")):
            with self.subTest(estimate), server("--estimate", estimate) as address:
                code, said, _ = run(address, 1)
                self.assertEqual(code, 2, said)
                self.assertIn(reason, said)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--franky", action="store_true")
    options, others = parser.parse_known_args()
    harness.PROGRAM = options.program.resolve()
    wanted = [FRANKA_SIM] + [FRANKY_SIM] * options.franky
    if why := "; ".join(filter(None, (environment.make() for environment in wanted))):
        print(f"franka: skipped, {why}")
        return SKIPPED
    Franky.is_wanted = options.franky
    return not unittest.main(argv=sys.argv[:1] + others, exit=False).result.wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
