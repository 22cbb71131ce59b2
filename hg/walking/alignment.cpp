#include "hg/walking/alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hg/walking/gains.h"

namespace hg::walking {
namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;

double in_target(const WalkMoment& moment, double angle) noexcept {
  const WalkSample& sample = moment.last();
  return free_distance(moment.path.spaces, sample.p, direction_of(sample.heading + angle));
}

}  // namespace

double Alignment::in_room(const WalkMoment& moment, double angle) const noexcept {
  return free_distance({&room_.walls, 1}, moment.room.p, direction_of(moment.room.heading + angle));
}

Redirection Alignment::step(const WalkMoment& moment) noexcept {
  constexpr double kTurnLeast = 0.67, kTurnMost = 1.24;  // in the room over what is seen
  constexpr double kWayLeast = 0.86, kWayMost = 1.26;    // likewise
  constexpr double kSmoothing = 0.125;
  constexpr double kAligned = 1e-3;            // m
  constexpr double kTurning = 10.0 * kDegree;  // rad/s, of people, who never go quite straight
  const double ahead_room = in_room(moment, 0.0), ahead_target = in_target(moment, 0.0);
  const double left = in_room(moment, kQuarter) - in_target(moment, kQuarter);
  const double right = in_room(moment, -kQuarter) - in_target(moment, -kQuarter);
  const double misalignment =
      std::abs(ahead_room - ahead_target) + std::abs(left) + std::abs(right);
  const bool is_worse = last_misalignment_ >= 0.0 && misalignment > last_misalignment_;
  last_misalignment_ = misalignment;
  const double turn = moment.turn(), distance = moment.distance();
  if (misalignment < kAligned) return {};
  Redirection redirection;
  const bool is_turning = std::abs(turn) > kTurning * kWalkPeriod;
  if (is_turning) {
    turn_gain_ += kSmoothing * ((is_worse ? kTurnLeast : kTurnMost) - turn_gain_);
    redirection.twist = (turn_gain_ - 1.0) * turn;
  } else if (distance > 0.0 && left != right) {
    const double scale = std::min(1.0, std::abs(std::max(left, right)));
    redirection.bend = std::copysign(scale * distance / kBendRadius, left - right);
  }
  if (!is_turning && ahead_target > 0.0)
    redirection.length = std::clamp(ahead_room / ahead_target, kWayLeast, kWayMost);
  return redirection;
}

double Alignment::heading_after_reset(const WalkMoment& moment) noexcept {
  constexpr int kDirections = 20;
  const double wanted = in_target(moment, 0.0);
  double best = moment.room.heading + std::numbers::pi;
  double least = std::numeric_limits<double>::infinity();
  bool has_room = false;
  for (int i = 0; i < kDirections; ++i) {
    const double heading = i * 2.0 * std::numbers::pi / kDirections;
    if (room_.needs_reset({moment.room.p, heading})) continue;
    const double difference =
        free_distance({&room_.walls, 1}, moment.room.p, direction_of(heading)) - wanted;
    const bool reaches = difference >= 0.0;
    if (has_room && !reaches) continue;
    if (std::abs(difference) < least || (reaches && !has_room)) {
      least = std::abs(difference);
      best = heading;
      has_room = reaches;
    }
  }
  return best;
}

}  // namespace hg::walking
