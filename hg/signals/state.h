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
#include "hg/signals/teleoperation.h"
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
  double distance = kInfinity;
  int pair = -1;
};

template <typename Archive, Is<CollisionReport> T>
void fields(Archive& a, T& collision) {
  a("distance", collision.distance, "smallest distance while braking from now on", unit::kM);
  a("pair", collision.pair, "index in the list of pairs; -1 = no pair is monitored");
}

/// Energy at the handle, and oscillation of hand and device.
struct PassivityReport {
  double tank = 0.0;
  double energy = 0.0;
  double oscillation = 0.0;
  double damping = 0.0;
  double inertia = 1.0;
};

template <typename Archive, Is<PassivityReport> T>
void fields(Archive& a, T& passivity) {
  a("tank", passivity.tank, "energy that the rendering may still deliver", unit::kJ);
  a("energy", passivity.energy, "net energy delivered through the handle", unit::kJ);
  a("oscillation", passivity.oscillation, "oscillation index; 1 = detected", unit::kNone);
  a("damping", passivity.damping, "damping added to the twin", unit::kNsPerM);
  a("inertia", passivity.inertia, "factor on the masses of the twin, raised on oscillation",
    unit::kNone);
}

/// Contact of the twin's end effector with virtual surfaces; resolved in B.
struct ContactReport {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();
  int surface = -1;
};

template <typename Archive, Is<ContactReport> T>
void fields(Archive& a, T& contact) {
  a("force", contact.force, "force of virtual surfaces on the handle", unit::kN);
  a("proxy", contact.proxy, "point nearest to the handle outside all surfaces", unit::kM);
  a("surface", contact.surface, "surface with the largest force, index in the scenario; -1 = none");
}

/// Estimated state of the device.
struct RobotState {
  VectorM q_m, dq_m, theta_m, dtheta_m, tau_m;
  VectorP q_p, dq_p, ddq_p;  ///< From the observer with the drive model
  Vector6 w_H = Vector6::Zero();
};

template <typename Archive, Is<RobotState> T>
void fields(Archive& a, T& robot) {
  a("q_m", robot.q_m, "link-side positions of the manipulator, unlimited joints unwrapped",
    unit::kJointPosition);
  a("dq_m", robot.dq_m, "link-side velocities of the manipulator", unit::kJointSpeed);
  a("theta_m", robot.theta_m,
    "motor-side positions, unwrapped like the link; empty without encoders", unit::kJointPosition);
  a("dtheta_m", robot.dtheta_m, "motor-side velocities; empty without encoders", unit::kJointSpeed);
  a("tau_m", robot.tau_m, "joint torque sensors", unit::kJointTorque);
  a("q_p", robot.q_p, "gantry positions", unit::kJointPosition);
  a("dq_p", robot.dq_p, "gantry velocities", unit::kJointSpeed);
  a("ddq_p", robot.ddq_p, "gantry accelerations", unit::kJointAcceleration);
  a("w_h", robot.w_H,
    "wrench of the user at the handle, in the base frame, filtered, without the payload",
    unit::kWrench);
}

/// Estimates from inertial units on the links; empty without them. "pm": all joints, the gantry's
/// first. All bending is lumped at the root, the first unit's link: a twist and its integral,
/// resolved in B; the integral decays within a third of a second.
struct InertialReport {
  VectorPM q, dq, ddq;
  VectorUpTo<6> bend, bend_rate, bend_acceleration;
  VectorUpTo<kMaxInertialUnits> trust;
};

template <typename Archive, Is<InertialReport> T>
void fields(Archive& a, T& inertial) {
  a("q", inertial.q, "positions of all joints, gantry first; empty = no units",
    unit::kJointPosition);
  a("dq", inertial.dq, "velocities of all joints, gantry first", unit::kJointSpeed);
  a("ddq", inertial.ddq, "accelerations of all joints, gantry first", unit::kJointAcceleration);
  a("bend", inertial.bend, "bending of the root in the base frame", unit::kDisplacement);
  a("bend_rate", inertial.bend_rate, "rate of the bending", unit::kTwist);
  a("bend_acceleration", inertial.bend_acceleration, "acceleration of the bending",
    unit::kAcceleration);
  a("trust", inertial.trust, "weight of each unit, 0..1", unit::kNone);
}

/// Integrated reference of the manipulator.
struct ReferenceState {
  VectorM q_m, dq_m, ddq_m;
};

template <typename Archive, Is<ReferenceState> T>
void fields(Archive& a, T& reference) {
  a("q_m", reference.q_m, "reference positions of the manipulator", unit::kJointPosition);
  a("dq_m", reference.dq_m, "reference velocities of the manipulator", unit::kJointSpeed);
  a("ddq_m", reference.ddq_m, "reference accelerations of the manipulator",
    unit::kJointAcceleration);
}

/// State of the twin.
struct TwinState {
  ConfigurationA q_a;
  VectorA dq_a, ddq_a;
};

