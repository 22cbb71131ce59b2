#include "hg/identify/friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::identify {
namespace {

constexpr double kPeriod = 1e-3;
constexpr int kSteps = 4;  // of the plant per period

ActuatorModel actuator() {
  ActuatorModel a = simulator::bare_actuator(0.5, 1e4);
  a.damping = 5.0;
  a.coulomb_friction = 3.0;
  a.viscous_friction = 1.2;
  a.load_friction = 0.08;
  a.stiction = 1.25;
  a.stribeck_speed = 0.05;
  return a;
}

// What the file of the device says: half of the truth.
ActuatorModel nominal() {
  ActuatorModel a = actuator();
  a.coulomb_friction *= 0.5;
  a.viscous_friction *= 0.5;
  a.load_friction = 0.04;
  a.stiction = 1.1;
  a.stribeck_speed = 0.1;
  return a;
}

using Path = std::function<double(double t)>;

// Far and fast, then little and slowly with stops.
double rich(double t) {
  const double wide = 0.6 * std::sin(1.7 * t) + 0.15 * std::sin(6.1 * t);
  const double fine = 0.05 * std::sin(1.3 * t) + 0.004 * std::sin(4.7 * t);
  return std::fmod(t, 20.0) < 10.0 ? wide : fine;
}

// A PD control makes one joint follow a path.
FrictionTrace move(const ActuatorModel& a, const simulator::JointEffects& effects, const Path& path,
                   double duration_s) {
  simulator::PlantConfig config = simulator::one_joint_config(a);
  config.effects = {effects};
  const model::ChainModel chain = simulator::one_joint(2.5);
  simulator::Plant plant(config, chain, chain.frame("tip"));
  simulator::PlantInput input = simulator::idle(config, false);
  FrictionTrace trace;
  trace.period_s = kPeriod;
  trace.cuts = {0};
  double before = 0.0;
  for (int k = 0; k * kPeriod < duration_s; ++k) {
    const Truth& truth = plant.truth();
    const double t = k * kPeriod, ahead = path(t + kPeriod);
    const double speed = (ahead - path(t)) / kPeriod;
    const double wanted = 2e3 * (path(t) - truth.theta_m[0]) + 120.0 * (speed - truth.dtheta_m[0]);
    const double tau = std::clamp(wanted, -a.torque_max, a.torque_max);  // where the path jumps
    trace.theta.push_back(truth.theta_m[0]);
    trace.tau_J.push_back(truth.tau_J[0]);
    trace.tau_motor.push_back(0.5 * (before + tau));
    before = tau;
    input.tau_command[0] = tau;
    for (int i = 0; i < kSteps; ++i) plant.step(input);
  }
  return trace;
}

simulator::JointEffects bristles(const ActuatorModel& a, double presliding, int elements) {
  simulator::JointEffects effects;
  effects.bristles = elements;
  effects.bristle_stiffness = a.coulomb_friction / presliding;
  effects.bristle_damping = 0.4 * std::sqrt(effects.bristle_stiffness * a.rotor_inertia);
  return effects;
}

// Found, and within `share` of the truth and `deviations` of what it says of itself.
void expect_near(const Figure& found, double truth, double share, const char* what) {
  EXPECT_TRUE(found.is_found) << what;
  EXPECT_NEAR(found.value, truth, share * truth) << what << " +- " << found.deviation;
  EXPECT_GT(found.deviation, 0.0) << what;
  EXPECT_LT(found.deviation, share * truth) << what;
}

void expect_friction(const FrictionEstimate& found) {
  const ActuatorModel a = actuator();
  expect_near(found.coulomb, a.coulomb_friction, 0.03, "coulomb");
  expect_near(found.load, a.load_friction, 0.15, "load");
  expect_near(found.viscous, a.viscous_friction, 0.10, "viscous");
  expect_near(found.stiction, a.stiction, 0.05, "stiction");
  expect_near(found.stribeck_speed, a.stribeck_speed, 0.20, "Stribeck speed");
}

TEST(IdentifyFriction, FindsAllOfARigidFriction) {
  const FrictionEstimate found = identify_friction(move(actuator(), {}, rich, 60.0), nominal());
  expect_friction(found);
  EXPECT_FALSE(found.presliding.is_found);
  EXPECT_EQ(found.presliding_elements, 0);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_NE(found.missing[0].find("presliding: none of 1e-05 rad"), std::string::npos)
      << found.missing[0];
  EXPECT_GT(found.reversals, 30);
}

class IdentifyPresliding : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Elements, IdentifyPresliding, testing::Values(1, 2, 3));

