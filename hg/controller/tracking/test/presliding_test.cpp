#include "hg/signals/presliding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hg/controller/tracking/test/control_setup.h"

namespace hg::tracking {
namespace {

constexpr double kWay = 1e-4;  // rad
constexpr int kJoint = 4;      // its torque is small: nothing saturates

ActuatorModel soft(double elements) {
  ActuatorModel actuator = reference_actuators()[kJoint];
  actuator.load_friction = actuator.viscous_friction = 0.0;
  actuator.stiction = 1.0;
  actuator.presliding = kWay;
  actuator.presliding_elements = elements;
  return actuator;
}

ControlledArm config_with(const ActuatorModel& actuator) {
  ControlledArm config = frictionless_config();
  config.actuators[kJoint] = actuator;
  config.friction_share = 1.0;
  config.friction_learning = 0.0;
  return config;
}

// Torques that are fed forward for friction while the reference of one joint is at `theta`, one
// after the other; the robot follows.
std::vector<double> fed_forward(const ControlledArm& config, const std::vector<double>& theta,
                                ControlState* last = nullptr) {
  const auto torques = [&](const ControlledArm& one, ControlState& state) {
    JointControl control = control_of(one);
    std::vector<double> result;
    for (const double angle : theta) {
      ReferenceState reference = at_rest(home());
      reference.q_m[kJoint] += angle;
      CommandFrame command;
      TrackingReport report;
      control.step(reference, reference, following(reference, VectorM::Zero(6)), state, command,
                   report);
      result.push_back(command.tau_m[kJoint]);
    }
    return result;
  };
  const ControlledArm smooth = config_with(frictionless_config().actuators[kJoint]);
  ControlState state = control_of(config).start(), plain = control_of(smooth).start();
  std::vector<double> friction = torques(config, state);
  const std::vector<double> rest = torques(smooth, plain);
  for (std::size_t k = 0; k < friction.size(); ++k) friction[k] -= rest[k];
  if (last != nullptr) *last = state;
  return friction;
}

TEST(Presliding, IsASpringUntilTheElementsSlipOneAfterTheOther) {
  for (const int elements : {1, 2, 3}) {
    const ActuatorModel actuator = soft(elements);
    double stiffness = 0.0;
    for (int k = 1; k <= elements; ++k) stiffness += actuator.coulomb_friction / (kWay * k);
    EXPECT_NEAR(presliding_stiffness(actuator), stiffness, 1e-9 * stiffness);
    const double little = 0.2 * kWay / elements;
    const std::vector<double> tau = fed_forward(
        config_with(actuator), {0.0, little, 0.0, 0.99 * kWay, kWay, 50 * kWay, 49.999 * kWay});
    EXPECT_NEAR(tau[0], 0.0, 1e-9);
    EXPECT_NEAR(tau[1], stiffness * little, 1e-3 * stiffness * little);
    EXPECT_NEAR(tau[2], 0.0, 1e-6) << "nothing slipped";
    EXPECT_LT(tau[3], actuator.coulomb_friction * 0.9999);
    EXPECT_NEAR(tau[4], actuator.coulomb_friction, 1e-6);
    EXPECT_NEAR(tau[5], actuator.coulomb_friction, 1e-6);
    EXPECT_NEAR(tau[5] - tau[6], stiffness * 1e-3 * kWay, 1e-3) << "back it is a spring again";
  }
}

TEST(Presliding, TurnsRoundOverTwiceItsWay) {
  const std::vector<double> tau =
      fed_forward(config_with(soft(3)), {0.0, 1e-2, 1e-2 - 1.9 * kWay, 1e-2 - 2.0 * kWay});
  const double F = soft(3).coulomb_friction;
  EXPECT_GT(tau[2], -0.999 * F);
  EXPECT_NEAR(tau[3], -F, 1e-6);
}

TEST(Presliding, IsMultipliedByWhatWasLearnt) {
  ControlledArm config = config_with(soft(2));
  const std::vector<double> path = {0.0, 0.3 * kWay, 2.0 * kWay};
  const std::vector<double> once = fed_forward(config, path);
  config.friction_share = 1.7;
  const std::vector<double> more = fed_forward(config, path);
  for (std::size_t k = 1; k < path.size(); ++k) EXPECT_NEAR(more[k], 1.7 * once[k], 1e-9);
}

TEST(Presliding, DoesNotDependOnTheSpeedOverWhichTheSignChanges) {
  ControlledArm config = config_with(soft(2));
  const std::vector<double> path = {0.0, 0.3 * kWay, 2.0 * kWay};
  const std::vector<double> tau = fed_forward(config, path);
  config.friction_speed = 1.0;
  EXPECT_EQ(fed_forward(config, path), tau);
}

TEST(Presliding, RemembersFeetOnlyWhereAJointHasIt) {
  EXPECT_EQ(control_of(reference_config()).start().feet.size(), 0);
  EXPECT_EQ(control_of(config_with(soft(2))).start().feet.rows(), 6);
  ActuatorModel without = soft(2);
  without.coulomb_friction = 0.0;
  EXPECT_EQ(control_of(config_with(without)).start().feet.size(), 0);
}

// Learnt is what is missing while all elements slip.
TEST(Presliding, NothingIsLearntBeforeAllElementsSlip) {
  ControlledArm config = config_with(soft(3));
  config.friction_learning = 1.0;
  model::ChainData chain(arm());
  chain.update(posture(home()), Eigen::VectorXd::Zero(8));
  const VectorM weight = chain.c().tail(6);
  const auto learnt_after = [&](double way) {
    JointControl control = control_of(config);
    ControlState state = control.start();
    for (const double angle : {0.0, way}) {
      ReferenceState reference = at_rest(home());
      reference.q_m[kJoint] += angle;
      reference.dq_m[kJoint] = 0.2;
      RobotState robot = following(reference, weight);
      robot.theta_m[kJoint] -= 2e-4;  // behind: the feedback adds torque
      CommandFrame command;
      TrackingReport report;
      control.step(reference, reference, robot, state, command, report);
    }
    return state.friction[kJoint];
  };
  EXPECT_EQ(learnt_after(0.9 * kWay), 1.0);
  EXPECT_GT(learnt_after(2.0 * kWay), 1.0);
}

TEST(Presliding, IsResetByARest) {
  const ControlledArm config = config_with(soft(2));
  ControlState state;
  fed_forward(config, {0.0, 5.0 * kWay}, &state);
  JointControl control = control_of(config);
  CommandFrame command;
  control.rest(at_rest(home()), state, command);
  ReferenceState elsewhere = at_rest(home());
  elsewhere.q_m[kJoint] += 0.1;
  TrackingReport report;
  control.step(elsewhere, elsewhere, following(elsewhere, VectorM::Zero(6)), state, command,
               report);
  const double here = elsewhere.q_m[kJoint] + state.tau_r[kJoint] / stiffness()[kJoint];
  EXPECT_NEAR(state.feet(kJoint, 0), here, 1e-9);
  EXPECT_NEAR(state.feet(kJoint, 1), here, 1e-9);
}

TEST(Presliding, StepsWithoutAllocating) {
  EXPECT_EQ(allocations_of_steps(config_with(soft(3))), 0u);
}

}  // namespace
}  // namespace hg::tracking
