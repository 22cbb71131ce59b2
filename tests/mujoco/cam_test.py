"""Motion and reaction of cams against SciPy's splines and MuJoCo's inverse dynamics.

The crank and the ram are two free joints in MuJoCo. The ram is moved by SciPy's spline through the same
points; the torque of the crank is that of MuJoCo at the crank and, by the slope of the spline, at the ram.
Arguments: the program cam_motion. Exits with 77, which CTest takes for skipped, where MuJoCo is missing.
"""

import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77

try:
    import mujoco
    import numpy as np
    from scipy.interpolate import CubicSpline
except ImportError as error:
    print(f"{error}: pip install -r tools/requirements-test.txt")
    sys.exit(SKIPPED)

URDF = """<robot name="cam"><link name="base"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="crank"/><axis xyz="0 1 0"/></joint>
<link name="crank"><inertial><origin xyz="0.02 0.01 0.1"/><mass value="1"/>
<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="crank"/><child link="ram"/>
<origin xyz="0.1 0.2 0" rpy="0.3 0.2 0.1"/><axis xyz="0 0.6 0.8"/>
<limit lower="-1" upper="1" velocity="9" effort="9"/></joint>
<link name="ram"><inertial><origin xyz="0.1 0.03 0"/><mass value="4"/>
<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""

# name: repeats per turn, points, range of the crank; the tolerance of what is no grid of equal distances
CAMS = {
    "press": (1, [(0, 0), (0.6, 0.004), (1.6, 0.046), (2.2, 0.05), (3.2, 0.05), (3.8, 0.046), (4.8, 0.004), (5.4, 0)],
              (-9, 9), 1e-3),
    "three lobes": (3, [(i * 2 * math.pi / 15, y) for i, y in enumerate((0, 0.02, 0.03, 0.02, -0.01))], (-9, 9), 1e-9),
    "guide": (0, [(-0.6, 0.1), (0, -0.05), (0.6, 0.02), (1.2, 0), (1.8, 0.06)], (-0.6, 1.8), 1e-9),
}


def spline_of(repeats, points):
    x, y = map(np.array, zip(*points, strict=True))
    if not repeats:
        return CubicSpline(x, y, bc_type="natural")
    return CubicSpline(np.append(x, x[0] + 2 * math.pi / repeats), np.append(y, y[0]), bc_type="periodic")


def by_mujoco(model, spline, states):
    """Columns as cam_motion writes them."""
    data = mujoco.MjData(model)
    rows = []
    for q, dq, ddq in states:
        value, slope, curvature = (spline(q, order) for order in range(3))
        ram = (value, slope * dq, slope * ddq + curvature * dq**2)
        data.qpos[:], data.qvel[:], data.qacc[:] = zip((q, dq, ddq), ram, strict=True)
        mujoco.mj_inverse(model, data)
        rows.append((*ram, data.qfrc_inverse[0] + slope * data.qfrc_inverse[1]))
    return np.array(rows)


class Cams(unittest.TestCase):
    def test_motion_and_reaction_are_those_of_scipy_and_mujoco(self):
        model = mujoco.MjModel.from_xml_string(URDF)
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        random = np.random.default_rng(3)
        with tempfile.TemporaryDirectory() as folder:
            urdf = pathlib.Path(folder) / "cam.urdf"
            urdf.write_text(URDF)
            for name, (repeats, points, ends, tolerance) in CAMS.items():
                states = np.column_stack([random.uniform(*ends, 500), *random.uniform(-3, 3, (2, 500))])
                text = ",".join(f"{x!r}:{y!r}" for x, y in points)
                lines = "\n".join(" ".join(map(repr, map(float, state))) for state in states)
                run = subprocess.run([PROGRAM, urdf, str(repeats), text], input=lines, text=True, capture_output=True,
                                     check=False)
                self.assertEqual((run.returncode, run.stderr), (0, ""))
                ours = np.array([[float(x) for x in line.split(",")] for line in run.stdout.splitlines()])
                judge = by_mujoco(model, spline_of(repeats, points), states)
                worst = np.abs(ours - judge).max(0) / np.abs(judge).max(0)
                print(f"{name}: position, speed, acceleration and torque differ by {worst} of the largest")
                self.assertLess(worst.max(), tolerance, name)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(argv=sys.argv[:1])
