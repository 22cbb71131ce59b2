/// Local dynamic forces and torques: strokes to and fro in a small cube, and a model fitted to
/// them.
///
/// Source: [HANDBOOK] 7. Forces are fitted along the axis of the stroke, torques about it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/haptify/measures.h"
#include "hg/experiments/place.h"

namespace hg::haptify {

struct DynamicsConfig {
  double stroke = 0.10;  ///< length of a stroke and edge of the cube, m; [HANDBOOK] 7
  double angle = 0.25;   ///< angle of a rotational stroke, rad, [A]
  std::vector<double> duration_s = {1.6, 1.0, 0.7};  ///< durations of one stroke, s: several speeds
  int strokes = 6;                                   ///< number of strokes per duration
  Eigen::Vector3d position = experiments::Place{}.middle;  ///< position of the handle, m in B
};

/// Number of stroke axes; 0..2: along x, y, z of B; 3..5: azimuth, pitch, roll of the hand.
inline constexpr int kStrokeAxes = 6;

struct Dynamics {
  DynamicFit fit;
  double mean = 0.0;     ///< mean |f| or |torque| along the axis
  double largest = 0.0;  ///< largest |f| or |torque| along the axis
  std::string failure;
};

Dynamics measure_dynamics(const config::Scenario& scenario, const DynamicsConfig& config, int axis,
                          std::uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Dynamics, fit, mean, largest, failure)

}  // namespace hg::haptify
