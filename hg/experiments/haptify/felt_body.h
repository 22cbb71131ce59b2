/// Felt mass of a free body that is pulled hard, and smallest stable inertia in rotation.
///
/// True forces and accelerations of the handle; SI units.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/decay.h"
#include "hg/experiments/place.h"
#include "hg/simulator/person/hand.h"

namespace hg::haptify {

struct PullConfig {
  double rise_s = 0.02;               ///< rise time of the force, s
  double from_s = 0.05, to_s = 0.25;  ///< evaluated interval after the begin of the force, s
  Eigen::Vector3d position = experiments::Place{}.middle;  ///< position of the handle, m in B
};

struct Pull {
  double mass = 0.0;          ///< felt mass: mean force over mean acceleration of the handle, kg
  double acceleration = 0.0;  ///< acceleration of the handle, m/s^2
  std::string failure;
};

/// Pulls with a constant force along one axis of H (0..2), without mass and spring of an arm.
Pull measure_pull(const config::Scenario& scenario, const PullConfig& config, int axis,
                  double force, std::uint64_t seed);

struct TwistConfig {
  double torque = 1.5;      ///< torque about the diagonal of the axes of H, Nm, [A]
  double duration = 0.01;   ///< duration of the torque, s
  double settling_s = 1.0;  ///< time from the grasp to the torque kick, s
  /// Rule for rest, as for a linear kick ([C] 3); 0.06 rad/s are 6 mm/s a hand's breadth off the
  /// axis.
  experiments::CalmRule calm = {.calm_speed = 0.06};
  Eigen::Vector3d position = experiments::Place{}.middle;  ///< position of the handle, m in B
};

struct Twist {
  /// Verdict; also kDiverges if a fault ended the run
  experiments::DecayClass verdict = experiments::DecayClass::kDiverges;
  std::string failure;  ///< fault before the handle was twisted; empty = none
};
/// Twists the handle of a body with the same inertia about all axes, held by a hand, for a moment,
/// and judges the decay; motion sustained only by friction does not count as rest.
Twist twist(const config::Scenario& scenario, const TwistConfig& config,
            const person::HandImpedance& hand, double inertia);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Pull, mass, acceleration, failure)

}  // namespace hg::haptify
