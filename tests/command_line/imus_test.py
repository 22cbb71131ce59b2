"""`hapticgiant imus`: derivatives, known facts about observability, quality of the search, messages.

    imus_test.py PROGRAM
"""

import itertools
import json
import math
import pathlib
import sys
import types
import unittest

import numpy as np
from program import MODELS, TemporaryFolder, run

package = types.ModuleType("hapticgiant")
package.__path__ = [str(pathlib.Path("python/hapticgiant").resolve())]
sys.modules["hapticgiant"] = package
from hapticgiant.imus import chain, motion, placement  # noqa: E402

GIANT = MODELS / "haptic_giant" / "haptic_giant.urdf"
UR5E = MODELS / "arms" / "ur5e" / "ur5e.urdf"
STEP = 1e-5  # of finite differences
SHORT_S = 0.2


def problem_of(file, places=None, noise=None, **options):
    robot = chain.Chain(file)
    places = places or placement.candidates(robot, grid=1)
    return placement.Problem(robot, motion.sines(robot, 1, SHORT_S, 1000.0), places,
                             noise or placement.Noise(), **options)


class Derivatives(unittest.TestCase):
    def test_are_those_of_finite_differences(self):
        r = np.array([0.1, 0.2, -0.3])
        for file in (GIANT, UR5E, MODELS / "arms" / "fr3" / "fr3.urdf"):
            robot = chain.Chain(file)
            x = np.random.default_rng(4).uniform(-1, 1, (3, 3 * robot.n))
            for link in robot.links:
                def measured(x, robot=robot, link=link):
                    return robot.motion(*np.split(x, 3, 1))[link].measured(r)
                slope = measured(x)[1]
                for k, unit in enumerate(STEP * np.eye(3 * robot.n)):
                    numeric = (measured(x + unit)[0] - measured(x - unit)[0]) / 2 / STEP
                    np.testing.assert_allclose(slope[:, :, k], numeric, atol=1e-7,
                                               err_msg=f"{file.name} {link} {k}")

    def test_a_motion_has_the_derivatives_that_it_says(self):
        robot = chain.Chain(UR5E)
        moved = motion.sines(robot, 3, 1.0, 1000.0)
        for value, slope in ((moved.q, moved.dq), (moved.dq, moved.ddq)):
            np.testing.assert_allclose((value[2:] - value[:-2]) * 500, slope[1:-1], atol=2e-3)
        for k, joint in enumerate(robot.moving):
            self.assertLessEqual(np.abs(moved.dq[:, k]).max(), joint.dq_max)
            self.assertGreaterEqual(moved.q[:, k].min(), joint.q_min)
            self.assertLessEqual(moved.q[:, k].max(), joint.q_max)


