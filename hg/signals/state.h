/// The plain structs that travel inside a cycle and out of it as a record.
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

/// Operating states, docs/safety.md.
enum class Mode : std::uint8_t {
  kOff = 0,
  kReady = 1,
  kArmed = 2,
  kRunning = 3,
  kStopping = 4,
  kFault = 5,
};

std::string_view to_string(Mode mode) noexcept;

/// How the device is being stopped, as in IEC 61800-5-2.
enum class Stop : std::uint8_t {
  kNone = 0,
  kSs2 = 1,  ///< controlled, then held under power
  kSs1 = 2,  ///< controlled, then drives off and brakes closed
  kSto = 3,  ///< drives off and brakes closed at once
};

std::string_view to_string(Stop stop) noexcept;

/// What of the device comes nearest to itself or its surroundings when it brakes now.
struct CollisionReport {
  double distance = kInfinity;  ///< smallest while braking, m
  int pair = -1;                ///< index in the list of pairs; -1 = none is watched
};

/// Energy at the handle, and whether hand and device shake each other.
struct PassivityReport {
  double tank = 0.0;         ///< energy that the rendering may still give, J
  double energy = 0.0;       ///< given through the handle and not got back, J
  double oscillation = 0.0;  ///< index of oscillation; 1 = detected
  double damping = 0.0;      ///< added to calm the twin, Ns/m
  double inertia = 1.0;      ///< factor on the masses of the twin, to calm it
};

/// What virtual surfaces do to the end effector of the twin; resolved in B.
struct ContactReport {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the handle, N
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();  ///< nearest to it outside of all of them, m
  int surface = -1;  ///< index in the scenario of the one that pushes most; -1 = none
};

/// What estimation knows about the device.
struct RobotState {
  VectorM q_m, dq_m;              ///< link side, unlimited joints unwrapped
  VectorM theta_m, dtheta_m;      ///< motor side, unwrapped like the link; empty without encoders
  VectorM tau_m;                  ///< joint torque sensors
  VectorP q_p, dq_p, ddq_p;       ///< gantry, from the observer with the drive model
  Vector6 w_H = Vector6::Zero();  ///< wrench of the user, filtered, without the payload's share
};

/// What inertial units on the links say of the device; empty without them. "pm": all joints, the
/// gantry's first. Bending is that of the root, the first unit's link, as if all of it were there:
/// a twist and what is integrated of it, resolved in B, forgotten within a third of a second.
struct InertialReport {
  VectorPM q, dq, ddq;                               ///< joints: rad or m, and its derivatives
  VectorUpTo<6> bend, bend_rate, bend_acceleration;  ///< m and rad, and their derivatives
  VectorUpTo<kMaxInertialUnits> trust;  ///< share with which each unit takes part, 0..1
};

/// Integrated reference of the manipulator.
struct ReferenceState {
  VectorM q_m, dq_m, ddq_m;
};

/// State of the twin.
struct TwinState {
  ConfigurationA q_a;   ///< coordinates; a floating joint has position and quaternion xyzw
  VectorA dq_a, ddq_a;  ///< velocities of its joints; a floating joint in its own frame
};

/// Where the user's wrench goes, in twin joint space (rad: Nm, m: N). The parts add up:
/// J_a^T w = inertia + damping + friction + spring + surface + limits (+ conflict); the part of w
/// that the twin's bearings carry is `structure`.
struct Budget {
  VectorA inertia;   ///< M_a ddq_a + c_a
  VectorA damping;   ///< viscous part of tau_dis
  VectorA friction;  ///< Coulomb part of tau_dis while slipping
  VectorA spring;    ///< -tau_dri
  VectorA surface;   ///< J_a^T w_ref, minus J_a^T times the wrench of what touches the arm
  VectorA limits;    ///< minus the constraint torques of all rows with a reaction
  VectorA conflict;  ///< minus what rows that could not be met add
  Vector6 structure = Vector6::Zero();  ///< part of w in the null space of J_a^T
};

/// How well the device follows its reference.
struct TrackingReport {
  VectorM error;         ///< reference minus link side, rad or m
  VectorM torque_share;  ///< motor torque asked for over its peak; empty without torque control
  /// Joint torque that motion and user's wrench do not explain, a moving mean, Nm; empty likewise.
  VectorM torque_unexplained;
  double latency_s = 0.0;   ///< of the torque loop, as measured before it was closed
  bool is_clamped = false;  ///< tracking was lost: the reference was brought back to the device
};

enum class SolverStatus : std::uint8_t {
  kNotRun = 0,
  kSolved = 1,
  kBudgetSpent = 2,  ///< ended before it was proven; the joints keep their limits
  kFailed = 3
};

std::string_view to_string(SolverStatus status) noexcept;

/// What became of the change of a parameter that came in with a cycle.
enum class ChangeStatus : std::uint8_t {
  kNone = 0,     ///< there was none
  kTaken = 1,    ///< its value is being approached
  kRefused = 2,  ///< parameter or index unknown to this twin, or value out of range: ignored
};

