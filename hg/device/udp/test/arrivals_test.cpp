#include "hg/device/udp/arrivals.h"

#include <gtest/gtest.h>

namespace hg::udp {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // ns

TEST(Arrivals, ASampleIsDelayedWhenItComesAPeriodAfterItWasDue) {
  Arrivals arrivals(1000.0);
  EXPECT_FALSE(arrivals.is_late(100, 0));
  EXPECT_FALSE(arrivals.is_late(101, 2 * kPeriod));
  EXPECT_TRUE(arrivals.is_late(102, 4 * kPeriod + 1));
  EXPECT_FALSE(arrivals.is_late(103, 4 * kPeriod + 2));  // those behind it come at once
  EXPECT_FALSE(arrivals.is_late(104, 4 * kPeriod + 3));
}

TEST(Arrivals, AGapIsNoDelay) {
  Arrivals arrivals(1000.0);
  EXPECT_FALSE(arrivals.is_late(1, 0));
  EXPECT_FALSE(arrivals.is_late(5, 5 * kPeriod));
  EXPECT_TRUE(arrivals.is_late(7, 9 * kPeriod));
}

TEST(Arrivals, WhatWasOvertakenCountsElsewhere) {
  Arrivals arrivals(1000.0);
  EXPECT_FALSE(arrivals.is_late(1, 0));
  EXPECT_FALSE(arrivals.is_late(3, 2 * kPeriod));
  EXPECT_FALSE(arrivals.is_late(2, 50 * kPeriod));
  EXPECT_FALSE(arrivals.is_late(3, 50 * kPeriod));
  EXPECT_FALSE(arrivals.is_late(4, 3 * kPeriod));
}

}  // namespace
}  // namespace hg::udp
