#include "hg/walking/steer_to_center.h"

#include <cmath>

#include "hg/walking/gains.h"

namespace hg::walking {

// The center; where it is behind, a place at the person's side, so that the person is led round.
Eigen::Vector2d SteerToCenter::target(const WalkMoment& moment) noexcept {
  constexpr double kBehind = 160.0 * kDegree, kAside = 4.0;  // rad, m
  const double angle = bearing(moment.room.heading, center_ - moment.room.p);
  if (std::abs(angle) < kBehind) {
    has_aside_ = false;
    return center_;
  }
  if (!has_aside_) {
    const double side = std::copysign(0.5 * std::numbers::pi, angle);
    aside_ = moment.room.p + kAside * direction_of(moment.room.heading + side);
    has_aside_ = true;
  }
  return aside_;
}

double SteerToCenter::heading_after_reset(const WalkMoment& moment) noexcept {
  applied_ = 0.0;
  has_aside_ = false;
  return Redirector::heading_after_reset(moment);
}

Redirection SteerToCenter::step(const WalkMoment& moment) noexcept {
  constexpr double kWalking = 0.2;            // m/s
  constexpr double kTurning = 1.5 * kDegree;  // rad/s
  constexpr double kAhead = 45.0 * kDegree;   // rad, less is done from here on
  constexpr double kNear = 1.25;              // m, likewise
  constexpr double kSmoothing = 0.125;        // share of the new value
  const Eigen::Vector2d way = target(moment) - moment.room.p;
  const double angle = bearing(moment.room.heading, way);
  const double side = std::copysign(1.0, angle);
  const double distance = moment.distance(), turn = moment.turn();
  const double bend = distance > kWalking * kWalkPeriod ? bend_to(side, distance) : 0.0;
  const double twist = std::abs(turn) >= kTurning * kWalkPeriod ? twist_to(side, turn) : 0.0;
  const bool is_bend = std::abs(bend) > std::abs(twist);
  double wanted = is_bend ? bend : twist;
  if (wanted == 0.0) return {};
  if (std::abs(angle) <= kAhead)
    wanted *= std::sin(0.5 * std::numbers::pi * std::abs(angle) / kAhead);
  if (way.norm() <= kNear) wanted *= way.norm() / kNear;
  applied_ += kSmoothing * (wanted - applied_);
  return is_bend ? Redirection{.bend = applied_} : Redirection{.twist = applied_};
}

}  // namespace hg::walking
