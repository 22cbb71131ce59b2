/// Positions of a joint to draw from or to begin in, where some of its limits are missing.
#pragma once

#include <cmath>
#include <numbers>

#include "hg/core/interval.h"

namespace hg::model {

/// `range` (rad, or m for a slide) with both ends finite: one turn, or 2 m, from the limit that
/// there is; around 0 where there is none.
inline Interval finite_range(Interval range, bool is_angle) noexcept {
  const double half = is_angle ? std::numbers::pi : 1.0;
  if (!std::isfinite(range.lb)) range.lb = std::isfinite(range.ub) ? range.ub - 2.0 * half : -half;
  if (!std::isfinite(range.ub)) range.ub = range.lb + 2.0 * half;
  return range;
}

}  // namespace hg::model
