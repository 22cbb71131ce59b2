"""Our rigid-body dynamics against those of MuJoCo, from the same URDF.

Argument: the build folder; the package is put into it first. Exits with 77, which CTest takes for
skipped, where MuJoCo is missing (pip install -r tools/requirements-test.txt).
"""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
STATES = 200  # of each robot
# of the largest entry; MuJoCo rounds by turning each inertia into its principal axes
TOLERANCE = 1e-10

try:
    import mujoco
    import numpy as np
except ImportError as error:
    print(f"{error}: pip install -r tools/requirements-test.txt")
    sys.exit(SKIPPED)


class Judge:
    """A robot as MuJoCo sees it, without contacts and joint limits."""

    def __init__(self, file):
        self.model = mujoco.MjModel.from_xml_path(str(file))
        flags = mujoco.mjtDisableBit
        self.model.opt.disableflags |= int(flags.mjDSBL_CONTACT) | int(flags.mjDSBL_CONSTRAINT)
        self.data = mujoco.MjData(self.model)

    @property
    def joint_names(self):
        return [self.model.joint(i).name for i in range(self.model.njnt)]

    def set_state(self, q, dq):
        self.data.qpos[:] = q
        self.data.qvel[:] = dq
        self.data.qfrc_applied[:] = 0.0
        mujoco.mj_forward(self.model, self.data)

    def mass_matrix(self):
        columns = []
        for unit in np.eye(self.model.nv):
            column = np.zeros(self.model.nv)
            mujoco.mj_mulM(self.model, self.data, column, unit)
            columns.append(column)
        return np.array(columns).T

    def bias(self):
        return np.array(self.data.qfrc_bias)

    def wrench_torques(self, body, point, wrench):
        torques = np.zeros(self.model.nv)
        mujoco.mj_applyFT(self.model, self.data, wrench[:3], wrench[3:], point,
                          self.model.body(body).id, torques)
        return torques

    def forward_dynamics(self, torques):
        self.data.qfrc_applied[:] = torques
        mujoco.mj_forward(self.model, self.data)
        return np.array(self.data.qacc)

    def inverse_dynamics(self, ddq):
        self.data.qacc[:] = ddq
        mujoco.mj_inverse(self.model, self.data)
        return np.array(self.data.qfrc_inverse)


class SameUrdf(unittest.TestCase):
    def compare(self, file, body, tip):
        """`tip`: frame of ours that is fixed to `body` of MuJoCo."""
        from hapticgiant import model

        ours, judge = model.Chain.from_urdf_file(str(ROOT / file)), Judge(ROOT / file)
        self.assertEqual([joint.name for joint in ours.joints], judge.joint_names)
        random = np.random.default_rng(6)
        for state in range(STATES):
            q, dq = random.uniform(-3, 3, ours.nv), random.normal(0, 2, ours.nv)
            tau, ddq = random.normal(0, 50, ours.nv), random.normal(0, 5, ours.nv)
            wrench = random.normal(0, 20, 6)
            ours.update(q, dq)
            judge.set_state(q, dq)
            with self.subTest(file=file, state=state):
                self.same(ours.M, judge.mass_matrix())
                self.same(ours.c, judge.bias())
                self.same(ours.inverse_dynamics(q, dq, ddq), judge.inverse_dynamics(ddq))
                applied = tau + ours.jacobian(tip).T @ wrench
                self.same(applied, tau + judge.wrench_torques(body, ours.pose(tip).p, wrench))
                self.same(np.linalg.solve(ours.M, applied - ours.c),
                          judge.forward_dynamics(applied))

    def same(self, ours, theirs):
        self.assertLess(np.abs(ours - theirs).max(), TOLERANCE * max(1.0, np.abs(theirs).max()))

    def test_haptic_giant(self):
        self.compare("models/haptic_giant/haptic_giant.urdf", "m6", "handle")

    def test_excavator(self):
        self.compare("models/twins/excavator/excavator.urdf", "bucket", "bucket")


def main():
    sys.path.insert(0, str(ROOT / "tests" / "packages"))
    from python_package_test import install

    site = pathlib.Path(sys.argv.pop(1)) / "package_mujoco"
    install(site.parent, site)
    sys.path.insert(0, str(site))
    unittest.main()


if __name__ == "__main__":
    main()
