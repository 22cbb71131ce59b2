#include "apps/hapticgiant/experiments/condition_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace hg::apps {
namespace {

const char* kind_name(ConditionKind kind) {
  switch (kind) {
    case ConditionKind::kLimit:
      return "limit";
    case ConditionKind::kSpeedLimit:
      return "speed_limit";
    case ConditionKind::kLocked:
      return "locked";
    case ConditionKind::kForceAbove:
      return "force_above_N";
    case ConditionKind::kForceBelow:
      return "force_below_N";
    case ConditionKind::kTwinAbove:
      return "twin_above";
    case ConditionKind::kTwinBelow:
      return "twin_below";
    case ConditionKind::kTurns:
      return "turns";
    case ConditionKind::kGantryAbove:
      return "gantry_above_m";
    case ConditionKind::kGantryBelow:
      return "gantry_below_m";
    case ConditionKind::kElapsed:
      return "elapsed_s";
    case ConditionKind::kHandleAt:
      return "handle_at";
  }
  return "";
}

// name of the limit or joint of the condition; empty = none
std::string subject(const Condition& condition, const config::Scenario& scenario) {
  const auto i = static_cast<std::size_t>(condition.index);
  const DeviceModel& device = scenario.device.model;
  switch (condition.kind) {
    case ConditionKind::kLimit:
    case ConditionKind::kSpeedLimit:
    case ConditionKind::kLocked:
      return scenario.limits[i].name;
    case ConditionKind::kTwinAbove:
    case ConditionKind::kTwinBelow:
      for (const rendering::TwinDof& dof : scenario.twin.model.dofs) {
        if (dof.q_index == condition.index) return dof.name;
      }
      return fmt::format("coordinate {} of the twin", condition.index);
    case ConditionKind::kTurns:
      return device.manipulator_joint(condition.index);
    case ConditionKind::kGantryAbove:
    case ConditionKind::kGantryBelow:
      return device.chain.joints()[i].name;
    case ConditionKind::kForceAbove:
    case ConditionKind::kForceBelow:
    case ConditionKind::kElapsed:
    case ConditionKind::kHandleAt:
      return {};
  }
  return {};
}

const char* side_text(LimitState side) {
  return side == LimitState::kLower ? "lower " : side == LimitState::kUpper ? "upper " : "";
}

bool is_angle(const Condition& condition, const config::Scenario& scenario) {
  const std::string name = subject(condition, scenario);
  for (const rendering::TwinDof& dof : scenario.twin.model.dofs) {
    if (dof.name == name) return dof.is_angle;
  }
  return true;
}

std::string text_of(const Condition& c, const config::Scenario& scenario) {
  const std::string name = subject(c, scenario);
  switch (c.kind) {
    case ConditionKind::kLimit:
      return fmt::format(
          "{} within {} of its {}limit, which acts", name,
          scenario.limits[static_cast<std::size_t>(c.index)].is_angle ? "5 mrad" : "2 mm",
          side_text(c.side));
    case ConditionKind::kSpeedLimit:
      return fmt::format("the {}speed limit of {} acts", side_text(c.side), name);
    case ConditionKind::kLocked:
      return fmt::format("a lock holds {}", name);
    case ConditionKind::kForceAbove:
      return fmt::format("force of the user > {:g} N", c.value);
    case ConditionKind::kForceBelow:
      return fmt::format("force of the user < {:g} N", c.value);
    case ConditionKind::kTwinAbove:
    case ConditionKind::kTwinBelow:
      return fmt::format("{} {} {:g} {}", name, c.kind == ConditionKind::kTwinAbove ? '>' : '<',
                         c.value, is_angle(c, scenario) ? "rad" : "m");
    case ConditionKind::kTurns:
      return fmt::format("{} has turned by {:g} turn{} since the start", name, c.value,
                         std::abs(c.value) == 1.0 ? "" : "s");
    case ConditionKind::kGantryAbove:
      return fmt::format("gantry {} > {:g} m", name, c.value);
    case ConditionKind::kGantryBelow:
      return fmt::format("gantry {} < {:g} m", name, c.value);
    case ConditionKind::kElapsed:
      return fmt::format("at least {:g} s after the hand has taken the handle", c.value);
    case ConditionKind::kHandleAt:
      return fmt::format(
          "handle within 0.10 m and 15 degrees of x {:g} m, y {:g} m, azimuth {:.0f} "
          "degrees",
          c.place.x(), c.place.y(), c.place.z() * 180.0 / std::numbers::pi);
  }
  return {};
}

}  // namespace

std::string condition_text(const EventRule& rule, const config::Scenario& scenario) {
  std::string text;
  for (const Condition& condition : rule.all_of) {
    text += (text.empty() ? "" : " and ") + text_of(condition, scenario);
  }
  return text;
}

nlohmann::ordered_json condition_json(const EventRule& rule, const config::Scenario& scenario) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Condition& c : rule.all_of) {
    nlohmann::ordered_json json = {{"kind", kind_name(c.kind)}};
    if (const std::string name = subject(c, scenario); !name.empty()) json["of"] = name;
    const bool has_side = c.kind == ConditionKind::kLimit || c.kind == ConditionKind::kSpeedLimit;
    if (has_side) json["side"] = c.side == LimitState::kInactive ? "either" : to_string(c.side);
    if (c.kind == ConditionKind::kHandleAt) {
      json["place"] = {{"x_m", c.place.x()}, {"y_m", c.place.y()}, {"azimuth_rad", c.place.z()}};
    } else if (!has_side && c.kind != ConditionKind::kLocked) {
      json["value"] = c.value;
    }
    all.push_back(json);
  }
  return all;
}

std::string paper_label(const EventRule& rule) {
  if (rule.name.starts_with("t_")) return rule.name;
  if (rule.what.starts_with("t_")) return rule.what.substr(0, rule.what.find(':'));
  return rule.name;
}

}  // namespace hg::apps
