/// Statistics of repeated measurements.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace hg::haptify {

/// Mean of independent repetitions, with the half width of its 95 % confidence interval.
struct Mean {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< mean; NaN without repetitions
  /// Half width; NaN for less than two repetitions
  double half_width = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;
};

/// Mean and two-sided confidence interval by Student's t, for normally distributed values.
Mean mean_of(std::span<const double> values);

inline double mean_value(std::span<const double> values) { return mean_of(values).value; }

/// 97.5 % quantile of Student's distribution; degrees >= 1.
double student_t(std::size_t degrees);

}  // namespace hg::haptify
