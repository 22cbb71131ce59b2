#include "hg/identify/joint_elasticity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/simulator/random_stream.h"

namespace hg::identify {
namespace {

constexpr double kPeriod = 1e-3, kK = 12e3, kD = 9.0, kGear = 100.0;

// A joint that swings under a torque of `size`; encoders and torque sensor with noise.
JointMotion motion(double size, double duration_s) {
  simulator::RandomStream random(1, simulator::RandomEffect::kTorqueNoise, 0);
  JointMotion part;
  const auto n = static_cast<Eigen::Index>(duration_s / kPeriod);
  part.q.resize(n, 1);
  part.theta = part.tau = part.q;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) * kPeriod;
    const double q = 0.5 * std::sin(1.1 * t);
    // torque and twist of the same swings: tau = K x + D x'
    double twist = 0.0, tau = 0.0;
    for (const double omega : {2.0, 31.0, 77.0}) {
      twist += size / kK / 3.0 * std::sin(omega * t);
      tau += size / 3.0 * (std::sin(omega * t) + kD / kK * omega * std::cos(omega * t));
    }
    const double theta = q + twist;
    part.q(k, 0) = q + 2e-6 * random.gaussian() + 5e-5 * std::sin(q + 1.0);
    part.theta(k, 0) = theta + 2e-4 + 2e-6 * random.gaussian() + 3e-5 * std::sin(2.0 * kGear * q);
    part.tau(k, 0) = tau + 0.02 * random.gaussian() + 0.3;
  }
  return part;
}

ActuatorModel nominal() { return {.stiffness = 1e4, .damping = 5.0}; }

TEST(JointElasticity, FindsStiffnessAndDampingDespiteTheErrorsOfTheEncoders) {
  const JointElasticity found =
      identify_elasticity({motion(10.0, 20.0)}, 0, kPeriod, nominal(), kGear);
  ASSERT_TRUE(found.stiffness.is_found);
  ASSERT_TRUE(found.damping.is_found);
  EXPECT_NEAR(found.stiffness.value, kK, 0.005 * kK);
  EXPECT_NEAR(found.damping.value, kD, 0.03 * kD);
  EXPECT_LT(std::abs(found.stiffness.value - kK), found.stiffness.interval());
  EXPECT_LT(std::abs(found.damping.value - kD), found.damping.interval());
  EXPECT_GE(found.stiffness.deviation, kTorqueGain * kK) << "a gain that no motion shows";
}

TEST(JointElasticity, SaysWhatWasNotExcited) {
  const JointElasticity found =
      identify_elasticity({motion(1e-3, 20.0)}, 0, kPeriod, nominal(), kGear);
  EXPECT_FALSE(found.stiffness.is_found);
  EXPECT_EQ(found.stiffness.value, nominal().stiffness);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_NE(found.missing[0].find("load it more"), std::string::npos) << found.missing[0];
}

TEST(JointElasticity, SaysThatARecordingIsTooShort) {
  const JointElasticity found =
      identify_elasticity({motion(10.0, 3.0)}, 0, kPeriod, nominal(), kGear);
  EXPECT_FALSE(found.stiffness.is_found);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_NE(found.missing[0].find("3 s only, 8 are needed"), std::string::npos) << found.missing[0];
}

}  // namespace
}  // namespace hg::identify
