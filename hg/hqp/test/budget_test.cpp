// A solve that ends early keeps its result, and the next one continues from there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp {
namespace {

constexpr double kSameSlack = 1e-8;
constexpr double kFeasible = 1e-8;

double slack_norm(const Solution& solution, int level) {
  return std::sqrt(solution.levels[level].slack_squared);
}

// Limits of a device that can be met, all at level 0, then anything: `seed`'s random problem around
// them.
Problem problem_with_limits(std::uint32_t seed) {
  const Problem rest = random_problem(seed, {});
  const int n = rest.variables();
  Problem problem({.variables = n, .levels = rest.levels() + 1, .rows = rest.rows() + n});
  problem.add_level();
  for (int i = 0; i < n; ++i) problem.add_bound(i, {-0.5 - 0.1 * i, 0.3});
  for (int level = 0; level < rest.levels(); ++level) {
    problem.add_level();
    for (int row = rest.first_row(level); row < rest.end_row(level); ++row) {
      if (rest.variable(row) >= 0) {
        problem.add_bound(rest.variable(row), rest.bounds(row), rest.weight(row));
      } else {
        problem.add_row(rest.coefficients(row), rest.bounds(row), rest.weight(row));
      }
    }
  }
  return problem;
}

// Cold, with a budget; with at most one set for the end there is no proof, but the point is kept.
struct Ended {
  int spent = 0;
  int solved = 0;
};

Ended end_all(const SolverOptions& options) {
  Ended ended;
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = problem_with_limits(seed);
    Solver solver(problem.capacity());
    Solution full(problem.capacity());
    Solution solution(problem.capacity());
    ActiveSet active;
    EXPECT_EQ(solver.solve(problem, {}, active, full), Status::kSolved);
    active = {};
    const Status status = solver.solve(problem, options, active, solution);
    EXPECT_EQ(fault_of(problem, options, solution), "");
    EXPECT_LE(slack_norm(solution, 0), kFeasible);
    for (int level = 0; level < solution.completed_levels; ++level) {
      EXPECT_NEAR(slack_norm(solution, level), slack_norm(full, level),
                  kSameSlack * (1.0 + slack_norm(full, level)));
    }
    const bool is_spent = status == Status::kIterationLimit;
    EXPECT_EQ(solver.budgets_spent(), is_spent ? 1u : 0u);
    ended.spent += is_spent;
    ended.solved += status == Status::kSolved;
    EXPECT_EQ(solver.solve(problem, {}, active, solution),
              Status::kSolved);  // continues from there
    EXPECT_EQ(fault_of(problem, {}, solution), "");
  }
  return ended;
}

TEST(Budget, KeepsLimitsAndCompletedLevels) {
  for (const int budget : {1, 2, 5}) {
    SCOPED_TRACE("budget " + std::to_string(budget));
    const Ended ended = end_all({.budget = budget});
    EXPECT_EQ(ended.solved + ended.spent, 500);
    EXPECT_GE(ended.solved, 495);  // the end proves nearly all
  }
}

TEST(Budget, KeepsLimitsWithoutASetForTheEnd) {
  const Ended ended = end_all({.max_iterations = 1, .budget = 1});
  EXPECT_EQ(ended.solved + ended.spent, 500);
  EXPECT_GT(ended.spent, 100);
}

TEST(Budget, IsNotExceededByMoreThanTheEnd) {
  int longer = 0;  // the dual method gave up
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = problem_with_limits(seed);
    Solver solver(problem.capacity());
    Solution solution(problem.capacity());
    for (const int budget : {1, 2, 5}) {
      ActiveSet active;
      solver.solve(problem, {.budget = budget}, active, solution);
      EXPECT_LE(solution.iterations, budget + 4 * problem.levels());
      longer += solution.iterations > budget + 1;
    }
  }
  EXPECT_LE(longer, 15);  // of 1500
}

}  // namespace
}  // namespace hg::hqp
