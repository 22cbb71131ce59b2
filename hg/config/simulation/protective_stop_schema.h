/// Description of the protective stop of a simulated remote machine.
#pragma once

#include <string_view>

#include "hg/config/schema.h"
#include "hg/teleoperation/machine.h"

namespace hg::config {

// A key of a protective stop, and what it means.
struct StopKey {
  std::string_view name, text;
};
struct StopKeys {
  StopKey beyond, speed, acceleration, force;
};
inline constexpr StopKeys kToolStops = {
    {"beyond_m", "tool: so far out of its range"},
    {"speed_m_per_s", "tool: when it is faster"},
    {"acceleration_m_per_s2", "tool: when its target accelerates more"},
    {"force_N", "tool: when its surroundings push more"}};
inline constexpr StopKeys kJointStops = {
    {"beyond_rad", "joints: so far out of its range"},
    {"speed_rad_per_s", "joints: when one is faster"},
    {"acceleration_rad_per_s2", "joints: when the target of one accelerates more"},
    {"torque_Nm", "joints: when something pushes more"}};

template <class V>
void describe_stops(V& v, teleoperation::StopRules& stops, const StopKeys& keys) {
  v.group(
      "protective_stop",
      [&](auto& child) {
        child.number(keys.beyond.name, stops.beyond, kNotNegative, keys.beyond.text);
        child.number(keys.speed.name, stops.speed, kPositive, keys.speed.text);
        child.number(keys.acceleration.name, stops.acceleration, kPositive, keys.acceleration.text);
        child.number(keys.force.name, stops.force, kPositive, keys.force.text);
      },
      "of the simulated machine, until the clutch is opened");
}

}  // namespace hg::config
