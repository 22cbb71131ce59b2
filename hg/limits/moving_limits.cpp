#include "hg/limits/moving_limits.h"

#include <algorithm>
#include <cmath>

namespace hg::limits {
namespace {

// Valid target: the midpoint of a crossed one, or the present limits if that is not finite.
Interval readable(Interval target, Interval now) noexcept {
  if (!target.empty()) return target;
  const double middle = 0.5 * (target.lb + target.ub);
  return std::isfinite(middle) ? Interval{middle, middle} : now;
}

double stepped(double now, double target, double step) noexcept {
  if (std::isinf(target)) return target;
  return now + std::clamp(target - now, -step, step);
}

}  // namespace

MovingLimits advanced(const MovingLimits& now, Interval target, double q, double v_rec,
                      double dt) noexcept {
  const Interval goal = readable(target, now.q);
  const double step = v_rec * dt;
  Interval next = {stepped(now.q.lb, goal.lb, step), stepped(now.q.ub, goal.ub, step)};

  // a new limit must not start beyond the joint, nor beyond the other limit
  if (now.q.lb == -kInfinity && goal.lb > -kInfinity) next.lb = std::min(goal.lb, q);
  if (now.q.ub == kInfinity && goal.ub < kInfinity) next.ub = std::max({goal.ub, q, next.lb});
  next.lb = std::min(next.lb, next.ub);
  return {next, target.empty()};
}

}  // namespace hg::limits
