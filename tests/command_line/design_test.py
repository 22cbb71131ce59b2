"""`hapticgiant design` as its user meets it, and its numbers against those of numpy and MuJoCo.

Usage: design_test.py PROGRAM   (from the repository root)

The arm of the person is built here once more, from its table in the JSON: products of rotations, and a
Jacobian by differences. The device is MuJoCo's, from the URDF; without MuJoCo that test is skipped.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import typing
import unittest
import xml.etree.ElementTree

import numpy as np
import yaml

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
FOLDER = pathlib.Path("models/haptic_giant")


def design(*arguments):
    """(exit code, standard output, standard error) of `hapticgiant design`."""
    done = subprocess.run([PROGRAM, "design", *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


def rotation(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def hand_pose(arm, q):
    """Position and rotation of the hand; the arm hangs along -z, the thumb points along x."""
    down = np.array([0.0, 0.0, -1.0])
    axes = [(0, -1, 0), (-1, 0, 0), (0, 0, 1), (0, -1, 0), (0, 0, 1), (1, 0, 0), (0, -1, 0)]
    turns = [rotation(axis, angle) for axis, angle in zip(axes, q)]
    upper = turns[0] @ turns[1] @ turns[2]
    fore = upper @ turns[3] @ turns[4]
    hand = fore @ turns[5] @ turns[6]
    p = (np.array(arm["shoulder_m"]) + arm["upper_arm_m"] * upper @ down
         + arm["forearm_m"] * fore @ down + arm["hand_m"] * hand @ down)
    return p, hand @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])


def jacobian(arm, q, step=1e-6):
    columns = []
    for unit in np.eye(7):
        (ahead, R_ahead), (behind, R_behind) = (hand_pose(arm, q + s * unit) for s in (step, -step))
        S = R_ahead @ R_behind.T
        turn = 0.5 * np.array([S[2, 1] - S[1, 2], S[0, 2] - S[2, 0], S[1, 0] - S[0, 1]])
        columns.append(np.concatenate([ahead - behind, turn]) / (2 * step))
    return np.array(columns).T


def half_sphere(count):
    i = np.arange(count)
    z = (i + 0.5) / count
    angle = np.pi * (3 - np.sqrt(5)) * i
    return np.column_stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z])


def coverage(device, human, directions):
    """By the definition: mean of min(1, ratio of the radii)."""
    radius = [1 / np.sqrt(np.einsum("ni,ij,nj->n", directions, np.linalg.inv(S), directions))
              for S in (device, human)]
    return np.mean(np.minimum(1.0, radius[0] / radius[1]))


def ellipsoid(rows, most):
    return rows @ np.diag(np.square(most)) @ rows.T


class Ratings(typing.NamedTuple):
    """Of the joints of the manipulator."""

    rotor: np.ndarray  # kg m^2
    stiffness: np.ndarray  # Nm/rad
    torque: np.ndarray  # Nm
    speed: np.ndarray  # rad/s
    effort: np.ndarray  # Nm


def ratings():
    device = yaml.safe_load((FOLDER / "device.yaml").read_text())
    names = device["manipulator"]
    sizes = [device["actuators"][name] for name in names]
    urdf = xml.etree.ElementTree.parse(FOLDER / "haptic_giant.urdf").getroot()
    limit = {joint.get("name"): joint.find("limit") for joint in urdf.iter("joint")}
    return Ratings(
        *(np.array([size[key] for size in sizes], dtype=float)
          for key in ("rotor_inertia_kg_m2", "stiffness_Nm_per_rad", "torque_max_Nm")),
        *(np.array([float(limit[name].get(key)) for name in names]) for key in ("velocity", "effort")))


def measures_of(jacobians, link, gravity, drives, hand, directions, length):
    """Measures of a posture, from Jacobians of the handle, mass matrix and gravity of the links."""
    inverse = np.linalg.inv(link + np.diag(drives.rotor))
    motion = [ellipsoid(rows, drives.speed) for rows in jacobians] + [
        ellipsoid(rows @ inverse, drives.torque - gravity) for rows in jacobians]
    measures = {name: coverage(S, H, directions) for name, S, H in zip(
        ("velocity", "turn_velocity", "acceleration", "turn_acceleration"), motion, hand)}
    Jt, Jr = jacobians
    with np.errstate(divide="ignore"):  # a joint without a lever limits nothing
        measures["force_N"] = np.min((drives.effort - gravity) / np.linalg.norm(Jt, axis=0))
        measures["torque_Nm"] = np.min((drives.effort - gravity) / np.linalg.norm(Jr, axis=0))
    measures["condition"] = np.linalg.cond(np.vstack([Jt / length, Jr]))
    mobility = Jt @ inverse @ Jt.T
    measures["reflected_mass_kg"] = 3 / np.trace(mobility)
    measures["reflected_mass_worst_kg"] = 1 / np.linalg.eigvalsh(mobility)[0]
    slowest = np.min(np.linalg.eigvals(np.linalg.solve(link, np.diag(drives.stiffness))).real)
    measures["eigenfrequency_Hz"] = np.sqrt(slowest) / (2 * np.pi)
    return measures


class Design(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        file = cls.folder / "measures.json"
        cls.done = design("measure", FOLDER / "device.yaml", "--poses", 200, "--samples", 100000,
                          "--json", file, "--picture", cls.folder / "coverage.svg")
        cls.measures = json.loads(file.read_text()) if file.is_file() else {}

    def test_measures_the_reference_device(self):
        code, out, err = self.done
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("HapticGiant, for a man, 1.76 m tall", out)
        metrics = self.measures["metrics"]
        self.assertEqual(metrics["poses"], 200)
        self.assertGreaterEqual(metrics["force_N"]["low_5_percent"], 50.0)  # [HG] III-B
        self.assertGreaterEqual(metrics["torque_Nm"]["low_5_percent"], 10.0)
        again = design("measure", "haptic_giant", "--poses", 200, "--samples", 100000)
        self.assertEqual(again[1], out)

    def test_arm_of_the_person_is_that_of_numpy(self):
        arm = self.measures["arm"]
        for pose in self.measures["poses"][:50]:
            p, R = hand_pose(arm, pose["hand"]["q_rad"])
            np.testing.assert_allclose(pose["hand"]["T_F_hand"]["p_m"], p, atol=1e-12)
            np.testing.assert_allclose(pose["hand"]["T_F_hand"]["R"], R.ravel(), atol=1e-12)

    def test_measures_are_those_of_mujoco_and_numpy(self):
        try:
            import mujoco
        except ImportError as error:
            self.skipTest(str(error))
        model = mujoco.MjModel.from_xml_path(str(FOLDER / "haptic_giant.urdf"))
        data = mujoco.MjData(model)
        drives = ratings()
        # the handle, fixed to m6 at 0.12 m
        body = model.body("m6").id
        arm, directions = self.measures["arm"], half_sphere(self.measures["directions"])
        person = [np.array([joint[key] for joint in arm["joints"]])
                  for key in ("dq_max_rad_per_s", "ddq_max_rad_per_s2")]
        R_B_F = np.array(self.measures["T_B_F"]["R"]).reshape(3, 3)
        judged = 0
        for pose in self.measures["poses"]:
            is_ = pose["device"]
            if not is_["reached"] or judged == 40:
                continue
            judged += 1
            data.qpos[:] = is_["q"]
            data.qvel[:] = 0.0
            mujoco.mj_forward(model, data)
            handle = data.xpos[body] + data.xmat[body].reshape(3, 3) @ [0.0, 0.0, 0.12]
            Jt, Jr = np.zeros((3, model.nv)), np.zeros((3, model.nv))
            mujoco.mj_jac(model, data, Jt, Jr, handle, body)
            Jt, Jr = Jt[:, 2:], Jr[:, 2:]
            full = np.zeros((model.nv, model.nv))
            for column, unit in zip(full, np.eye(model.nv)):
                mujoco.mj_mulM(model, data, column, unit)
            link = full[2:, 2:]
            J_hand = jacobian(arm, np.array(pose["hand"]["q_rad"]))
            hand = [R_B_F @ ellipsoid(rows, most) @ R_B_F.T
                    for most in person for rows in (J_hand[:3], J_hand[3:])]
            expected = measures_of((Jt, Jr), link, np.abs(data.qfrc_bias[2:]), drives, hand, directions,
                                   self.measures["length_m"])
            for name, value in expected.items():
                self.assertAlmostEqual(is_[name] / value, 1.0, delta=1e-6, msg=name)
        self.assertEqual(judged, 40)

    def test_summary_is_that_of_its_poses(self):
        metrics, poses = self.measures["metrics"], [p["device"] for p in self.measures["poses"]]
        reached = [pose for pose in poses if pose["reached"]]
        self.assertEqual(metrics["reached"], len(reached))
        self.assertAlmostEqual(metrics["coverage_velocity"],
                               sum(pose["velocity"] for pose in reached) / len(poses))
        self.assertAlmostEqual(metrics["reflected_mass_mean_kg"],
                               np.mean([pose["reflected_mass_kg"] for pose in reached]))
        self.assertEqual(metrics["force_N"]["least"], min(pose["force_N"] for pose in reached))

    def test_pictures_are_pictures(self):
        code, _, err = design("arm", "--samples", 20000, "--picture", self.folder / "arm.svg")
        self.assertEqual((code, err), (0, ""))
        for name in ("arm.svg", "coverage.svg"):
            text = (self.folder / name).read_text()
            self.assertTrue(text.startswith("<svg"), name)
            xml.etree.ElementTree.fromstring(text)

    def test_an_arm_on_a_table_is_measured_too(self):
        code, out, err = design("measure", "ur5e", "--poses", 6, "--samples", 20000)
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("Universal Robots UR5e", out)
        self.assertIn("gripping along the handle", out)

    def test_women_of_small_stature_reach_less(self):
        out = [design("arm", "--person", person, "--samples", 50000)[1]
               for person in ("female,5", "male,95")]
        volumes = [float(text.split("reaches ")[1].split()[0]) for text in out]
        self.assertLess(volumes[0], volumes[1])

    def test_runs_of_haptify_that_ended_early_are_counted(self):
        folder = self.folder / "bin"
        folder.mkdir()
        (folder / "hapticgiant-design").write_text(
            '#!/bin/sh\nmkdir -p "$3" && echo {} > "$3/results.json"\n')
        (folder / "hapticgiant").write_text(
            '#!/bin/sh\n[ "$1" != haptify ] || { mkdir -p "$6"; echo \'{"failures": ["a", "b"]}\' '
            '> "$6/figures.json"; exit 1; }\n')
        for file in folder.iterdir():
            file.chmod(0o755)
        done = subprocess.run(
            [sys.executable, "-B", "python/hapticgiant/design", "x.yaml", "--out", folder / "out"],
            env={**os.environ, "HAPTICGIANT_PROGRAM": str(folder / "hapticgiant")},
            capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("\ndoor        passed\nhaptify     2 runs ended early, see ", done.stdout)

    def test_bad_input_is_one_clear_error(self):
        for arguments, words in (
                (("arm", "--person", "man"), "expected male or female"),
                (("arm", "--person", "male,0"), "between 0 and 100"),
                (("arm", "--person", "male,tall"), "percentile of the stature"),
                (("measure", "haptic_gant"), "haptic_giant"),
                (("measure", "haptic_giant", "--grip", "sideways"), "across"),
                (("measure",), "device is required")):
            code, _, err = design(*arguments)
            self.assertEqual(code, 2, arguments)
            self.assertIn(words, err)

    def test_a_bad_option_of_the_search_is_bad_input(self):
        if not PROGRAM.with_name("hapticgiant-design").exists():
            self.skipTest("the search was not built (Debian: libpagmo-dev)")
        code, _, err = design("none.yaml", "--out", self.folder / "none", "--seed", -3)
        self.assertEqual(code, 2)
        self.assertIn("--seed: must be a whole number from 0 to 1000000000, got -3", err)


if __name__ == "__main__":
    unittest.main()