TEST_P(IdentifyPresliding, FindsWayAndNumberOfElements) {
  constexpr double kWay = 2e-4;
  const FrictionTrace trace = move(actuator(), bristles(actuator(), kWay, GetParam()), rich, 60.0);
  const FrictionEstimate found = identify_friction(trace, nominal());
  expect_friction(found);
  EXPECT_EQ(found.presliding_elements, GetParam());
  expect_near(found.presliding, kWay, 0.1, "presliding");
  // without any noise what is left is that torques are known once per period
  EXPECT_LT(std::abs(found.presliding.value - kWay),
            4.0 * found.presliding.deviation + 0.01 * kWay);
  EXPECT_TRUE(found.missing.empty()) << found.missing.front();
}

TEST(IdentifyFriction, NamesTheDirectionThatIsMissing) {
  const auto once = [](double t) { return t < 3.0 ? 0.0 : 0.1 * (t - 3.0); };
  const FrictionEstimate found = identify_friction(move(actuator(), {}, once, 20.0), nominal());
  EXPECT_FALSE(found.coulomb.is_found);
  EXPECT_EQ(found.coulomb.value, nominal().coulomb_friction);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_NE(found.missing[0].find("in the negative direction"), std::string::npos)
      << found.missing[0];
}

TEST(IdentifyFriction, ReportsThatItIsTooShort) {
  const FrictionEstimate found = identify_friction(move(actuator(), {}, rich, 6.0), nominal());
  EXPECT_FALSE(found.coulomb.is_found);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_NE(found.missing[0].find("record longer"), std::string::npos) << found.missing[0];
}

bool names(const FrictionEstimate& found, const std::string& what) {
  for (const std::string& missing : found.missing) {
    if (missing.starts_with(what)) return true;
  }
  return false;
}

// At one speed there is neither a Stribeck curve nor a viscous share, and few reversals.
TEST(IdentifyFriction, MakesNothingUpAtOneSpeed) {
  const auto steady = [](double t) {
    const double phase = std::fmod(t, 24.0);
    return 0.03 * (phase < 12.0 ? phase : 24.0 - phase);
  };
  const FrictionEstimate found = identify_friction(move(actuator(), {}, steady, 60.0), nominal());
  EXPECT_TRUE(found.coulomb.is_found);
  EXPECT_FALSE(found.presliding.is_found);
  EXPECT_FALSE(found.stribeck_speed.is_found);
  EXPECT_TRUE(names(found, "presliding: ")) << found.reversals;
  EXPECT_TRUE(names(found, "Stribeck speed: "));
  EXPECT_DOUBLE_EQ(found.stribeck_speed.value, nominal().stribeck_speed);
}

// Correlated errors count: the same noise held for half a second says less than white noise.
TEST(IdentifyFriction, DeviationsGrowWithCorrelatedErrors) {
  const FrictionTrace clean = move(actuator(), {}, rich, 60.0);
  const auto deviation_with = [&](std::size_t held) {
    FrictionTrace noisy = clean;
    std::uint64_t state = 1;
    double error = 0.0;
    for (std::size_t k = 0; k < noisy.theta.size(); ++k) {
      if (k % held == 0) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        error = static_cast<double>(state >> 11U) * 0x1p-53 - 0.5;
      }
      noisy.tau_motor[k] += error;
    }
    return identify_friction(noisy, nominal()).coulomb.deviation;
  };
  EXPECT_GT(deviation_with(500), 2.0 * deviation_with(20));
}

}  // namespace
}  // namespace hg::identify
