/// What a free body feels like when it is pulled hard, and how light its rotation may be.
///
/// True forces and accelerations of the handle; SI units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/experiments/motion_analysis.h"
#include "hg/user/hand.h"

namespace hg::haptify {

struct PullConfig {
  double rise_s = 0.02;                        ///< of the force
  double from_s = 0.05, to_s = 0.25;           ///< after its begin: what counts
  Eigen::Vector3d position{0.0, 0.0, -0.775};  ///< middle of the box of the handle, m in B
};

struct Pull {
  double mass = 0.0;          ///< felt: mean force over mean acceleration of the handle, kg
  double acceleration = 0.0;  ///< m/s^2
  std::string failure;
};

/// A steady force along one axis of H (0..2), without mass and spring of an arm.
Pull measure_pull(const config::Scenario& scenario, const PullConfig& config, int axis,
                  double force, std::uint64_t seed);

struct TwistConfig {
  double torque = 1.5;      ///< Nm, along the diagonal of the axes of H, [A]
  double duration = 0.01;   ///< s
  double settling_s = 1.0;  ///< from the grasp to the kick
  /// As for a kick along ([C] 3); 0.06 rad/s are 6 mm/s a hand's breadth off the axis.
  experiments::CalmRule calm = {.calm_speed = 0.06};
  Eigen::Vector3d position{0.0, 0.0, -0.775};  ///< middle of the box of the handle, m in B
};

struct Twist {
  experiments::Verdict verdict = experiments::Verdict::kDiverges;  ///< also where a fault ended it
  std::string failure;  ///< a fault before the handle was twisted
};
/// The same inertia about all axes. A hand holds the body, its handle is twisted for a moment, and
/// its turning calms down or does not; what goes on by friction alone is not calm either.
Twist twist(const config::Scenario& scenario, const TwistConfig& config,
            const user::HandImpedance& hand, double inertia);

}  // namespace hg::haptify
