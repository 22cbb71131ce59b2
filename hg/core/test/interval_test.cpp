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

}  // namespace
}  // namespace hg
