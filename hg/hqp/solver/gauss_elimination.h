/// HouseholderQr of one variable per row (Gauss): the task of HouseholderQr without reflections, in
/// an eighth of the time, where rounding leaves no doubt about ranks.
///
/// Row c_t becomes pivot t: R_t = c_t - sum over s < t of L_ts R_s meets only variables that the
/// pivots before it have not taken. Rows of single variables stay unchanged; to keep it so,
/// variables that some equality fixes alone are taken last. Least squares: G. Peters, J. Wilkinson,
/// The least squares problem and pseudo-inverses, Computer Journal 13(3), 1970. Contract: no
/// allocation after construction. Doubtful cases are reported (false, kUnsure).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solver/householder_qr.h"

namespace hg::hqp::solver {

class GaussElimination {
 public:
  enum class Outcome : std::uint8_t { kIndependent, kDependent, kUnsure };

  GaussElimination(int max_variables, int max_rows);

  /// Forgets all pivots; gets ready for `problem`.
  void reset(const Problem& problem) noexcept;
  /// Forgets all pivots but the first `rank`.
  void truncate(int rank) noexcept;

  int rank() const noexcept { return rank_; }
  int freedom() const noexcept { return n_ - rank_; }
  /// Row id of pivot t; -1: a variable that add_smallest_norm() took.
  int pivot_row(int t) const noexcept { return pivots_[t].row; }

  /// Adds the row as next pivot, with c x = target, unless it depends on the others.
  Outcome add_row(const Problem& problem, TargetRow row, double tolerance) noexcept;

  /// Adds the rows as pivots as far as they are independent. Their values minimise
  /// sum weight^2 (c x - target)^2. False if in doubt; the pivots must then be truncated.
  [[nodiscard]] bool add_least_squares(const Problem& problem, std::span<const TargetRow> rows,
                                       double tolerance) noexcept;

  /// Whether the last add_least_squares() gives every row its target.
  bool is_met() const noexcept { return is_met_; }

  /// Eliminates all free variables, with the values that minimise |x|.
  void add_smallest_norm(const Problem& problem) noexcept;

  /// The point where every pivot row has its value, n numbers; needs freedom() == 0. False if in
  /// doubt: the point is so much larger than the targets that a rank may be wrong.
  [[nodiscard]] bool find_point(double* x) const noexcept;

  bool is_free(int variable) const noexcept { return pivot_of_variable_[variable] < 0; }

  /// Reduces a row to the free variables: c x = y x + the result, with the pivots at their values.
  /// y has n numbers and zeros up to a multiple of 4, and meets only free variables.
  double reduce_to_free(const Problem& problem, int row, double* y) noexcept;
  /// Reduces a single variable, as reduce_to_free() of a row.
  double reduce_to_free(int variable, double* y) noexcept;

  /// Computes the eliminated variables of x from the free ones; their old values do not matter.
  void complete(double* x) const noexcept;

  /// Finds mu with g + sum over t < rank of mu_t c_t = 0; writes only those from `first` on.
  /// Returns the largest component of the sum.
  double find_multipliers(const double* g, int rank, int first, double* mu) noexcept;

 private:
  struct Pivot {
    int row;
    int variable;
    bool is_unit;    ///< c_t = R_t is a single variable
    double inverse;  ///< 1 / R_t[variable]
    double size;     ///< largest |R_t|
    double value;    ///< value of R_t x
  };

  /// Scalars that accompany the reduced row y.
  struct Rest {
    double value = 0.0;        ///< remaining target value for y x
    double value_scale = 0.0;  ///< size of the terms of `value`
    double growth = 0.0;       ///< size of the terms of y

    /// Updates the scalars for y -= factor R_t, with the pivot t.
    void subtract(double factor, const Pivot& pivot) noexcept {
      const double term = factor * pivot.value;
      value -= term;
      value_scale += std::abs(term);
      growth += std::abs(factor) * pivot.size;
    }
  };
  /// A row put aside, reduced by the first `depth` pivots.
  struct DeferredRow {
    int row;
    double norm;
    int slot;  ///< index of y and its factors, stride_ apart
    int depth;
    Rest rest;
  };

  double* reduced_row(int t) noexcept { return R_.data() + t * stride_; }
  const double* reduced_row(int t) const noexcept { return R_.data() + t * stride_; }
  double* factors(int t) noexcept { return L_.data() + t * stride_; }
  const double* factors(int t) const noexcept { return L_.data() + t * stride_; }
  void load(const double* c, double* y) const noexcept;
  void subtract_pivots(int first, int end, double* y, double* factors, Rest& rest) const noexcept;
  void reduce(const Problem& problem, TargetRow row) noexcept;
  void reduce_unit(int variable, double target) noexcept;
  void choose_variable() noexcept;
  Outcome decide_rank(double norm, double tolerance) noexcept;
  Outcome decide_rank_closely(double norm, double tolerance) noexcept;
  void append(int row) noexcept;
  void keep_dependent(double weight, double smallest, int first) noexcept;
  double weight_of_pivot(const Problem& problem, int t) const noexcept;
  void defer(int row, double norm) noexcept;
  bool add_deferred_rows(const Problem& problem, int first, double tolerance) noexcept;
  void solve_level(const Problem& problem, int first) noexcept;
  bool solve_for_residuals(const Problem& problem, int first) noexcept;
  void solve_by_reflections(const Problem& problem, int first) noexcept;

  int n_ = 0;
  /// Distance from row to row: n rounded up to a multiple of 4, padded with zeros
  int stride_ = 0;
  int rank_ = 0;
  std::vector<Pivot> pivots_;
  std::vector<int> pivot_of_variable_;  ///< -1: free
  bool has_preference_ = false;
  Eigen::VectorXd preference_;  ///< per variable, 1: may be eliminated at once

  // Row t of R and of L (L_ts for s < t), stride_ apart. Row rank_ is the row under work: y and its
  // factors, y = c - factors R.
  Eigen::VectorXd R_;
  Eigen::VectorXd L_;
  int variable_ = -1;     ///< variable that y would eliminate
  bool is_unit_ = false;  ///< y is a single free variable, unreduced
  double largest_ = 0.0;  ///< largest |y_i|
  Rest rest_;

  std::vector<DeferredRow> deferred_;
  Eigen::VectorXd deferred_rows_;
  Eigen::VectorXd deferred_factors_;

  // least squares of a level: its dependent rows D, as combinations of its pivots, the residuals of
  // their targets, and the change of the pivots' values
  int dependents_ = 0;
  bool is_met_ = true;              ///< residual of D is zero
  Eigen::VectorXd dependent_rows_;  ///< rows of D, n apart
  Eigen::VectorXd dependent_rest_;
  Eigen::VectorXd dependent_weight_;
  Eigen::VectorXd matrix_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd change_;
  Eigen::VectorXi order_;
  Eigen::VectorXd scratch_;
};

}  // namespace hg::hqp::solver
