/// A horizontal virtual surface under the hand: sliding on it, pressing on it, knocking on it.
///
/// Source: [HANDBOOK] 7. Forces are the true ones of the person, depths those of the true handle.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hg/config/scenario.h"
#include "hg/experiments/motion_analysis.h"
#include "hg/haptify/play.h"
#include "hg/user/hand.h"

namespace hg::haptify {

struct SurfaceConfig {
  Eigen::Vector3d position{0.0, 0.0, -0.775};  ///< of the surface below the hand, m in B
  double clearance = 0.01;                     ///< of the handle above it when it begins, m
  // sliding
  double slide_stiffness = 2000.0;  ///< N/m
  double slide_force = 3.5;         ///< N, with which the person presses: 2 to 5 of [HANDBOOK] 7
  double stroke = 0.20;             ///< m
  double stroke_s = 2.0;            ///< per stroke
  int strokes = 4;                  ///< along each of the two axes
  // pressing
  double damping = 20.0;      ///< of the surface, Ns/m
  double press_force = 40.0;  ///< N, at the end of a slow press
  double press_s = 4.0;       ///< of pressing and of letting go
  double least_force = 2.0;   ///< from which the slope counts, N
  double peak_force = 140.0;  ///< N, goal of the hardest press: the monitor stops at 150
  double peak_s = 8.0;        ///< of pressing so hard
  double peak_stiffness = 4000.0;
  double peak_tolerance = 0.1;  ///< of the force from the line: farther off it is not the surface
  // knocking
  double knock_press = 10.0;  ///< N, with which the person presses
  user::HandPreset knock_hand = user::HandPreset::kNormal;
  experiments::CalmRule calm;
};

/// The scenario of a hand above a surface, at rest for a second.
config::Scenario above_surface(const config::Scenario& scenario, const SurfaceConfig& config,
                               double stiffness, double damping);

struct Slide {
  double force = 0.0;      ///< mean tangential |f| in contact while sliding, N
  double own_share = 0.0;  ///< mean |m a + b v| of it, tangential, N
  double inertial = 0.0;   ///< mean |m a|, N
  double viscous = 0.0;    ///< mean |b v|, N
  double extra = 0.0;      ///< mean |f - (m a + b v)|, tangential, N
  double normal = 0.0;     ///< mean normal force, N
  double speed = 0.0;      ///< mean, m/s
  std::string failure;
};
Slide measure_slide(const config::Scenario& scenario, const SurfaceConfig& config,
                    std::uint64_t seed);

struct Press {
  double accuracy = 0.0;       ///< measured over commanded stiffness, %
  double twin_accuracy = 0.0;  ///< the same with the depth of the rendered body, %
  double force = 0.0;          ///< largest, N
  std::string failure;
};
/// Slow press and release; the slope of the loading part.
Press measure_press(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
                    std::uint64_t seed);

struct Peak {
  double force = 0.0;  ///< largest that was within the tolerance of the line, N
  std::string end;     ///< what ended it, in words
  std::string failure;
};
Peak measure_peak(const config::Scenario& scenario, const SurfaceConfig& config,
                  std::uint64_t seed);

struct Knock {
  experiments::Verdict verdict = experiments::Verdict::kDiverges;  ///< also where a fault ended it
  std::string failure;  ///< the hand did not get to the surface
};
/// A hand presses on the surface, gets a kick of 15 N for 10 ms, and the handle calms down along
/// the normal or does not: along the surface nothing but joints' friction acts.
Knock knock(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
            double damping);

/// The last of growing stiffnesses up to which all are calm, N/m; 0 when the first one is not.
double stiffest_calm(std::span<const double> stiffness,
                     std::span<const experiments::Verdict> verdicts);

}  // namespace hg::haptify
