#include "hg/hqp/direct_elimination.h"

#include <algorithm>
#include <cmath>

#include "hg/hqp/dense_least_squares.h"
#include "hg/hqp/rows.h"

namespace hg::hqp {
namespace {

// What is left of a row is, relative to its norm, an upper bound of its distance from the others,
// and at most the norm of the free directions away from it. Within this factor of the tolerance,
// the decision is left to the orthogonal elimination.
constexpr double kDoubt = 1e3;
// Weight of the numbers of a row in the choice of its variable, for variables that are taken last.
constexpr double kTakenLast = 1e-2;
constexpr double kRoundOff = 1e-14;  // a value below this share of its terms is none

}  // namespace

DirectElimination::DirectElimination(int max_variables, int max_rows)
    : pivots_(index(max_variables)),
      pivot_of_variable_(index(max_variables)),
      preference_(max_variables),
      R_(max_variables * max_variables),
      L_(max_variables * max_variables),
      y_(max_variables),
      factors_(max_variables),
      level_factors_(max_variables * max_rows),
      matrix_(max_variables * max_rows),
      targets_(max_rows),
      rhs_(max_rows),
      values_(max_variables),
      order_(max_rows) {}

void DirectElimination::reset(const Problem& problem) noexcept {
  n_ = problem.variables();
  rank_ = 0;
  std::fill_n(pivot_of_variable_.begin(), n_, -1);
  preference_.head(n_).setOnes();
  for (int row = 0; row < problem.rows(); ++row) {
    const int variable = problem.variable(row);
    if (variable >= 0 && is_equality(problem.bounds(row))) preference_[variable] = kTakenLast;
  }
}

void DirectElimination::truncate(int rank) noexcept {
  while (rank_ > rank) pivot_of_variable_[index(pivots_[index(--rank_)].variable)] = -1;
}

// y -= factors R for the pivots first..rank-1
void DirectElimination::reduce(int first, int rank, double* y_data,
                               double* factors) const noexcept {
  Eigen::Map<Eigen::VectorXd> y(y_data, n_);
  for (int s = first; s < rank; ++s) {
    const Pivot& pivot = pivots_[index(s)];
    const double factor = y[pivot.variable] * pivot.inverse;
    factors[s] = factor;
    if (factor == 0.0) continue;
    if (!pivot.is_unit) y -= factor * VectorView(R_.data() + s * n_, n_);
    y[pivot.variable] = 0.0;
  }
}

// Judges what is left of a row, and chooses the variable that it would take.
DirectElimination::Outcome DirectElimination::judge(double norm, double tolerance) noexcept {
  const double largest = y_.head(n_).cwiseAbs().maxCoeff();
  if (largest * kDoubt <= tolerance * norm) return Outcome::kDependent;
  if (!(largest > kDoubt * tolerance * norm)) return Outcome::kUnsure;
  y_.head(n_).cwiseAbs().cwiseProduct(preference_.head(n_)).maxCoeff(&variable_);
  return Outcome::kIndependent;
}

// A row of a single variable is left alone when the variable is free, and vanishes when another
// such row has taken it.
DirectElimination::Outcome DirectElimination::reduce_unit(TargetRow row, int variable,
                                                          double tolerance) noexcept {
  factors_.head(rank_).setZero();
  value_ = row.target;
  value_scale_ = std::abs(row.target);
  const int t = pivot_of_variable_[index(variable)];
  is_unit_ = t < 0;
  variable_ = variable;
  if (t < 0) return Outcome::kIndependent;
  if (pivots_[index(t)].is_unit) {
    factors_[t] = 1.0;
    subtract_pivots(t, t + 1);
    return Outcome::kDependent;
  }
  y_.head(n_).setZero();
  y_[variable] = 1.0;
  reduce(t, rank_, y_.data(), factors_.data());
  subtract_pivots(t, rank_);
  return judge(1.0, tolerance);
}

DirectElimination::Outcome DirectElimination::reduce(const Problem& problem, TargetRow row,
                                                     double tolerance) noexcept {
  const int variable = problem.variable(row.row);
  if (variable >= 0) return reduce_unit(row, variable, tolerance);
  y_.head(n_) = VectorView(problem.coefficients(row.row).data(), n_);
  reduce(0, rank_, y_.data(), factors_.data());
  is_unit_ = false;
  value_ = row.target;
  value_scale_ = std::abs(row.target);
  subtract_pivots(0, rank_);
  return judge(problem.norm(row.row), tolerance);
}

// What the pivots first..end-1 leave of the target.
void DirectElimination::subtract_pivots(int first, int end) noexcept {
  for (int s = first; s < end; ++s) {
    const double term = factors_[s] * pivots_[index(s)].value;
    value_ -= term;
    value_scale_ += std::abs(term);
  }
}

void DirectElimination::append(int row) noexcept {
  pivots_[index(rank_)] = {.row = row,
                           .variable = variable_,
                           .is_unit = is_unit_,
                           .inverse = is_unit_ ? 1.0 : 1.0 / y_[variable_],
                           .value = value_};
  if (!is_unit_) {
    reduced_row(rank_) = y_.head(n_);
    Eigen::Map<Eigen::VectorXd>(L_.data() + rank_ * n_, rank_) = factors_.head(rank_);
  }
  pivot_of_variable_[index(variable_)] = rank_;
  ++rank_;
}

DirectElimination::Outcome DirectElimination::add_row(const Problem& problem, TargetRow row,
                                                      double tolerance) noexcept {
  const Outcome outcome = reduce(problem, row, tolerance);
  if (outcome == Outcome::kIndependent) append(row.row);
  return outcome;
}

bool DirectElimination::add_least_squares(const Problem& problem, std::span<const TargetRow> rows,
                                          double tolerance) noexcept {
  const int first = rank_;
  bool is_met = true;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const TargetRow row = rows[index(i)];
    const Outcome outcome = reduce(problem, row, tolerance);
    if (outcome == Outcome::kUnsure) return false;

    Eigen::Map<Eigen::VectorXd> factors(level_factors_.data() + i * n_, n_ - first);
    factors.setZero();
    factors.head(rank_ - first) = factors_.segment(first, rank_ - first);
    targets_[i] = value_;
    for (int s = first; s < rank_; ++s) targets_[i] += factors_[s] * pivots_[index(s)].value;
    if (outcome == Outcome::kIndependent) {
      factors[rank_ - first] = 1.0;
      append(row.row);
    } else if (std::abs(value_) > kRoundOff * value_scale_) {
      is_met = false;
    }
  }
  if (!is_met && rank_ > first) solve_level(problem, rows, first);
  return true;
}

