// Impacts, hard pulls, light rotations and springs: each measure sees the device that does it
// badly.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/felt_body.h"
#include "hg/experiments/haptify/impact.h"
#include "hg/experiments/haptify/swing.h"

namespace hg::haptify {
namespace {

using experiments::DecayClass;

const config::Scenario& walk() {
  static const config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  return scenario;
}

// whose handle may brake and accelerate with 1 m/s^2 only: its law knows that rating and no motors
config::Scenario sluggish() {
  config::Scenario scenario = walk();
  scenario.device.control.method = tracking::Method::kDrives;
  scenario.device.model.actuators.clear();
  config::settle_law(scenario);
  for (CartesianLimit& limit : scenario.device.model.cartesian_limits) {
    for (limits::JointLimits& axis : limit.axes) axis.ddq_max = 1.0;
  }
  return scenario;
}

Impact hit(const config::Scenario& scenario, const ImpactConfig& config, double stiffness,
           double speed) {
  return measure_impact(scenario, config, stiffness, speed, find_way(scenario, config, speed), 1);
}

TEST(Impact, IsAsDeepAsTheDeviceMustBrake) {
  ImpactConfig config;
  config.watched_s = 3.0;
  const Impact impact = hit(sluggish(), config, 20'000.0, 0.3);
  EXPECT_EQ(impact.failure, "");
  EXPECT_NEAR(impact.speed, 0.3, 0.02);
  EXPECT_EQ(impact.braking, 1.0);
  EXPECT_NEAR(impact.bound, impact.speed * impact.speed / 2.0, 1e-12);
  EXPECT_NEAR(impact.depth / impact.bound, 1.0, 0.3);
  // which is more than the wall gives way
  EXPECT_GT(impact.depth, 3.0 * impact.speed * std::sqrt(6.0 / 20'000.0));
}

TEST(Impact, OnAWallIsCaughtWhateverTheBody) {
  const ImpactConfig config;
  for (const double mass : {0.5, 6.0}) {
    config::Scenario scenario = walk();
    experiments::set_free_twin(scenario, {.mass = mass, .damping = 4.0});
    const double way_s = find_way(scenario, config, 0.2);
    for (const double stiffness : {2e3, 5e4}) {
      SCOPED_TRACE(std::to_string(mass) + " kg on " + std::to_string(stiffness) + " N/m");
      const Impact impact = measure_impact(scenario, config, stiffness, 0.2, way_s, 1);
      EXPECT_EQ(impact.failure, "");
      EXPECT_EQ(impact.end, "");
      EXPECT_NEAR(impact.braking, 10.5, 1.5);  // 3 m/s^2 is the rating of the handle
      EXPECT_LE(impact.depth, impact.allowed());
      EXPECT_LE(impact.rebound, 0.1);
      EXPECT_LE(impact.rest_s, 0.5);
      EXPECT_LE(impact.energy_out, impact.energy_in);
    }
  }
}

// with which surfaces were said to be before they took it from the body
TEST(Impact, OnALittleDampedWallIsThrownBack) {
  ImpactConfig config;
  config.damping = 20.0;
  EXPECT_GT(hit(walk(), config, 2000.0, 0.4).rebound, 0.3);
  config.damping = {};
  config.rest_speed = 1e-6;  // nothing is ever so still
  EXPECT_TRUE(std::isinf(hit(walk(), config, 2000.0, 0.4).rest_s));
}

TEST(Impact, WithoutAContactIsNone) {
  config::Scenario weak = walk();
  weak.script.hand.force_max = 1e-3;
  EXPECT_EQ(measure_impact(weak, {.watched_s = 1.0}, 2000.0, 0.4, 0.3, 1).failure,
            "the hand did not reach the wall");
}

TEST(Pull, FeelsTheBodyUntilTheDeviceGivesNoMore) {
  const Pull soft = measure_pull(walk(), {}, 1, 10.0, 1);
  EXPECT_EQ(soft.failure, "");
  EXPECT_NEAR(soft.mass, 6.0, 1.0);
  EXPECT_NEAR(soft.mass * soft.acceleration, 10.0, 0.3);
  EXPECT_NEAR(measure_pull(sluggish(), {}, 1, 30.0, 1).mass, 30.0, 5.0);
}

TEST(Twist, CalmsDownUnlessTheBodyIsTooLight) {
  const person::HandImpedance hand = person::hand(person::HandPreset::kNormal);
  EXPECT_EQ(twist(walk(), {}, hand, 0.08).verdict, DecayClass::kStable);
  EXPECT_NE(twist(walk(), {}, hand, 0.0005).verdict, DecayClass::kStable);
}

TEST(OscillationOf, FindsFrequencyDampingAndAmplitude) {
  constexpr double kRate = 1000.0, kHz = 2.3, kPi = std::numbers::pi;
  for (const double zeta : {0.05, 0.0, -0.08}) {
    std::vector<double> signal;
    for (int i = 0; i < 4000; ++i) {
      const double t = i / kRate, omega = 2.0 * kPi * kHz;
      signal.push_back(0.3 * std::exp(-zeta / std::sqrt(1.0 - zeta * zeta) * omega * t) *
                       std::cos(omega * t));
    }
    const Oscillation found = oscillation_of(signal, 4, kRate);
    EXPECT_NEAR(found.frequency_Hz, kHz, 1e-3);
    EXPECT_NEAR(found.damping_ratio, zeta, 1e-3);
    EXPECT_NEAR(found.amplitude, 0.3 * std::exp(-zeta * kPi), 3e-3);  // half a swing later
  }
  const std::vector<double> creep(100, 1.0);
  EXPECT_EQ(oscillation_of(creep, 4, kRate).frequency_Hz, 0.0);
}

TEST(Swing, IsThatOfTheHingeUntilTheDeviceGivesNoMore) {
  SwingConfig config;
  config.watched_s = 4.0;
  const Swing soft = measure_swing(walk(), config, 200.0, 0.005, 1);
  EXPECT_EQ(soft.failure, "");
  EXPECT_NEAR(soft.ideal_Hz, std::sqrt(200.0 / 2.5) / (2.0 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(soft.true_handle.frequency_Hz, soft.ideal_Hz, 0.03 * soft.ideal_Hz);
  EXPECT_NEAR(soft.true_handle.damping_ratio, soft.ideal_damping, 0.02);
  const Swing far = measure_swing(sluggish(), config, 200.0, 0.15, 1);
  EXPECT_LT(far.true_handle.frequency_Hz, 0.7 * far.ideal_Hz);
}

}  // namespace
}  // namespace hg::haptify