class KnownFacts(unittest.TestCase):
    def speeds(self, links, encoders=False):
        """(sum, difference) of m4' and m5': what is not known, gyroscopes on these links alone."""
        noise = placement.Noise(accelerometer=1e6, encoders=encoders)
        problem = problem_of(GIANT, [placement.Candidate(link, (0, 0, 0)) for link in links], noise)
        n = problem.chain.n
        names = [joint.name for joint in problem.chain.moving]
        m4, m5 = n + names.index("m4"), n + names.index("m5")
        gyro = problem.chain.motion(problem.motion.q, problem.motion.dq, problem.motion.ddq)["m6"].dw
        np.testing.assert_allclose(gyro[:, :, m4], gyro[:, :, m5], atol=1e-12)  # parallel axes
        P = problem.covariances(tuple(range(len(links))))[-1]
        return [math.sqrt(P[m4, m4] + P[m5, m5] + 2 * sign * P[m4, m5]) for sign in (1, -1)]

    def test_gyroscopes_behind_parallel_axes_do_not_distinguish_their_joints(self):
        total, difference = self.speeds(["m3", "m6"])
        self.assertLess(total, 0.02)
        self.assertGreater(difference, 1.0)

    def test_a_unit_between_them_or_encoders_do(self):
        for links, encoders in ((["m3", "m4", "m6"], False), (["m3", "m6"], True)):
            total, difference = self.speeds(links, encoders)
            self.assertLess(total, 0.02)
            self.assertLess(difference, 0.02)

    def test_a_joint_behind_the_last_unit_is_known_by_its_encoder_alone(self):
        problem = problem_of(UR5E, [placement.Candidate("forearm_link", (0.1, 0, 0))])
        alone, one = problem.errors([(), (0,)])
        n = problem.chain.n
        for first in (n, 2 * n):
            np.testing.assert_allclose(one[first + 3:first + n], alone[first + 3:first + n], rtol=1e-6)
            self.assertTrue((one[first:first + 3] < 0.9 * alone[first:first + 3]).all())

    def test_how_a_unit_is_turned_does_not_matter(self):
        problem = problem_of(UR5E)
        H = problem._all_rows((4,))
        turn = np.kron(np.eye(2), chain.rotation_of(np.array([0.3, -1.0, 2.0])))
        for each in (H, turn @ H):
            problem.filter(each[None], lambda k, P: setattr(self, "last", P))
            kept = getattr(self, "kept", self.last)
            self.kept = self.last
        np.testing.assert_allclose(kept, self.last, rtol=1e-6, atol=1e-12)


class Search(unittest.TestCase):
    def test_greedy_with_exchange_is_close_to_the_best_of_all(self):
        for measure, criterion in itertools.product(placement.MEASURES, ("logdet", "lambda_min", "trace")):
            problem = problem_of(UR5E, measure=measure, criterion=criterion)
            best = placement.exhaustive(problem, 2)
            found = placement.exchange(problem, placement.greedy(problem, 2))
            self.assertEqual(best.evaluated, math.comb(len(problem.places), 2))
            self.assertLessEqual(best.score, found.score * (1 + 1e-9))
            self.assertLess(found.score, 1.05 * best.score, (measure, criterion))

    def test_a_link_carries_one_sensor_where_that_is_asked_for(self):
        problem = problem_of(UR5E, one_per_link=True)
        for search in (lambda: placement.exhaustive(problem, 3),
                       lambda: placement.exchange(problem, placement.greedy(problem, 3))):
            self.assertEqual(len({problem.places[i].link for i in search().placement}), 3)

    def test_information_is_submodular_and_its_bounds_hold(self):
        problem = problem_of(UR5E, measure="gramian")
        value = lambda sensors: problem.information(problem.scores([sensors]))[0]  # noqa: E731
        random = np.random.default_rng(1)
        for _ in range(50):
            *large, new = (int(i) for i in random.choice(len(problem.places), 5, replace=False))
            small = large[:2]
            early, late = value((*small, new)) - value(small), value((*large, new)) - value(large)
            self.assertGreater(late, 0)
            self.assertGreater(early, late - 1e-9)
        best, found = placement.exhaustive(problem, 3), placement.greedy(problem, 3)
        bound = placement.submodular_bound(problem, found.placement)
        self.assertLessEqual(bound, best.score)
        nothing = value(())
        self.assertGreater(problem.information(found.score) - nothing,
                           (1 - 1 / math.e) * (problem.information(best.score) - nothing))


