#include "hg/identify/friction_traces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::identify {
namespace {

constexpr double kNoLag = 0.0;

DeviceModel one_joint() {
  DeviceModel device{.chain = model::ChainModel::free_body({})};
  device.actuators = {reference_actuators().front()};
  return device;
}

// Sample `k` of a drive that is on and answers the command of two samples before.
Sample sample(std::uint64_t k) {
  Sample s;
  s.sensors.sequence = k;
  s.sensors.answered_sequence = k > 2 ? k - 2 : 0;
  s.sensors.theta_m = VectorM::Constant(1, 1e-3 * static_cast<double>(k));
  s.sensors.tau_m = VectorM::Constant(1, 7.0);
  s.command.sequence = k;
  s.command.enable = true;
  s.command.tau_m = VectorM::Constant(1, static_cast<double>(k));
  return s;
}

TEST(FrictionTraces, TakesTheCommandThatWasAtWork) {
  FrictionTraces traces(one_joint(), kNoLag);
  for (std::uint64_t k = 1; k <= 1000; ++k) traces.add(sample(k));
  const FrictionTrace& joint = traces.joints()[0];
  EXPECT_EQ(traces.samples(), 1000u);
  EXPECT_EQ(traces.used(), joint.theta.size());
  ASSERT_GT(joint.theta.size(), 600u);
  ASSERT_LT(joint.theta.size(), 710u) << "brakes open for 0.3 s";
  EXPECT_EQ(joint.cuts, std::vector<std::size_t>{0});
  // until the last sample that of the sample before was at work, given two samples before that
  EXPECT_EQ(joint.theta.back(), 1.0);
  EXPECT_EQ(joint.tau_motor.back(), 997.0);
  EXPECT_EQ(joint.tau_J.back(), 7.0);
}

TEST(FrictionTraces, FollowsTheCurrent) {
  FrictionTraces traces(one_joint(), 2e-3);
  for (std::uint64_t k = 1; k <= 1000; ++k) {
    Sample s = sample(k);
    s.command.tau_m[0] = k <= 900 ? 0.0 : 10.0;
    traces.add(s);
  }
  const std::vector<double>& tau = traces.joints()[0].tau_motor;
  // the command of 901 is at work from 903 on; 4 ms later that is two time constants
  EXPECT_NEAR(tau[tau.size() - 1 - (1000 - 907)], 10.0 * (1.0 - std::exp(-2.0)), 1e-9);
}

TEST(FrictionTraces, CutsWhereSamplesAreLostOrDrivesAreOff) {
  FrictionTraces traces(one_joint(), kNoLag);
  for (std::uint64_t k = 1; k <= 2000; ++k) {
    if (k == 700) continue;
    Sample s = sample(k);
    if (k == 1300) s.command.enable = false;
    traces.add(s);
  }
  EXPECT_EQ(traces.joints()[0].cuts.size(), 3u);
  EXPECT_EQ(traces.gaps(), 1u);
}

TEST(FrictionTraces, UnwrapsJointsWithoutLimits) {
  FrictionTraces traces(one_joint(), kNoLag);
  for (std::uint64_t k = 1; k <= 1000; ++k) {
    Sample s = sample(k);
    s.sensors.theta_m[0] = std::remainder(0.01 * static_cast<double>(k), 2.0 * std::numbers::pi);
    traces.add(s);
  }
  const std::vector<double>& theta = traces.joints()[0].theta;
  EXPECT_NEAR(theta.back() - theta.front(), 0.01 * static_cast<double>(theta.size() - 1), 1e-9);
}

TEST(FrictionTraces, RefusesDrivesThatFollowPositions) {
  DeviceModel without = one_joint();
  without.actuators.clear();
  EXPECT_THROW(FrictionTraces(without, kNoLag), SetupError);
}

}  // namespace
}  // namespace hg::identify
