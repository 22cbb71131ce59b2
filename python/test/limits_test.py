"""hapticgiant.limits: bounds hold over arrays of states."""

import unittest

import numpy as np

from hapticgiant import SetupError, limits

PERIOD = 1e-3  # s
ELBOW = limits.JointLimits(q_min=-1.0, q_max=0.5, dq_max=2.0, ddq_max=10.0)


class RecoverableBounds(unittest.TestCase):
    def test_states_that_lean_on_their_bounds_keep_all_limits(self):
        seed = 5
        random = np.random.default_rng(seed)
        q = random.uniform(-1.0, 0.5, 200)
        dq = np.zeros(200)
        for _ in range(2000):
            lower, upper = limits.recoverable_bounds(ELBOW, q, dq, PERIOD)
            self.assertTrue((lower <= upper).all(), seed)
            ddq = np.where(random.random(200) < 0.5, upper, random.uniform(lower, upper))
            self.assertLessEqual(np.abs(ddq).max(), 10.0 + 1e-9, seed)
            q = q + PERIOD * dq + 0.5 * PERIOD**2 * ddq
            dq = dq + PERIOD * ddq
            self.assertTrue(((q >= -1.0 - 1e-9) & (q <= 0.5 + 1e-9)).all(), seed)

    def test_numbers_and_arrays_broadcast(self):
        lower, upper = limits.bounds_B(ELBOW, np.zeros((3, 1)), [0.0, 1.0], PERIOD)
        self.assertEqual((lower.shape, upper.shape), ((3, 2), (3, 2)))
        self.assertEqual(float(limits.bounds_B(ELBOW, 0, 0, PERIOD)[1]), upper[0, 0])

    def test_mirrored_states_have_mirrored_bounds(self):
        mirrored = limits.JointLimits(q_min=-0.5, q_max=1.0, dq_max=2.0, ddq_max=10.0)
        q, dq = np.linspace(-0.9, 0.4, 14), np.linspace(-1.0, 1.0, 14)
        for bounds in (limits.bounds_A, limits.bounds_B, limits.bounds_C):
            lower, upper = bounds(ELBOW, q, dq, 20e-3)
            mirror_lower, mirror_upper = bounds(mirrored, -q, -dq, 20e-3)
            np.testing.assert_array_equal(mirror_lower, -upper)
            np.testing.assert_array_equal(mirror_upper, -lower)

    def test_paper_bounds_C_are_the_printed_formula(self):
        lower, upper = limits.bounds_C(ELBOW, 0.1, 0.2, 20e-3)
        self.assertAlmostEqual(float(upper), 2 / 20e-3**2 * (0.5 - 0.1 - 20e-3 * 0.2))
        self.assertAlmostEqual(float(lower), 2 / 20e-3**2 * (-1.0 - 0.1 - 20e-3 * 0.2))

    def test_an_axis_may_go_no_faster_than_it_can_brake(self):
        _, upper = limits.braking_velocity_bounds(-1, 1, [0.0, 0.9, 1.0], tau=45e-3, ddq_max=2.0)
        self.assertTrue(upper[0] > upper[1] > upper[2] == 0.0)

    def test_impossible_limits_are_refused_and_named(self):
        with self.assertRaisesRegex(SetupError, "q_max"):
            limits.JointLimits(q_min=1.0, q_max=0.0)
        with self.assertRaisesRegex(ValueError, "dt must be positive"):
            limits.recoverable_bounds(ELBOW, 0.0, 0.0, 0.0)
        with self.assertRaises(ValueError):
            limits.bounds_A(ELBOW, np.zeros(3), np.zeros(2), PERIOD)


if __name__ == "__main__":
    unittest.main()
