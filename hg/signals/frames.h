/// Plain structs at the boundary of a cycle: sensors and operator in, command out.
///
/// A recording of SensorFrame and OperatorFrame replays a run bit for bit. SI units; names carry
/// coordinate frames (B = base, H = handle, S = force/torque sensor). Copyable, no allocation.
#pragma once

#include <cstdint>

#include "hg/core/fields.h"
#include "hg/core/types.h"
#include "hg/signals/fault.h"
#include "hg/signals/twin_input.h"

namespace hg {

/// Signals of the device's safety controller (PLC), docs/concepts/safety.md, [HANDBOOK] 6.8.
struct SafetyInputs {
  bool emergency_stop = false;
  bool operator_enable = true;
  bool override_key = false;
  bool is_field_clear = true;
  bool has_disagreement = false;
};

template <typename Archive, Is<SafetyInputs> T>
void fields(Archive& a, T& safety) {
  a("emergency_stop", safety.emergency_stop,
    "stop requested by a button, or by a fault of the safety controller");
  a("operator_enable", safety.operator_enable, "enabling switch is held, or there is none");
  a("override_key", safety.override_key, "slow motion with a free handle is permitted");
  a("is_field_clear", safety.is_field_clear, "no person in the scanner's field, or no scanner");
  a("has_disagreement", safety.has_disagreement,
    "channels of one input differed longer than allowed");
}

/// Readings of the inertial units on the links, six numbers each, root to tip.
using InertialReadings = VectorUpTo<6 * kMaxInertialUnits>;

/// Raw sensor values of one sample of a device.
struct SensorFrame {
  std::uint64_t sequence = 0;
  double time_s = 0.0;
  VectorM q_m, dq_m, theta_m, tau_m;
  VectorP q_p;
  Vector6 w_S = Vector6::Zero();
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();
  std::uint64_t answered_sequence = 0;  ///< CommandFrame::sequence; gives the latency of the loop
  bool dead_man = false;
  SafetyInputs safety;
  VectorM temperature_m;
  std::uint32_t bus_errors = 0;
  FaultCode driver_fault = FaultCode::kNone;  ///< The other values are then not valid
  InertialReadings inertial;
};

template <typename Archive, Is<SensorFrame> T>
void fields(Archive& a, T& sensors) {
  a("sequence", sensors.sequence, "sample number, incremented by one per sample");
  a("time_s", sensors.time_s, "time of the device's clock", unit::kS);
  a("q_m", sensors.q_m,
    "link-side encoders of the manipulator; unlimited joints wrapped to [-pi, pi)",
    unit::kJointPosition);
  a("dq_m", sensors.dq_m, "link-side velocities of the manipulator", unit::kJointSpeed);
  a("theta_m", sensors.theta_m, "motor-side encoders at the output of the gear; empty = none",
    unit::kJointPosition);
  a("tau_m", sensors.tau_m, "joint torque sensors; empty = none", unit::kJointTorque);
  a("q_p", sensors.q_p, "gantry encoders", unit::kJointPosition);
  a("w_s", sensors.w_S, "wrench on the handle at the sensor S, in S: force, torque", unit::kWrench);
  a("a_s", sensors.a_S, "accelerometer in S: acceleration minus gravity; zero without one",
    unit::kMPerS2);
  a("omega_s", sensors.omega_S, "gyroscope in S; zero without one", unit::kRadPerS);
  a("answered_sequence", sensors.answered_sequence,
    "sequence of the newest command in effect; 0 = none yet");
  a("dead_man", sensors.dead_man, "the user's hand closes the dead-man switch of the handle");
  a("safety", sensors.safety, "inputs of the safety controller");
  a("temperature_m", sensors.temperature_m, "motor temperatures; empty = not measured",
    unit::kDegC);
  a("bus_errors", sensors.bus_errors, "fieldbus answers missing in this sample");
  a("driver_fault", sensors.driver_fault,
    "fault of the driver, a number of hg/signals/fault.h; 0 = none");
  a("inertial", sensors.inertial,
    "inertial units on the links, each in its own axes: accelerometer (acceleration minus "
    "gravity), gyroscope; empty = none",
    unit::kImu);
}

/// Target of a simulated person's hand. Used by simulated devices only.
struct HandTarget {
  bool active = false;
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  double press = 0.0;
  bool turns = false;
  Eigen::Matrix3d R_B = Eigen::Matrix3d::Identity();
};

template <typename Archive, Is<HandTarget> T>
void fields(Archive& a, T& target) {
  a("active", target.active, "a simulated person follows this target, not its script");
  a("p_b", target.p_B, "target position of the handle in the base frame", unit::kM);
  a("press", target.press, "how far the hand presses the held lever, 0..1", unit::kNone);
  a("turns", target.turns,
    "the hand turns the handle to r_b; otherwise the handle may rotate freely");
  a("r_b", target.R_B, "target orientation of the handle in the base frame, row by row",
    unit::kNone);
}

/// Buttons and keys of an operator's panel. Used by simulated devices only, except the emergency
/// stop, which acts on every device.
struct SafetyPanel {
  bool emergency_stop = false;
  bool operator_enable = true;
  bool override_key = false;
  bool person_in_field = false;
  bool reset = false;
};

template <typename Archive, Is<SafetyPanel> T>
void fields(Archive& a, T& panel) {
  a("emergency_stop", panel.emergency_stop, "emergency stop is pressed");
  a("operator_enable", panel.operator_enable, "enabling switch is held");
  a("override_key", panel.override_key, "override key is turned");
  a("person_in_field", panel.person_in_field,
    "a person besides the user is in the scanner's field");
  a("reset", panel.reset, "reset of the safety controller; acts on its rising edge");
}

/// Request of the operator to change the mode. Numbers are recorded and never change meaning.
enum class ModeRequest : std::uint8_t {
  kNone = 0,
  kArm = 1,
  kRun = 2,
  kStop = 3,
  kReset = 4,
  kTare = 5,        ///< zero the force/torque sensor with the handle free and at rest
  kAutonomous = 6,  ///< run slowly with a free handle; needs the override key
};

/// All inputs of a cycle other than sensors.
struct OperatorFrame {
  ModeRequest request = ModeRequest::kNone;
  HandTarget hand_target;
  SafetyPanel panel;
  ParameterChange change;
  TwinForce twin_force;
  TwinBase twin_base;
  bool is_clutch_open = false;
  std::uint32_t late_cycles = 0;
};

template <typename Archive, Is<OperatorFrame> T>
void fields(Archive& a, T& input) {
  a("request", input.request);
  a("hand_target", input.hand_target, "target of a simulated hand");
  a("panel", input.panel, "panel of a simulated operator");
  a("change", input.change, "change of a parameter of the twin");
  a("twin_force", input.twin_force, "force of a remote machine on the twin");
  a("twin_base", input.twin_base, "motion of the place of the twin");
  a("is_clutch_open", input.is_clutch_open, "the operator releases the remote machine");
  a("late_cycles", input.late_cycles, "cycles late or left out since the last cycle");
}

/// Command to the device until the next sample.
struct CommandFrame {
  std::uint64_t sequence = 0;
  bool enable = false;
  VectorM q_m, dq_m, ddq_m, tau_m;
  VectorP dq_p;
  HandTarget hand_target;
  SafetyPanel panel;
};

/// Makes the command one that switches the drives off and moves nothing; positions stay.
inline void disable(CommandFrame& command) noexcept {
  command.enable = false;
  command.dq_m.setZero();
  command.ddq_m.setZero();
  command.tau_m.setZero();
  command.dq_p.setZero();
}

template <typename Archive, Is<CommandFrame> T>
void fields(Archive& a, T& command) {
  a("sequence", command.sequence, "sequence of the answered sensor frame");
  a("enable", command.enable, "drives powered; otherwise drives off and brakes closed");
  a("q_m", command.q_m, "reference positions of the manipulator", unit::kJointPosition);
  a("dq_m", command.dq_m, "reference velocities of the manipulator", unit::kJointSpeed);
  a("ddq_m", command.ddq_m, "reference accelerations of the manipulator", unit::kJointAcceleration);
  a("tau_m", command.tau_m, "motor torques; empty: drives follow positions", unit::kJointTorque);
  a("dq_p", command.dq_p, "gantry velocities", unit::kJointSpeed);
  a("hand_target", command.hand_target, "target passed through to a simulated hand");
  a("panel", command.panel, "panel passed through to a simulated safety controller");
}

}  // namespace hg
