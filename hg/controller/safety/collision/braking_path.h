/// The way on which all joints of a device brake at once, each alone; [HANDBOOK] 6.4.
#pragma once

#include <algorithm>
#include <cmath>

#include "hg/controller/safety/collision/guard.h"

namespace hg::collision {

/// Braking with all joints at once from the state at time 0.
struct BrakingPath {
  const Braking& braking;
  const VectorPM& q;
  const VectorPM& dq;
  VectorPM stop;

  BrakingPath(const Braking& b, const VectorPM& from, const VectorPM& speed) noexcept
      : braking(b), q(from), dq(speed), stop(from) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      stop[i] += dq[i] * (b.reaction[i] + 0.5 * std::abs(dq[i]) / b.deceleration[i]);
    }
  }

  /// Time until joint i is at rest; 0 for one that is.
  double time_to_rest(Eigen::Index i) const noexcept {
    return dq[i] == 0.0 ? 0.0 : braking.reaction[i] + std::abs(dq[i]) / braking.deceleration[i];
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
    const double reaction = braking.reaction[i], deceleration = braking.deceleration[i];
    const double since = std::max(0.0, time - reaction);
    if (since * deceleration >= std::abs(dq[i])) {
      return time >= reaction ? stop[i] : q[i] + dq[i] * time;
    }
    return q[i] + dq[i] * time - std::copysign(0.5 * deceleration * since * since, dq[i]);
  }

  VectorPM positions(double time) const noexcept {
    VectorPM at(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = position(i, time);
    return at;
  }

  /// Speed of joint i at `time` >= 0, without its sign.
  double speed(Eigen::Index i, double time) const noexcept {
    const double since = std::max(0.0, time - braking.reaction[i]);
    return std::max(0.0, std::abs(dq[i]) - braking.deceleration[i] * since);
  }

  /// Bound on how far points of `b` of this pair, in the frame of `a`, are from the straight line
  /// between their positions at `begin` and `end`: an eighth of the square of the time, times their
  /// largest acceleration. Joints i and j turn a point by at most the lever of the outer one.
  double bend(const Pair& pair, double begin, double end) const noexcept {
    double acceleration = 0.0, inner_speed = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double fastest = speed(i, begin);
      if (pair.lever[i] == 0.0 || fastest == 0.0) continue;
      acceleration +=
          pair.lever[i] * (braking.deceleration[i] + fastest * (fastest + 2.0 * inner_speed));
      inner_speed += fastest;
    }
    return 0.125 * (end - begin) * (end - begin) * acceleration;
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
