#include "hg/controller/tracking/loop_stability.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hg/controller/tracking/test/control_setup.h"

namespace hg::tracking {
namespace {

Loop reference_loop(Method method = Method::kModal) {
  return {.config = reference_config(method),
          .filters = {},
          .device = device_with(reference_actuators())};
}

std::vector<Eigen::VectorXd> usual_postures() {
  return {posture(home()), posture(joints(0.0, 0.4, -0.3, 0.6, 0.4, 0.0)),  // stretched
          posture(joints(0.0, 2.6, -1.5, 2.2, 0.5, 0.5)),                   // folded
          posture(joints(0.3, 1.2, 0.8, 1.0, -0.5, 1.0))};
}

// with the worst one that was found: forearm and hand steeply down
std::vector<Eigen::VectorXd> postures() {
  std::vector<Eigen::VectorXd> all = usual_postures();
  all.push_back(posture(joints(0.0, 1.57, -0.67, 0.4, 0.6, 0.0)));
  return all;
}

double worst_radius(const Loop& loop, double latency) {
  double worst = 0.0;
  for (const Eigen::VectorXd& q : postures()) {
    worst = std::max(worst, spectral_radius(loop, q, latency));
  }
  return worst;
}

// not faster than requested, and not much slower: they die out within 50 ms
TEST(LoopStability, AtOneMillisecondErrorsDieOutAboutAsFastAsThePolesSay) {
  const double radius = worst_radius(reference_loop(), 1e-3);
  EXPECT_LT(radius, std::exp(-20.0 * 1e-3));
  EXPECT_GT(radius, std::exp(-65.0 * 1e-3));
}

TEST(LoopStability, GainsChosenForTheLatencyAreStableWithIt) {
  for (const double latency : {0.5e-3, 1e-3, 1.5e-3, 2e-3, 3e-3}) {
    EXPECT_LT(worst_radius(reference_loop(), latency), 1.0) << latency;
  }
}

// Gains for `nominal` meet an arm whose latency is `latency` and whose rotors have `rotor` times
// the inertia in the controller's model.
double worst_radius_of_plant(double nominal, double latency, double rotor) {
  const Loop loop = reference_loop();
  TruePlant plant = {loop.device.actuators, loop.config.loop};
  plant.loop.latency = latency;
  for (ActuatorModel& actuator : plant.actuators) actuator.rotor_inertia *= rotor;
  double worst = 0.0;
  for (const Eigen::VectorXd& q : usual_postures()) {
    worst = std::max(worst, spectral_radius(loop, q, nominal, plant));
  }
  return worst;
}

// [C] 1: with w0 = 200 a latency of 2 ms oscillates, with w0 = 140 or less it does not
TEST(LoopStability, GainsForOneMillisecondAreTooHighForThree) {
  EXPECT_LT(worst_radius_of_plant(1e-3, 1e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_of_plant(1e-3, 1.5e-3, 1.0), 1.0);
  EXPECT_GT(worst_radius_of_plant(1e-3, 2.5e-3, 1.0), 1.0);
  EXPECT_GT(worst_radius_of_plant(1e-3, 3e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_of_plant(2.5e-3, 2.5e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_of_plant(3e-3, 1e-3, 1.0), 1.0);  // caution does no harm
}

// [C] 1: 0.5x is unstable, 0.7 to 1.5x is fine
TEST(LoopStability, RotorsMustBeKnownToThirtyPercent) {
  EXPECT_GT(worst_radius_of_plant(1e-3, 1e-3, 0.5), 1.0);
  for (const double rotor : {0.7, 1.0, 1.5}) {
    EXPECT_LT(worst_radius_of_plant(1e-3, 1e-3, rotor), 1.0) << rotor;
  }
}

// Random postures within the limits of the reference device, q4 + q5 kept from the singularity.
std::vector<Eigen::VectorXd> dense_postures(std::size_t count) {
  std::mt19937 random(5);
  const auto between = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  };
  std::vector<Eigen::VectorXd> all;
  while (all.size() < count) {
    const double m4 = between(0.2, 2.45), m5 = between(-2.0, 2.1);
    if (m4 + m5 < 0.26 || m4 + m5 > 2.88) continue;
    all.push_back(posture(joints(between(-3.1, 3.1), between(0.2, 2.75), between(-2.6, 2.6), m4, m5,
                                 between(-2.6, 2.1))));
  }
  return all;
}

// Gains must hold for an arm that is not known exactly, wherever it stands, without the help of
// friction.
TEST(LoopStability, EveryPostureIsStableWithWrongMassesSpringsAndLatency) {
  const Loop loop = reference_loop();
  const TruePlant nominal = {loop.device.actuators, loop.config.loop};
  const auto with = [&](auto change) {
    TruePlant plant = nominal;
    change(plant);
    return plant;
  };
  const auto rotors = [](double factor) {
    return [factor](TruePlant& r) {
      for (ActuatorModel& actuator : r.actuators) actuator.rotor_inertia *= factor;
    };
  };
  const auto springs = [](double factor) {
    return [factor](TruePlant& r) {
      for (ActuatorModel& actuator : r.actuators) actuator.stiffness *= factor;
    };
  };
  const auto links = [](double factor) { return [factor](TruePlant& r) { r.link_mass = factor; }; };
  const std::vector<std::pair<std::string, TruePlant>> plants = {
      {"as nominal", nominal},
      {"rotors x 0.75", with(rotors(0.75))},
      {"rotors x 1.25", with(rotors(1.25))},
      {"springs x 0.75", with(springs(0.75))},
      {"springs x 1.25", with(springs(1.25))},
      {"links x 0.75", with(links(0.75))},
      {"links x 1.25", with(links(1.25))},
      {"latency x 1.5", with([](TruePlant& r) { r.loop.latency *= 1.5; })}};
  const std::vector<Eigen::VectorXd> dense = dense_postures(150);
  for (const auto& [what, plant] : plants) {
    double worst = 0.0;
    for (const Eigen::VectorXd& q : dense) {
      worst = std::max(worst, spectral_radius(loop, q, 1e-3, plant));
    }
    EXPECT_LT(worst, 0.995) << what;
  }
}

TEST(LoopStability, TheMotorPdIsStableToo) {
  EXPECT_LT(worst_radius(reference_loop(Method::kMotorPd), 1e-3), 1.0);
}

TEST(LoopStability, TheLongestStableLatencyEndsTheSearch) {
  EXPECT_EQ(longest_stable_latency(reference_loop(), postures(), 3), 3);
  Loop wrong = reference_loop();
  for (ActuatorModel& actuator : wrong.device.actuators) actuator.torque_max = 1e9;
  wrong.filters.link_pole_Hz = 20.0;  // [C] 2: unstable
  EXPECT_EQ(longest_stable_latency(wrong, postures(), 3), 0);
}

}  // namespace
}  // namespace hg::tracking
