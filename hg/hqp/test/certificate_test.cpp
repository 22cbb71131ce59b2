#include "hg/hqp/test/certificate.h"

#include <gtest/gtest.h>

namespace hg::hqp {
namespace {

TEST(OptimalityGaps, AreZeroAtTheOptimumAndNotBesideIt) {
  Problem problem({.variables = 2, .levels = 2, .rows = 3});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 1.0});
  problem.add_level();
  problem.add_bound(0, {3.0, 3.0});
  problem.add_row(std::vector{1.0, 1.0}, {2.0, 2.0});

  EXPECT_LT(largest_gap(problem, {1.0, 1.0}), 1e-12);
  EXPECT_GT(largest_gap(problem, {0.9, 1.1}), 0.1);   // could go up to the bound
  EXPECT_GT(largest_gap(problem, {1.0, 0.9}), 0.01);  // the other row could be met
  EXPECT_GT(largest_gap(problem, {1.1, 0.9}), 0.1);   // breaks the bound
}

}  // namespace
}  // namespace hg::hqp
