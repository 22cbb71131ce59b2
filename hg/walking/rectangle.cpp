#include "hg/walking/rectangle.h"

#include <limits>

namespace hg::walking {
namespace {

// To the side through which a line from inside leaves the rectangle.
double exit_distance(const Rectangle& space, const Eigen::Vector2d& p,
                     const Eigen::Vector2d& direction) noexcept {
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2; ++i) {
    if (direction[i] == 0.0) continue;
    const double side = direction[i] > 0.0 ? space.upper[i] : space.lower[i];
    distance = std::min(distance, (side - p[i]) / direction[i]);
  }
  return distance;
}

}  // namespace

double free_distance(std::span<const Rectangle> spaces, const Eigen::Vector2d& p,
                     const Eigen::Vector2d& direction) noexcept {
  constexpr double kStep = 1e-6;  // m, across a side that two rectangles share
  double distance = 0.0;
  for (std::size_t crossed = 0; crossed <= spaces.size(); ++crossed) {
    const Eigen::Vector2d from = p + (distance + kStep) * direction;
    double farthest = 0.0;
    for (const Rectangle& space : spaces) {
      if (space.contains(from)) farthest = std::max(farthest, exit_distance(space, p, direction));
    }
    if (farthest <= distance) break;
    distance = farthest;
  }
  return distance;
}

}  // namespace hg::walking
