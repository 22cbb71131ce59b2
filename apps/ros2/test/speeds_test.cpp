#include "apps/ros2/speeds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace hg::ros2 {
namespace {

constexpr std::int64_t kPeriod_ns = 4'000'000;
constexpr double kLeast_s = 2e-3;

VectorM at(double q) { return VectorM::Constant(6, q); }

// a joint at 1 rad/s, whose states arrive five at a time, 20 us apart; returns the largest speed
// after the first burst
double fastest_of_bursts(bool has_stamps) {
  Speeds speeds(kLeast_s);
  double fastest = 0.0;
  for (std::int64_t i = 0; i < 100; ++i) {
    const std::int64_t made_ns = 1 + i * kPeriod_ns;
    const std::int64_t arrival_ns = (i / 5 + 1) * 5 * kPeriod_ns + (i % 5) * 20'000;
    const bool is_known =
        speeds.see(at(1e-9 * static_cast<double>(made_ns)), has_stamps ? made_ns : 0, arrival_ns);
    if (is_known && i > 5) fastest = std::max(fastest, speeds.speeds()[0]);
  }
  return fastest;
}

TEST(Speeds, AreRightWhereStatesArriveInBursts) {
  EXPECT_NEAR(fastest_of_bursts(true), 1.0, 1e-9);
  EXPECT_NEAR(fastest_of_bursts(false), 1.0, 1e-9);
}

TEST(Speeds, FollowArrivalWhereStampsStandStillAndBeginAgainAfterAClockWasSetBack) {
  Speeds speeds(kLeast_s);
  EXPECT_FALSE(speeds.see(at(0.0), 7, kPeriod_ns));
  EXPECT_TRUE(speeds.see(at(0.004), 7, 2 * kPeriod_ns));
  EXPECT_NEAR(speeds.speeds()[0], 1.0, 1e-9);
  EXPECT_FALSE(speeds.see(at(0.008), 5, 3 * kPeriod_ns));
  EXPECT_TRUE(speeds.see(at(0.016), 5 + kPeriod_ns, 4 * kPeriod_ns));
  EXPECT_NEAR(speeds.speeds()[0], 2.0, 1e-9);
}

}  // namespace
}  // namespace hg::ros2
