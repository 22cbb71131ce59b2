/// Key figures that show whether a change of the control is felt, for comparisons in one run.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/decay.h"

namespace hg::haptify {

/// Key figures along x of the handle, where there is a direction; seed of the scenario.
struct HandFigures {
  /// Frequency up to which felt over body is within 3 dB, 10 N; 0 = a fault
  double transparency_Hz = 0.0;
  double latency_s = 0.0;     ///< latency of the handle behind an ideal twin, 10 N; 0 = a fault
  double extra_force = 0.0;   ///< force that the device adds in free space, N
  double vibration = 0.0;     ///< vibration in free space, above 20 Hz, m/s^2
  double centroid_Hz = 0.0;   ///< centroid of the vibration
  double joint_error = 0.0;   ///< largest reference minus true link in free space, rad
  double light_normal = 0.0;  ///< speed of 0.3 kg in a normal hand, seconds after a kick, m/s
  double light_stiff = 0.0;   ///< speed of 0.4 kg in a stiff hand, likewise, m/s
  std::array<experiments::DecayClass, 2>
      wall{};  ///< wall of 20 kN/m against 6 kg and 3 kg, in a normal hand
};

/// Measures the key figures. The twin of `scenario` is a free body.
HandFigures measure_hand_figures(const config::Scenario& scenario);

nlohmann::ordered_json to_json(const HandFigures& figures);

}  // namespace hg::haptify
