/// Impact of a hand with its body on a virtual wall: depth, rebound, time to rest.
///
/// Speeds and depths are those of the true handle, forces and energies those of the rendered wall.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "hg/config/simulation/scenario.h"

namespace hg::haptify {

/// The wall stands upright in front of the person. The goal of the hand stops so deep in it that
/// the arm still presses with `press` where the body comes to rest: a hand that pulls back does not
/// test a wall.
struct ImpactConfig {
  Eigen::Vector3d position{0.0, 0.3, -0.775};  ///< position of the wall where it is hit, m in B
  std::optional<double> damping;  ///< damping of the wall, Ns/m; none = default of surfaces
  double press = 10.0;            ///< pressing force, N
  double braking = 5.0;           ///< deceleration, m/s^2, about what the motors give
  double run_up_s = 0.35;         ///< run-up distance over the speed, s
  /// Longest duration of the goal's motion to its end behind the wall, s
  double longest_way_s = 4.0;
  double watched_s = 2.0;    ///< time observed after the first contact, s
  double rest_speed = 5e-3;  ///< speed along the normal below which the handle is at rest, m/s
  double still_s = 0.5;      ///< time at the end of the run for which rest must hold, s
};

/// Distances from the wall, m.
struct ImpactWay {
  double run_up = 0.0;  ///< distance at which the handle starts
  double behind = 0.0;  ///< depth at which the goal of the hand stops
};
ImpactWay way_of_impact(const config::Scenario& scenario, const ImpactConfig& config, double speed);

/// Duration of the goal's motion for which the handle meets the wall with `speed`, s, found by
/// trials without a wall; the fastest tried if that is not enough.
double find_way(const config::Scenario& scenario, const ImpactConfig& config, double speed);

/// Failure of an impact whose speed was less than 95 % of the wanted one.
inline constexpr const char* kTooSlow = "the hand did not get as fast";

/// Largest depth of a good impact over v^2 / (2 a).
inline constexpr double kDeepestImpact = 1.3;

struct Impact {
  double speed = 0.0;  ///< speed just before the wall, m/s
  double depth = 0.0;  ///< depth of the deepest point of the handle behind the wall, m
  /// Deceleration available from the motors in the posture and with the speeds of the contact,
  /// against the mean force of the hand until the deepest point, m/s^2
  double braking = 0.0;
  double bound = 0.0;  ///< v^2 / (2 a) with this deceleration, m
  double onset = 0.0;  ///< extra depth because torques reach their bounds with 20 ms: v 10 ms, m
  /// Deflection of the wall itself, on a device without limits, m: under the largest force of the
  /// person, plus v sqrt(m / K) / e, that of a critical damper on the mass of body and arm.
  double spring = 0.0;
  double rebound = 0.0;  ///< largest speed away from the wall after the deepest point, over `speed`
  /// Time from the contact to rest, s; infinity = not before the end of the run
  double rest_s = 0.0;
  double last_speed = 0.0;  ///< largest speed along the normal in the last `still_s`, m/s
  /// Energy from the body into the wall as far as the device acts with it, J
  double energy_in = 0.0;
  double energy_out = 0.0;  ///< energy returned by the wall, J
  double peak_force = 0.0;  ///< largest force of the wall on the rendered body, N
  double felt_force = 0.0;  ///< largest force of the person along the normal, N
  std::string end;          ///< fault or exceeded limit that the impact led to; empty = none
  std::string failure;      ///< reason why there was no such impact, or none that motors can brake

  /// Largest allowed depth, m.
  double allowed() const { return kDeepestImpact * bound + onset + spring; }
};
Impact measure_impact(const config::Scenario& scenario, const ImpactConfig& config,
                      double stiffness, double speed, double way_s, std::uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Impact, speed, depth, braking, bound, onset, spring, rebound,
                                   rest_s, last_speed, energy_in, energy_out, peak_force,
                                   felt_force, end, failure)

}  // namespace hg::haptify
