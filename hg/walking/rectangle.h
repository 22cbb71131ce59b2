/// Rectangles in the plane: a room of the device's laboratory, rooms of a building.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>

namespace hg::walking {

struct Rectangle {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero(), upper = Eigen::Vector2d::Zero();  ///< m

  Eigen::Vector2d middle() const noexcept { return 0.5 * (lower + upper); }
  bool contains(const Eigen::Vector2d& p) const noexcept { return clearance(p) >= 0.0; }
  /// Distance from p to the nearest side, m; negative outside.
  double clearance(const Eigen::Vector2d& p) const noexcept {
    return std::min((p - lower).minCoeff(), (upper - p).minCoeff());
  }
  /// The rectangle whose sides lie by `width` further inside.
  Rectangle inset(double width) const noexcept {
    return {lower.array() + width, upper.array() - width};
  }
};

/// The unit vector of a heading in rad.
inline Eigen::Vector2d direction_of(double heading) noexcept {
  return {std::cos(heading), std::sin(heading)};
}

/// A rectangle about the origin.
inline Rectangle centered(double length_x, double length_y) noexcept {
  const Eigen::Vector2d half(0.5 * length_x, 0.5 * length_y);
  return {-half, half};
}

/// How far one can go from p in the unit vector's direction without leaving the union of the
/// rectangles, m; 0 outside.
double free_distance(std::span<const Rectangle> spaces, const Eigen::Vector2d& p,
                     const Eigen::Vector2d& direction) noexcept;

}  // namespace hg::walking
