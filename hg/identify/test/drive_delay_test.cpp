#include "hg/identify/drive_delay.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::identify {
namespace {

constexpr double kPeriod = 2e-3;

double path(double t) { return 0.4 * std::sin(1.9 * t) + 0.1 * std::sin(7.3 * t); }
double lagging(double t, double lag) {
  const auto part = [&](double size, double omega) {
    const double phase = std::atan(lag * omega);
    return size * std::cos(phase) * std::sin(omega * t - phase);
  };
  return part(0.4, 1.9) + part(0.1, 7.3);
}

// Drives that follow the path after `delay`, with a lag in it, and with an error that friction
// leaves.
JointMotion motion(double delay, double lag, double size, double duration_s) {
  JointMotion part;
  const auto n = static_cast<Eigen::Index>(duration_s / kPeriod);
  part.q.resize(n, 1);
  part.command.resize(n, 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) * kPeriod;
    const double forward = path(t + 1e-3) > path(t - 1e-3) ? 1.0 : -1.0;
    part.command(k, 0) = size * path(t);
    part.q(k, 0) = size * lagging(t - (delay - lag), lag) + 1e-5 * forward;
  }
  return part;
}

TEST(DriveDelay, FindsADelayThatIsNoMultipleOfThePeriod) {
  const DriveDelay found = identify_delay({motion(11.7e-3, 0.0, 1.0, 20.0)}, 0, kPeriod);
  ASSERT_TRUE(found.delay.is_found);
  EXPECT_NEAR(found.delay.value, 11.7e-3, 0.05e-3);
  EXPECT_FALSE(found.lag.is_found);
}

TEST(DriveDelay, FindsTheLagInIt) {
  const DriveDelay found = identify_delay({motion(40e-3, 25e-3, 1.0, 20.0)}, 0, kPeriod);
  ASSERT_TRUE(found.delay.is_found);
  EXPECT_NEAR(found.delay.value, 40e-3, 1e-3);
  ASSERT_TRUE(found.lag.is_found);
  EXPECT_NEAR(found.lag.value, 25e-3, 3e-3);
}

TEST(DriveDelay, SaysWhatWasNotExcitedAndWhatIsTooShort) {
  const DriveDelay still = identify_delay({motion(10e-3, 0.0, 1e-6, 20.0)}, 0, kPeriod);
  EXPECT_FALSE(still.delay.is_found);
  ASSERT_EQ(still.missing.size(), 1u);
  EXPECT_NE(still.missing[0].find("move it faster"), std::string::npos) << still.missing[0];
  const DriveDelay brief = identify_delay({motion(10e-3, 0.0, 1.0, 2.0)}, 0, kPeriod);
  EXPECT_FALSE(brief.delay.is_found);
  EXPECT_NE(brief.missing.at(0).find("s only"), std::string::npos) << brief.missing[0];
}

TEST(DriveDelay, JointsThatDisagreeWidenTheCommonInterval) {
  const auto joint = [](double delay) { return DriveDelay{.delay = {delay, 1e-4, true}}; };
  EXPECT_FALSE(common_delay({}).is_found);
  EXPECT_NEAR(common_delay({joint(0.010), joint(0.0101)}).deviation, 0.7e-4, 1e-5);
  EXPECT_GT(common_delay({joint(0.010), joint(0.012)}).deviation, 5e-4);
}

}  // namespace
}  // namespace hg::identify
