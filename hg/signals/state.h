/// Plain structs used inside a cycle and recorded after it.
///
/// SI units. Chains: p = prepositioning unit (gantry), m = manipulator, a = twin. Frames: B = base,
/// H = handle of the device, E = end effector of the twin. Wrenches act on the handle, at H,
/// resolved in B, force first. Copyable, no allocation.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hg/core/fields.h"
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

template <typename Archive, Is<CollisionReport> T>
void fields(Archive& a, T& collision) {
  a("distance", collision.distance, "smallest distance while braking from now on, m");
  a("pair", collision.pair, "index in the list of pairs; -1 = no pair is monitored");
}

/// Energy at the handle, and oscillation of hand and device.
struct PassivityReport {
  double tank = 0.0;         ///< Energy that the rendering may still deliver, J
  double energy = 0.0;       ///< Net energy delivered through the handle, J
  double oscillation = 0.0;  ///< Oscillation index; 1 = detected
  double damping = 0.0;      ///< Damping added to the twin, Ns/m
  double inertia = 1.0;      ///< Factor on the twin's masses, raised on oscillation
};

template <typename Archive, Is<PassivityReport> T>
void fields(Archive& a, T& passivity) {
  a("tank", passivity.tank, "energy that the rendering may still deliver, J");
  a("energy", passivity.energy, "net energy delivered through the handle, J");
  a("oscillation", passivity.oscillation, "oscillation index; 1 = detected");
  a("damping", passivity.damping, "damping added to the twin, Ns/m");
  a("inertia", passivity.inertia, "factor on the masses of the twin, raised on oscillation");
}

/// Contact of the twin's end effector with virtual surfaces; resolved in B.
struct ContactReport {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the handle, N
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();  ///< Nearest point outside all surfaces, m
  int surface = -1;  ///< Surface with the largest force, index in the scenario; -1 = none
};

template <typename Archive, Is<ContactReport> T>
void fields(Archive& a, T& contact) {
  a("force", contact.force, "force of virtual surfaces on the handle, N");
  a("proxy", contact.proxy, "point nearest to the handle outside all surfaces, m");
  a("surface", contact.surface, "surface with the largest force, index in the scenario; -1 = none");
}

/// Estimated state of the device.
struct RobotState {
  VectorM q_m, dq_m;              ///< Link side, unlimited joints unwrapped
  VectorM theta_m, dtheta_m;      ///< Motor side, unwrapped like the link; empty without encoders
  VectorM tau_m;                  ///< Joint torque sensors
  VectorP q_p, dq_p, ddq_p;       ///< Gantry, from the observer with the drive model
  Vector6 w_H = Vector6::Zero();  ///< Wrench of the user, filtered, payload compensated
};

template <typename Archive, Is<RobotState> T>
void fields(Archive& a, T& robot) {
  a("q_m", robot.q_m, "link-side positions of the manipulator, unwrapped, rad");
  a("dq_m", robot.dq_m, "link-side velocities of the manipulator, rad/s");
  a("theta_m", robot.theta_m, "motor-side positions, unwrapped, rad");
  a("dtheta_m", robot.dtheta_m, "motor-side velocities, rad/s");
  a("tau_m", robot.tau_m, "joint torque sensors, Nm");
  a("q_p", robot.q_p, "gantry positions, m");
  a("dq_p", robot.dq_p, "gantry velocities, m/s");
  a("ddq_p", robot.ddq_p, "gantry accelerations, m/s^2");
  a("w_h", robot.w_H, "wrench of the user at the handle, in the base frame: force N, torque Nm");
}

/// Estimates from inertial units on the links; empty without them. "pm": all joints, the gantry's
/// first. All bending is lumped at the root, the first unit's link: a twist and its integral,
/// resolved in B; the integral decays within a third of a second.
struct InertialReport {
  VectorPM q, dq, ddq;                               ///< Joints: rad or m, and derivatives
  VectorUpTo<6> bend, bend_rate, bend_acceleration;  ///< Bending: m and rad, and derivatives
  VectorUpTo<kMaxInertialUnits> trust;               ///< Weight of each unit, 0..1
};

template <typename Archive, Is<InertialReport> T>
void fields(Archive& a, T& inertial) {
  a("q", inertial.q, "positions of all joints, gantry first, rad or m; empty = no units");
  a("dq", inertial.dq, "velocities of all joints, gantry first, rad/s or m/s");
  a("ddq", inertial.ddq, "accelerations of all joints, gantry first, rad/s^2 or m/s^2");
  a("bend", inertial.bend, "bending of the root in the base frame: m, rad");
  a("bend_rate", inertial.bend_rate, "rate of the bending: m/s, rad/s");
  a("bend_acceleration", inertial.bend_acceleration, "acceleration of the bending: m/s^2, rad/s^2");
  a("trust", inertial.trust, "weight of each unit, 0..1");
}