template <typename Archive, Is<TwinState> T>
void fields(Archive& a, T& twin) {
  a("q_a", twin.q_a, "coordinates; a floating joint has x y z qx qy qz qw", unit::kJointPosition);
  a("dq_a", twin.dq_a, "velocities; a floating joint has v, omega in its own frame",
    unit::kJointSpeed);
  a("ddq_a", twin.ddq_a, "accelerations; those of a floating joint in its own frame",
    unit::kJointAcceleration);
}

/// Breakdown of the user's wrench in twin joint space. The parts add up:
/// J_a^T S w = inertia + damping + friction + spring + surface + limits (+ conflict), with the
/// scale S of the felt wrench; `structure` is the part of w carried by the twin's bearings.
struct Budget {
  VectorA inertia;   ///< M_a ddq_a + c_a
  VectorA damping;   ///< viscous part of tau_dis
  VectorA friction;  ///< Coulomb part of tau_dis while slipping
  VectorA spring;    ///< -tau_dri
  VectorA
      surface;  ///< J_a^T w_ref, minus what surfaces, contacts of the arm and a remote machine do
  VectorA limits;                       ///< negative constraint torques of all rows with a reaction
  VectorA conflict;                     ///< negative contribution of rows that could not be met
  Vector6 structure = Vector6::Zero();  ///< part of w in the null space of J_a^T S
};

template <typename Archive, Is<Budget> T>
void fields(Archive& a, T& budget) {
  a("inertia", budget.inertia, "torques of inertia, Coriolis forces and weight",
    unit::kJointTorque);
  a("damping", budget.damping, "torques of dampers", unit::kJointTorque);
  a("friction", budget.friction, "torques of Coulomb friction while slipping", unit::kJointTorque);
  a("spring", budget.spring, "torques of springs and closers", unit::kJointTorque);
  a("surface", budget.surface, "torques of surfaces, reference wrench and contacts",
    unit::kJointTorque);
  a("limits", budget.limits, "torques of active limits", unit::kJointTorque);
  a("conflict", budget.conflict, "torques of limits that could not be met", unit::kJointTorque);
  a("structure", budget.structure, "wrench carried by the bearings of the twin: force, torque",
    unit::kWrench);
}

/// Tracking of the reference by the device.
struct TrackingReport {
  VectorM error, torque_share, torque_unexplained;
  double latency_s = 0.0;
  bool is_clamped = false;
};

