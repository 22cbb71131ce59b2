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
        mu = solution.multipliers(level=2)
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
        problem = problem_of([[([1.0, 0.0], 1.0, 1.0)], [([np.nan, 2.0], 1.0, 1.0)]], 2)
        with self.assertRaisesRegex(ValueError, r"row 1 \(level 1\): nan x0 \+ 2 x1 = 1: .*finite"):
            hqp.solve(problem)
        problem.set_row(1, [0.0, 1.0])
        problem.set_weight(1, -1.0)
        with self.assertRaisesRegex(ValueError, "the weight must be positive"):
            hqp.solve(problem)

    def test_rows_and_bounds_come_from_arrays(self):
        random = np.random.default_rng(3)
        A, b, w = random.normal(size=(4, 3)), random.normal(size=4), np.array([1, 2, 0.5, 3.0])
        problem = hqp.Problem(3)
        problem.add_level()
        self.assertEqual(problem.add_bounds(-10, [10, 20, np.inf]), [0, 1, 2])
        problem.add_level()
        self.assertEqual(problem.add_rows(A, b, b, w), [3, 4, 5, 6])
        solution = hqp.solve(problem)
        x = np.linalg.lstsq(w[:, None] * A, w * b, rcond=None)[0]
        np.testing.assert_allclose(solution.x, x, atol=1e-10)
        self.assertEqual(solution.state.dtype.kind, "i")
        np.testing.assert_array_equal(solution.state[:3], hqp.RowState.INACTIVE)
        np.testing.assert_array_equal(solution.freedom, [3, 3])
        np.testing.assert_array_equal(solution.blocking_row, [-1, -1])
        self.assertEqual(solution.slack_squared.shape, (2,))
        for A_, lb, words in ((A[:, :2], b, "A: columns: expected 3"), (A, b[:2], "lb: expected 4")):
            with self.assertRaisesRegex(ValueError, words):
                problem.add_rows(A_, lb, b)

    def test_a_solution_explains_itself(self):
        levels = [[([1, 0], -np.inf, 1.0)], [([1, 0], 5.0, 5.0)]]
        solution = hqp.solve(problem_of(levels, 2))
        self.assertIn("optimal, blocked by row 0\nrow 0 (level 0): x0 in [-inf, 1]: held at its "
                      "upper bound", str(solution))
        self.assertNotIn("multipliers", str(solution))
        self.assertIn("multipliers of level 1", solution.explain(level=1))

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
            hqp.solve(problem).multipliers(level=1)
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

    def test_a_written_problem_is_solved_the_same_way(self):
        random = np.random.default_rng(5)
        problem = hqp.Problem(6)
        problem.add_level()
        problem.add_rows(random.normal(size=(12, 6)), -1.0, 1.0, 0.1)
        problem.add_level()
        problem.add_bounds(*2 * [3 * random.normal(size=6)])
        options = hqp.Options()
        options.max_iterations = 2
        solution = hqp.solve(problem, options=options)
        self.assertEqual(solution.status, hqp.Status.ITERATION_LIMIT)
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder, "written.hqp"))
            hqp.write_problem(file, problem, solution.active_set, options, "a test")
            (read,) = hqp.read_recorded_problems(file)
            self.assertEqual((read.name, read.options.max_iterations), ("a test", 2))
            again = hqp.solve(read.problem, read.active_set, read.options)
            expected = hqp.solve(problem, solution.active_set, options)
            self.assertEqual(again.x.tobytes(), expected.x.tobytes())
            hqp.write_problem(file, problem, name="two\nlines")
            (read,) = hqp.read_recorded_problems(file)
            self.assertIsNone(read.active_set)
            self.assertEqual(read.name, "two lines")
            with self.assertRaisesRegex(SetupError, "cannot be written"):
                hqp.write_problem(folder, problem)
            options.max_iterations = 0
            with self.assertRaisesRegex(SetupError, "max_iterations"):
                hqp.write_problem(file, problem, options=options)
            self.assertEqual(len(hqp.read_problems(file)), 1)  # what was there

    def test_options_that_are_not_right_are_refused(self):
        problem = problem_of([[([1.0, 0.0], 1.0, 1.0)]], 2)
        for name, value in (("rank_tolerance", 0.0), ("feasibility_tolerance", float("nan")),
                            ("max_iterations", 0)):
            options = hqp.Options()
            setattr(options, name, value)
            with self.assertRaisesRegex(SetupError, name):
                hqp.solve(problem, options=options)


if __name__ == "__main__":
    unittest.main()