/// Integrated reference of the manipulator.
struct ReferenceState {
  VectorM q_m, dq_m, ddq_m;
};

template <typename Archive, Is<ReferenceState> T>
void fields(Archive& a, T& reference) {
  a("q_m", reference.q_m, "reference positions of the manipulator, rad");
  a("dq_m", reference.dq_m, "reference velocities of the manipulator, rad/s");
  a("ddq_m", reference.ddq_m, "reference accelerations of the manipulator, rad/s^2");
}

/// State of the twin.
struct TwinState {
  ConfigurationA q_a;   ///< Coordinates; a floating joint has position and quaternion xyzw
  VectorA dq_a, ddq_a;  ///< Joint velocities, accelerations; floating joint: in its own frame
};

template <typename Archive, Is<TwinState> T>
void fields(Archive& a, T& twin) {
  a("q_a", twin.q_a, "coordinates, rad or m; a floating joint has x y z qx qy qz qw");
  a("dq_a", twin.dq_a, "velocities, rad/s or m/s; a floating joint has v, omega in its own frame");
  a("ddq_a", twin.ddq_a, "accelerations, rad/s^2 or m/s^2");
}

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

template <typename Archive, Is<Budget> T>
void fields(Archive& a, T& budget) {
  a("inertia", budget.inertia, "torques of inertia, Coriolis forces and weight, Nm or N");
  a("damping", budget.damping, "torques of dampers, Nm or N");
  a("friction", budget.friction, "torques of Coulomb friction while slipping, Nm or N");
  a("spring", budget.spring, "torques of springs and closers, Nm or N");
  a("surface", budget.surface, "torques of surfaces, reference wrench and contacts, Nm or N");
  a("limits", budget.limits, "torques of active limits, Nm or N");
  a("conflict", budget.conflict, "torques of limits that could not be met, Nm or N");
  a("structure", budget.structure,
    "wrench carried by the bearings of the twin: force N, torque Nm");
}

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

template <typename Archive, Is<TrackingReport> T>
void fields(Archive& a, T& tracking) {
  a("error", tracking.error, "reference minus link side, rad");
  a("torque_share", tracking.torque_share,
    "commanded motor torque over its peak; empty without torque control");
  a("torque_unexplained", tracking.torque_unexplained,
    "joint torque not explained by motion and user, moving mean, Nm");
  a("latency_s", tracking.latency_s, "measured latency of the torque loop, s");
  a("is_clamped", tracking.is_clamped,
    "tracking was lost: the reference was moved back to the device");
}

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

/// All results of a cycle: recorded, shown, and evaluated after the run. Each group says which
/// stage computes it; fields() lists the members in the order of recordings.
struct CycleRecord {
  // Computed by the cycle itself.
  std::uint64_t cycle = 0;
  double time_s = 0.0;           ///< Nominal time since the cycle was created, s
  std::uint64_t state_hash = 0;  ///< Hash of the state after this cycle; equal in a replay

  // Computed by the supervisor, from operator, safety inputs and broken rules of all stages.
  Mode mode = Mode::kOff;
  bool is_autonomous = false;  ///< Running autonomously, with a free handle
  Stop stop = Stop::kNone;     ///< Kind of the present or last stop
  Fault fault;
  Refusal refusal = Refusal::kNone;  ///< Refusal of this cycle's request

  // Computed by estimation.
  RobotState robot;  ///< Its w_H keeps the last valid wrench while the sensor is out of range
  InertialReport inertial;
  TareStatus tare = TareStatus::kNone;
  bool is_tared = false;  ///< A tare exists, or this device needs none

  // Computed by the collision guard.
  CollisionReport collision;

  // Computed by prepositioning.
  VectorP q_p_target;  ///< Gantry target of prepositioning

  // Computed by rendering. A cycle that brakes the joints without the law replaces reference, twin
  // and sync_error.
  ChangeStatus change = ChangeStatus::kNone;  ///< Outcome of this cycle's parameter change
  ReferenceState reference;
  TwinState twin;
  Pose T_B_H;                                     ///< Handle at the reference
  Pose T_B_E;                                     ///< End effector of the twin
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();  ///< Velocity of the handle at the reference, m/s
  Eigen::Vector3d a_H = Eigen::Vector3d::Zero();  ///< Commanded acceleration (that of E), m/s^2
  Eigen::Vector3d p_B_elbow = Eigen::Vector3d::Zero();  ///< Position of the elbow, m
  double sync_error = 0.0;                              ///< Distance of H and E, m
  double sync_error_angle = 0.0;                        ///< Angle between H and E, rad
  VectorA tau_a;                                        ///< J_a^T w
  Budget budget;
  std::array<LimitReport, kMaxLimits> limits{};
  int limit_count = 0;
  int felt_limit = -1;               ///< Index of the limit that the user feels most; -1 = none
  Vector6 w_felt = Vector6::Zero();  ///< Wrench of that limit on the handle (device rows only)
  ContactReport contact;
  SolverStatus solver_status = SolverStatus::kNotRun;
  int solver_iterations = 0;
  int active_set_changes = 0;

