/// Parts of a Frame. See message.h for the rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"
#include "hg/viewer_server/message.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

struct FeltLimitMessage {
  int index = 0;
  std::string name, text;
  Vector6 w = Vector6::Zero();
};

struct ActiveLimitMessage {
  int index = 0;
  LimitReport report;
  std::string text;
};

struct SafetyMessage {
  Stop stop = Stop::kNone;
  bool is_autonomous = false;
  int fault = 0;
  std::string cause, release, warning;
  bool emergency_stop = false;
  std::vector<std::uint64_t> stop_pressed_by;
  SafetyPanel panel;
};

struct GhostMessage {
  double time_s = 0.0;
  std::vector<double> q_device, q_twin;
  Vec3 p_B_H{}, force{};
};

template <>
inline constexpr Interface kInterface<FeltLimitMessage> = {
    "FeltLimit", "limit that the user feels most; no wrench for limits of the twin"};
template <>
inline constexpr Interface kInterface<ActiveLimitMessage> = {"ActiveLimit", "active limit"};
template <>
inline constexpr Interface kInterface<ContactReport> = {"Contact", "contact with virtual surfaces"};
template <>
inline constexpr Interface kInterface<HandBudget> = {
    "Budget", "user = inertia + damping + ... + structure + rest"};
template <>
inline constexpr Interface kInterface<Singularity> = {
    "Singularity", "distance of the manipulator from a singularity"};
template <>
inline constexpr Interface kInterface<RunState> = {"RunState",
                                                   "state of the run as set by commands"};
template <>
inline constexpr Interface kInterface<SafetyMessage> = {
    "Safety", "cause of a stop, and the panel of the simulated operator"};
template <>
inline constexpr Interface kInterface<GhostMessage> = {"Ghost",
                                                       "second recording, overlaid for comparison"};

template <typename Archive, Is<FeltLimitMessage> T>
void fields(Archive& a, T& felt) {
  a("index", felt.index, "index in Scene.limits");
  a("name", felt.name);
  a("text", felt.text, "elbow x: upper limit, 23 N");
  fields(a, felt.w);
}

template <typename Archive, Is<ActiveLimitMessage> T>
void fields(Archive& a, T& limit) {
  a("index", limit.index, "index in Scene.limits");
  pass_some(a, limit.report, {"state", "cause", "reaction", "excess"});
  a("text", limit.text);
}

template <typename Archive, Is<SafetyMessage> T>
void fields(Archive& a, T& safety) {
  a("stop", safety.stop, "kind of the present or last stop");
  a("is_autonomous", safety.is_autonomous, "runs autonomously, with a free handle");
  a("fault", safety.fault, "number of the cause; 0 = none");
  a("cause", safety.cause, "cause with value and limit; empty = none");
  a("release", safety.release, "conditions for a reset");
  a("warning", safety.warning, "rule nearest to its threshold; empty = all are far from it");
  a("emergency_stop", safety.emergency_stop, "an emergency stop is pressed");
  a("stop_pressed_by", safety.stop_pressed_by, "pages that pressed it, perhaps gone; 0 = script");
  pass_some(a, safety.panel, {"operator_enable", "override_key", "person_in_field"});
}

template <typename Archive, Is<GhostMessage> T>
void fields(Archive& a, T& ghost) {
  a("time_s", ghost.time_s, "time of its run, s");
  a("q_device", ghost.q_device, "gantry, then reference of the manipulator, rad or m");
  a("q_twin", ghost.q_twin, "coordinates of the twin, rad or m");
  a("p_B_H_m", ghost.p_B_H);
  a("force_N", ghost.force);
}

}  // namespace hg::viewer_server