// Values of the pivots from `first` on, in the sense of least squares over all rows of the level.
void DirectElimination::solve_level(const Problem& problem, std::span<const TargetRow> rows,
                                    int first) noexcept {
  const int r = rank_ - first;
  int m = 0;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const VectorView factors(level_factors_.data() + i * n_, r);
    if (!factors.isZero(0.0)) order_[m++] = i;
  }
  Eigen::Map<Eigen::MatrixXd> A(matrix_.data(), m, r);
  for (int k = 0; k < m; ++k) {
    const int i = order_[k];
    const double weight = problem.weight(rows[index(i)].row);
    A.row(k) = weight * VectorView(level_factors_.data() + i * n_, r).transpose();
    rhs_[k] = weight * targets_[i];
  }
  solve_least_squares(m, r, A.data(), rhs_.data(), order_.data(), values_.data());
  for (int j = 0; j < r; ++j) pivots_[index(first + j)].value = values_[j];
}

void DirectElimination::find_point(double* x_data) const noexcept {
  Eigen::Map<Eigen::VectorXd> x(x_data, n_);
  x.setZero();
  for (int t = rank_ - 1; t >= 0; --t) {
    const Pivot& pivot = pivots_[index(t)];
    const double others = pivot.is_unit ? 0.0 : VectorView(R_.data() + t * n_, n_).dot(x);
    x[pivot.variable] = (pivot.value - others) * pivot.inverse;
  }
}

double DirectElimination::find_multipliers(const double* g, int rank, int first,
                                           double* mu) noexcept {
  y_.head(n_) = VectorView(g, n_);
  reduce(0, rank, y_.data(), factors_.data());
  for (int t = rank - 1; t >= first; --t) {
    mu[t] = -factors_[t];
    if (!pivots_[index(t)].is_unit) factors_.head(t) += mu[t] * VectorView(L_.data() + t * n_, t);
  }
  return y_.head(n_).cwiseAbs().maxCoeff();
}

}  // namespace hg::hqp
