#include "hg/core/interval.h"

#include <gtest/gtest.h>

namespace hg {
namespace {

TEST(Interval, TheDefaultContainsEverythingAndBoundsNothing) {
  EXPECT_TRUE(Interval{}.contains(1e300));
  EXPECT_FALSE(Interval{}.bounded());
  EXPECT_FALSE(Interval{}.empty());
}

TEST(Interval, IntersectingDisjointIntervalsIsEmpty) {
  EXPECT_TRUE(intersect({0.0, 1.0}, {2.0, 3.0}).empty());
  EXPECT_FALSE(intersect({0.0, 1.0}, {1.0, 3.0}).empty());
}

TEST(Interval, MovedIntoAnotherIsTheIntersectionOrTheNearestPoint) {
  const auto expect = [](Interval is, double lb, double ub) {
    EXPECT_EQ(is.lb, lb);
    EXPECT_EQ(is.ub, ub);
  };
  expect(moved_into({0.0, 2.0}, {1.0, 3.0}), 1.0, 2.0);
  expect(moved_into({0.0, 0.3}, {0.5, 0.8}), 0.5, 0.5);
  expect(moved_into({1.0, 2.0}, {0.5, 0.8}), 0.8, 0.8);
  expect(moved_into({1.0, 2.0}, {0.8, 0.5}), 1.0, 2.0);
}

}  // namespace
}  // namespace hg
