/// Arithmetic with rows of a problem that treats single variables as what they are.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "hg/hqp/problem.h"

namespace hg::hqp {

inline std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

using VectorView = Eigen::Map<const Eigen::VectorXd>;

/// c x of row `row`; `x` points to problem.variables() numbers.
inline double dot(const Problem& problem, int row, const double* x) noexcept {
  const int variable = problem.variable(row);
  if (variable >= 0) return x[variable];
  const Eigen::Index n = problem.variables();
  return VectorView(problem.coefficients(row).data(), n).dot(VectorView(x, n));
}

/// y += factor * c of row `row`.
inline void add_multiple(const Problem& problem, int row, double factor, double* y) noexcept {
  const int variable = problem.variable(row);
  if (variable >= 0) {
    y[variable] += factor;
    return;
  }
  const Eigen::Index n = problem.variables();
  Eigen::Map<Eigen::VectorXd>(y, n) += factor * VectorView(problem.coefficients(row).data(), n);
}

inline bool is_equality(Interval bounds) noexcept { return bounds.lb == bounds.ub; }

/// How far `value` is outside: > 0 above the upper bound, < 0 below the lower one, 0 inside.
inline double excess(Interval bounds, double value) noexcept {
  if (value > bounds.ub) return value - bounds.ub;
  if (value < bounds.lb) return value - bounds.lb;
  return 0.0;
}

/// Size of the numbers that meet in c x - bound; rounding errors are a fraction of it.
inline double magnitude(double norm, double bound, double x_norm) noexcept {
  return norm * x_norm + (std::isfinite(bound) ? std::abs(bound) : 0.0);
}

}  // namespace hg::hqp
