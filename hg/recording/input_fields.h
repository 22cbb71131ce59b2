/// The fields of what enters and leaves a cycle, each written once: encoding, decoding and the text
/// of the schema all come from passing an archive to fields(). See message.h for the rules.
#pragma once

#include <string_view>

#include "hg/recording/message.h"
#include "hg/signals/state.h"

namespace hg::recording {

template <>
inline constexpr std::string_view kMessageName<Pose> = "hapticgiant_msgs/Pose";
template <>
inline constexpr std::string_view kMessageName<SensorFrame> = "hapticgiant_msgs/SensorFrame";
template <>
inline constexpr std::string_view kMessageName<SafetyInputs> = "hapticgiant_msgs/SafetyInputs";
template <>
inline constexpr std::string_view kMessageName<SafetyPanel> = "hapticgiant_msgs/SafetyPanel";
template <>
inline constexpr std::string_view kMessageName<HandTarget> = "hapticgiant_msgs/HandTarget";
template <>
inline constexpr std::string_view kMessageName<ParameterChange> =
    "hapticgiant_msgs/ParameterChange";
template <>
inline constexpr std::string_view kMessageName<OperatorFrame> = "hapticgiant_msgs/OperatorFrame";
template <>
inline constexpr std::string_view kMessageName<CommandFrame> = "hapticgiant_msgs/CommandFrame";
template <>
inline constexpr std::string_view kMessageName<Fault> = "hapticgiant_msgs/Fault";
template <>
inline constexpr std::string_view kMessageName<RobotState> = "hapticgiant_msgs/RobotState";
template <>
inline constexpr std::string_view kMessageName<ReferenceState> = "hapticgiant_msgs/ReferenceState";
template <>
inline constexpr std::string_view kMessageName<TwinState> = "hapticgiant_msgs/TwinState";

template <typename Archive, Is<Pose> T>
void fields(Archive& a, T& pose) {
  a("p", pose.p, "m");
  a("r", pose.R, "rotation matrix, row by row");
}

template <typename Archive, Is<SafetyInputs> T>
void fields(Archive& a, T& safety) {
  a("emergency_stop", safety.emergency_stop, "a stop is asked for");
  a("operator_enable", safety.operator_enable, "the operator holds the enabling switch");
  a("override_key", safety.override_key, "may move slowly with nobody at the handle");
  a("is_field_clear", safety.is_field_clear, "nobody stands in the scanner's field");
  a("has_disagreement", safety.has_disagreement, "channels of an input differed for too long");
}

template <typename Archive, Is<SafetyPanel> T>
void fields(Archive& a, T& panel) {
  a("emergency_stop", panel.emergency_stop, "button is pressed");
  a("operator_enable", panel.operator_enable, "enabling switch is held");
  a("override_key", panel.override_key, "key is turned");
  a("person_in_field", panel.person_in_field, "somebody besides the user");
  a("reset", panel.reset, "of the safety controller; acts when it is pressed");
}

template <typename Archive, Is<SensorFrame> T>
void fields(Archive& a, T& sensors) {
  a("sequence", sensors.sequence, "counts up by one per sample");
  a("time_s", sensors.time_s, "clock of the device");
  a("q_m", sensors.q_m, "link-side encoders of the manipulator, rad");
  a("dq_m", sensors.dq_m, "rad/s");
  a("theta_m", sensors.theta_m, "motor-side encoders at the output of the gear, rad");
  a("tau_m", sensors.tau_m, "joint torque sensors, Nm");
  a("q_p", sensors.q_p, "gantry encoders, m");
  a("w_s", sensors.w_S, "wrench at the force/torque sensor, resolved in it: force N, torque Nm");
  a("a_s", sensors.a_S, "accelerometer in the sensor: acceleration minus gravity, m/s^2");
  a("omega_s", sensors.omega_S, "gyroscope in the sensor, rad/s");
  a("answered_sequence", sensors.answered_sequence, "of the newest command at work");
  a("dead_man", sensors.dead_man, "the dead-man switch is closed");
  a("safety", sensors.safety, "inputs of the safety controller");
  a("temperature_m", sensors.temperature_m, "of the motors, degrees Celsius");
  a("bus_errors", sensors.bus_errors, "fieldbus answers missing in this sample");
  a("driver_fault", sensors.driver_fault, "0 none; numbers are listed in hg/signals/fault.h");
  a("inertial", sensors.inertial,
    "units on links: accelerometer m/s^2, gyroscope rad/s, each in its own axes; empty without");
}

template <typename Archive, Is<HandTarget> T>
void fields(Archive& a, T& target) {
  a("active", target.active, "false: the simulated person's script decides");
  a("p_b", target.p_B, "target of the handle in the base frame, m");
  a("press", target.press, "how far the hand presses its lever, 0..1");
  a("turns", target.turns, "false: the hand lets the handle turn as it likes");
  a("r_b", target.R_B, "target orientation of the handle, if it turns");
}

template <typename Archive, Is<ParameterChange> T>
void fields(Archive& a, T& change) {
  a("parameter", change.parameter);
  a("index", change.index, "degree of freedom of the twin, or component of the wrench");
  a("value", change.value, "new value, SI units");
}

template <typename Archive, Is<OperatorFrame> T>
void fields(Archive& a, T& input) {
  a("request", input.request);
  a("hand_target", input.hand_target);
  a("panel", input.panel, "of a simulated operator");
  a("change", input.change, "of a parameter of the twin");
  a("late_cycles", input.late_cycles, "missed since the last cycle");
  a("most_active_sets", input.most_active_sets, "the budget of the solver; 0: as configured");
}

template <typename Archive, Is<CommandFrame> T>
void fields(Archive& a, T& command) {
  a("sequence", command.sequence, "of the sensor frame that it answers");
  a("enable", command.enable, "drives powered");
  a("q_m", command.q_m, "reference of the manipulator, rad");
  a("dq_m", command.dq_m, "rad/s");
  a("ddq_m", command.ddq_m, "rad/s^2");
  a("tau_m", command.tau_m, "motor torques, Nm; empty: the drives follow the reference");
  a("dq_p", command.dq_p, "gantry, m/s");
  a("hand_target", command.hand_target);
  a("panel", command.panel);
}

template <typename Archive, Is<Fault> T>
void fields(Archive& a, T& fault) {
  a("code", fault.code, "0 none; numbers are listed in hg/signals/fault.h");
  a("index", fault.index, "joint, limit or component; -1 none");
  a("value", fault.value, "the offending value");
  a("limit", fault.limit, "what it was compared with");
}

template <typename Archive, Is<RobotState> T>
void fields(Archive& a, T& robot) {
  a("q_m", robot.q_m, "link side, unwrapped, rad");
  a("dq_m", robot.dq_m, "rad/s");
  a("theta_m", robot.theta_m, "motor side, unwrapped, rad");
  a("dtheta_m", robot.dtheta_m, "rad/s");
  a("tau_m", robot.tau_m, "joint torque sensors, Nm");
  a("q_p", robot.q_p, "gantry, m");
  a("dq_p", robot.dq_p, "m/s");
  a("ddq_p", robot.ddq_p, "m/s^2");
  a("w_h", robot.w_H, "wrench of the user at the handle, resolved in the base: force N, torque Nm");
}

template <typename Archive, Is<ReferenceState> T>
void fields(Archive& a, T& reference) {
  a("q_m", reference.q_m, "rad");
  a("dq_m", reference.dq_m, "rad/s");
  a("ddq_m", reference.ddq_m, "rad/s^2");
}

template <typename Archive, Is<TwinState> T>
void fields(Archive& a, T& twin) {
  a("q_a", twin.q_a, "rad or m; a floating joint has x y z qx qy qz qw");
  a("dq_a", twin.dq_a, "rad/s or m/s; a floating joint has v, omega in its own frame");
  a("ddq_a", twin.ddq_a, "rad/s^2 or m/s^2");
}

}  // namespace hg::recording
