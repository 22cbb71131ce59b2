/// Plain structs at the boundary of a cycle: sensors and operator in, command out.
///
/// A recording of SensorFrame and OperatorFrame replays a run bit for bit. SI units; names carry
/// coordinate frames (B = base, H = handle, S = force/torque sensor). Copyable, no allocation.
#pragma once

#include <cstdint>

#include "hg/core/fields.h"
#include "hg/core/types.h"
#include "hg/signals/fault.h"

namespace hg {

/// Signals of the device's safety controller (PLC), docs/concepts/safety.md, [HANDBOOK] 6.8.
struct SafetyInputs {
  bool emergency_stop = false;    ///< Stop request: button, or fault of the safety controller
  bool operator_enable = true;    ///< The operator holds the enabling switch
  bool override_key = false;      ///< Slow motion with a free handle is permitted
  bool is_field_clear = true;     ///< No person is in the scanner's field
  bool has_disagreement = false;  ///< Channels of one input disagreed longer than allowed
};

template <typename Archive, Is<SafetyInputs> T>
void fields(Archive& a, T& safety) {
  a("emergency_stop", safety.emergency_stop, "stop requested by a safety input");
  a("operator_enable", safety.operator_enable, "enabling switch is held, or there is none");
  a("override_key", safety.override_key, "slow motion with a free handle is permitted");
  a("is_field_clear", safety.is_field_clear, "no person in the scanner's field, or no scanner");
  a("has_disagreement", safety.has_disagreement, "channels of an input differed for too long");
}

/// Readings of the inertial units on the links, six numbers each, root to tip: accelerometer, then
/// gyroscope.
using InertialReadings = VectorUpTo<6 * kMaxInertialUnits>;

/// Raw sensor values of one sample of a device.
struct SensorFrame {
  std::uint64_t sequence = 0;     ///< Sample number, incremented by one per sample
  double time_s = 0.0;            ///< Time of the device's clock, s
  VectorM q_m;                    ///< Link-side encoders; unlimited joints wrapped to [-pi, pi)
  VectorM dq_m;                   ///< Link-side joint velocities
  VectorM theta_m;                ///< Motor-side encoders at the output of the gear; empty = none
  VectorM tau_m;                  ///< Joint torque sensors
  VectorP q_p;                    ///< Gantry encoders
  Vector6 w_S = Vector6::Zero();  ///< Wrench on the handle at S, resolved in S, force first
  /// Accelerometer in S: acceleration minus gravity, resolved in S; zero without one.
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();  ///< Gyroscope in S; zero without one
  /// CommandFrame::sequence of the newest command in effect; gives the latency of the loop.
  std::uint64_t answered_sequence = 0;
  bool dead_man = false;  ///< The user's hand closes the dead-man switch of the handle
  SafetyInputs safety;
  VectorM temperature_m;         ///< Motor temperatures, degrees Celsius; empty = not measured
  std::uint32_t bus_errors = 0;  ///< Missing fieldbus answers in this sample
  FaultCode driver_fault = FaultCode::kNone;  ///< Fault of the driver without valid values
  /// Inertial units on the links: acceleration minus gravity, m/s^2, and angular velocity, rad/s,
  /// in their own axes; empty = none.
  InertialReadings inertial;
};

template <typename Archive, Is<SensorFrame> T>
void fields(Archive& a, T& sensors) {
  a("sequence", sensors.sequence, "sample number, incremented by one per sample");
  a("time_s", sensors.time_s, "time of the device's clock, s");
  a("q_m", sensors.q_m,
    "link-side encoders of the manipulator, rad; unlimited joints in [-pi, pi)");
  a("dq_m", sensors.dq_m, "link-side velocities of the manipulator, rad/s");
  a("theta_m", sensors.theta_m, "motor-side encoders at the output of the gear, rad; empty = none");
  a("tau_m", sensors.tau_m, "joint torque sensors, Nm; empty = none");
  a("q_p", sensors.q_p, "gantry encoders, m");
  a("w_s", sensors.w_S, "wrench on the handle at the sensor S, in S: force N, torque Nm");
  a("a_s", sensors.a_S, "accelerometer in S: acceleration minus gravity, m/s^2");
  a("omega_s", sensors.omega_S, "gyroscope in S, rad/s");
  a("answered_sequence", sensors.answered_sequence,
    "sequence of the newest command in effect; 0 = none yet");
  a("dead_man", sensors.dead_man, "dead-man switch of the handle is closed");
  a("safety", sensors.safety, "inputs of the safety controller");
  a("temperature_m", sensors.temperature_m,
    "motor temperatures, degrees Celsius; empty = not measured");
  a("bus_errors", sensors.bus_errors, "fieldbus answers missing in this sample");
  a("driver_fault", sensors.driver_fault,
    "fault of the driver, a number of hg/signals/fault.h; 0 = none");
  a("inertial", sensors.inertial,
    "inertial units on the links, each in its own axes: accelerometer m/s^2, gyroscope rad/s; "
    "empty = none");
}

/// Target of a simulated person's hand. Used by simulated devices only.
struct HandTarget {
  bool active = false;                            ///< false: the person's script sets the target
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();  ///< Target position of the handle in B
  double press = 0.0;                             ///< How far the hand presses the held lever, 0..1
  bool turns = false;  ///< false: the hand leaves the handle free to rotate
  /// Target orientation of the handle in B, used if `turns`
  Eigen::Matrix3d R_B = Eigen::Matrix3d::Identity();
};

template <typename Archive, Is<HandTarget> T>
void fields(Archive& a, T& target) {
  a("active", target.active, "a simulated person follows this target, not its script");
  a("p_b", target.p_B, "target position of the handle in the base frame, m");
  a("press", target.press, "how far the hand presses its lever, 0..1");
  a("turns", target.turns,
    "the hand turns the handle to r_b; otherwise the handle may rotate freely");
  a("r_b", target.R_B, "target orientation of the handle, row by row");
}

/// Buttons and keys of an operator's panel. Used by simulated devices only, except the emergency
/// stop, which acts on every device.
struct SafetyPanel {
  bool emergency_stop = false;
  bool operator_enable = true;
  bool override_key = false;
  bool person_in_field = false;  ///< A person besides the user is in the scanner's field
  bool reset = false;            ///< Reset of the safety controller; acts on its rising edge
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

/// Parameter of a twin that may change at run time. Numbers are recorded and never change meaning.
enum class Parameter : std::uint8_t {
  kNone = 0,
  kStiffness = 1,         ///< Nm/rad or N/m, >= 0
  kRest = 2,              ///< rad or m
  kPreload = 3,           ///< Nm or N
  kDamping = 4,           ///< Nms/rad or Ns/m, >= 0
  kQuadraticDamping = 5,  ///< Nms^2/rad^2 or Ns^2/m^2, >= 0
  kFriction = 6,          ///< Nm or N, >= 0
  kLowerLimit = 7,        ///< rad or m; may be -infinity
  kUpperLimit = 8,        ///< rad or m; may be infinity
  kSpeedLimit = 9,        ///< rad/s or m/s, > 0; may be infinity
  kReferenceWrench = 10,  ///< N or Nm; index 0..5: force x y z, torque x y z
  kGravity = 11,          ///< share of the earth's gravity, 0..1
  kMassScale = 12,        ///< factor on all masses of the twin, 0.1..10
};

/// New value of one parameter of the twin, approached smoothly within a second.
struct ParameterChange {
  Parameter parameter = Parameter::kNone;
  std::int16_t index = -1;  ///< Degree of freedom of the twin, or component; see Parameter
  double value = 0.0;
};

template <typename Archive, Is<ParameterChange> T>
void fields(Archive& a, T& change) {
  a("parameter", change.parameter);
  a("index", change.index, "degree of freedom of the twin, or component of the wrench");
  a("value", change.value, "new value, SI units");
}

/// All inputs of a cycle other than sensors.
struct OperatorFrame {
  ModeRequest request = ModeRequest::kNone;
  HandTarget hand_target;
  SafetyPanel panel;
  ParameterChange change;
  std::uint32_t late_cycles = 0;  ///< Cycles late or left out by this run since the last cycle
};

template <typename Archive, Is<OperatorFrame> T>
void fields(Archive& a, T& input) {
  a("request", input.request);
  a("hand_target", input.hand_target, "target of a simulated hand");
  a("panel", input.panel, "panel of a simulated operator");
  a("change", input.change, "change of a parameter of the twin");
  a("late_cycles", input.late_cycles, "cycles late or left out since the last cycle");
}

/// Command to the device until the next sample.
struct CommandFrame {
  std::uint64_t sequence = 0;  ///< Sequence number of the answered SensorFrame
  bool enable = false;         ///< Drives powered; false: drives off and brakes closed
  VectorM q_m;                 ///< Reference positions of the manipulator
  VectorM dq_m;                ///< Reference velocities of the manipulator
  VectorM ddq_m;               ///< Reference accelerations of the manipulator
  VectorM tau_m;               ///< Motor torques; empty: the drives follow the reference
  VectorP dq_p;                ///< Gantry velocities
  HandTarget hand_target;      ///< Passed through to a simulated person
  SafetyPanel panel;           ///< Passed through to a simulated safety controller
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
  a("q_m", command.q_m, "reference positions of the manipulator, rad");
  a("dq_m", command.dq_m, "reference velocities of the manipulator, rad/s");
  a("ddq_m", command.ddq_m, "reference accelerations of the manipulator, rad/s^2");
  a("tau_m", command.tau_m, "motor torques, Nm; empty: the drives follow the reference");
  a("dq_p", command.dq_p, "gantry velocities, m/s");
  a("hand_target", command.hand_target, "target of a simulated hand");
  a("panel", command.panel, "panel for a simulated safety controller");
}

}  // namespace hg
