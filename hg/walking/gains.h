/// Gains that reactive methods share: settings of the Redirected Walking Toolkit and OpenRDW, after
/// the thresholds of [Steinicke et al. 2010].
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/walking/redirection.h"

namespace hg::walking {

inline constexpr double kDegree = std::numbers::pi / 180.0;

inline constexpr double kBendRadius = 7.5;                 // m
inline constexpr double kLargestBendRate = 15 * kDegree;   // rad/s
inline constexpr double kLargestTwistRate = 30 * kDegree;  // rad/s
// turns in the room over those that are seen: towards the goal, and away from it
inline constexpr double kTurnUp = 1.0 / 0.8, kTurnDown = 1.0 / 1.49;

/// Angle from a heading to a direction, in [-pi, pi].
inline double bearing(double heading, const Eigen::Vector2d& direction) noexcept {
  return std::remainder(std::atan2(direction.y(), direction.x()) - heading, 2.0 * std::numbers::pi);
}

/// Rotation towards `side` (1 = left, -1 = right) that a way of this length allows, rad.
inline double bend_to(double side, double distance) noexcept {
  return side * std::min(distance / kBendRadius, kLargestBendRate * kWalkPeriod);
}

/// Rotation towards `side` that a turn allows: more of it towards that side, less of it away, rad.
inline double twist_to(double side, double turn) noexcept {
  const double gain = turn * side > 0.0 ? kTurnUp - 1.0 : 1.0 - kTurnDown;
  return side * std::min(gain * std::abs(turn), kLargestTwistRate * kWalkPeriod);
}

}  // namespace hg::walking