  // Computed by passivity, after the rendering.
  PassivityReport passivity;

  // Computed by the monitor. After a stop that another rule aborted, the supervisor puts that rule.
  Fault warning;  ///< Rule nearest to its threshold, once beyond its warning level

  // Computed by tracking; is_clamped by rendering, when the reference leaves the device.
  TrackingReport tracking;
  bool is_latency_known = false;  ///< Latency was measured, or this device has no torque loop

  // Computed by compliance, after tracking.
  TouchReport touch;

  // Computed by the sanitiser.
  std::uint32_t sanitised = 0;  ///< Bit i: command of joint i was changed; from bit 16: gantry
};

template <typename Archive, Is<CycleRecord> T>
void fields(Archive& a, T& record) {
  a("cycle", record.cycle, "number of the cycle");
  a("time_s", record.time_s, "nominal time, s; log time minus the start of the run");
  a("mode", record.mode);
  a("is_autonomous", record.is_autonomous, "runs autonomously, with a free handle");
  a("stop", record.stop);
  a("fault", record.fault, "cause of the stop");
  a("warning", record.warning, "rule nearest to its threshold, once beyond its warning level");
  a("sanitised", record.sanitised, "bit i: command of joint i was changed; from bit 16: gantry");
  a("change", record.change, "outcome of a parameter change");
  a("tare", record.tare);
  a("is_tared", record.is_tared, "a tare exists, or this device needs none");
  a("is_latency_known", record.is_latency_known,
    "latency was measured, or there is no torque loop");
  a("refusal", record.refusal, "refusal of a request");
  a("robot", record.robot, "estimated state of the device");
  a("reference", record.reference, "integrated reference of the manipulator");
  a("twin", record.twin, "state of the twin");
  a("handle", record.T_B_H, "handle in the base frame, at the reference");
  a("twin_end", record.T_B_E, "end effector of the twin in the base frame");
  a("v_h", record.v_H, "velocity of the handle at the reference, m/s");
  a("a_h", record.a_H, "commanded acceleration of the handle, m/s^2");
  a("p_b_elbow", record.p_B_elbow, "position of the elbow in the base frame, m");
  a("sync_error", record.sync_error, "distance of handle and twin, m");
  a("sync_error_angle", record.sync_error_angle, "angle between handle and twin, rad");
  a("tau_a", record.tau_a, "user's wrench as torques of the twin's joints, Nm or N");
  a("budget", record.budget, "breakdown of the user's wrench");
  a.sequence("limits", record.limits, record.limit_count,
             "limits in the order of metadata \"limits\"");
  a("felt_limit", record.felt_limit, "index of the limit that the user feels most; -1 = none");
  a("w_felt", record.w_felt, "wrench of the felt limit on the handle: force N, torque Nm");
  a("tracking", record.tracking, "tracking of the reference by the device");
  a("collision", record.collision, "distance to a collision if the device brakes now");
  a("passivity", record.passivity, "energy and oscillation at the handle");
  a("contact", record.contact, "contact of the twin with virtual surfaces");
  a("touch", record.touch, "contact of the arm anywhere but at the handle");
  a("q_p_target", record.q_p_target, "gantry target of prepositioning, m");
  a("solver_status", record.solver_status);
  a("solver_iterations", record.solver_iterations, "active sets tried in this cycle");
  a("active_set_changes", record.active_set_changes,
    "rows whose state changed since the last cycle");
  a("state_hash", record.state_hash, "hash of the state after this cycle; equal in a replay");
  a("inertial", record.inertial, "estimates from inertial units on the links");
}

/// Complete record of one cycle.
struct Sample {
  SensorFrame sensors;
  OperatorFrame operator_input;
  CommandFrame command;
  CycleRecord record;
  Truth truth;                 ///< Ground truth at the time of `sensors`; not part of a replay
  double cycle_time_us = 0.0;  ///< Duration measured by the runtime; not part of a replay
};

template <typename Archive, Is<Sample> T>
void fields(Archive& a, T& sample) {
  a("sensors", sample.sensors, "input of the cycle");
  a("operator_input", sample.operator_input, "input of the cycle");
  a("command", sample.command, "output of the cycle");
  a("record", sample.record, "results of the cycle");
  a("truth", sample.truth, "ground truth of a simulation; not part of a replay");
  a("cycle_time_us", sample.cycle_time_us,
    "measured duration of the cycle, us; not part of a replay");
}

}  // namespace hg