template <typename Archive, Is<TrackingReport> T>
void fields(Archive& a, T& tracking) {
  a("error", tracking.error, "reference minus link side", unit::kJointPosition);
  a("torque_share", tracking.torque_share,
    "commanded motor torque over its peak; empty without torque control", unit::kNone);
  a("torque_unexplained", tracking.torque_unexplained,
    "joint torque not explained by motion and user, moving mean; empty without torque control",
    unit::kJointTorque);
  a("latency_s", tracking.latency_s, "latency of the torque loop, as measured before it was closed",
    unit::kS);
  a("is_clamped", tracking.is_clamped, "the reference was moved back to a device that lagged");
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

/// Part of the record that the rendering law fills in. Poses and velocities are those at the time
/// of the sample. Fields of CycleRecord.
struct LawReport {
  Pose T_B_H, T_B_E;
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_H = Eigen::Vector3d::Zero();  ///< That of E
  Eigen::Vector3d p_B_elbow = Eigen::Vector3d::Zero();
  double sync_error = 0.0;  ///< In the record after the motion of this cycle
  double sync_error_angle = 0.0;
  VectorA tau_a;  ///< J_a^T S w
  Budget budget;
  Vector6 felt_scale = Vector6::Ones();  ///< Diagonal of S
  std::array<LimitReport, kMaxLimits> limits{};
  int limit_count = 0;
  int felt_limit = -1;
  Vector6 w_felt = Vector6::Zero();
  ContactReport contact;
  SolverStatus solver_status = SolverStatus::kNotRun;
  int solver_iterations = 0;
  int active_set_changes = 0;
};

/// All results of a cycle: recorded, shown, and evaluated after the run. Each group says which
/// stage computes it; fields() lists the members in the order of recordings.
struct CycleRecord : LawReport {
  // Computed by the cycle itself.
  std::uint64_t cycle = 0;
  double time_s = 0.0;
  std::uint64_t state_hash = 0;

  // Computed by the supervisor, from operator, safety inputs and broken rules of all stages.
  Mode mode = Mode::kOff;
  bool is_autonomous = false;
  Stop stop = Stop::kNone;
  Fault fault;
  Refusal refusal = Refusal::kNone;

  // Computed by estimation.
  RobotState robot;  ///< Its w_H keeps the last valid wrench while the sensor is out of range
  InertialReport inertial;
  TareStatus tare = TareStatus::kNone;
  bool is_tared = false;
  RestReport rest;

  CollisionReport collision;  // computed by the collision guard
  VectorP q_p_target;         // computed by prepositioning

  // Computed by rendering, besides LawReport. A cycle that brakes the joints without the law
  // replaces reference, twin and sync_error.
  ChangeStatus change = ChangeStatus::kNone;
  ReferenceState reference;
  TwinState twin;

  // Computed by passivity, after the rendering.
  PassivityReport passivity;

  // Computed by the monitor. After a stop that another rule aborted, the supervisor puts that rule.
  Fault warning;

  // Computed by tracking; is_clamped by rendering, when the reference leaves the device.
  TrackingReport tracking;
  bool is_latency_known = false;

  // Computed by compliance, after tracking.
  TouchReport touch;

  // Computed by the sanitiser.
  std::uint32_t sanitised = 0;
};

template <typename Archive, Is<CycleRecord> T>
void fields(Archive& a, T& record) {
  a("cycle", record.cycle, "number of the cycle");
  a("time_s", record.time_s,
    "nominal time since the cycle was created; log time minus the start of the run", unit::kS);
  a("mode", record.mode);
  a("is_autonomous", record.is_autonomous, "runs autonomously, with a free handle");
  a("stop", record.stop, "kind of the present or last stop");
  a("fault", record.fault, "cause of the stop");
  a("warning", record.warning, "rule nearest to its threshold, once beyond its warning level");
  a("sanitised", record.sanitised, "bit i: command of joint i was changed; from bit 16: gantry");
  a("change", record.change, "outcome of this cycle's parameter change");
  a("tare", record.tare);
  a("is_tared", record.is_tared, "a tare exists, or this device needs none");
  a("is_latency_known", record.is_latency_known,
    "latency was measured, or this device has no torque loop");
  a("refusal", record.refusal, "refusal of this cycle's request");
  a("robot", record.robot, "estimated state of the device");
  a("reference", record.reference, "integrated reference of the manipulator");
  a("twin", record.twin, "state of the twin");
  a("handle", record.T_B_H, "handle in the base frame, at the reference");
  a("twin_end", record.T_B_E, "end effector of the twin in the base frame");
  a("v_h", record.v_H, "velocity of the handle at the reference", unit::kMPerS);
  a("a_h", record.a_H, "commanded acceleration of the handle", unit::kMPerS2);
  a("p_b_elbow", record.p_B_elbow,
    "position of the elbow in the base frame; zero: the device names none", unit::kM);
  a("sync_error", record.sync_error, "distance of handle and twin", unit::kM);
  a("sync_error_angle", record.sync_error_angle, "angle between handle and twin", unit::kRad);
  a("tau_a", record.tau_a, "user's wrench as torques of the twin's joints", unit::kJointTorque);
  a("budget", record.budget, "breakdown of the user's wrench");
  a.sequence("limits", record.limits, record.limit_count,
             "limits in the order of metadata \"limits\"");
  a("felt_limit", record.felt_limit, "index of the limit that the user feels most; -1 = none");
  a("w_felt", record.w_felt,
    "wrench of the felt limit on the handle, of limits of the device only: force, torque",
    unit::kWrench);
  a("tracking", record.tracking, "tracking of the reference by the device");
  a("collision", record.collision, "distance to a collision if the device brakes now");
  a("passivity", record.passivity, "energy and oscillation at the handle");
  a("contact", record.contact, "contact of the twin with virtual surfaces");
  a("touch", record.touch, "contact of the arm anywhere but at the handle");
  a("q_p_target", record.q_p_target, "gantry target of prepositioning", unit::kJointPosition);
  a("solver_status", record.solver_status);
  a("solver_iterations", record.solver_iterations, "active sets of all solves of this cycle");
  a("active_set_changes", record.active_set_changes, "limit rows in another state than before");
  a("state_hash", record.state_hash, "hash of the state after this cycle; equal in a replay");
  a("inertial", record.inertial, "estimates from inertial units on the links");
  a("felt_scale", record.felt_scale, "factors of the user's wrench on the twin", unit::kNone);
  a("rest", record.rest, "drift of the force sensor");
}

/// Complete record of one cycle.
struct Sample {
  SensorFrame sensors;
  OperatorFrame operator_input;
  CommandFrame command;
  CycleRecord record;
  Truth truth;
  TeleoperationReport teleoperation;
  double cycle_time_us = 0.0;
};

template <typename Archive, Is<Sample> T>
void fields(Archive& a, T& sample) {
  a("sensors", sample.sensors, "input of the cycle");
  a("operator_input", sample.operator_input, "input of the cycle");
  a("command", sample.command, "output of the cycle");
  a("record", sample.record, "results of the cycle");
  a("truth", sample.truth,
    "ground truth of a simulation at the time of the sensors; not part of a replay");
  a("teleoperation", sample.teleoperation,
    "the other side of a teleoperation before the cycle; not part of a replay");
  a("cycle_time_us", sample.cycle_time_us,
    "duration of the cycle as measured by the runtime; not part of a replay", unit::kUs);
}

}  // namespace hg
