/// Finite position ranges for sampling and for start values of joints without limits.
#pragma once

#include <cmath>
#include <numbers>

#include "hg/core/interval.h"

namespace hg::model {

/// `range` (rad, or m for a prismatic joint) with both ends finite: one turn, or 2 m, from the
/// existing limit; around 0 without any limit.
inline Interval finite_range(Interval range, bool is_angle) noexcept {
  const double half = is_angle ? std::numbers::pi : 1.0;
  if (!std::isfinite(range.lb)) range.lb = std::isfinite(range.ub) ? range.ub - 2.0 * half : -half;
  if (!std::isfinite(range.ub)) range.ub = range.lb + 2.0 * half;
  return range;
}

}  // namespace hg::model
