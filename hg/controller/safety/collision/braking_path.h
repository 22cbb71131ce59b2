/// The way on which all joints of a device brake at once.
#pragma once

#include <algorithm>
#include <cmath>

#include "hg/controller/safety/collision/guard.h"

namespace hg::collision {

/// Braking with all joints at once from the state at time 0.
struct BrakingPath {
  const VectorPM& reaction;
  const VectorPM& q;
  const VectorPM& dq;
  VectorPM deceleration;
  VectorPM stop;

  BrakingPath(const Braking& braking, const VectorPM& from, const VectorPM& speed) noexcept
      : BrakingPath(braking, from, speed, decelerations(braking, from, speed)) {}

  BrakingPath(const Braking& braking, const VectorPM& from, const VectorPM& speed,
              const VectorPM& by) noexcept
      : reaction(braking.reaction), q(from), dq(speed), deceleration(by), stop(from) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      stop[i] += dq[i] * (reaction[i] + 0.5 * std::abs(dq[i]) / deceleration[i]);
    }
  }

  /// Time until joint i is at rest; 0 for one that is.
  double time_to_rest(Eigen::Index i) const noexcept {
    return dq[i] == 0.0 ? 0.0 : reaction[i] + std::abs(dq[i]) / deceleration[i];
  }

  /// Time until the joints that move this pair are at rest.
  double duration(const Pair& pair) const noexcept {
    double longest = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (pair.lever[i] != 0.0) longest = std::max(longest, time_to_rest(i));
    }
    return longest;
  }

  double position(Eigen::Index i, double time) const noexcept {
    const double since = std::max(0.0, time - reaction[i]);
    if (since * deceleration[i] >= std::abs(dq[i])) {
      return time >= reaction[i] ? stop[i] : q[i] + dq[i] * time;
    }
    return q[i] + dq[i] * time - std::copysign(0.5 * deceleration[i] * since * since, dq[i]);
  }

  VectorPM positions(double time) const noexcept {
    VectorPM at(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = position(i, time);
    return at;
  }

  /// Speed of joint i at `time` >= 0, without its sign.
  double speed(Eigen::Index i, double time) const noexcept {
    const double since = std::max(0.0, time - reaction[i]);
    return std::max(0.0, std::abs(dq[i]) - deceleration[i] * since);
  }

  /// Bound on how far points of `b` of this pair, in the frame of `a`, are from the straight line
  /// between their positions at `begin` and `end`: an eighth of the square of the time, times their
  /// largest acceleration. Joints i and j turn a point by at most the lever of the outer one.
  double bend(const Pair& pair, double begin, double end) const noexcept {
    double acceleration = 0.0, inner_speed = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double fastest = speed(i, begin);
      if (pair.lever[i] == 0.0 || fastest == 0.0) continue;
      acceleration += pair.lever[i] * (deceleration[i] + fastest * (fastest + 2.0 * inner_speed));
      inner_speed += fastest;
    }
    return 0.125 * (end - begin) * (end - begin) * acceleration;
  }

  /// Largest distance of joint i from where it is at the same time on `other`, which has the same
  /// reaction time: at the begin, where braking begins, where either is at rest, or where both are
  /// equally fast.
  double most_apart(const BrakingPath& other, Eigen::Index i) const noexcept {
    const double begin = reaction[i];
    const double faster = dq[i] - other.dq[i];
    const double harder =
        std::copysign(deceleration[i], dq[i]) - std::copysign(other.deceleration[i], other.dq[i]);
    const double alike = harder != 0.0 ? begin + std::max(0.0, faster / harder) : begin;
    double most = std::abs(q[i] - other.q[i]);
    for (const double time : {begin, alike, time_to_rest(i), other.time_to_rest(i)}) {
      most = std::max(most, std::abs(position(i, time) - other.position(i, time)));
    }
    return most;
  }

  /// Bound on what the joints between `begin` and `end` may take from the distance
  double travel(const Pair& pair, double begin, double end) const noexcept {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (pair.lever[i] == 0.0) continue;
      sum += pair.lever[i] * std::abs(position(i, end) - position(i, begin));
    }
    return sum;
  }
};

}  // namespace hg::collision
