/// Description of scenario.yaml.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/simulation/bystander_schema.h"
#include "hg/config/simulation/change_schema.h"
#include "hg/config/simulation/injection_schema.h"
#include "hg/config/simulation/panel_schema.h"
#include "hg/config/simulation/surface_schema.h"
#include "hg/config/simulation/teleoperation_schema.h"
#include "hg/config/simulation/twin_motion_schema.h"
#include "hg/config/sources.h"
#include "hg/signals/event_rule.h"
#include "hg/simulator/person/person.h"

namespace hg::config {

/// Names that events may use, and their meaning.
struct EventNames {
  std::vector<std::string> limits;       ///< limits of the catalogue
  std::vector<std::string> twin_joints;  ///< twin joints that are not floating
  std::vector<int> twin_limits;          ///< indices of the twin joints in the catalogue
  std::vector<int> twin_coordinates;     ///< indices of the twin joints in q_a
  std::vector<std::string> manipulator;
  std::vector<std::string> gantry;
  std::vector<std::string> surfaces;
};

/// Content of scenario.yaml, before it becomes a Scenario.
struct ScenarioDraft {
  std::string title, description;
  std::filesystem::path device, twin, script;
  person::PersonKind person = person::PersonKind::kScript;
  double duration_s = 0.0;
  EventNames names;
  std::vector<EventRule> events;
  std::optional<simulator::MovingBaseConfig> twin_motion;
  bool moves() const { return twin_motion.has_value(); }
};

inline constexpr std::array<Choice<person::PersonKind>, 2> kPersons = {
    {{"mouse", person::PersonKind::kMouse}, {"none", person::PersonKind::kNone}}};
inline constexpr std::array<Choice<LimitState>, 2> kSides = {
    {{"lower", LimitState::kLower}, {"upper", LimitState::kUpper}}};

template <class V>
void describe_parts(V& v, ScenarioDraft& d) {
  v.words("title", d.title, "one line", Need::kRequired);
  v.words("description", d.description, "one sentence", Need::kRequired);
  v.path("device", d.device, "device.yaml", Need::kRequired);
  v.path("twin", d.twin, "twin.yaml", Need::kRequired);
  v.path_or_choice("person", d.script, d.person, kPersons,
                   "script.yaml of the hand, or mouse, or none", Need::kRequired);
  v.number("duration_s", d.duration_s, kPositive,
           "length of the run, from when a scripted hand takes the handle", Need::kRequired);
  describe_twin_motion(v, d.twin_motion);
}

/// Conditions on single limits and surfaces.
template <class V>
void describe_limit_conditions(V& v, const EventNames& names, EventRule& event) {
  LimitState side = LimitState::kInactive;
  v.choice("side", side, kSides, "of limit and speed_limit; without it either side");
  int index = 0;
  if (v.name("limit", index, names.limits, "a limit", "this limit is felt")) {
    event.all_of.push_back({.kind = ConditionKind::kLimit, .index = index, .side = side});
  }
  if (v.name("speed_limit", index, names.limits, "a limit", "its largest speed is felt")) {
    event.all_of.push_back({.kind = ConditionKind::kSpeedLimit, .index = index, .side = side});
  }
  if (v.name("locked", index, names.twin_joints, "a joint of the twin", "a lock holds it")) {
    const int limit = names.twin_limits[index];
    event.all_of.push_back({.kind = ConditionKind::kLocked, .index = limit});
  }
  if (v.name("surface", index, names.surfaces, "a surface of the scenario",
             "of all virtual surfaces this one pushes the twin most")) {
    event.all_of.push_back({.kind = ConditionKind::kSurface, .index = index});
  }
}

template <class V>
void describe_conditions(V& v, const EventNames& names, EventRule& event) {
  describe_limit_conditions(v, names, event);
  const auto number = [&](const char* key, ConditionKind kind, const char* text) {
    double value = kNoDefault;
    if (v.number(key, value, kNotNegative, text)) {
      event.all_of.push_back({.kind = kind, .value = value});
    }
  };
  const auto by_name = [&](const char* key, ConditionKind kind, const std::vector<std::string>& of,
                           const char* what, const char* text) {
    v.numbers_by_name(
        key, of, what, kJointPosition,
        [&](int index, double value) {
          const bool is_twin =
              kind == ConditionKind::kTwinAbove || kind == ConditionKind::kTwinBelow;
          if (is_twin) index = names.twin_coordinates[index];
          event.all_of.push_back({.kind = kind, .index = index, .value = value});
        },
        text);
  };
  number("force_above_N", ConditionKind::kForceAbove, "norm of the user's force");
  number("force_below_N", ConditionKind::kForceBelow, "norm of the user's force");
  by_name("twin_above", ConditionKind::kTwinAbove, names.twin_joints, "a joint of the twin",
          "positions in rad or m");
  by_name("twin_below", ConditionKind::kTwinBelow, names.twin_joints, "a joint of the twin",
          "positions in rad or m");
  by_name("turns", ConditionKind::kTurns, names.manipulator, "a manipulator joint",
          "full turns since the start, with sign");
  by_name("gantry_above", ConditionKind::kGantryAbove, names.gantry, "a gantry joint",
          "positions in m");
  by_name("gantry_below", ConditionKind::kGantryBelow, names.gantry, "a gantry joint",
          "positions in m");
  number("elapsed_s", ConditionKind::kElapsed, "time since the device began to run");
  v.group(
      "handle_at",
      [&](auto& child) {
        Condition& at = event.all_of.emplace_back();
        at.kind = ConditionKind::kHandleAt;
        child.number("x_m", at.place.x(), kAnyNumber, "in B", Need::kRequired);
        child.number("y_m", at.place.y(), kAnyNumber, "in B", Need::kRequired);
        child.number("azimuth_rad", at.place.z(), kAnyNumber, "of the hand axis about z of B",
                     Need::kRequired);
      },
      "the handle is nearer than 0.10 m and 15 degrees");
  v.rule(!event.all_of.empty(), "", "an event needs at least one condition");
}

template <class V>
void describe_events(V& v, ScenarioDraft& d) {
  v.list(
      "events",
      [&](auto& child) {
        EventRule& event = d.events.emplace_back();
        child.words("name", event.name, "short, for example t_a", Need::kRequired);
        child.words("what", event.what, "one sentence for people", Need::kRequired);
        child.group(
            "when", [&](auto& conditions) { describe_conditions(conditions, d.names, event); },
            "conditions, all true at the same time", Need::kRequired);
      },
      "expected events: each is looked for once the one before it has happened");
}

}  // namespace hg::config