/// How the last tare of the force/torque sensor went. A refused one leaves the old tare.
enum class TareStatus : std::uint8_t {
  kNone = 0,             ///< there was none
  kUnderWay = 1,         ///< the wrench is being averaged
  kDone = 2,             ///< its mean is taken off from now on
  kRefusedHeld = 3,      ///< the dead-man was closed: somebody held the handle
  kRefusedMoving = 4,    ///< joints or gantry moved
  kRefusedUnsteady = 5,  ///< the wrench varied more than the sensor's noise: somebody touched it
  kRefusedRunning = 6,   ///< the device ran or stopped
};

std::string_view to_string(TareStatus status) noexcept;

/// Why a request of the operator was not followed.
enum class Refusal : std::uint8_t {
  kNone = 0,
  kNotTared = 1,             ///< arming a device that needs a tare and has none
  kLatencyTooLong = 2,       ///< arming a torque loop that would not be stable
  kLatencyUnknown = 3,       ///< arming a torque loop before enough commands were answered
  kNotReady = 4,             ///< arming a device that is not ready: off, on already, or stopping
  kNotArmed = 5,             ///< running a device whose drives are off, or that runs or stops
  kFaultPresent = 6,         ///< anything but a reset after a fault
  kCauseRemains = 7,         ///< a reset while the cause of the fault is still there
  kNoFault = 8,              ///< a reset without a fault
  kOperatorReleased = 9,     ///< arming while the operator does not hold the enabling switch
  kNobodyHolds = 10,         ///< running by hand with nobody at the handle
  kSomebodyHolds = 11,       ///< running autonomously with somebody at the handle
  kNoOverride = 12,          ///< running autonomously without the override key
  kFieldOccupied = 13,       ///< running autonomously with somebody in the scanner's field
  kStillMoving = 14,         ///< arming a device that still moves, its drives just off
  kTwinApart = 15,           ///< arming where the twin cannot be where the handle is
  kPostureImplausible = 16,  ///< arming where gravity says another posture than the encoders
};

std::string_view to_string(Refusal refusal) noexcept;

/// Everything that a cycle has to say: recorded, shown, and judged after the run.
struct CycleRecord {
  std::uint64_t cycle = 0;
  double time_s = 0.0;  ///< nominal time since the cycle was created
  Mode mode = Mode::kOff;
  bool is_autonomous = false;  ///< runs with nobody at the handle
  Stop stop = Stop::kNone;     ///< how it is being stopped, or was
  Fault fault;
  /// The rule nearest to its threshold, once beyond its warning; after a stop that another rule
  /// broke off, that one.
  Fault warning;
  std::uint32_t sanitised = 0;  ///< bit i: command of joint i was changed; from bit 16: gantry
  ChangeStatus change = ChangeStatus::kNone;
  TareStatus tare = TareStatus::kNone;
  bool is_tared = false;             ///< a tare is there, or this device needs none
  bool is_latency_known = false;     ///< it was measured, or this device has no torque loop
  Refusal refusal = Refusal::kNone;  ///< of this cycle's request
  RobotState robot;
  ReferenceState reference;
  TwinState twin;
  Pose T_B_H;                                     ///< handle at the reference
  Pose T_B_E;                                     ///< end effector of the twin
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();  ///< its velocity
  Eigen::Vector3d a_H = Eigen::Vector3d::Zero();  ///< its acceleration asked for this sample
  Eigen::Vector3d p_B_elbow = Eigen::Vector3d::Zero();
  double sync_error = 0.0;        ///< distance of H and E in m
  double sync_error_angle = 0.0;  ///< angle between H and E in rad
  VectorA tau_a;                  ///< J_a^T w
  Budget budget;
  std::array<LimitReport, kMaxLimits> limits{};
  int limit_count = 0;
  int felt_limit = -1;               ///< index of the limit that the user feels most; -1 = none
  Vector6 w_felt = Vector6::Zero();  ///< its reaction as a wrench on the handle (device rows only)
  TrackingReport tracking;
  CollisionReport collision;
  PassivityReport passivity;
  ContactReport contact;
  TouchReport touch;
  VectorP q_p_target;  ///< where prepositioning wants the gantry
  SolverStatus solver_status = SolverStatus::kNotRun;
  int solver_iterations = 0;
  int active_set_changes = 0;
  std::uint64_t state_hash = 0;  ///< of the state after this cycle; equal in a replay
  InertialReport inertial;
};

/// One cycle, complete: what is recorded.
struct Sample {
  SensorFrame sensors;
  OperatorFrame operator_input;
  CommandFrame command;
  CycleRecord record;
  Truth truth;                 ///< at the time of `sensors`; not part of a replay
  double cycle_time_us = 0.0;  ///< measured by the runtime; not part of a replay
};

}  // namespace hg
