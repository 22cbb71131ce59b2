"""`hapticgiant imus` against MuJoCo: what sensors measure, and whether predicted errors come true.

An extended Kalman filter is fed with what MuJoCo's gyroscopes and accelerometers show along motions
with random jerk. Exits with 77, which CTest takes for skipped, where MuJoCo is missing.
"""

import pathlib
import sys
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77

try:
    import mujoco
    import numpy as np
except ImportError as error:
    print(f"{error}: pip install -r tools/requirements-test.txt")
    sys.exit(SKIPPED)

package = types.ModuleType("hapticgiant")
package.__path__ = [str(ROOT / "python" / "hapticgiant")]
sys.modules["hapticgiant"] = package
from hapticgiant.imus import chain, motion, placement  # noqa: E402

GIANT = ROOT / "models/haptic_giant/haptic_giant.urdf"
ARMS = [ROOT / f"models/arms/{name}/{name}.urdf" for name in ("ur5e", "fr3")]
SEEDS = 16
LENGTH_S = 0.2
LOOK = 40  # samples between two looks at the errors: longer than they are correlated


class Judge:
    """A robot of MuJoCo with a gyroscope and an accelerometer at each place."""

    def __init__(self, file, places):
        spec = mujoco.MjSpec.from_file(str(file))
        for index, place in enumerate(places):
            spec.body(place.link).add_site(name=f"unit{index}", pos=list(place.r))
            for kind in (mujoco.mjtSensor.mjSENS_GYRO, mujoco.mjtSensor.mjSENS_ACCELEROMETER):
                spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=f"unit{index}")
        self.model = spec.compile()
        flags = mujoco.mjtDisableBit
        self.model.opt.disableflags |= int(flags.mjDSBL_CONTACT) | int(flags.mjDSBL_CONSTRAINT)
        self.data = mujoco.MjData(self.model)

    def signals(self, q, dq, ddq):
        """(T, 6 places)"""
        found = []
        for each in zip(q, dq, ddq, strict=True):
            self.data.qpos[:], self.data.qvel[:], self.data.qacc[:] = each
            mujoco.mj_inverse(self.model, self.data)
            found.append(self.data.sensordata.copy())
        return np.array(found)


class Signals(unittest.TestCase):
    def test_sensors_of_all_links_measure_what_those_of_mujoco_do(self):
        for file in (GIANT, *ARMS):
            robot = chain.Chain(file)
            places = placement.candidates(robot, grid=1)
            q, dq, ddq = np.random.default_rng(5).uniform(-1, 1, (3, 10, robot.n))
            judge = Judge(file, places).signals(q, dq, ddq)
            at = robot.motion(q, dq, ddq)
            ours = np.concatenate([at[p.link].measured(np.array(p.r))[0] for p in places], 1)
            np.testing.assert_allclose(ours, judge, atol=1e-9, err_msg=str(file))


