#include "bench/comparison.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "bench/baseline.h"
#include "hg/hqp/solver.h"

namespace hg::bench {
namespace {

// x0 + x1 = 2 first; then x0 <= 0.5; then x = (1, 3): slack (0, 0, norm of what cannot be had).
hqp::Problem corner() {
  hqp::Problem problem({.variables = 2, .levels = 3, .rows = 4});
  problem.add_level();
  problem.add_row(std::array{1.0, 1.0}, {2.0, 2.0});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 0.5}, 2.0);
  problem.add_level();
  problem.add_bound(0, {1.0, 1.0});
  problem.add_bound(1, {3.0, 3.0}, 3.0);
  return problem;
}

TEST(SlackNorms, AreWeightedAndZeroInsideTheBounds) {
  const std::vector<double> norms = slack_norms(corner(), std::array{1.5, 2.0});
  ASSERT_EQ(norms.size(), 3u);
  EXPECT_NEAR(norms[0], 1.5, 1e-15);
  EXPECT_NEAR(norms[1], 2.0, 1e-15);
  EXPECT_NEAR(norms[2], std::hypot(0.5, 3.0), 1e-15);
  EXPECT_EQ(slack_norms(corner(), std::array{0.5, 1.5})[1], 0.0);
}

TEST(Compare, TheFirstLevelThatDiffersDecides) {
  EXPECT_EQ(compare(std::array{1.0, 5.0}, std::array{1.0, 5.0}), ComparisonVerdict::kSame);
  EXPECT_EQ(compare(std::array{1.0 + 1e-7, 5.0}, std::array{1.0, 5.0}), ComparisonVerdict::kSame);
  EXPECT_EQ(compare(std::array{1.1, 0.0}, std::array{1.0, 5.0}), ComparisonVerdict::kWorse);
  EXPECT_EQ(compare(std::array{1.0, 4.0}, std::array{1.0, 5.0}), ComparisonVerdict::kBetter);
}

TEST(Compare, WhatIsBoughtFromALevelAboveIsWorse) {
  EXPECT_EQ(compare(std::array{1.0 + 1e-7, 4.0}, std::array{1.0, 5.0}), ComparisonVerdict::kWorse);
  EXPECT_EQ(compare(std::array{1e-9, 4.0}, std::array{0.0, 5.0}), ComparisonVerdict::kWorse);
}

TEST(Compare, WhatIsNotANumberIsWorse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compare(std::array{nan, 5.0}, std::array{1.0, 5.0}), ComparisonVerdict::kWorse);
}

TEST(Baseline, TheCascadeSolvesACornerWithAnActiveBoundAndAConflict) {
  const BaselineSolve solve = find_baseline();
  if (solve == nullptr) GTEST_SKIP() << kHowToGetBaseline;
  std::array<double, 2> x{};
  ASSERT_TRUE(solve(corner(), x.data()));
  // on the line x1 = 2 - x0, (x0 - 1)^2 + 9 (x1 - 3)^2 falls to x0 = -0.8: the bound is no obstacle
  EXPECT_NEAR(x[0], -0.8, 1e-6);
  EXPECT_NEAR(x[1], 2.8, 1e-6);

  hqp::Problem pushed = corner();
  pushed.set_bounds(3, {-3.0, -3.0});  // now to x0 = 4.6
  ASSERT_TRUE(solve(pushed, x.data()));
  EXPECT_NEAR(x[0], 0.5, 1e-6);
  EXPECT_NEAR(x[1], 1.5, 1e-6);

  pushed.set_bounds(1, {5.0, 5.0});  // a second equality fixes x before the last level
  ASSERT_TRUE(solve(pushed, x.data()));
  EXPECT_NEAR(x[0], 5.0, 1e-6);
  EXPECT_NEAR(x[1], -3.0, 1e-6);
}

TEST(Baseline, TheCascadeKeepsTheSlackOfLimitsThatContradictEachOther) {
  const BaselineSolve solve = find_baseline();
  if (solve == nullptr) GTEST_SKIP() << kHowToGetBaseline;
  hqp::Problem problem({.variables = 2, .levels = 2, .rows = 4});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 0.5}, 2.0);
  problem.add_bound(0, {1.5, kInfinity});
  problem.add_level();
  problem.add_bound(0, {9.0, 9.0});
  problem.add_bound(1, {3.0, 3.0});
  std::array<double, 2> x{};
  ASSERT_TRUE(solve(problem, x.data()));
  EXPECT_NEAR(x[0], 0.7, 1e-6);  // 4 (x0 - 0.5) + (x0 - 1.5) = 0
  EXPECT_NEAR(x[1], 3.0, 1e-6);
}

}  // namespace
}  // namespace hg::bench