class Command(TemporaryFolder):
    def imus(self, *words, code=0):
        found, out, err = run("imus", *words)
        self.assertEqual(found, code, out + err)
        return out, err

    def refused(self, *words, message):
        out, err = self.imus(*words, code=2)
        self.assertEqual(out, "")
        self.assertIn(message, err)
        self.assertNotIn("Traceback", err)

    def test_places_sensors_and_leaves_a_picture_and_a_file(self):
        picture, file = self.folder / "imus.svg", self.folder / "imus.json"
        out, _ = self.imus(MODELS / "arms/ur5e/device.yaml", "--count", 2, "--grid", 1, "--duration",
                           SHORT_S, "--picture", picture, "--json", file)
        summary = json.loads(file.read_text())
        self.assertIn("12 candidates on 6 links", out)
        self.assertIn("<svg", picture.read_text())
        self.assertEqual(len(summary["choices"][-1]["placement"]), 2)
        encoders, one, two = summary["rms_errors"][:3]
        for before, after in ((encoders, one), (one, two)):
            self.assertLess(sum(map(math.log, after["ddq"])), sum(map(math.log, before["ddq"])) - 1)
        again, _ = self.imus(MODELS / "arms/ur5e/device.yaml", "--count", 2, "--grid", 1, "--duration",
                             SHORT_S)
        self.assertEqual(out, again)

    def test_a_table_of_positions_is_a_motion(self):
        robot = chain.Chain(UR5E)
        moved = motion.sines(robot, 2, 0.5, 500.0)
        names = [joint.name for joint in robot.moving]
        rows = [",".join(["time_s", *names])]
        rows += [",".join(map(repr, [k / 500, *map(float, q)])) for k, q in enumerate(moved.q)]
        table = self.folder / "motion.csv"
        table.write_text("\n".join(rows))
        found = motion.from_table(robot, table, 500.0)
        cut = (len(moved) - len(found)) // 2
        np.testing.assert_allclose(found.ddq, moved.ddq[cut:cut + len(found)], atol=0.05)
        out, _ = self.imus(UR5E, "--motion", table, "--rate", 500, "--link", "forearm_link")
        self.assertIn("forearm_link (", out)
        table.write_text("\n".join([*rows[:5], "0.1,1,2", *rows[5:]]))
        self.refused(UR5E, "--motion", table, message="motion.csv:6: expected a number")
        table.write_text("time_s,a\n0,1\n")
        self.refused(UR5E, "--motion", table, message="motion.csv:1: expected a column 'shoulder_pan")

    def test_bad_input_is_refused_with_its_place(self):
        text = UR5E.read_text()
        bad = self.folder / "bad.urdf"
        for change, message in (
                (text.replace('type="revolute"', 'type="revolving"', 1), "type 'revolving'"),
                (text.replace("</robot>", ""), "no XML"),
                (text.replace('<parent link="forearm_link"', '<parent link="arm"'), "'arm' is not there"),
                ("<robot name='a'><link name='b'/></robot>", "has no moving joint"),
                ("<sdf/>", "bad.urdf:1: expected <robot>")):
            self.assertNotEqual(change, text)
            bad.write_text(change)
            self.refused(bad, message=message)
        device = self.folder / "device.yaml"
        device.write_text(f"urdf: {UR5E}\nposture: {{elbow_jiont: 1}}\n")
        self.refused(device, message="did you mean 'elbow_joint'?")
        device.write_text(f"urdf: {UR5E}\njoints: {{elbow_joint: {{q_min_rad: low}}}}\n")
        self.refused(device, message="elbow_joint: q_min_rad: expected a number, got 'low'")
        device.write_text("urdf: [\n")
        self.refused(device, message="device.yaml:2: no YAML")
        self.refused(self.folder / "none.urdf", message="none.urdf: No such file")
        self.refused(UR5E, "--link", "forearm", message="did you mean 'forearm_link'?")
        self.refused(UR5E, "--at", "forearm_link:1,2", message="expected LINK:X,Y,Z in m")
        self.refused(UR5E, "--at", "forearm_link:0,0,0", "--count", 2, message="--count: 2 sensors, there is room for 1")
        self.refused(UR5E, "--one-per-link", "--count", 7, message="there is room for 6")
        self.refused(UR5E, "--count", 0, message="expected a whole number from 1 on")
        self.refused(UR5E, "--gyro", "-1", message="expected a number above 0")
        self.refused(UR5E, "--duration", "0.01", message="--duration: expected at least 0.1 s")
        self.refused(UR5E, "--picture", "a.xyz", message="expected .svg, .png or .pdf")


if __name__ == "__main__":
    unittest.main()
