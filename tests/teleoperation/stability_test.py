"""Where position-force becomes unstable: the trials of the program against the Nyquist criterion of
the same loop, linear, in contact.

    stability_test.py PROGRAM

Hand, body, machine and wall are written down here a second time, as transfer functions. The margin
of the criterion says at which delay the loop begins to oscillate; the program must be calm at less
and shake at more.
"""

import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM = sys.argv.pop(1)
PERIOD = 1e-3

# hg/teleoperation/trial.h, method.h, machine.h; hg/simulator/person/hand.cpp
BODY, DRAG, LATE = 6.0, 4.0, 4e-3
MACHINE = dict(m=3.0, K=1e4, B=300.0, friction=2.0)
WALL_DAMPING = 20.0
HANDS = {
    "relaxed": dict(m=1.0, K=80.0, B=8.0, grip=300.0, grip_damping=5.0),
    "normal": dict(m=1.0, K=250.0, B=20.0, grip=1000.0, grip_damping=15.0),
    "stiff": dict(m=1.7, K=600.0, B=45.0, grip=3000.0, grip_damping=40.0),
}


def open_loop(w, hand, wall):
    """Leader position to itself through link, machine, wall and link, without their delay."""
    s = 1j * w
    h, r = HANDS[hand], MACHINE
    arm = h["m"] * s**2 + h["B"] * s + h["K"]
    grip = h["grip_damping"] * s + h["grip"]
    impedance = grip * arm / (grip + arm)
    body = BODY * s**2 + DRAG * s + impedance * np.exp(-s * LATE)
    contact = WALL_DAMPING * s + wall
    follows = (r["B"] * s + r["K"]) / (r["m"] * s**2 + (r["B"] + r["friction"]) * s + r["K"] + contact)
    return contact * follows / body


def critical_delay(hand, wall):
    """Round trip at which the loop's first crossing of 1 meets -180 degrees, s."""
    w = np.linspace(0.5, 400.0, 800000)
    loop = open_loop(w, hand, wall)
    delays = []
    magnitude = np.abs(loop)
    for k in np.flatnonzero(np.diff(np.sign(magnitude - 1.0)) < 0):
        margin = np.angle(loop[k]) + np.pi
        delays.append((margin % (2.0 * np.pi)) / w[k])
    return min(delays)


def is_calm(hand, wall, delay):
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "trials.csv"
        subprocess.run(
            [PROGRAM, "experiment", "teleoperation", "--methods", "position_force", "--hands", hand,
             "--walls", str(wall), "--delays", str(1e3 * delay), "--losses", "0", "--press", "20",
             "--hold", "30", "--csv", table],
            check=True, stdout=subprocess.DEVNULL)
        return next(csv.DictReader(table.open()))["is_calm"] == "1"


class PositionForce(unittest.TestCase):
    def test_it_shakes_from_the_delay_on_that_the_criterion_names(self):
        for hand in HANDS:
            for wall in (1000.0, 2000.0):
                # The program's own: an answer is felt one period later, and force and target hold
                # for a period, which is half a period late on average, each.
                critical = 0.5 * (critical_delay(hand, wall) - 2.0 * PERIOD)
                with self.subTest(hand=hand, wall=wall, critical_ms=1e3 * critical):
                    self.assertGreater(critical, 1e-3)
                    below = np.floor(1e3 * 0.92 * critical) * 1e-3
                    above = np.ceil(1e3 * 1.08 * critical) * 1e-3
                    self.assertTrue(is_calm(hand, wall, below), f"{below} s")
                    self.assertFalse(is_calm(hand, wall, above), f"{above} s")


if __name__ == "__main__":
    unittest.main()
