/// Position of a joint over that of the joint which it follows: a smooth curve through many points.
#pragma once

#include <vector>

#include "hg/core/interval.h"

namespace hg::model {

/// Cubic spline through points at equal distances: continuous with slope and curvature. Where the
/// leader turns without end, the curve continues from turn to turn. Does not change after
/// construction; nothing allocates or throws. SI units.
class CouplingCurve {
 public:
  struct Point {
    double value = 0.0;      ///< Position of the joint that follows, rad or m
    double slope = 0.0;      ///< Its speed over that of the leader
    double curvature = 0.0;  ///< Derivative of the slope by the leader's position
  };

  /// A curve over `range` through at least four `values` at equal distances, the first and the last
  /// at its ends, where its slopes are `first_slope` and `last_slope`. `is_periodic`: the range is
  /// a period, and each adds the difference between the last value and the first.
  CouplingCurve(const Interval& range, std::vector<double> values, double first_slope,
                double last_slope, bool is_periodic);

  /// The curve where the leader is at q; beyond the range it continues straight, or in turns.
  Point at(double q) const noexcept;
  /// Positions of the leader that the curve is given for; unbounded if it is periodic.
  Interval range() const noexcept { return is_periodic_ ? Interval{} : range_; }
  /// Largest magnitude of the slope.
  double steepest() const noexcept;

 private:
  Interval range_;
  double step_ = 1.0;
  bool is_periodic_ = false;
  std::vector<double> values_, curvatures_;  ///< At the points
};

}  // namespace hg::model
