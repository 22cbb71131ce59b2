"""hapticgiant.model and haptic_giant: kinematics and dynamics agree with each other."""

import unittest

import numpy as np

import hapticgiant as hg

URDF = str(hg.MODELS / "haptic_giant" / "haptic_giant.urdf")
STEP = 1e-6  # of finite differences
CLOSE = 1e-5  # what they give away


class ChainTest(unittest.TestCase):
    def setUp(self):
        self.chain = hg.model.Chain.from_urdf_file(URDF)
        self.random = np.random.default_rng(3)
        self.q, self.dq, self.ddq = self.random.uniform(-1, 1, (3, self.chain.nv))
        self.frame = self.chain.frame_names[-1]

    def test_jacobian_times_speed_is_the_twist_of_the_pose(self):
        self.chain.update(self.q, self.dq)
        twist = self.chain.twist(self.frame)
        before = self.chain.pose(self.frame)
        np.testing.assert_allclose(self.chain.jacobian(self.frame) @ self.dq, twist, atol=1e-12)
        self.chain.update(self.chain.integrate(self.q, STEP * self.dq), self.dq)
        after = self.chain.pose(self.frame)
        np.testing.assert_allclose((after.p - before.p) / STEP, twist[:3], atol=CLOSE)
        turn = (after.r @ before.r.T - np.eye(3)) / STEP
        np.testing.assert_allclose([turn[2, 1], turn[0, 2], turn[1, 0]], twist[3:], atol=CLOSE)

    def test_inverse_dynamics_is_M_ddq_plus_c(self):
        self.chain.update(self.q, self.dq)
        tau = self.chain.inverse_dynamics(self.q, self.dq, self.ddq)
        np.testing.assert_allclose(self.chain.M @ self.ddq + self.chain.c, tau, atol=1e-9)
        np.testing.assert_array_equal(self.chain.M, self.chain.M.T)

    def test_gravity_can_be_left_out_and_the_root_moved(self):
        at = hg.Pose([1.0, 2.0, 3.0], np.eye(3))
        light = hg.model.Chain.from_urdf_file(URDF, placement=at, gravity=False)
        light.update(self.q, 0 * self.dq)
        self.chain.update(self.q, 0 * self.dq)
        np.testing.assert_array_equal(light.gravity, 0.0)
        self.assertGreater(np.abs(self.chain.gravity).max(), 1.0)
        np.testing.assert_allclose(light.pose(self.frame).p - self.chain.pose(self.frame).p,
                                   at.p, atol=1e-12)

    def test_results_are_copies(self):
        self.chain.update(self.q, self.dq)
        M = self.chain.M
        kept = M.copy()
        self.chain.update(2 * self.q, self.dq)
        np.testing.assert_array_equal(M, kept)
        with self.assertRaisesRegex(ValueError, "read-only"):
            M[0, 0] = 1.0

    def test_wrong_names_and_sizes_say_what_was_expected(self):
        self.chain.update(self.q, self.dq)
        with self.assertRaisesRegex(hg.SetupError, "handle"):
            self.chain.pose("handel")
        with self.assertRaisesRegex(ValueError, "q: expected 8 numbers, got 7"):
            self.chain.update(self.q[:7], self.dq)
        with self.assertRaises(IndexError):
            self.chain.pose(1000)
        with self.assertRaisesRegex(hg.SetupError, "nowhere.urdf"):
            hg.model.Chain.from_urdf_file("nowhere.urdf")

    def test_a_free_body_falls(self):
        body = hg.model.free_body(2.0, 0.1 * np.eye(3))
        body.update(body.neutral(), np.zeros(6))
        np.testing.assert_allclose(body.c, [0, 0, 2.0 * 9.81, 0, 0, 0], atol=1e-2)


class PoseTest(unittest.TestCase):
    def test_matrices_come_out_as_they_went_in(self):
        turn = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        pose = hg.Pose([1, 2, 3], turn)
        np.testing.assert_array_equal(pose.r, turn)
        np.testing.assert_allclose((pose @ pose).p, pose.p + pose.r @ pose.p)
        np.testing.assert_allclose((pose @ pose.inverse()).r, np.eye(3))
        with self.assertRaisesRegex(ValueError, "r: expected 9 numbers, got 3"):
            hg.Pose([1, 2, 3], [1, 2, 3])


class HapticGiant(unittest.TestCase):
    def test_inverse_finds_the_joints_again(self):
        q_p, q_m = [0.1, -0.2], [0.2, 1.4, -0.6, 1.0, 0.9, 0.3]
        pose = hg.haptic_giant.hand_pose(q_p, q_m)
        found, status = hg.haptic_giant.inverse(pose, q_p)
        self.assertEqual(status, hg.haptic_giant.InverseStatus.SOLVED)
        np.testing.assert_allclose(found, q_m, atol=1e-9)

    def test_closed_form_and_chain_are_the_same_robot(self):
        chain = hg.model.Chain.from_urdf_file(URDF)
        q_p, q_m = [0.1, -0.2], [0.2, 1.4, -0.6, 1.0, 0.9, 0.3]
        chain.update([*q_p, *q_m], np.zeros(8))
        pose = chain.pose("handle")
        closed = hg.haptic_giant.hand_pose(q_p, q_m)
        np.testing.assert_allclose(closed.p, pose.p, atol=1e-9)
        np.testing.assert_allclose(closed.r, pose.r, atol=1e-9)
        determinant = np.linalg.det(chain.jacobian("handle")[:, 2:])
        self.assertAlmostEqual(hg.haptic_giant.jacobian_determinant(q_m), determinant)

    def test_the_gantry_target_brings_the_best_posture(self):
        q_m = [0.2, 1.4, -0.6, 1.0, 0.9, 0.3]
        pose = hg.haptic_giant.hand_pose([0.1, -0.2], q_m)
        q_p, _, status = hg.haptic_giant.inverse_at_target(pose)
        self.assertEqual(status.name, "SOLVED")
        np.testing.assert_allclose(hg.haptic_giant.gantry_target([0.1, -0.2], q_m), q_p, atol=1e-9)

    def test_out_of_reach_is_reported(self):
        far = hg.Pose([0, 0, 9], hg.haptic_giant.hand_pose([0, 0], [0, 1, 0, 1, 1, 0]).r)
        _, status = hg.haptic_giant.inverse(far, [0, 0])
        self.assertEqual(status.name, "HEIGHT_OUT_OF_REACH")


if __name__ == "__main__":
    unittest.main()
