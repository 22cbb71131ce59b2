/// The arm that the tests of the controller share: the reference device with the numbers of
/// [HANDBOOK] 1.2.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "hg/controller/tracking/joint_control.h"
#include "hg/core/allocation_counter.h"
#include "hg/model/chain_data.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::tracking {

inline constexpr int kGantry = 2, kJoints = 6;

inline const model::ChainModel& arm() {
  static const model::ChainModel chain =
      model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf");
  return chain;
}

inline DeviceModel device_with(std::vector<ActuatorModel> actuators, double rate_Hz = 1000.0) {
  return {.chain = arm(),
          .n_p = kGantry,
          .n_m = kJoints,
          .handle = arm().frame("handle"),
          .rate_Hz = rate_Hz,
          .actuators = std::move(actuators)};
}

/// A control with the facts about the device that the tests change.
struct ControlledArm : ControlConfig {
  std::vector<ActuatorModel> actuators;
  double rate_Hz = 1000.0;
};

inline ControlledArm reference_config(Method method = Method::kModal) {
  ControlledArm config;
  config.method = method;
  config.actuators = reference_actuators();
  return config;
}

/// Motors without friction.
inline ControlledArm frictionless_config(Method method = Method::kModal) {
  ControlledArm config = reference_config(method);
  for (ActuatorModel& actuator : config.actuators) {
    actuator.coulomb_friction = actuator.viscous_friction = actuator.load_friction = 0.0;
  }
  return config;
}

inline JointControl control_of(const ControlledArm& config) {
  return {config, device_with(config.actuators, config.rate_Hz)};
}

inline VectorM joints(double m1, double m2, double m3, double m4, double m5, double m6) {
  return (VectorM(6) << m1, m2, m3, m4, m5, m6).finished();
}

inline VectorM home() {
  return joints(0.0, 0.5 * std::numbers::pi, -std::atan(0.53 / 0.67), 0.5 * std::numbers::pi, 0.0,
                0.0);
}

/// The arm with its gantry at 0.
inline Eigen::VectorXd posture(const VectorM& q_m) {
  return (Eigen::VectorXd(8) << 0.0, 0.0, q_m).finished();
}

inline MatrixM link_mass(const VectorM& q_m) {
  model::ChainData chain(arm());
  chain.update(posture(q_m), Eigen::VectorXd::Zero(8));
  return chain.M().bottomRightCorner(6, 6);
}

inline VectorM stiffness() { return joints(12000.0, 12000.0, 7000.0, 7000.0, 3000.0, 3000.0); }
inline VectorM rotor_inertia() { return joints(1.46, 1.46, 0.61, 0.61, 0.12, 0.12); }

inline ReferenceState at_rest(const VectorM& q_m) {
  return {.q_m = q_m, .dq_m = VectorM::Zero(6), .ddq_m = VectorM::Zero(6)};
}

/// A device that moves exactly as `reference` says, its springs transmitting `tau`.
inline RobotState following(const ReferenceState& reference, const VectorM& tau) {
  RobotState robot;
  robot.q_m = reference.q_m;
  robot.dq_m = robot.dtheta_m = reference.dq_m;
  robot.theta_m = reference.q_m + tau.cwiseQuotient(stiffness());
  robot.tau_m = tau;
  robot.q_p = robot.dq_p = robot.ddq_p = VectorP::Zero(2);
  return robot;
}

/// A sample in whose period the command of so many periods ago is at work.
inline SensorFrame answered(std::uint64_t sequence, std::uint64_t periods_ago) {
  SensorFrame frame;
  frame.sequence = sequence;
  frame.answered_sequence = sequence - periods_ago;
  return frame;
}

/// Of everything that a controller does in a period, ten times.
inline std::uint64_t allocations_of_steps(const ControlledArm& config) {
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  const RobotState robot = following(reference, VectorM::Zero(6));
  CommandFrame command;
  TrackingReport report;
  const AllocationCounter counter;
  for (int k = 0; k < 10; ++k) control.step(reference, reference, robot, state, command, report);
  control.listen(answered(7, 2), false, state);
  control.rest(reference, state, command);
  return counter.count();
}

}  // namespace hg::tracking
