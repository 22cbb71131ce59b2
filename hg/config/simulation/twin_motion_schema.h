/// Description of the motion of the twin's place in a scenario.
#pragma once

#include <optional>

#include "hg/config/schema.h"
#include "hg/simulator/moving_base.h"

namespace hg::config {

inline constexpr auto kSwingDirections = choices_of<simulator::SwingDirection>();

template <class V>
void describe(V& v, simulator::Swing& swing) {
  v.choice("direction", swing.direction, kSwingDirections,
           "along an axis of the base frame, or about one that the others have turned");
  const bool turns = swing.direction >= simulator::SwingDirection::kRx;
  if (v.covers(!turns)) {
    v.number("amplitude_m", swing.amplitude, {.lb = -1.0, .ub = 1.0}, "of a shift",
             Need::kRequired);
  }
  if (v.covers(turns)) {
    v.number("amplitude_rad", swing.amplitude, {.lb = -1.0, .ub = 1.0}, "of a turn",
             Need::kRequired);
  }
  v.number("period_s", swing.period, {.lb = 0.1, .ub = 1e4}, "of the sine", Need::kRequired);
  v.number("phase_rad", swing.phase, kAnyNumber, "of the sine when the motion begins");
}

template <class V>
void describe(V& v, simulator::MovingBaseConfig& motion) {
  v.vector("about_m", motion.p_about, kAnyNumber,
           "point that turns leave where it is, in the base frame");
  v.number("begin_s", motion.begin, {.lb = 0.1, .ub = 60.0}, "time in which the motion begins");
  v.number("end_s", motion.end, {.lb = 0.1, .ub = 60.0},
           "time in which it ends when the device stops");
  v.list(
      "swings", [&](auto& child) { describe(child, motion.swings.emplace_back()); },
      "sines that are added up", Need::kRequired);
}

/// `motion` is empty where the file has none.
template <class V>
void describe_twin_motion(V& v, std::optional<simulator::MovingBaseConfig>& motion) {
  v.group(
      "twin_motion", [&](auto& child) { describe(child, motion.emplace()); },
      "motion of the place where the twin stands, docs/concepts/moving_base.md");
}

}  // namespace hg::config
