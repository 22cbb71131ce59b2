#include "hg/model/joint_range.h"

#include <gtest/gtest.h>

namespace hg::model {
namespace {

using std::numbers::pi;

void expect_range(const Interval& range, double lb, double ub) {
  EXPECT_EQ(range.lb, lb);
  EXPECT_EQ(range.ub, ub);
}

TEST(FiniteRange, KeepsTheLimitsThatThereAre) {
  expect_range(finite_range({-0.5, 7.0}, true), -0.5, 7.0);
  expect_range(finite_range({4.0, kInfinity}, true), 4.0, 4.0 + 2.0 * pi);
  expect_range(finite_range({-kInfinity, -4.0}, true), -4.0 - 2.0 * pi, -4.0);
  expect_range(finite_range({4.0, kInfinity}, false), 4.0, 6.0);
  expect_range(finite_range({-kInfinity, -4.0}, false), -6.0, -4.0);
}

TEST(FiniteRange, IsOneTurnOrTwoMetresAroundZeroWithoutLimits) {
  expect_range(finite_range({}, true), -pi, pi);
  expect_range(finite_range({}, false), -1.0, 1.0);
}

}  // namespace
}  // namespace hg::model
