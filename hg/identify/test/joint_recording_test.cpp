#include "hg/identify/joint_recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "hg/core/error.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::identify {
namespace {

DeviceModel one_joint() {
  DeviceModel device{.chain = simulator::one_joint(1.0)};
  device.n_m = 1;
  return device;
}

Sample sample(std::uint64_t k) {
  Sample s;
  s.sensors.sequence = k;
  s.sensors.q_m = s.sensors.theta_m =
      VectorM::Constant(1, std::remainder(0.01 * static_cast<double>(k), 2 * std::numbers::pi));
  s.sensors.tau_m = VectorM::Constant(1, 7.0);
  s.command.q_m = s.sensors.q_m;
  s.command.enable = true;
  return s;
}

TEST(JointRecording, UnwrapsAnglesAndCutsAtGaps) {
  JointRecording joints(one_joint());
  for (std::uint64_t k = 1; k <= 3000; ++k) {
    if (k == 2000) continue;
    joints.add(sample(k));
  }
  const std::vector<JointMotion> parts = joints.parts();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(joints.samples(), 2999u);
  EXPECT_EQ(joints.gaps(), 1u);
  EXPECT_LT(parts[1].samples(), 1000);
  const JointMotion& part = parts[0];
  const Eigen::Index last = part.samples() - 1;
  EXPECT_NEAR(part.q(last, 0) - part.q(0, 0), 0.01 * static_cast<double>(last), 1e-9);
  EXPECT_NEAR(part.theta(last, 0), part.q(last, 0), 1e-9);
  EXPECT_NEAR(part.command(last, 0), part.q(last, 0), 1e-9);
}

TEST(JointRecording, LeavesOutWhatIsNotFinite) {
  JointRecording joints(one_joint());
  for (std::uint64_t k = 1; k <= 1000; ++k) {
    Sample s = sample(k);
    s.sensors.tau_m[0] = std::numeric_limits<double>::quiet_NaN();
    joints.add(s);
  }
  EXPECT_EQ(joints.used(), 0u);
  EXPECT_TRUE(joints.parts().empty());
}

TEST(JointRecording, RefusesAnotherDevice) {
  JointRecording joints(one_joint());
  Sample s = sample(1);
  s.sensors.q_m = VectorM::Zero(6);
  EXPECT_THROW(joints.add(s), SetupError);
}

TEST(Smoothing, KeepsLinesAndTheirSlope) {
  Series line(100, 1);
  for (Eigen::Index k = 0; k < 100; ++k) line(k, 0) = 3.0 * static_cast<double>(k) + 5.0;
  const Series smooth = smoothed(line, 10);
  const Series rate = slope(smooth, 0.1);
  for (Eigen::Index k = 11; k < 89; ++k) {
    EXPECT_NEAR(smooth(k, 0), line(k, 0), 1e-9);
    EXPECT_NEAR(rate(k, 0), 30.0, 1e-9);
  }
}

}  // namespace
}  // namespace hg::identify
