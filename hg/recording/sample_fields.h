/// The fields of the record of a cycle and of the whole sample, and the message of an event; see
/// message.h for the rules.
#pragma once

#include <string>
#include <string_view>

#include "hg/recording/input_fields.h"
#include "hg/recording/message.h"
#include "hg/signals/state.h"

namespace hg::recording {

/// Noteworthy event in a recording.
struct Event {
  double time_s = 0.0;
  std::string name, text;
};

template <>
inline constexpr std::string_view kMessageName<Budget> = "hapticgiant_msgs/Budget";
template <>
inline constexpr std::string_view kMessageName<LimitReport> = "hapticgiant_msgs/LimitReport";
template <>
inline constexpr std::string_view kMessageName<TrackingReport> = "hapticgiant_msgs/TrackingReport";
template <>
inline constexpr std::string_view kMessageName<InertialReport> = "hapticgiant_msgs/InertialReport";
template <>
inline constexpr std::string_view kMessageName<CollisionReport> =
    "hapticgiant_msgs/CollisionReport";
template <>
inline constexpr std::string_view kMessageName<PassivityReport> =
    "hapticgiant_msgs/PassivityReport";
template <>
inline constexpr std::string_view kMessageName<ContactReport> = "hapticgiant_msgs/ContactReport";
template <>
inline constexpr std::string_view kMessageName<TouchReport> = "hapticgiant_msgs/TouchReport";
template <>
inline constexpr std::string_view kMessageName<BystanderReport> =
    "hapticgiant_msgs/BystanderReport";
template <>
inline constexpr std::string_view kMessageName<CycleRecord> = "hapticgiant_msgs/CycleRecord";
template <>
inline constexpr std::string_view kMessageName<Truth> = "hapticgiant_msgs/Truth";
template <>
inline constexpr std::string_view kMessageName<Sample> = "hapticgiant_msgs/Sample";
template <>
inline constexpr std::string_view kMessageName<Event> = "hapticgiant_msgs/Event";

template <typename Archive, Is<Budget> T>
void fields(Archive& a, T& budget) {
  a("inertia", budget.inertia, "parts of J_a^T w in twin joint space, Nm or N");
  a("damping", budget.damping);
  a("friction", budget.friction);
  a("spring", budget.spring);
  a("surface", budget.surface);
  a("limits", budget.limits);
  a("conflict", budget.conflict);
  a("structure", budget.structure, "part of the wrench that the twin's bearings carry");
}

template <typename Archive, Is<LimitReport> T>
void fields(Archive& a, T& report) {
  a("state", report.state);
  a("cause", report.cause);
  a("position", report.position, "of the limited quantity, rad or m");
  a("to_lower", report.to_lower, "distance left to the limit as rendered");
  a("to_upper", report.to_upper);
  a("excess", report.excess, "how far it is outside its range");
  a("slack", report.slack, "acceleration by which its row misses the bound");
  a("reaction", report.reaction, "constraint force N or torque Nm");
}

template <typename Archive, Is<TrackingReport> T>
void fields(Archive& a, T& tracking) {
  a("error", tracking.error, "reference minus link side, rad");
  a("torque_share", tracking.torque_share, "motor torque asked for over its peak");
  a("torque_unexplained", tracking.torque_unexplained, "by motion and user's wrench, mean, Nm");
  a("latency_s", tracking.latency_s, "of the torque loop, as measured");
  a("is_clamped", tracking.is_clamped, "the reference was brought back to the device");
}

template <typename Archive, Is<CollisionReport> T>
void fields(Archive& a, T& collision) {
  a("distance", collision.distance, "smallest while braking from now on, m");
  a("pair", collision.pair, "index among the pairs that are watched; -1 none");
}

template <typename Archive, Is<PassivityReport> T>
void fields(Archive& a, T& passivity) {
  a("tank", passivity.tank, "energy that the rendering may still give, J");
  a("energy", passivity.energy, "given through the handle and not got back, J");
  a("oscillation", passivity.oscillation, "index; 1 = detected");
  a("damping", passivity.damping, "added to calm the twin, Ns/m");
  a("inertia", passivity.inertia, "factor on the masses of the twin, to calm it");
}

template <typename Archive, Is<ContactReport> T>
void fields(Archive& a, T& contact) {
  a("force", contact.force, "of virtual surfaces on the handle, N");
  a("proxy", contact.proxy, "nearest to the handle outside of all surfaces, m");
  a("surface", contact.surface, "that pushes most, in the order of the scenario; -1 none");
}

template <typename Archive, Is<TouchReport> T>
void fields(Archive& a, T& touch) {
  a("torque", touch.torque, "on the joints by what touches the arm, Nm; empty: not felt for");
  a("share", touch.share, "of the joint's threshold, the largest");
  a("is_told", touch.is_told, "something touches the arm, which gives way");
  a("joint", touch.joint, "the last one that feels it, whose link is touched; -1 none");
  a("wrench", touch.wrench, "on the handle, that does the same to the joints");
}

template <typename Archive, Is<InertialReport> T>
void fields(Archive& a, T& inertial) {
  a("q", inertial.q, "all joints, the gantry's first, rad or m; empty without units");
  a("dq", inertial.dq, "rad/s or m/s");
  a("ddq", inertial.ddq, "rad/s^2 or m/s^2");
  a("bend", inertial.bend, "of the root, resolved in the base: m, rad");
  a("bend_rate", inertial.bend_rate, "m/s, rad/s");
  a("bend_acceleration", inertial.bend_acceleration, "m/s^2, rad/s^2");
  a("trust", inertial.trust, "share with which each unit takes part, 0..1");
}

template <typename Archive, Is<CycleRecord> T>
void fields(Archive& a, T& record) {
  a("cycle", record.cycle);
  a("time_s", record.time_s, "nominal time; the log time is this plus the start of the run");
  a("mode", record.mode);
  a("is_autonomous", record.is_autonomous, "runs with nobody at the handle");
  a("stop", record.stop);
  a("fault", record.fault);
  a("warning", record.warning, "the rule nearest to its threshold, beyond its warning");
  a("sanitised", record.sanitised, "bit i: command of joint i was changed; from bit 16: gantry");
  a("change", record.change, "of a parameter");
  a("tare", record.tare);
  a("is_tared", record.is_tared, "a tare is there, or this device needs none");
  a("is_latency_known", record.is_latency_known, "of the torque loop, or there is none");
  a("refusal", record.refusal, "of the request");
  a("robot", record.robot, "estimated state of the device");
  a("reference", record.reference, "integrated reference of the manipulator");
  a("twin", record.twin);
  a("handle", record.T_B_H, "handle in the base frame, at the reference");
  a("twin_end", record.T_B_E, "end effector of the twin in the base frame");
  a("v_h", record.v_H, "its velocity, m/s");
  a("a_h", record.a_H, "its acceleration, m/s^2");
  a("p_b_elbow", record.p_B_elbow, "m");
  a("sync_error", record.sync_error, "distance of handle and twin, m");
  a("sync_error_angle", record.sync_error_angle, "rad");
  a("tau_a", record.tau_a, "J_a^T w, Nm or N");
  a("budget", record.budget, "where the user's wrench goes");
  a.sequence("limits", record.limits, record.limit_count, "in the order of metadata \"limits\"");
  a("felt_limit", record.felt_limit, "the limit that the user feels most, -1 none");
  a("w_felt", record.w_felt, "its reaction as a wrench on the handle");
  a("tracking", record.tracking, "how well the device follows");
  a("collision", record.collision);
  a("passivity", record.passivity);
  a("contact", record.contact);
  a("touch", record.touch);
  a("q_p_target", record.q_p_target, "where prepositioning wants the gantry, m");
  a("solver_status", record.solver_status);
  a("solver_iterations", record.solver_iterations);
  a("active_set_changes", record.active_set_changes);
  a("state_hash", record.state_hash, "equal in a replay");
  a("inertial", record.inertial, "what inertial units on the links say");
}

template <typename Archive, Is<BystanderReport> T>
void fields(Archive& a, T& bystander) {
  a("force", bystander.force, "of the arm on the body, N");
  a("pressure", bystander.pressure, "N/cm^2");
  a("compression", bystander.compression, "of the body, m");
}

template <typename Archive, Is<Truth> T>
void fields(Archive& a, T& truth) {
  a("is_known", truth.is_known, "false: the device is real");
  a("q_m", truth.q_m, "link side, rad");
  a("dq_m", truth.dq_m, "rad/s");
  a("theta_m", truth.theta_m, "motor side, rad");
  a("dtheta_m", truth.dtheta_m, "rad/s");
  a("tau_j", truth.tau_J, "transmitted by the springs, Nm");
  a("tau_motor", truth.tau_motor, "Nm");
  a("q_p", truth.q_p, "gantry, m");
  a("dq_p", truth.dq_p, "m/s");
  a("ddq_p", truth.ddq_p, "m/s^2");
  a("handle", truth.T_B_H);
  a("twist", truth.twist, "of the handle: m/s, rad/s");
  a("acceleration", truth.acceleration, "of the handle: m/s^2, rad/s^2");
  a("w_h", truth.w_H, "wrench of the user at the handle: N, Nm");
  a("bystander", truth.bystander, "whom the arm hits");
}

template <typename Archive, Is<Sample> T>
void fields(Archive& a, T& sample) {
  a("sensors", sample.sensors, "input of the cycle");
  a("operator_input", sample.operator_input, "input of the cycle");
  a("command", sample.command, "output of the cycle");
  a("record", sample.record);
  a("truth", sample.truth, "what only a simulation knows; not part of a replay");
  a("cycle_time_us", sample.cycle_time_us, "measured, not part of a replay");
}

template <typename Archive, Is<Event> T>
void fields(Archive& a, T& event) {
  a("time_s", event.time_s, "nominal time of the run");
  a("name", event.name);
  a("text", event.text);
}

}  // namespace hg::recording
