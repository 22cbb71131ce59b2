/// Arithmetic with rows of a problem, with a fast path for rows of a single variable.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "hg/hqp/problem.h"

namespace hg::hqp::solver {

using VectorView = Eigen::Map<const Eigen::VectorXd>;

/// Dot product a b of n numbers; avoids Eigen's dispatch for small n.
inline double dot(int n, const double* a, const double* b) noexcept {
  using Pair = Eigen::Array2d;
  using PairView = Eigen::Map<const Pair>;
  Pair even = Pair::Zero();
  Pair odd = Pair::Zero();
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    even += PairView(a + i) * PairView(b + i);
    odd += PairView(a + i + 2) * PairView(b + i + 2);
  }
  if (i + 2 <= n) {
    even += PairView(a + i) * PairView(b + i);
    i += 2;
  }
  const double sum = (even + odd).sum();
  return i < n ? sum + a[i] * b[i] : sum;
}

/// c x of row `row`; `x` points to problem.variables() numbers.
inline double dot(const Problem& problem, int row, const double* x) noexcept {
  const int variable = problem.variable(row);
  if (variable >= 0) return x[variable];
  return dot(problem.variables(), problem.coefficients(row).data(), x);
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

/// Signed distance of `value` from the interval: > 0 above, < 0 below, 0 inside.
inline double excess(Interval bounds, double value) noexcept {
  if (value > bounds.ub) return value - bounds.ub;
  if (value < bounds.lb) return value - bounds.lb;
  return 0.0;
}

/// Size of the terms of c x - bound; rounding errors are a fraction of it.
inline double magnitude(double norm, double bound, double x_norm) noexcept {
  return norm * x_norm + (std::isfinite(bound) ? std::abs(bound) : 0.0);
}

}  // namespace hg::hqp::solver
