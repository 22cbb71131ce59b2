/// Closed intervals: limits, bounds and slacks are all of this kind.
#pragma once

#include <algorithm>
#include <limits>

namespace hg {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Closed interval [lb, ub]; empty when lb > ub. An infinite end means "no limit on this side".
struct Interval {
  double lb = -kInfinity;
  double ub = kInfinity;

  constexpr bool empty() const noexcept { return lb > ub; }
  constexpr bool contains(double x) const noexcept { return lb <= x && x <= ub; }
  constexpr bool bounded() const noexcept { return lb > -kInfinity || ub < kInfinity; }
};

/// Intersection of two intervals; empty if they are disjoint.
constexpr Interval intersect(Interval a, Interval b) noexcept {
  return {std::max(a.lb, b.lb), std::min(a.ub, b.ub)};
}

/// Intersection of both; if disjoint, the point of `stronger` nearest to `weaker`. An empty
/// `stronger` is ignored.
constexpr Interval moved_into(Interval weaker, Interval stronger) noexcept {
  if (stronger.empty()) return weaker;
  return {std::clamp(weaker.lb, stronger.lb, stronger.ub),
          std::clamp(weaker.ub, stronger.lb, stronger.ub)};
}

}  // namespace hg
