/// Frame: what happens now, 60 times a second. See message.h for the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"
#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

template <>
inline constexpr auto kWords<Mode> =
    std::to_array<std::string_view>({"off", "ready", "armed", "running", "stopping", "fault"});
template <>
inline constexpr auto kWords<LimitState> = std::to_array<std::string_view>({"inactive", "lower",
                                                                            "upper", "violated"});
template <>
inline constexpr auto kWords<LimitCause> = std::to_array<std::string_view>(
    {"none", "position", "velocity", "acceleration", "lock", "latch", "friction", "contradiction"});

struct FeltLimitMessage {
  int index = 0;
  std::string name, text;
  Vec3 force{}, torque{};
};

struct ActiveLimitMessage {
  int index = 0;
  LimitState state = LimitState::kInactive;
  LimitCause cause = LimitCause::kNone;
  double reaction = 0.0, excess = 0.0;
  std::string text;
};

struct WrenchMessage {
  Vec3 force{}, torque{};
};

struct BudgetMessage {
  WrenchMessage user, inertia, damping, spring, friction, surface, limits, conflict, structure,
      rest;
};

struct SingularityMessage {
  double measure = 0.0;
  int limit = -1;
};

struct RunStateMessage {
  bool is_paused = false;
  double speed = 1.0;
  bool is_over = false;
  double position_s = 0.0;
  std::string recording;
};

struct GhostMessage {
  double time_s = 0.0;
  std::vector<double> q_device, q_twin;
  Vec3 p_B_H{}, force{};
};

struct FrameMessage {
  std::uint64_t run = 0;
  double time_s = 0.0;
  Mode mode = Mode::kOff;
  std::string mode_text, fault, status;
  std::vector<double> q_device, q_measured, dq_device, dq_measured, tau_measured, q_twin, dq_twin;
  std::vector<double> q_gantry_target, tracking_error;
  bool is_clamped = false;
  Vec3 p_B_H{}, v_H{}, p_B_E{}, p_B_elbow{}, force{}, torque{};
  Quaternion quaternion_B_H{}, quaternion_B_E{};
  std::optional<FeltLimitMessage> felt;
  std::vector<ActiveLimitMessage> active;
  std::vector<double> limit_position;
  std::vector<std::optional<double>> limit_distance;
  BudgetMessage budget;
  std::optional<SingularityMessage> singularity;
  double sync_error_mm = 0.0, sync_error_deg = 0.0, cycle_time_us = 0.0, cycle_time_max_us = 0.0;
  HandMessage hand;
  RunStateMessage run_state;
  std::uint64_t clients = 0;
  std::optional<GhostMessage> ghost;
};

template <>
inline constexpr Interface kInterface<FeltLimitMessage> = {"FeltLimit", "what is felt most"};
template <>
inline constexpr Interface kInterface<ActiveLimitMessage> = {"ActiveLimit", "a limit that acts"};
template <>
inline constexpr Interface kInterface<WrenchMessage> = {"Wrench", "on the hand, at H, in B"};
template <>
inline constexpr Interface kInterface<BudgetMessage> = {
    "Budget", "user = inertia + damping + ... + structure + rest"};
template <>
inline constexpr Interface kInterface<SingularityMessage> = {"Singularity", "of the manipulator"};
template <>
inline constexpr Interface kInterface<RunStateMessage> = {"RunState", "what commands have made"};
template <>
inline constexpr Interface kInterface<GhostMessage> = {"Ghost", "a second recording, compared"};
template <>
inline constexpr Interface kInterface<FrameMessage> = {"Frame", "program -> page, at update_rate"};

template <typename Archive, Is<FeltLimitMessage> T>
void fields(Archive& a, T& felt) {
  a("index", felt.index, "in Scene.limits");
  a("name", felt.name);
  a("text", felt.text, "elbow x: upper limit, 23 N");
  a("force_N", felt.force, "of its reaction on the hand; zero for limits of the twin");
  a("torque_Nm", felt.torque);
}

template <typename Archive, Is<ActiveLimitMessage> T>
void fields(Archive& a, T& limit) {
  a("index", limit.index, "in Scene.limits");
  a("state", limit.state);
  a("cause", limit.cause);
  a("reaction", limit.reaction, "Nm or N, in its own coordinate");
  a("excess", limit.excess, "outside its range by this, rad or m");
  a("text", limit.text);
}

template <typename Archive, Is<WrenchMessage> T>
void fields(Archive& a, T& wrench) {
  a("force_N", wrench.force);
  a("torque_Nm", wrench.torque);
}

