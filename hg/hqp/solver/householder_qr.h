/// Orthogonal elimination of rows: the null space (3)-(4) of [HG], one row at a time.
///
/// Q is orthogonal (n x n). Its first rank() columns span the pivot rows, column t being orthogonal
/// to pivot rows 0..t-1; the other columns span what these rows leave free. A new pivot row turns
/// only the free columns (Householder reflection), so dropping the last pivots costs nothing.
/// Contract: no allocation after construction.
#pragma once

#include <Eigen/Core>
#include <span>

#include "hg/hqp/problem.h"

namespace hg::hqp::solver {

/// A row with its target value.
struct TargetRow {
  int row;
  double target;
};

class HouseholderQr {
 public:
  HouseholderQr(int max_variables, int max_rows);

  /// Forgets all pivots; n variables.
  void reset(int n) noexcept;
  /// Forgets all pivots but the first `rank`.
  void truncate(int rank) noexcept { rank_ = rank; }

  int rank() const noexcept { return rank_; }
  int freedom() const noexcept { return n_ - rank_; }
  /// Row id of pivot t, and c q of that row and its column.
  int pivot_row(int t) const noexcept { return pivot_row_[t]; }
  double pivot(int t) const noexcept { return pivot_[t]; }
  const double* column(int t) const noexcept { return Q_.data() + t * n_; }

  /// Takes the row as next pivot, unless it depends on the others: the free part of it is not
  /// longer than `tolerance` times its norm.
  bool add_row(const Problem& problem, int row, double tolerance) noexcept;

  /// Writes into step() the smallest free step d from x that minimises sum weight^2 (c (x + d) -
  /// target)^2. The rows become pivots, as far as they are independent: of the candidates always
  /// the one with the longest free part relative to its norm.
  void add_least_squares(const Problem& problem, std::span<const TargetRow> rows, const double* x,
                         double tolerance) noexcept;
  const Eigen::VectorXd& step() const noexcept { return step_; }

  /// Projects g onto the free columns: out = N N^T g, n numbers.
  void project_to_free(const double* g, double* out) noexcept;

 private:
  Eigen::Map<Eigen::MatrixXd> free_columns() noexcept;
  void reduce(const Problem& problem, int row, double factor, double* y) noexcept;
  double reflect(const double* y, int size) noexcept;
  int choose_pivots(std::span<const TargetRow> rows, double tolerance,
                    const Problem& problem) noexcept;

  int n_ = 0;
  int rank_ = 0;
  Eigen::VectorXd Q_;  ///< n x n, column after column
  Eigen::VectorXi pivot_row_;
  Eigen::VectorXd pivot_;
  Eigen::VectorXd reflection_;  ///< Householder vector of the last reflect()
  double reflection_factor_ = 0.0;
  Eigen::VectorXd scratch_;
  Eigen::VectorXd step_;
  // least squares block: reduced rows as columns, their order, right-hand side, factor
  Eigen::VectorXd reduced_;
  Eigen::VectorXi order_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd factor_;
  Eigen::VectorXd z_;
};

}  // namespace hg::hqp::solver
