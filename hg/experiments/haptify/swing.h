/// Free oscillation of a hinge with a spring: frequency and damping of the handle.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/place.h"

namespace hg::haptify {

struct SwingConfig {
  double inertia = 2.5;  ///< inertia about the hinge, kg m^2
  double radius = 0.75;  ///< distance from the hinge to the handle, m: that of the door
  double damping = 1.0;  ///< damping of the hinge, Nms/rad
  double watched_s = 6.0;
  int swings = 4;  ///< number of evaluated swings
  /// Position of the handle where the spring is at rest, m in B
  Eigen::Vector3d position = experiments::Place{}.middle;
};

/// Oscillation of a signal about zero.
struct Oscillation {
  double frequency_Hz = 0.0;   ///< frequency; 0 = no oscillation
  double damping_ratio = 0.0;  ///< damping ratio from the decay of the peaks; below 0 they grow
  double amplitude = 0.0;      ///< amplitude of the first evaluated peak
};

/// Evaluates the first `swings` whole swings, from the first zero on; `rate_Hz` of the samples.
Oscillation oscillation_of(std::span<const double> signal, int swings, double rate_Hz);

struct Swing {
  Oscillation true_handle;     ///< oscillation of the true handle, angle about the hinge, rad
  double ideal_Hz = 0.0;       ///< sqrt(K / I) / 2 pi
  double ideal_damping = 0.0;  ///< damping ratio of the ideal hinge
  std::string failure;
};

/// Measures a swing of an upright hinge released `deflection` (rad) from its rest. `scenario` gives
/// device and orientation of the handle.
Swing measure_swing(const config::Scenario& scenario, const SwingConfig& config, double stiffness,
                    double deflection, std::uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Oscillation, frequency_Hz, damping_ratio, amplitude)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Swing, true_handle, ideal_Hz, ideal_damping, failure)

}  // namespace hg::haptify
