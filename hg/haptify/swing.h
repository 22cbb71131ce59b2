/// A hinge with a spring that nobody holds: how fast and how long the handle swings.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hg/config/scenario.h"

namespace hg::haptify {

struct SwingConfig {
  double inertia = 2.5;  ///< about the hinge, kg m^2
  double radius = 0.75;  ///< from the hinge to the handle, m: that of the door
  double damping = 1.0;  ///< of the hinge, Nms/rad
  double watched_s = 6.0;
  int swings = 4;  ///< that count
  Eigen::Vector3d position{0.0, 0.0,
                           -0.775};  ///< of the handle where the spring is at rest, m in B
};

/// Of a signal about zero.
struct Oscillation {
  double frequency_Hz = 0.0;   ///< 0 = it does not go to and fro
  double damping_ratio = 0.0;  ///< from the decay of its peaks; below 0 they grow
  double amplitude = 0.0;      ///< of the first peak that counts
};

/// Of the first `swings` whole swings, from the first zero on; `rate_Hz` of the samples.
Oscillation oscillation_of(std::span<const double> signal, int swings, double rate_Hz);

struct Swing {
  Oscillation true_handle;     ///< angle about the hinge, rad
  double ideal_Hz = 0.0;       ///< sqrt(K / I) / 2 pi
  double ideal_damping = 0.0;  ///< damping ratio of the same hinge by itself
  std::string failure;
};

/// The hinge stands upright, and starts `deflection` (rad) from its rest. `scenario` gives device
/// and orientation of the handle.
Swing measure_swing(const config::Scenario& scenario, const SwingConfig& config, double stiffness,
                    double deflection, std::uint64_t seed);

}  // namespace hg::haptify
