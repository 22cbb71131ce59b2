/// The few figures that say whether a change of the control is felt: for comparisons in one run.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/experiments/motion_analysis.h"

namespace hg::haptify {

/// Along x of the handle where there is a direction; seed of the scenario.
struct HandFigures {
  double transparency_Hz = 0.0;  ///< felt over body within 3 dB, 10 N; 0 = a fault
  double latency_s = 0.0;        ///< of the handle behind an ideal twin, 10 N; 0 = a fault
  double extra_force = 0.0;      ///< on a slow walk, N
  double vibration = 0.0;        ///< on it, above 20 Hz, m/s^2
  double centroid_Hz = 0.0;      ///< of that
  double joint_error = 0.0;      ///< on it: largest of reference minus true link, rad
  double light_normal = 0.0;     ///< of 0.3 kg in a normal hand, seconds after a kick, m/s
  double light_stiff = 0.0;      ///< of 0.4 kg in a stiff hand
  std::array<experiments::Verdict, 2>
      wall{};  ///< of 20 kN/m against 6 kg and 3 kg, in a normal hand
};

/// `scenario`: a slow walk with a free twin.
HandFigures measure_hand_figures(const config::Scenario& scenario);

/// A table with a row for each.
std::string to_text(const std::vector<std::pair<std::string, HandFigures>>& all);

}  // namespace hg::haptify
