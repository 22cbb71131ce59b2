#include "bench/growth.h"

#include <gtest/gtest.h>

#include "bench/comparison.h"
#include "hg/hqp/solver.h"

namespace hg::bench {
namespace {

constexpr double kRounding = 1e-12;  // coefficients and points are of order 1

// Largest excess of a row that is no wish at the point of the problem.
double worst_violation(const GrowingProblem& growing) {
  const hqp::Problem& problem = growing.problem();
  double worst = 0.0;
  for (int row = 0; row < growing.first_wish(); ++row) {
    double value = 0.0;
    if (problem.variable(row) >= 0) {
      value = growing.point()[problem.variable(row)];
    } else {
      for (int i = 0; i < problem.variables(); ++i) {
        value += problem.coefficients(row)[i] * growing.point()[i];
      }
    }
    const Interval bounds = problem.bounds(row);
    worst = std::max({worst, bounds.lb - value, value - bounds.ub});
  }
  return worst;
}

TEST(GrowingProblem, ItsPointFulfilsEverythingButTheWishesInEveryStep) {
  for (const int n : {6, 24, 60}) {
    for (const int levels : {1, 2, 7, 20}) {
      GrowingProblem growing(n, levels, 3);
      for (int step = 0; step < 3; ++step) {
        EXPECT_LT(worst_violation(growing), kRounding)
            << n << " variables, " << levels << " levels";
        growing.step();
      }
    }
  }
}

TEST(GrowingProblem, HasTheStatedSizeAndRowsOfLengthOne) {
  GrowingProblem growing(24, 7, 1);
  growing.step();
  EXPECT_EQ(growing.problem().variables(), 24);
  EXPECT_EQ(growing.problem().levels(), 7);
  EXPECT_EQ(growing.problem().rows(), 60);
  for (int row = 0; row < 60; ++row) EXPECT_NEAR(growing.problem().norm(row), 1.0, kRounding);
}

TEST(GrowingProblem, IsSolvedWithLimitsActing) {
  GrowingProblem growing(24, 4, 1);
  hqp::Solver solver(growing.problem().capacity());
  hqp::Solution solution(growing.problem().capacity());
  hqp::ActiveSet active;
  ASSERT_EQ(solver.solve(growing.problem(), {}, active, solution), hqp::Status::kSolved);
  for (int level = 0; level < 3; ++level) {
    EXPECT_LT(solution.levels[level].slack_squared, 1e-18) << level;
  }
  int acting = 0;
  for (int row = 0; row < growing.first_wish(); ++row) {
    const hqp::RowState state = solution.state[row];
    acting += state == hqp::RowState::kLower || state == hqp::RowState::kUpper;
  }
  EXPECT_GE(acting, 3);
}

TEST(GrowingProblem, TheSameSeedIsTheSameProblem) {
  GrowingProblem one(12, 3, 5), same(12, 3, 5), other(12, 3, 6);
  one.step();
  same.step();
  other.step();
  EXPECT_EQ(one.point(), same.point());
  EXPECT_NE(one.point(), other.point());
}

TEST(Growth, EverySizeIsMeasuredOverAllItsProblems) {
  const GrowthRow row = measure_growth(6, 2, 1);
  EXPECT_EQ(row.failures, 0u);
  EXPECT_EQ(row.cold.count(), 20u);
  EXPECT_EQ(row.warm.count(), 20u);
  EXPECT_GE(row.warm_iterations, 1.0);
  EXPECT_LE(row.warm_iterations, row.cold_iterations);
}

}  // namespace
}  // namespace hg::bench
