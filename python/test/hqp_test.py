"""hapticgiant.hqp: problems from numpy and back."""

import pathlib
import tempfile
import unittest

import numpy as np

from hapticgiant import SetupError, hqp


def problem_of(levels, variables):
    """Levels are lists of (row, lb, ub)."""
    problem = hqp.Problem(variables)
    for rows in levels:
        problem.add_level()
        for row, lb, ub in rows:
            problem.add_row(row, lb, ub)
    return problem


class Solve(unittest.TestCase):
    def test_a_single_level_is_least_squares(self):
        seed = 7
        random = np.random.default_rng(seed)
        A, b = random.normal(size=(8, 5)), random.normal(size=8)
        solution = hqp.solve(problem_of([[(row, t, t) for row, t in zip(A, b)]], 5))
        self.assertEqual(solution.status, hqp.Status.SOLVED)
        np.testing.assert_allclose(solution.x, np.linalg.lstsq(A, b, rcond=None)[0], atol=1e-10,
                                   err_msg=f"seed {seed}")
        np.testing.assert_allclose(solution.slack, b - A @ solution.x, atol=1e-10)
        self.assertAlmostEqual(solution.slack_squared[0], np.sum((b - A @ solution.x) ** 2))

    def test_a_higher_level_is_never_sacrificed(self):
        levels = [[([1, 0], -np.inf, 1.0)], [([1, 1], 3.0, 3.0)], [([1, 0], 5.0, 5.0)]]
        problem = problem_of(levels, 2)
        solution = hqp.solve(problem)
        np.testing.assert_allclose(solution.x, [1.0, 2.0])
        self.assertEqual(solution.state[0], hqp.RowState.UPPER)
        self.assertEqual(solution.blocking_row[2], 0)
        mu = hqp.multipliers(problem, solution, level=2)
        np.testing.assert_allclose(mu, [4.0, 0.0, -4.0], atol=1e-12)

    def test_the_last_active_set_solves_the_same_problem_at_once(self):
        random = np.random.default_rng(1)
        levels = [[(row, -1.0, 1.0) for row in random.normal(size=(12, 6))],
                  [(row, t, t) for row, t in zip(np.eye(6), 3 * random.normal(size=6))]]
        problem = problem_of(levels, 6)
        cold = hqp.solve(problem)
        warm = hqp.solve(problem, cold.active_set)
        self.assertGreater(cold.iterations, 1)
        self.assertEqual(warm.iterations, 1)
        np.testing.assert_allclose(warm.x, cold.x, atol=1e-12)

    def test_rows_can_change(self):
        problem = problem_of([[([1.0, 0.0], 1.0, 1.0)]], 2)
        problem.set_row(0, [0.0, 2.0])
        problem.set_bounds(0, 4.0, 4.0)
        problem.set_weight(0, 3.0)
        np.testing.assert_allclose(hqp.solve(problem).x, [0.0, 2.0])

    def test_bad_rows_are_named(self):
        problem = problem_of([[([1.0, 0.0], 1.0, 1.0)], [([np.nan, 0.0], 1.0, 1.0)]], 2)
        solution = hqp.solve(problem)
        self.assertEqual((solution.status, solution.bad_row), (hqp.Status.BAD_ROW, 1))
        np.testing.assert_allclose(solution.x, [1.0, 0.0])

    def test_wrong_shapes_raise(self):
        problem = problem_of([[([1.0, 0.0], 1.0, 1.0)]], 2)
        bound = problem.add_bound(1, ub=0.0)
        with self.assertRaisesRegex(ValueError, "expected 2 numbers, got 3"):
            problem.add_row([1, 2, 3])
        with self.assertRaisesRegex(ValueError, "row 7"):
            problem.set_bounds(7, 0.0, 1.0)
        with self.assertRaisesRegex(ValueError, "add_bound"):
            problem.set_row(bound, [1.0, 0.0])
        with self.assertRaises(SetupError):
            problem.add_bound(2)
        with self.assertRaises(ValueError):
            hqp.multipliers(problem, hqp.solve(problem), level=1)
        with self.assertRaises(SetupError):
            hqp.Problem(0)
        with self.assertRaises(TypeError):
            problem.add_row("words")

    def test_files_are_read(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "one.txt")
            file.write_text("hqp 2 1\nlevel 1 0\n1 1 4\nend\n")
            (problem,) = hqp.read_problems(str(file))
            np.testing.assert_allclose(hqp.solve(problem).x, [2.0, 2.0])
            file.write_text("hqp 2 1\nlevel 1 0\n1 1\nend\n")
            with self.assertRaisesRegex(SetupError, "one.txt:3"):
                hqp.read_problems(str(file))


if __name__ == "__main__":
    unittest.main()
