#include "hg/control/loop_stability.h"

#include <gtest/gtest.h>

#include "hg/control/test/control_setup.h"

namespace hg::control {
namespace {

Loop reference_loop(Method method = Method::kModal) {
  return {.config = reference_config(method),
          .chain = arm(),
          .n_p = kGantry,
          .n_m = kJoints,
          .handle = arm().frame("handle")};
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

// not faster than asked for, and not much slower: they die out within 50 ms
TEST(LoopStability, AtOneMillisecondErrorsDieOutAboutAsFastAsThePolesSay) {
  const double radius = worst_radius(reference_loop(), 1e-3);
  EXPECT_LT(radius, std::exp(-20.0 * 1e-3));
  EXPECT_GT(radius, std::exp(-65.0 * 1e-3));
}

TEST(LoopStability, GainsThatKnowTheLatencyAreStableWithIt) {
  for (const double latency : {0.5e-3, 1e-3, 1.5e-3, 2e-3, 3e-3}) {
    EXPECT_LT(worst_radius(reference_loop(), latency), 1.0) << latency;
  }
}

// Gains for `believed` meet an arm whose latency is `latency` and whose rotors have `rotor` times
// the inertia that the controller knows.
double worst_radius_in_reality(double believed, double latency, double rotor) {
  const Loop loop = reference_loop();
  Reality reality = {loop.config.actuators, loop.config.loop};
  reality.loop.latency = latency;
  for (ActuatorModel& actuator : reality.actuators) actuator.rotor_inertia *= rotor;
  double worst = 0.0;
  for (const Eigen::VectorXd& q : usual_postures()) {
    worst = std::max(worst, spectral_radius(loop, q, believed, reality));
  }
  return worst;
}

// [C] 1: with w0 = 200 a latency of 2 ms oscillates, with w0 = 140 or less it does not
TEST(LoopStability, GainsForOneMillisecondAreTooHighForThree) {
  EXPECT_LT(worst_radius_in_reality(1e-3, 1e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_in_reality(1e-3, 1.5e-3, 1.0), 1.0);
  EXPECT_GT(worst_radius_in_reality(1e-3, 2.5e-3, 1.0), 1.0);
  EXPECT_GT(worst_radius_in_reality(1e-3, 3e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_in_reality(2.5e-3, 2.5e-3, 1.0), 1.0);
  EXPECT_LT(worst_radius_in_reality(3e-3, 1e-3, 1.0), 1.0);  // caution does no harm
}

// [C] 1: 0.5x is unstable, 0.7 to 1.5x is fine
TEST(LoopStability, RotorsMustBeKnownToThirtyPercent) {
  EXPECT_GT(worst_radius_in_reality(1e-3, 1e-3, 0.5), 1.0);
  for (const double rotor : {0.7, 1.0, 1.5}) {
    EXPECT_LT(worst_radius_in_reality(1e-3, 1e-3, rotor), 1.0) << rotor;
  }
}

TEST(LoopStability, TheMotorPdIsStableToo) {
  EXPECT_LT(worst_radius(reference_loop(Method::kMotorPd), 1e-3), 1.0);
}

TEST(LoopStability, TheLongestStableLatencyEndsTheSearch) {
  EXPECT_EQ(longest_stable_latency(reference_loop(), postures(), 3), 3);
  Loop wrong = reference_loop();
  for (ActuatorModel& actuator : wrong.config.actuators) actuator.torque_max = 1e9;
  wrong.filters.link_pole_Hz = 20.0;  // [C] 2: unstable
  EXPECT_EQ(longest_stable_latency(wrong, postures(), 3), 0);
}

}  // namespace
}  // namespace hg::control
