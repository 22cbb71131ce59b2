/// Selects active rows among those at their bounds, by non-negative least squares on multipliers.
///
/// At a point x with gradient g, minimises |g + F^T lambda + sum mu_i s_i c_i| over mu >= 0, where
/// F are the pivot rows already eliminated and s_i = +1 at an upper, -1 at a lower bound. The
/// negated residual is the steepest feasible descent; a zero residual proves x optimal. The
/// residual decreases with every change, so degenerate corners cannot make it cycle. [LH74] C.
/// Lawson, R. Hanson, Solving Least Squares Problems, 1974, ch. 23.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solver/householder_qr.h"

namespace hg::hqp::solver {

/// A row at one of its bounds.
struct RowAtBound {
  int row;
  double sign;  ///< +1: at the upper bound, -1: at the lower
};

class Nnls {
 public:
  Nnls(int max_variables, int max_candidates);

  /// Runs on `candidates`, of which earlier ones are preferred among equals. Leaves the rows
  /// with positive multipliers as pivots of `elimination`, after those it had. `g_scale`: size of
  /// the terms that make up g.
  void solve(const Problem& problem, const std::vector<RowAtBound>& candidates, const double* g,
             double g_scale, double rank_tolerance, HouseholderQr& elimination) noexcept;

  /// Number of rows with positive multipliers, these rows, and their multipliers.
  int size() const noexcept { return size_; }
  RowAtBound row(int i) const noexcept { return rows_[i]; }
  double mu(int i) const noexcept { return mu_[i]; }
  /// Steepest feasible descent, minus the residual.
  const Eigen::VectorXd& descent() const noexcept { return descent_; }

 private:
  int most_opposed(const Problem& problem, const std::vector<RowAtBound>& candidates,
                   double descent_norm) const noexcept;
  void solve_passive(const Problem& problem, const double* g, int base,
                     const HouseholderQr& elimination) noexcept;
  void remove_non_positive(const Problem& problem, int base, double rank_tolerance,
                           HouseholderQr& elimination) noexcept;

  int size_ = 0;
  std::vector<RowAtBound> rows_;
  Eigen::VectorXd mu_;
  Eigen::VectorXd mu_new_;
  /// Per candidate: in rows_ already, or dependent on them
  std::vector<std::uint8_t> is_excluded_;
  std::vector<int> candidate_;  ///< candidate index per entry of rows_
  Eigen::VectorXd descent_;
  Eigen::VectorXd rest_;
};

}  // namespace hg::hqp::solver
