/// A hand runs with its body into a virtual wall: how deep, how it comes back, when it is at rest.
///
/// Speeds and depths are those of the true handle, forces and energies those of the rendered wall.
#pragma once

#include <cstdint>
#include <string>

#include "hg/config/scenario.h"

namespace hg::haptify {

/// The wall stands upright in front of the person. The goal of the hand stops as deep in it as the
/// arm needs to press with `press`, which is what somebody does who reaches for a wall.
struct ImpactConfig {
  Eigen::Vector3d position{0.0, 0.3, -0.775};  ///< of the wall where it is hit, m in B
  double damping = 20.0;                       ///< of the wall, Ns/m: as surfaces have by default
  double run_up_s = 0.5;                       ///< in which the goal goes to the wall
  double longest_run_up = 1.5;                 ///< m
  double watched_s = 6.0;                      ///< after the first contact
  double rest_speed = 5e-3;                    ///< along the normal: slower is at rest, m/s
  double still_s = 0.5;                        ///< at the end of the run, for which rest must hold
};

/// How far the hand runs up to meet a wall with `speed`, m: found by trying without a wall. The
/// longest run-up where that is not enough.
double find_run_up(const config::Scenario& scenario, const ImpactConfig& config, double speed);

struct Impact {
  double speed = 0.0;    ///< just before the wall, m/s
  double depth = 0.0;    ///< deepest point of the handle behind the wall, m
  double bound = 0.0;    ///< v^2 / (2 a) of that speed and braking_limit(), m; 0 = unknown
  double rebound = 0.0;  ///< largest speed away from the wall after the deepest point, over `speed`
  double rest_s = 0.0;   ///< from the contact to rest; infinity = not before the end of the run
  double last_speed = 0.0;  ///< largest along the normal in the last `still_s`, m/s
  double energy_in = 0.0;   ///< that the body gave to the wall, J
  double energy_out = 0.0;  ///< that the wall gave back, J
  double peak_force = 0.0;  ///< of the wall on the rendered body, N
  double felt_force = 0.0;  ///< largest of the person along the normal, N
  std::string end;          ///< fault or exceeded limit that the impact led to; empty = none
  std::string failure;      ///< no contact
};
Impact measure_impact(const config::Scenario& scenario, const ImpactConfig& config,
                      double stiffness, double run_up, std::uint64_t seed);

/// What the hand may brake with along the normal of the wall: the Cartesian limit of the handle in
/// device.yaml, m/s^2; infinity without one.
double braking_limit(const config::Device& device);

}  // namespace hg::haptify