class Consistency(unittest.TestCase):
    """The reference device with two sensors: errors of filters against the predicted covariance."""

    @classmethod
    def setUpClass(cls):
        cls.robot = chain.Chain(GIANT)
        cls.motion = motion.sines(cls.robot, 1, LENGTH_S, 1000.0)
        cls.places = placement.candidates(cls.robot, grid=1)
        noise = placement.Noise(jerk_rad=5.0, jerk_m=2.0)  # a little, so that all seeds stay near
        cls.problem = placement.Problem(cls.robot, cls.motion, cls.places, noise)
        n = cls.robot.n
        known = np.repeat([1e-4, 0.02, 0.5], n)  # a filter that has run for a while
        cls.problem.P0 = np.diag((known / cls.problem.scale) ** 2)
        every = cls.problem.scores([(i, j) for i in range(len(cls.places)) for j in range(i)])
        pairs = [(i, j) for i in range(len(cls.places)) for j in range(i)]
        cls.best, cls.worst = pairs[int(every.argmin())], pairs[int(every.argmax())]
        cls.random = pairs[int(np.random.default_rng(2).integers(len(pairs)))]
        cls.found = {name: cls.play(pair) for name, pair in
                     (("best", cls.best), ("random", cls.random), ("worst", cls.worst))}

    @classmethod
    def play(cls, pair):
        """Errors (T, SEEDS, 3 n) of filters, and the predicted covariance (T, 3 n, 3 n), scaled."""
        problem, robot, n = cls.problem, cls.robot, cls.robot.n
        random, scale, F = np.random.default_rng(7), problem.scale, problem.F
        places = [cls.places[i] for i in pair]
        reference = np.concatenate([cls.motion.q, cls.motion.dq, cls.motion.ddq], 1) / scale
        pushes = reference[1:] - reference[:-1] @ F.T  # what the filter knows of the jerk
        steps, size = reference.shape
        truth = np.empty((steps, SEEDS, size))
        truth[0] = reference[0] + random.normal(size=(SEEDS, size)) @ np.sqrt(problem.P0)
        root = np.linalg.cholesky(problem.Q)
        for k in range(1, steps):
            jerk = random.normal(size=(SEEDS, size)) @ root.T
            truth[k] = truth[k - 1] @ F.T + pushes[k - 1] + jerk
        flat = np.split((truth * scale).reshape(-1, size), 3, 1)
        sigma = np.tile(problem._sigma[:, 0], len(places))
        clean = Judge(GIANT, places).signals(*flat) / sigma
        shown = clean.reshape(steps, SEEDS, -1) + random.normal(size=(steps, SEEDS, len(sigma)))
        E = problem._encoder
        encoders = truth @ E.T + random.normal(size=(steps, SEEDS, n))
        x, P = np.tile(reference[0], (SEEDS, 1)), np.tile(problem.P0, (SEEDS, 1, 1))
        errors = np.empty_like(truth)
        for k in range(steps):
            if k:
                x, P = x @ F.T + pushes[k - 1], F @ P @ F.T + problem.Q
            at = robot.motion(*np.split(x * scale, 3, 1))
            measured = [at[place.link].measured(np.array(place.r)) for place in places]
            expected = np.concatenate([each[0] for each in measured], 1) / sigma
            H = np.concatenate([each[1] for each in measured], 1) * scale / sigma[:, None]
            H = np.concatenate([np.tile(E, (SEEDS, 1, 1)), H], 1)
            rest = np.concatenate([encoders[k] - x @ E.T, shown[k] - expected], 1)
            cross = H @ P
            gain = np.linalg.solve(cross @ H.transpose(0, 2, 1) + np.eye(H.shape[1]), cross)
            gain = gain.transpose(0, 2, 1)
            x = x + np.einsum("sij,sj->si", gain, rest)
            left = np.eye(size) - gain @ H
            P = left @ P @ left.transpose(0, 2, 1) + gain @ gain.transpose(0, 2, 1)
            errors[k] = x - truth[k]
        return errors, problem.covariances(pair) / np.outer(scale, scale)

    def looks(self, name):
        errors, P = self.found[name]
        return errors[LOOK - 1::LOOK], P[LOOK - 1::LOOK]

    def test_normalised_errors_are_as_large_as_predicted(self):
        for name in self.found:
            errors, P = self.looks(name)
            nees = np.einsum("ksi,kij,ksj->ks", errors, np.linalg.inv(P), errors) / errors.shape[2]
            self.assertAlmostEqual(nees.mean(), 1.0, delta=0.12, msg=name)
            print(f"{name:7} normalised error squared {nees.mean():.3f}")

    def test_each_joint_has_the_predicted_errors(self):
        n = self.robot.n
        for name in self.found:
            errors, P = self.looks(name)
            predicted = np.sqrt(np.diagonal(P, axis1=1, axis2=2).mean(0))
            ratio = np.sqrt((errors ** 2).mean((0, 1))) / predicted
            np.testing.assert_allclose(ratio[n:], 1.0, atol=0.3, err_msg=name)
            self.assertAlmostEqual(np.sqrt((ratio[n:] ** 2).mean()), 1.0, delta=0.1, msg=name)

    def test_the_best_placement_is_better_in_truth(self):
        n, size = self.robot.n, {}
        for name, (errors, _) in self.found.items():
            rms = np.sqrt((errors[LOOK:, :, n:] ** 2).mean((0, 1)))
            size[name] = np.exp(np.log(rms).mean())
        print({name: round(float(value / size["best"]), 2) for name, value in size.items()})
        self.assertLess(1.05 * size["best"], size["random"])
        self.assertLess(1.5 * size["best"], size["worst"])


if __name__ == "__main__":
    unittest.main()
