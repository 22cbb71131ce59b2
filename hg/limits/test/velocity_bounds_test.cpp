#include "hg/limits/velocity_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/limits/test/one_joint.h"

namespace hg::limits {
namespace {

constexpr double kDt = 1e-3;               // s
constexpr double kSpeedMax = 1.5;          // m/s, the gantry of the reference device
constexpr Interval kTravel = {-1.4, 1.6};  // m
constexpr double kRounding = 1e-12;        // m

TEST(BrakingVelocityBounds, InfiniteLimitsGiveInfiniteBounds) {
  EXPECT_FALSE(braking_velocity_bounds({}, {}, 0.3).bounded());
}

TEST(BrakingVelocityBounds, DelayAndBrakingUseUpTheDistance) {
  const DriveResponse drive = {.tau = 0.05, .ddq_max = 2.0};
  const double d = 0.8;  // far enough for the first term to be the smaller one
  const double dq = braking_velocity_bounds(kTravel, drive, kTravel.ub - d).ub;
  EXPECT_NEAR(dq * drive.tau + dq * dq / (2.0 * drive.ddq_max), d, kRounding);
}

TEST(BrakingVelocityBounds, NearAndOutsideALimitTheApproachIsCriticallyDamped) {
  const DriveResponse drive = {.tau = 0.05, .ddq_max = 2.0};
  for (const double d : {0.01, 1e-6, 0.0, -1e-6, -0.1}) {
    const double q = kTravel.ub - d;
    EXPECT_DOUBLE_EQ(braking_velocity_bounds(kTravel, drive, q).ub, (kTravel.ub - q) / 0.2) << d;
  }
}

TEST(BrakingVelocityBounds, MirroringTheJointMirrorsTheBoundsAndTheyAreNeverEmpty) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const DriveResponse drive = {.tau = log_uniform(random, 1e-3, 0.2),
                                 .ddq_max = log_uniform(random, 0.5, 10.0)};
    const double lb = uniform(random, -2.0, 2.0);
    const double ub = lb + (seed % 4 == 0 ? 0.0 : uniform(random, 0.0, 3.0));
    const double q = uniform(random, -6.0, 6.0);
    const Interval dq = braking_velocity_bounds({lb, ub}, drive, q);
    ASSERT_LE(dq.lb, dq.ub);
    const Interval mirrored = braking_velocity_bounds({-ub, -lb}, drive, -q);
    ASSERT_EQ(mirrored.lb, -dq.ub);
    ASSERT_EQ(mirrored.ub, -dq.lb);
  }
}

TEST(BrakingVelocityBounds, AReturnFromFarOutsideRespectsTheOppositeLimit) {
  const DriveResponse drive = {.tau = 0.04, .ddq_max = 2.0};
  const Interval narrow = {0.0, 0.1};
  const double q = 3.0;
  const Interval dq = braking_velocity_bounds(narrow, drive, q);
  EXPECT_EQ(dq.lb, dq.ub);
  EXPECT_NEAR(-dq.ub * drive.tau + dq.ub * dq.ub / (2.0 * drive.ddq_max), 3.0, kRounding);
}

// A velocity-controlled axis: dead time, lag, and its own acceleration limit.
class Axis {
 public:
  Axis(double q, double dead_time, double lag, double ddq_max)
      : q_(q), lag_(lag), ddq_max_(ddq_max), commands_(std::lround(dead_time / kDt) + 1, 0.0) {}

  double q() const { return q_; }

  // One period; the lag is integrated in steps short against it.
  void follow(double dq_cmd) {
    constexpr int kSteps = 20;
    commands_.push_back(dq_cmd);
    commands_.erase(commands_.begin());
    for (int i = 0; i < kSteps; ++i) {
      const double ddq = std::clamp((commands_.front() - dq_) / lag_, -ddq_max_, ddq_max_);
      q_ += kDt / kSteps * (dq_ + 0.5 * kDt / kSteps * ddq);
      dq_ += kDt / kSteps * ddq;
    }
  }

 private:
  double q_;
  double dq_ = 0.0;
  double lag_;
  double ddq_max_;
  std::vector<double> commands_;
};

struct Drive {
  double dead_time, lag;
};

class ClosedLoop : public testing::TestWithParam<Drive> {};

TEST_P(ClosedLoop, TheAxisNeverPassesALimitAndArrivesThere) {
  const auto [dead_time, lag] = GetParam();
  const DriveResponse drive = {.tau = dead_time + lag + kDt, .ddq_max = 2.0};
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    Axis axis(uniform(random, kTravel.lb, kTravel.ub), dead_time, lag, 1.25 * drive.ddq_max);
    const bool is_wandering = seed % 2 == 1;
    double wish = kSpeedMax;
    for (int k = 0; k < 12'000; ++k) {
      if (is_wandering && k % 50 == 0) wish = uniform(random, -2.0, 2.0) * kSpeedMax;
      const Interval dq = braking_velocity_bounds(kTravel, drive, axis.q());
      axis.follow(std::clamp(std::clamp(wish, -kSpeedMax, kSpeedMax), dq.lb, dq.ub));
      ASSERT_LE(axis.q(), kTravel.ub + kRounding) << k;
      ASSERT_GE(axis.q(), kTravel.lb - kRounding) << k;
    }
    if (!is_wandering) {
      ASSERT_NEAR(axis.q(), kTravel.ub, 1e-6);
    }
  }
}

TEST_P(ClosedLoop, FromOutsideTheAxisComesBackAndNeverLeavesAgain) {
  const auto [dead_time, lag] = GetParam();
  const DriveResponse drive = {.tau = dead_time + lag + kDt, .ddq_max = 2.0};
  for (const double excess : {1e-4, 0.02, 0.3}) {
    Axis axis(kTravel.ub + excess, dead_time, lag, 1.25 * drive.ddq_max);
    bool is_inside = false;
    for (int k = 0; k < 5000; ++k) {
      axis.follow(std::min(kSpeedMax, braking_velocity_bounds(kTravel, drive, axis.q()).ub));
      is_inside = is_inside || axis.q() <= kTravel.ub;
      ASSERT_LE(axis.q(), kTravel.ub + (is_inside ? kRounding : excess)) << k;
    }
    EXPECT_NEAR(axis.q(), kTravel.ub, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, ClosedLoop,
                         testing::Values(Drive{0.0, 5e-3}, Drive{0.0, 20e-3}, Drive{0.0, 50e-3},
                                         Drive{4e-3, 5e-3}, Drive{4e-3, 40e-3}, Drive{10e-3, 5e-3},
                                         Drive{10e-3, 50e-3}, Drive{30e-3, 10e-3}));

TEST(CheckDriveResponse, AnImpossibleValueIsRefusedAndNamed) {
  const auto said = [](const DriveResponse& drive) -> std::string {
    try {
      check_drive_response(drive, "gantry x");
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(said({}), "");
  EXPECT_EQ(said({.tau = 0.0}), "gantry x: tau must be finite and positive, got 0");
  for (const double bad : {0.0, -1.0, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(said({.tau = bad}).starts_with("gantry x: tau must")) << bad;
    EXPECT_TRUE(said({.ddq_max = bad}).starts_with("gantry x: ddq_max must")) << bad;
  }
}

}  // namespace
}  // namespace hg::limits
