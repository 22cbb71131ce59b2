"""The driver against franky-sim, a second server that has nothing in common with franka-sim."""

import contextlib
import math
import unittest

from harness import FOLDER, FRANKY_SIM, listening, patiently, run

PORT = 1337  # it has no other
ADDRESS = "franka://127.0.0.1"
AT_THE_DOOR = "0.3007 -0.2253 0.0493 -2.3782 0.0132 2.1534 -1.2261".split()  # rad, by --move-to-start


@contextlib.contextmanager
def franky_sim(*command):
    with listening(PORT, FRANKY_SIM.python, *command):
        yield ADDRESS


class Franky(unittest.TestCase):
    is_wanted = False

    def setUp(self):
        if not self.is_wanted:
            self.skipTest("without --franky")

    @patiently
    def test_its_own_estimate_contains_the_weight_of_the_arm(self):
        program = FRANKY_SIM.folder / "bin" / "franky-sim"
        with franky_sim(program, "-s", "mujoco", "--hostname", "127.0.0.1") as address:
            for _ in range(2):  # it takes the next client
                code, said, _ = run(address, 1)
                self.assertEqual(code, 2, said)
                self.assertIn("contains the weight of the arm", said)

    @patiently
    def test_a_hand_opens_the_door_and_shuts_it(self):
        self.open_the_door("")

    @patiently
    def test_and_by_speeds(self):
        self.open_the_door("/speeds")

    def open_the_door(self, by):
        with franky_sim(FOLDER / "franky_server.py", "--pull", "9", "-9", "--posture",
                        *AT_THE_DOOR) as address:
            code, said, summary = run(address + by, 6.5, scenario="open_cupboard")
            self.assertEqual(code, 0, said)
            self.assertNotIn("push lightly first", said)  # the weight of the tool was seen
            happened = [(event["name"], event["what"]) for event in summary["events"]]
            self.assertEqual(happened, [("hinge", "upper limit reached"),
                                        ("hinge", "lower limit reached")], said)
            self.assertEqual(summary["allocations_in_loop"], 0)
            self.assertTrue(summary["limits_held"], said)
            self.assertAlmostEqual(summary["force"]["max_N"], math.hypot(9, 9), delta=0.5)
            link = summary["link"]
            self.assertGreater(link["received"] + link["held"], 6500)  # every cycle is accounted for
            self.assertLessEqual(link["held"], link["lost"])
            self.assertEqual(link["malformed"] + link["foreign"], 0)
            code, said, _ = run(address + by, 0.5, scenario="open_cupboard")
            self.assertEqual(code, 0, said)
