/// The plain structs that cross the boundary of a cycle: sensors and operator in, command out.
///
/// A recording of SensorFrame and OperatorFrame replays a run bit for bit. SI units; frames are
/// spelled in names (B = base, H = handle, S = force/torque sensor). Copyable, no allocation.
#pragma once

#include <cstdint>

#include "hg/core/types.h"
#include "hg/signals/fault.h"

namespace hg {

/// What the safety controller of a device (its PLC) says, docs/safety.md, [HANDBOOK] 6.8.
struct SafetyInputs {
  bool emergency_stop = false;    ///< a stop is asked for: button, or the controller's own fault
  bool operator_enable = true;    ///< the operator holds the enabling switch
  bool override_key = false;      ///< the device may move with nobody at the handle, slowly
  bool is_field_clear = true;     ///< nobody stands in the scanner's field
  bool has_disagreement = false;  ///< channels of one input differed longer than allowed
};

/// Six numbers per inertial unit on a link, root to tip: accelerometer, then gyroscope.
using InertialReadings = VectorUpTo<6 * kMaxInertialUnits>;

/// What a device measured in one sample, as its sensors give it.
struct SensorFrame {
  std::uint64_t sequence = 0;     ///< counts up by one per sample
  double time_s = 0.0;            ///< the device's clock
  VectorM q_m;                    ///< link-side encoders; unlimited joints wrapped to [-pi, pi)
  VectorM dq_m;                   ///< link-side joint velocities
  VectorM theta_m;                ///< motor-side encoders at the output of the gear; empty = none
  VectorM tau_m;                  ///< joint torque sensors
  VectorP q_p;                    ///< gantry encoders
  Vector6 w_S = Vector6::Zero();  ///< wrench on the handle at S, resolved in S, force first
  /// Accelerometer in S: acceleration minus gravity, resolved in S; zero without one.
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();  ///< gyroscope in S; zero without one
  /// CommandFrame::sequence of the newest command at work: tells the latency of the loop.
  std::uint64_t answered_sequence = 0;
  bool dead_man = false;  ///< the user's hand closes the dead-man switch of the handle
  SafetyInputs safety;
  VectorM temperature_m;         ///< of the motors, degrees Celsius; empty = not measured
  std::uint32_t bus_errors = 0;  ///< fieldbus answers that are missing in this sample
  FaultCode driver_fault = FaultCode::kNone;  ///< why the driver has no (good) values
  /// Units on links: acceleration minus gravity, m/s^2, and rad/s, in their own axes; empty = none.
  InertialReadings inertial;
};

/// Where a simulated person wants the handle. Only simulated devices look at it.
struct HandTarget {
  bool active = false;                            ///< false: the person's own script decides
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();  ///< target position of the handle in B
  double press = 0.0;  ///< how far the hand presses the lever it holds, 0..1
  bool turns = false;  ///< false: the hand lets the handle turn as it likes
  Eigen::Matrix3d R_B = Eigen::Matrix3d::Identity();  ///< target orientation of the handle, if so
};

/// Buttons and keys of an operator's panel. Only simulated devices look at it; its emergency stop
/// acts whatever the device is.
struct SafetyPanel {
  bool emergency_stop = false;
  bool operator_enable = true;
  bool override_key = false;
  bool person_in_field = false;  ///< besides whoever holds the handle
  bool reset = false;            ///< of the safety controller; acts when it is pressed
};

/// Numbers are recorded and never change their meaning.
enum class ModeRequest : std::uint8_t {
  kNone = 0,
  kArm = 1,
  kRun = 2,
  kStop = 3,
  kReset = 4,
  kTare = 5,        ///< what the force/torque sensor shows of a free handle at rest is its zero
  kAutonomous = 6,  ///< run with nobody at the handle, slowly, with the override key
};

/// What of a twin may change while it runs. Numbers are recorded and never change their meaning.
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
  kGravity = 11,          ///< share of the earth's, 0..1
  kMassScale = 12,        ///< all masses of the twin times this, 0.1..10
};

/// One parameter of the twin gets a new value, approached within a second without a bump.
struct ParameterChange {
  Parameter parameter = Parameter::kNone;
  std::int16_t index = -1;  ///< degree of freedom of the twin, or component; see Parameter
  double value = 0.0;
};

/// Everything that enters a cycle from outside other than sensors.
struct OperatorFrame {
  ModeRequest request = ModeRequest::kNone;
  HandTarget hand_target;
  SafetyPanel panel;
  ParameterChange change;
  std::uint32_t late_cycles = 0;  ///< missed by this run since the last cycle: late or left out
  /// The solver's budget in this cycle, where it is smaller than the one configured; 0: that one. A
  /// fault on purpose.
  std::uint32_t most_active_sets = 0;
};

/// What the device is asked to do until the next sample.
struct CommandFrame {
  std::uint64_t sequence = 0;  ///< of the SensorFrame that it answers
  bool enable = false;         ///< drives powered; false also means: brakes closed
  VectorM q_m;                 ///< reference positions of the manipulator
  VectorM dq_m;                ///< reference velocities
  VectorM ddq_m;               ///< reference accelerations
  VectorM tau_m;               ///< motor torques; empty: the drives follow the reference
  VectorP dq_p;                ///< gantry velocities
  HandTarget hand_target;      ///< handed through to a simulated person
  SafetyPanel panel;           ///< handed through to a simulated safety controller
};

}  // namespace hg
