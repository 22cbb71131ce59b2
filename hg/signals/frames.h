/// Plain structs at the boundary of a cycle: sensors and operator in, command out.
///
/// A recording of SensorFrame and OperatorFrame replays a run bit for bit. SI units; names carry
/// coordinate frames (B = base, H = handle, S = force/torque sensor). Copyable, no allocation.
#pragma once

#include <cstdint>

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

/// Target of a simulated person's hand. Used by simulated devices only.
struct HandTarget {
  bool active = false;                            ///< false: the person's script sets the target
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();  ///< Target position of the handle in B
  double press = 0.0;                             ///< How far the hand presses the held lever, 0..1
  bool turns = false;  ///< false: the hand leaves the handle free to rotate
  /// Target orientation of the handle in B, used if `turns`
  Eigen::Matrix3d R_B = Eigen::Matrix3d::Identity();
};

/// Buttons and keys of an operator's panel. Used by simulated devices only, except the emergency
/// stop, which acts on every device.
struct SafetyPanel {
  bool emergency_stop = false;
  bool operator_enable = true;
  bool override_key = false;
  bool person_in_field = false;  ///< A person besides the user is in the scanner's field
  bool reset = false;            ///< Reset of the safety controller; acts on its rising edge
};

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

/// All inputs of a cycle other than sensors.
struct OperatorFrame {
  ModeRequest request = ModeRequest::kNone;
  HandTarget hand_target;
  SafetyPanel panel;
  ParameterChange change;
  std::uint32_t late_cycles = 0;  ///< Cycles late or left out by this run since the last cycle
};

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

}  // namespace hg
