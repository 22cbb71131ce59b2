/// Parts of a Frame. See message.h for the rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"
#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

template <>
inline constexpr auto kWords<Mode> =
    std::to_array<std::string_view>({"off", "ready", "armed", "running", "stopping", "fault"});
template <>
inline constexpr auto kWords<Stop> = std::to_array<std::string_view>({"none", "SS2", "SS1", "STO"});
template <>
inline constexpr auto kWords<LimitState> = std::to_array<std::string_view>({"inactive", "lower",
                                                                            "upper", "violated"});
template <>
inline constexpr auto kWords<LimitCause> =
    std::to_array<std::string_view>({"none", "position", "velocity", "acceleration", "lock",
                                     "latch", "friction", "contradiction", "torque"});

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

struct ContactMessage {
  int surface = -1;
  Vec3 force{}, proxy{};
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

struct SafetyMessage {
  Stop stop = Stop::kNone;
  bool is_autonomous = false;
  int fault = 0;
  std::string cause, release, warning;
  bool emergency_stop = false;
  std::vector<std::uint64_t> stop_pressed_by;
  bool operator_enable = true, override_key = false, person_in_field = false;
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

template <>
inline constexpr Interface kInterface<FeltLimitMessage> = {"FeltLimit", "what is felt most"};
template <>
inline constexpr Interface kInterface<ActiveLimitMessage> = {"ActiveLimit", "a limit that acts"};
template <>
inline constexpr Interface kInterface<ContactMessage> = {"Contact", "with virtual surfaces"};
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
inline constexpr Interface kInterface<SafetyMessage> = {
    "Safety", "what stops the device, and the panel of its simulated operator"};
template <>
inline constexpr Interface kInterface<GhostMessage> = {"Ghost", "a second recording, compared"};

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

template <typename Archive, Is<ContactMessage> T>
void fields(Archive& a, T& contact) {
  a("surface", contact.surface, "in Scene.surfaces, the one that pushes most");
  a("force_N", contact.force, "of all of them on the handle");
  a("proxy_m", contact.proxy, "where the handle would be if they were hard");
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
  a("surface", budget.surface, "virtual surfaces and the reference wrench of the twin");
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
  a("position_s", state.position_s, "of the run, also of a recorded one");
  a("recording", state.recording, "name of the file that is written or played; empty = none");
}

template <typename Archive, Is<SafetyMessage> T>
void fields(Archive& a, T& safety) {
  a("stop", safety.stop, "how it is being stopped, or was");
  a("is_autonomous", safety.is_autonomous, "runs with nobody at the handle");
  a("fault", safety.fault, "number of the cause; 0 = none");
  a("cause", safety.cause, "with value and limit; empty = none");
  a("release", safety.release, "what has to happen before a reset");
  a("warning", safety.warning, "the rule nearest to its threshold; empty = all are far from it");
  a("emergency_stop", safety.emergency_stop, "a button is pressed");
  a("stop_pressed_by", safety.stop_pressed_by, "pages, which may be gone; 0 = the script");
  a("operator_enable", safety.operator_enable, "the switch is held");
  a("override_key", safety.override_key, "the key is turned");
  a("person_in_field", safety.person_in_field, "besides the user");
}

template <typename Archive, Is<GhostMessage> T>
void fields(Archive& a, T& ghost) {
  a("time_s", ghost.time_s);
  a("q_device", ghost.q_device);
  a("q_twin", ghost.q_twin);
  a("p_B_H_m", ghost.p_B_H);
  a("force_N", ghost.force);
}

}  // namespace hg::viewer_server
