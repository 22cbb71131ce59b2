/// A hand runs with its body into a virtual wall: how deep, how it comes back, when it is at rest.
///
/// Speeds and depths are those of the true handle, forces and energies those of the rendered wall.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hg/config/scenario.h"

namespace hg::haptify {

/// The wall stands upright in front of the person. The goal of the hand stops so deep in it that
/// the arm still presses with `press` where the body comes to rest: who pulls back does not test a
/// wall.
struct ImpactConfig {
  Eigen::Vector3d position{0.0, 0.3, -0.775};  ///< of the wall where it is hit, m in B
  std::optional<double> damping;               ///< of the wall, Ns/m; none: as surfaces have
  double press = 10.0;                         ///< N
  double braking = 5.0;                        ///< m/s^2, about what the motors give
  double run_up_s = 0.35;                      ///< times the speed: from where the hand runs up
  double longest_way_s = 4.0;  ///< of the goal, from its begin to its end behind the wall
  double watched_s = 2.0;      ///< after the first contact
  double rest_speed = 5e-3;    ///< along the normal: slower is at rest, m/s
  double still_s = 0.5;        ///< at the end of the run, for which rest must hold
};

/// How long the goal of the hand is on its way when the handle meets the wall with `speed`, s:
/// found by trying without a wall. The fastest that was tried where that is not enough.
double find_way(const config::Scenario& scenario, const ImpactConfig& config, double speed);

// what an impact may be
inline constexpr double kDeepestImpact = 1.3;  ///< depth over v^2 / (2 a)
inline constexpr double kMostRebound = 0.1;    ///< of the speed
inline constexpr double kLatestRest = 0.5;     ///< s after the contact

struct Impact {
  double speed = 0.0;  ///< just before the wall, m/s
  double depth = 0.0;  ///< deepest point of the handle behind the wall, m
  double braking =
      0.0;  ///< what the motors may brake with in the posture and with the speeds of the
            ///< contact, against the mean force of the hand until the deepest point, m/s^2
  double bound = 0.0;  ///< v^2 / (2 a) with these, m
  double onset = 0.0;  ///< what it costs that torques come to their bounds with 20 ms, v 10 ms, m
  /// What the wall gives by itself, on a device without limits, m: to the largest force of the
  /// person, and v sqrt(m / K) / e, that of a critical damper on the mass of body and arm.
  double spring = 0.0;
  double rebound = 0.0;  ///< largest speed away from the wall after the deepest point, over `speed`
  double rest_s = 0.0;   ///< from the contact to rest; infinity = not before the end of the run
  double last_speed = 0.0;  ///< largest along the normal in the last `still_s`, m/s
  double energy_in = 0.0;   ///< that the body gave to the wall as far as the device acts with it, J
  double energy_out = 0.0;  ///< that the wall gave back, J
  double peak_force = 0.0;  ///< of the wall on the rendered body, N
  double felt_force = 0.0;  ///< largest of the person along the normal, N
  std::string end;          ///< fault or exceeded limit that the impact led to; empty = none
  std::string failure;      ///< why there was no such impact, or none that motors can brake

  /// How deep it may be, m.
  double allowed() const { return kDeepestImpact * bound + onset + spring; }
};
Impact measure_impact(const config::Scenario& scenario, const ImpactConfig& config,
                      double stiffness, double speed, double way_s, std::uint64_t seed);

}  // namespace hg::haptify
