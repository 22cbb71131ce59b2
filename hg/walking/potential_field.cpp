#include "hg/walking/potential_field.h"

#include <algorithm>
#include <cmath>

#include "hg/walking/gains.h"

namespace hg::walking {

// Sum over the walls of the negative gradient of 1 / distance.
Eigen::Vector2d PotentialField::push(const Eigen::Vector2d& p) const noexcept {
  constexpr double kNearest = 1e-3;  // m
  const auto of_wall = [=](double distance) {
    const double d = std::max(distance, kNearest);
    return 1.0 / (d * d);
  };
  return {of_wall(p.x() - room_.lower.x()) - of_wall(room_.upper.x() - p.x()),
          of_wall(p.y() - room_.lower.y()) - of_wall(room_.upper.y() - p.y())};
}

Redirection PotentialField::step(const WalkMoment& moment) noexcept {
  constexpr double kLonger = 1.14;  // way that is seen over that in the room, on the way to a wall
  const Eigen::Vector2d push = this->push(moment.room.p);
  const double side = std::copysign(1.0, bearing(moment.room.heading, push));
  const double bend = bend_to(side, moment.distance()), twist = twist_to(side, moment.turn());
  Redirection redirection;
  if (push.dot(direction_of(moment.room.heading)) < 0.0) redirection.length = 1.0 / kLonger;
  (std::abs(twist) > std::abs(bend) ? redirection.twist : redirection.bend) =
      std::abs(twist) > std::abs(bend) ? twist : bend;
  return redirection;
}

double PotentialField::heading_after_reset(const WalkMoment& moment) noexcept {
  const Eigen::Vector2d push = this->push(moment.room.p);
  return std::atan2(push.y(), push.x());
}

}  // namespace hg::walking