template <typename Archive, Is<BudgetMessage> T>
void fields(Archive& a, T& budget) {
  a("user", budget.user, "what the user exerts");
  a("inertia", budget.inertia, "what the motion of the twin takes, with its weight");
  a("damping", budget.damping);
  a("spring", budget.spring, "springs and closers");
  a("friction", budget.friction, "while slipping; held joints are limits");
  a("surface", budget.surface, "reference wrench of the twin");
  a("limits", budget.limits, "all limits that act");
  a("conflict", budget.conflict, "limits that could not be met");
  a("structure", budget.structure, "carried by the bearings of the twin");
  a("rest", budget.rest, "what is left of the sum: 0 while running, else what nothing explains");
}

template <typename Archive, Is<SingularityMessage> T>
void fields(Archive& a, T& singularity) {
  a("measure", singularity.measure, "0 = singular, 1 = as far from it as this device gets");
  a("limit", singularity.limit, "in Scene.limits, what keeps it away; -1 = none");
}

template <typename Archive, Is<RunStateMessage> T>
void fields(Archive& a, T& state) {
  a("is_paused", state.is_paused);
  a("speed", state.speed, "simulated (or recorded) seconds per second");
  a("is_over", state.is_over, "stopped, a fault, or the end of a recording");
  a("position_s", state.position_s, "in the recording that is played; else time_s");
  a("recording", state.recording, "name of the file that is written or played; empty = none");
}

template <typename Archive, Is<GhostMessage> T>
void fields(Archive& a, T& ghost) {
  a("time_s", ghost.time_s);
  a("q_device", ghost.q_device);
  a("q_twin", ghost.q_twin);
  a("p_B_H_m", ghost.p_B_H);
  a("force_N", ghost.force);
}

template <typename Archive, Is<FrameMessage> T>
void fields(Archive& a, T& frame) {
  a.type("frame");
  a("run", frame.run, "Scene.run that this belongs to");
  a("time_s", frame.time_s);
  a("mode", frame.mode);
  a("mode_text", frame.mode_text, "the mode and its cause in words");
  a("fault", frame.fault, "empty = none");
  a("status", frame.status, "one line from the program");
  a("q_device", frame.q_device, "rad or m: gantry, then reference of the manipulator");
  a("q_measured", frame.q_measured, "rad or m: gantry, then manipulator");
  a("dq_device", frame.dq_device, "rad/s or m/s, as q_device");
  a("dq_measured", frame.dq_measured, "rad/s or m/s, as q_measured; the gantry's speed");
  a("tau_measured_Nm", frame.tau_measured, "of the manipulator's joints; empty = no sensors");
  a("q_twin", frame.q_twin, "rad or m");
  a("dq_twin", frame.dq_twin, "rad/s or m/s; a floating joint has 6, in its own frame");
  a("q_gantry_target_m", frame.q_gantry_target, "where prepositioning wants the gantry");
  a("tracking_error", frame.tracking_error, "rad or m, reference minus measured, manipulator");
  a("is_clamped", frame.is_clamped, "tracking was lost: the reference waits for the device");
  a("p_B_H_m", frame.p_B_H, "handle, at the reference");
  a("quaternion_B_H", frame.quaternion_B_H);
  a("v_H_m_per_s", frame.v_H);
  a("p_B_E_m", frame.p_B_E, "end effector of the twin");
  a("quaternion_B_E", frame.quaternion_B_E);
  a("p_B_elbow_m", frame.p_B_elbow);
  a("force_N", frame.force, "of the user on the handle, in B");
  a("torque_Nm", frame.torque);
  a("felt", frame.felt);
  a("active", frame.active, "limits that act");
  a("limit_position", frame.limit_position, "rad or m, in the order of Scene.limits");
  a("limit_distance", frame.limit_distance, "to the nearer end, with margin; null = unbounded");
  a("budget", frame.budget, "why do I feel this?");
  a("singularity", frame.singularity);
  a("sync_error_mm", frame.sync_error_mm, "between handle and twin");
  a("sync_error_deg", frame.sync_error_deg);
  a("cycle_time_us", frame.cycle_time_us);
  a("cycle_time_max_us", frame.cycle_time_max_us, "since the frame before");
  a("hand", frame.hand);
  a("run_state", frame.run_state);
  a("clients", frame.clients, "pages that are connected");
  a("ghost", frame.ghost);
}

}  // namespace hg::viewer_server
