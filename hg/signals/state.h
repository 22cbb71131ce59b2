/// Plain structs used inside a cycle and recorded after it.
///
/// SI units. Chains: p = prepositioning unit (gantry), m = manipulator, a = twin. Frames: B = base,
/// H = handle of the device, E = end effector of the twin. Wrenches act on the handle, at H,
/// resolved in B, force first. Copyable, no allocation.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hg/core/stacked.h"
#include "hg/core/types.h"
#include "hg/signals/fault.h"
#include "hg/signals/frames.h"
#include "hg/signals/limit.h"
#include "hg/signals/touch.h"
#include "hg/signals/truth.h"

namespace hg {

/// Operating states, docs/concepts/safety.md.
enum class Mode : std::uint8_t {
  kOff = 0,
  kReady = 1,
  kArmed = 2,
  kRunning = 3,
  kStopping = 4,
  kFault = 5,
};

std::string_view to_string(Mode mode) noexcept;

/// Kind of stop of the device, as in IEC 61800-5-2.
enum class Stop : std::uint8_t {
  kNone = 0,
  kSs2 = 1,  ///< controlled, then held under power
  kSs1 = 2,  ///< controlled, then drives off and brakes closed
  kSto = 3,  ///< drives off and brakes closed at once
};

std::string_view to_string(Stop stop) noexcept;

/// Smallest distance of the device to itself or its surroundings if it brakes now.
struct CollisionReport {
  double distance = kInfinity;  ///< Smallest distance while braking, m
  int pair = -1;                ///< Index in the list of pairs; -1 = no pair is monitored
};

/// Energy at the handle, and oscillation of hand and device.
struct PassivityReport {
  double tank = 0.0;         ///< Energy that the rendering may still deliver, J
  double energy = 0.0;       ///< Net energy delivered through the handle, J
  double oscillation = 0.0;  ///< Oscillation index; 1 = detected
  double damping = 0.0;      ///< Damping added to the twin, Ns/m
  double inertia = 1.0;      ///< Factor on the twin's masses, raised on oscillation
};

/// Contact of the twin's end effector with virtual surfaces; resolved in B.
struct ContactReport {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the handle, N
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();  ///< Nearest point outside all surfaces, m
  int surface = -1;  ///< Surface with the largest force, index in the scenario; -1 = none
};

/// Estimated state of the device.
struct RobotState {
  VectorM q_m, dq_m;              ///< Link side, unlimited joints unwrapped
  VectorM theta_m, dtheta_m;      ///< Motor side, unwrapped like the link; empty without encoders
  VectorM tau_m;                  ///< Joint torque sensors
  VectorP q_p, dq_p, ddq_p;       ///< Gantry, from the observer with the drive model
  Vector6 w_H = Vector6::Zero();  ///< Wrench of the user, filtered, payload compensated
};

/// Estimates from inertial units on the links; empty without them. "pm": all joints, the gantry's
/// first. All bending is lumped at the root, the first unit's link: a twist and its integral,
/// resolved in B; the integral decays within a third of a second.
struct InertialReport {
  VectorPM q, dq, ddq;                               ///< Joints: rad or m, and derivatives
  VectorUpTo<6> bend, bend_rate, bend_acceleration;  ///< Bending: m and rad, and derivatives
  VectorUpTo<kMaxInertialUnits> trust;               ///< Weight of each unit, 0..1
};

/// Integrated reference of the manipulator.
struct ReferenceState {
  VectorM q_m, dq_m, ddq_m;
};

/// State of the twin.
struct TwinState {
  ConfigurationA q_a;   ///< Coordinates; a floating joint has position and quaternion xyzw
  VectorA dq_a, ddq_a;  ///< Joint velocities, accelerations; floating joint: in its own frame
};

/// Breakdown of the user's wrench in twin joint space (rad: Nm, m: N). The parts add up:
/// J_a^T w = inertia + damping + friction + spring + surface + limits (+ conflict); `structure` is
/// the part of w carried by the twin's bearings.
struct Budget {
  VectorA inertia;   ///< M_a ddq_a + c_a
  VectorA damping;   ///< viscous part of tau_dis
  VectorA friction;  ///< Coulomb part of tau_dis while slipping
  VectorA spring;    ///< -tau_dri
  VectorA surface;   ///< J_a^T w_ref, minus J_a^T times the wrench of a contact with the arm
  VectorA limits;    ///< Negative constraint torques of all rows with a reaction
  VectorA conflict;  ///< Negative contribution of rows that could not be met
  Vector6 structure = Vector6::Zero();  ///< Part of w in the null space of J_a^T
};

/// Tracking of the reference by the device.
struct TrackingReport {
  VectorM error;         ///< Reference minus link side, rad or m
  VectorM torque_share;  ///< Commanded motor torque over its peak; empty without torque control
  /// Joint torque not explained by motion and user wrench, moving mean, Nm; empty without torque
  /// control.
  VectorM torque_unexplained;
  double latency_s = 0.0;   ///< Latency of the torque loop, s, as measured before it was closed
  bool is_clamped = false;  ///< Tracking was lost: the reference was moved back to the device
};

/// Outcome of the solver in one cycle.
enum class SolverStatus : std::uint8_t {
  kNotRun = 0,
  kSolved = 1,
  kBudgetSpent = 2,  ///< stopped before optimality was proven; joint limits hold
  kFailed = 3
};

std::string_view to_string(SolverStatus status) noexcept;

/// Outcome of the parameter change that a cycle received.
enum class ChangeStatus : std::uint8_t {
  kNone = 0,     ///< there was none
  kTaken = 1,    ///< the value is being approached
  kRefused = 2,  ///< parameter or index unknown to this twin, or value out of range: ignored
};

/// Outcome of the last tare of the force/torque sensor. A refused one keeps the old tare.
enum class TareStatus : std::uint8_t {
  kNone = 0,             ///< there was none
  kUnderWay = 1,         ///< the wrench is being averaged
  kDone = 2,             ///< the mean is subtracted from now on
  kRefusedHeld = 3,      ///< the dead-man switch was closed: the handle was held
  kRefusedMoving = 4,    ///< joints or gantry moved
  kRefusedUnsteady = 5,  ///< the wrench varied beyond sensor noise: the handle was touched
  kRefusedRunning = 6,   ///< the device was running or stopping
};

std::string_view to_string(TareStatus status) noexcept;

/// Reason for refusing a request of the operator.
enum class Refusal : std::uint8_t {
  kNone = 0,
  kNotTared = 1,             ///< arming: required tare is missing
  kLatencyTooLong = 2,       ///< arming: torque loop would be unstable
  kLatencyUnknown = 3,       ///< arming: too few answered commands to measure the latency
  kNotReady = 4,             ///< arming: device is not ready (off, already on, or stopping)
  kNotArmed = 5,             ///< running: drives are off, or device is running or stopping
  kFaultPresent = 6,         ///< anything but a reset: a fault is present
  kCauseRemains = 7,         ///< reset: the cause of the fault is still present
  kNoFault = 8,              ///< reset: there is no fault
  kOperatorReleased = 9,     ///< arming: enabling switch is not held
  kNobodyHolds = 10,         ///< running by hand: the handle is not held
  kSomebodyHolds = 11,       ///< running autonomously: the handle is held
  kNoOverride = 12,          ///< running autonomously: override key is off
  kFieldOccupied = 13,       ///< running autonomously: a person is in the scanner's field
  kStillMoving = 14,         ///< arming: the device still moves after power-off
  kTwinApart = 15,           ///< arming: the twin cannot reach the handle's pose
  kPostureImplausible = 16,  ///< arming: gravity and encoders disagree on the posture
};

std::string_view to_string(Refusal refusal) noexcept;

/// All results of a cycle: recorded, shown, and evaluated after the run.
struct CycleRecord {
  std::uint64_t cycle = 0;
  double time_s = 0.0;  ///< Nominal time since the cycle was created, s
  Mode mode = Mode::kOff;
  bool is_autonomous = false;  ///< Running autonomously, with a free handle
  Stop stop = Stop::kNone;     ///< Kind of the present or last stop
  Fault fault;
  /// Rule nearest to its threshold, once beyond its warning level; after a stop that another rule
  /// aborted, that rule.
  Fault warning;
  std::uint32_t sanitised = 0;  ///< Bit i: command of joint i was changed; from bit 16: gantry
  ChangeStatus change = ChangeStatus::kNone;
  TareStatus tare = TareStatus::kNone;
  bool is_tared = false;             ///< A tare exists, or this device needs none
  bool is_latency_known = false;     ///< Latency was measured, or this device has no torque loop
  Refusal refusal = Refusal::kNone;  ///< Refusal of this cycle's request
  RobotState robot;
  ReferenceState reference;
  TwinState twin;
  Pose T_B_H;                                     ///< Handle at the reference
  Pose T_B_E;                                     ///< End effector of the twin
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();  ///< Velocity of the handle at the reference, m/s
  Eigen::Vector3d a_H = Eigen::Vector3d::Zero();  ///< Commanded acceleration (that of E), m/s^2
  Eigen::Vector3d p_B_elbow = Eigen::Vector3d::Zero();
  double sync_error = 0.0;        ///< Distance of H and E, m
  double sync_error_angle = 0.0;  ///< Angle between H and E, rad
  VectorA tau_a;                  ///< J_a^T w
  Budget budget;
  std::array<LimitReport, kMaxLimits> limits{};
  int limit_count = 0;
  int felt_limit = -1;               ///< Index of the limit that the user feels most; -1 = none
  Vector6 w_felt = Vector6::Zero();  ///< Wrench of that limit on the handle (device rows only)
  TrackingReport tracking;
  CollisionReport collision;
  PassivityReport passivity;
  ContactReport contact;
  TouchReport touch;
  VectorP q_p_target;  ///< Gantry target of prepositioning
  SolverStatus solver_status = SolverStatus::kNotRun;
  int solver_iterations = 0;
  int active_set_changes = 0;
  std::uint64_t state_hash = 0;  ///< Hash of the state after this cycle; equal in a replay
  InertialReport inertial;
};

/// Complete record of one cycle.
struct Sample {
  SensorFrame sensors;
  OperatorFrame operator_input;
  CommandFrame command;
  CycleRecord record;
  Truth truth;                 ///< Ground truth at the time of `sensors`; not part of a replay
  double cycle_time_us = 0.0;  ///< Duration measured by the runtime; not part of a replay
};

}  // namespace hg
