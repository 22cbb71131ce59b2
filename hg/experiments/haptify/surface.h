/// A horizontal virtual surface under the hand: sliding on it, pressing on it, knocking on it.
///
/// Source: [HANDBOOK] 7. Forces are the true ones of the person, depths those of the true handle.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/decay.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/place.h"
#include "hg/simulator/person/hand.h"

namespace hg::haptify {

struct SurfaceConfig {
  /// Position of the surface below the hand, m in B
  Eigen::Vector3d position = experiments::Place{}.middle;
  double clearance = 0.01;  ///< height of the handle above the surface at the begin, m
  // sliding
  double slide_stiffness = 2000.0;  ///< stiffness while sliding, N/m
  double slide_force = 3.5;         ///< pressing force of the person, N: 2 to 5 of [HANDBOOK] 7
  double stroke = 0.20;             ///< length of a stroke, m
  double stroke_s = 2.0;            ///< duration of a stroke, s
  int strokes = 4;                  ///< number of strokes along each of the two axes
  // pressing
  double damping = 20.0;      ///< damping of the surface, Ns/m
  double press_force = 40.0;  ///< force at the end of a slow press, N
  double press_s = 4.0;       ///< duration of pressing and of releasing, s
  double least_force = 2.0;   ///< force from which the slope counts, N
  double peak_force = 140.0;  ///< goal of the hardest press, N: the monitor stops at 150
  double peak_s = 8.0;        ///< duration of the hardest press, s
  double peak_stiffness = 4000.0;
  /// Relative deviation of the force from the line up to which it counts as the surface
  double peak_tolerance = 0.1;
  // knocking
  double knock_press = 10.0;  ///< pressing force of the person, N
  person::HandPreset knock_hand = person::HandPreset::kNormal;
  experiments::CalmRule calm;
};

/// Scenario of a hand above a surface, at rest for a second.
config::Scenario above_surface(const config::Scenario& scenario, const SurfaceConfig& config,
                               double stiffness, double damping);

struct Slide {
  double force = 0.0;      ///< mean tangential |f| in contact while sliding, N
  double own_share = 0.0;  ///< mean |m a + b v| of the twin, tangential, N
  double inertial = 0.0;   ///< mean |m a|, N
  double viscous = 0.0;    ///< mean |b v|, N
  double extra = 0.0;      ///< mean |f - (m a + b v)|, tangential, N
  double normal = 0.0;     ///< mean normal force, N
  double speed = 0.0;      ///< mean speed, m/s
  std::string failure;
};
Slide measure_slide(const config::Scenario& scenario, const SurfaceConfig& config,
                    std::uint64_t seed);

struct Press {
  double accuracy = 0.0;       ///< measured over commanded stiffness, %
  double twin_accuracy = 0.0;  ///< accuracy with the depth of the rendered body, %
  double force = 0.0;          ///< largest force, N
  std::string failure;
};
/// Measures the stiffness by a slow press and release, from the slope of the loading part.
Press measure_press(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
                    std::uint64_t seed);

struct Peak {
  double force = 0.0;  ///< largest force within the tolerance of the line, N
  std::string end;     ///< end of the press, in words
  std::string failure;
};
Peak measure_peak(const config::Scenario& scenario, const SurfaceConfig& config,
                  std::uint64_t seed);

struct Knock {
  /// Verdict; also kDiverges if a fault ended the run
  experiments::DecayClass verdict = experiments::DecayClass::kDiverges;
  std::string failure;  ///< the hand did not reach the surface; empty = it did
};
/// A hand presses on the surface and gets a kick of 15 N for 10 ms; judges the decay along the
/// normal, since along the surface only joint friction acts.
Knock knock(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
            double damping);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Slide, force, own_share, inertial, viscous, extra, normal, speed,
                                   failure)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Press, accuracy, twin_accuracy, force, failure)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Peak, force, end, failure)

}  // namespace hg::haptify
