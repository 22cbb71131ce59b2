#include "hg/hqp/solver/gauss_elimination.h"

#include <algorithm>
#include <cmath>

#include "hg/hqp/solver/dense_least_squares.h"
#include "hg/hqp/solver/rows.h"

namespace hg::hqp::solver {
namespace {

// Ratio of a row's remainder, relative to its norm, to the tolerance: the decision is clear when
// the remainder is that many times larger or smaller, else the row is judged closely.
constexpr double kClear = 1e3;
// Growth of the terms of y over its row from which rounding shows.
constexpr double kLargestGrowth = 1e6;
// Rows of a level with a smaller remaining share yield to the others of the level.
constexpr double kSmallRemainder = 1e-2;
// Weight of a row's coefficients in the choice of its variable, for variables eliminated last.
constexpr double kTakenLast = 1e-2;
constexpr double kRoundOff = 1e-14;  // a value below this share of its terms counts as zero
// Largest number of [E -I] in the residual form of least squares: its condition is not much larger.
constexpr double kLargestResidualFactor = 1e3;

constexpr int kBlock = 4;
int padded(int n) noexcept { return (n + kBlock - 1) / kBlock * kBlock; }

// y -= factor * r, `size` being a multiple of kBlock.
void subtract(int size, double factor, const double* __restrict r, double* __restrict y) noexcept {
  for (int v = 0; v < size; v += kBlock) {
    for (int k = 0; k < kBlock; ++k) y[v + k] -= factor * r[v + k];
  }
}

using Block = Eigen::Array<double, kBlock, 1>;
using BlockView = Eigen::Map<const Block>;

// y = a b, number by number; `size` is a multiple of kBlock here and below.
void multiply(int size, const double* a, const double* b, double* y) noexcept {
  for (int v = 0; v < size; v += kBlock) {
    Eigen::Map<Block>(y + v) = BlockView(a + v) * BlockView(b + v);
  }
}

// Size of the largest number of y.
double largest(int size, const double* y) noexcept {
  Block result = Block::Zero();
  for (int v = 0; v < size; v += kBlock) result = result.max(BlockView(y + v).abs());
  return result.maxCoeff();
}

// Index of the first number of y that has at least this size.
int find_size(int n, const double* y, double size) noexcept {
  int v = 0;
  while (v + 1 < n && std::abs(y[v]) < size) ++v;
  return v;
}

}  // namespace

GaussElimination::GaussElimination(int max_variables, int max_rows)
    : pivots_(max_variables),
      pivot_of_variable_(max_variables),
      preference_(padded(max_variables)),
      R_((max_variables + 1) * padded(max_variables)),
      L_((max_variables + 1) * padded(max_variables)),
      deferred_rows_(max_rows * padded(max_variables)),
      deferred_factors_(max_rows * padded(max_variables)),
      dependent_rows_(max_variables * std::max(max_variables, max_rows)),
      dependent_rest_(std::max(max_variables, max_rows)),
      dependent_weight_(std::max(max_variables, max_rows)),
      matrix_(max_variables * (max_variables + max_rows)),
      rhs_(max_variables + max_rows),
      change_(max_variables),
      order_(max_variables + max_rows),
      scratch_(padded(max_variables)) {
  deferred_.reserve(max_rows);
}

void GaussElimination::reset(const Problem& problem) noexcept {
  n_ = problem.variables();
  stride_ = padded(n_);
  rank_ = 0;
  std::fill_n(pivot_of_variable_.begin(), n_, -1);
  has_preference_ = false;
  const int rows = problem.rows();
  for (int row = 0; row < rows; ++row) {
    const int variable = problem.variable(row);
    if (variable < 0 || !is_equality(problem.bounds(row))) continue;
    if (!has_preference_) preference_.head(stride_).setOnes();
    has_preference_ = true;
    preference_[variable] = kTakenLast;
  }
}

void GaussElimination::truncate(int rank) noexcept {
  while (rank_ > rank) pivot_of_variable_[pivots_[--rank_].variable] = -1;
}

void GaussElimination::load(const double* c, double* y) const noexcept {
  std::copy_n(c, n_, y);
  std::fill(y + n_, y + stride_, 0.0);
}

// y -= factors R for the pivots from `first` up to `end`; `rest` follows.
void GaussElimination::subtract_pivots(int first, int end, double* y, double* factors,
                                       Rest& rest) const noexcept {
  for (int s = first; s < end; ++s) {
    const Pivot& pivot = pivots_[s];
    const double factor = y[pivot.variable] * pivot.inverse;
    factors[s] = factor;
    if (factor == 0.0) continue;
    if (!pivot.is_unit) subtract(stride_, factor, reduced_row(s), y);
    y[pivot.variable] = 0.0;
    rest.subtract(factor, pivot);
  }
}

// A row of a single variable is left alone when the variable is free, and vanishes when another
// such row has taken it.
void GaussElimination::reduce_unit(int variable, double target) noexcept {
  rest_ = {.value = target, .value_scale = std::abs(target)};
  variable_ = variable;
  const int t = pivot_of_variable_[variable];
  is_unit_ = t < 0;
  if (is_unit_) {
    largest_ = 1.0;
    return;
  }
  double* factor = factors(rank_);
  std::fill_n(factor, rank_, 0.0);
  if (pivots_[t].is_unit) {
    factor[t] = 1.0;
    rest_.subtract(1.0, pivots_[t]);
    largest_ = 0.0;
  } else {
    double* y = reduced_row(rank_);
    std::fill_n(y, stride_, 0.0);
    y[variable] = 1.0;
    subtract_pivots(t, rank_, y, factor, rest_);
    choose_variable();
  }
}

void GaussElimination::reduce(const Problem& problem, TargetRow row) noexcept {
  const int variable = problem.variable(row.row);
  if (variable >= 0) {
    reduce_unit(variable, row.target);
    return;
  }
  double* y = reduced_row(rank_);
  load(problem.coefficients(row.row).data(), y);
  is_unit_ = false;
  rest_ = {.value = row.target, .value_scale = std::abs(row.target)};
  subtract_pivots(0, rank_, y, factors(rank_), rest_);
  choose_variable();
}

// Chooses the variable that y would eliminate, and computes the size of y.
void GaussElimination::choose_variable() noexcept {
  const double* y = reduced_row(rank_);
  largest_ = largest(stride_, y);
  if (has_preference_) {
    multiply(stride_, y, preference_.data(), scratch_.data());
    variable_ = find_size(n_, scratch_.data(), largest(stride_, scratch_.data()));
  } else {
    variable_ = find_size(n_, y, largest_);
  }
}

GaussElimination::Outcome GaussElimination::decide_rank(double norm, double tolerance) noexcept {
  if (rest_.growth > kLargestGrowth * norm) return Outcome::kUnsure;
  if (largest_ * kClear <= tolerance * norm) return Outcome::kDependent;
  if (largest_ > kClear * tolerance * norm) return Outcome::kIndependent;
  return decide_rank_closely(norm, tolerance);
}

// The distance of the row from the pivots is at most |y|; and at least |y z| / |z|, where z is the
// free direction that moves variable_ and, of the others, only taken ones.
GaussElimination::Outcome GaussElimination::decide_rank_closely(double norm,
                                                                double tolerance) noexcept {
  const VectorView y(reduced_row(rank_), n_);
  const double rounding = kRoundOff * (norm + rest_.growth);
  if (y.norm() + rounding < tolerance * norm) return Outcome::kDependent;

  Eigen::Map<Eigen::VectorXd> z(scratch_.data(), n_);
  z.setZero();
  z[variable_] = 1.0;
  for (int s = rank_ - 1; s >= 0; --s) {
    const Pivot& pivot = pivots_[s];
    if (pivot.is_unit) continue;
    z[pivot.variable] = -dot(n_, reduced_row(s), z.data()) * pivot.inverse;
  }
  const double distance = (std::abs(y[variable_]) - rounding) / z.norm();
  return distance > tolerance * norm ? Outcome::kIndependent : Outcome::kUnsure;
}

void GaussElimination::append(int row) noexcept {
  const double inverse = is_unit_ ? 1.0 : 1.0 / reduced_row(rank_)[variable_];
  pivots_[rank_] = {.row = row,
                    .variable = variable_,
                    .is_unit = is_unit_,
                    .inverse = inverse,
                    .size = is_unit_ ? 1.0 : largest_,
                    .value = rest_.value};
  pivot_of_variable_[variable_] = rank_;
  ++rank_;
}

GaussElimination::Outcome GaussElimination::add_row(const Problem& problem, TargetRow row,
                                                    double tolerance) noexcept {
  reduce(problem, row);
  const Outcome outcome = decide_rank(problem.norm(row.row), tolerance);
  if (outcome == Outcome::kIndependent) append(row.row);
  return outcome;
}

// The row under work depends on the pivots, of which those from `first` on are of its level. It
// takes part in the level unless its share of these is smaller than `smallest`.
void GaussElimination::keep_dependent(double weight, double smallest, int first) noexcept {
  if (std::abs(rest_.value) > kRoundOff * rest_.value_scale) is_met_ = false;
  const double* factor = factors(rank_);
  double share = 0.0;
  for (int s = first; s < rank_; ++s) share += std::abs(factor[s]) * pivots_[s].size;
  if (share <= smallest) return;
  double* dependent = dependent_rows_.data() + dependents_ * n_;
  std::copy(factor + first, factor + rank_, dependent);
  std::fill(dependent + rank_ - first, dependent + n_ - first, 0.0);
  dependent_rest_[dependents_] = rest_.value;
  dependent_weight_[dependents_++] = weight;
}

bool GaussElimination::add_least_squares(const Problem& problem, std::span<const TargetRow> rows,
                                         double tolerance) noexcept {
  const int first = rank_;
  deferred_.clear();
  dependents_ = 0;
  is_met_ = true;
  for (const TargetRow& row : rows) {
    const double norm = problem.norm(row.row);
    reduce(problem, row);
    if (rest_.growth > kLargestGrowth * norm) return false;
    if (largest_ >= std::max(kSmallRemainder, kClear * tolerance) * norm) {
      append(row.row);
    } else if (decide_rank(norm, tolerance) == Outcome::kDependent) {
      keep_dependent(problem.weight(row.row), tolerance * norm, first);
    } else {
      defer(row.row, norm);
    }
  }
  if (!deferred_.empty() && !add_deferred_rows(problem, first, tolerance)) return false;
  if (!is_met_ && rank_ > first) solve_level(problem, first);
  return true;
}

// Stores the row under work in deferred_, to be decided later.
void GaussElimination::defer(int row, double norm) noexcept {
  const int slot = static_cast<int>(deferred_.size());
  std::copy_n(reduced_row(rank_), stride_, deferred_rows_.data() + slot * stride_);
  std::copy_n(factors(rank_), rank_, deferred_factors_.data() + slot * stride_);
  deferred_.push_back({.row = row, .norm = norm, .slot = slot, .depth = rank_, .rest = rest_});
}

// Adds the rows put aside, always the one with the largest remainder.
bool GaussElimination::add_deferred_rows(const Problem& problem, int first,
                                         double tolerance) noexcept {
  while (!deferred_.empty()) {
    std::size_t best = 0;
    double largest_share = -1.0;
    for (std::size_t k = 0; k < deferred_.size(); ++k) {
      DeferredRow& row = deferred_[k];
      double* y = deferred_rows_.data() + row.slot * stride_;
      double* factor = deferred_factors_.data() + row.slot * stride_;
      subtract_pivots(row.depth, rank_, y, factor, row.rest);
      row.depth = rank_;
      const double share = VectorView(y, n_).cwiseAbs().maxCoeff() / row.norm;
      if (share <= largest_share) continue;
      largest_share = share;
      best = k;
    }
    const DeferredRow row = deferred_[best];
    deferred_[best] = deferred_.back();
    deferred_.pop_back();

    std::copy_n(deferred_rows_.data() + row.slot * stride_, stride_, reduced_row(rank_));
    std::copy_n(deferred_factors_.data() + row.slot * stride_, rank_, factors(rank_));
    is_unit_ = false;
    rest_ = row.rest;
    choose_variable();
    const Outcome outcome = decide_rank(row.norm, tolerance);
    if (outcome == Outcome::kUnsure) return false;
    if (outcome == Outcome::kIndependent) {
      append(row.row);
    } else {
      keep_dependent(problem.weight(row.row), tolerance * row.norm, first);
    }
  }
  return true;
}

void GaussElimination::add_smallest_norm(const Problem& problem) noexcept {
  const int first = rank_;
  dependents_ = 0;
  for (int v = 0; v < n_; ++v) {
    if (pivot_of_variable_[v] >= 0) continue;
    reduce_unit(v, 0.0);
    append(-1);
  }
  for (int s = 0; s < first; ++s) {
    reduce_unit(pivots_[s].variable, 0.0);
    keep_dependent(1.0, 0.0, first);
  }
  solve_level(problem, first);
}

double GaussElimination::weight_of_pivot(const Problem& problem, int t) const noexcept {
  const int row = pivots_[t].row;
  return row < 0 ? 1.0 : problem.weight(row);
}

// Values of the pivots from `first` on, in the sense of least squares over all rows of the level:
// the change u minimises |W L u|^2 + |V (D u - rest)|^2, with the weights W of pivots and V of
// dependent rows.
void GaussElimination::solve_level(const Problem& problem, int first) noexcept {
  if (!solve_for_residuals(problem, first)) solve_by_reflections(problem, first);
  for (int t = first; t < rank_; ++t) pivots_[t].value += change_[t - first];
}

// Few dependent rows: the residuals z = (W L u, V (D u - rest)) are the smallest with [E -I] z = V
// rest, E = V D L^-1 W^-1. The rows of [E -I], made orthogonal one after the other, span z. False
// when this method is not suitable.
bool GaussElimination::solve_for_residuals(const Problem& problem, int first) noexcept {
  const int r = rank_ - first;
  const int d = dependents_;
  if (d >= r) return false;
  change_.head(r).setZero();
  for (int k = 0; k < d; ++k) {
    const double weight = dependent_weight_[k];
    Eigen::Map<Eigen::VectorXd> row(matrix_.data() + k * (r + d), r + d);
    row.head(r) = weight * VectorView(dependent_rows_.data() + k * n_, r);
    row.tail(d).setZero();
    row[r + k] = -1.0;
    for (int i = r - 1; i >= 0; --i) {
      const int t = first + i;
      if (!pivots_[t].is_unit) row.head(i) -= row[i] * VectorView(factors(t) + first, i);
    }
    for (int i = 0; i < r; ++i) row[i] /= weight_of_pivot(problem, first + i);
    if (!(row.cwiseAbs().maxCoeff() < kLargestResidualFactor)) return false;

    double rest = weight * dependent_rest_[k];
    for (int j = 0; j < k; ++j) {
      const VectorView other(matrix_.data() + j * (r + d), r + d);
      const double share = other.dot(row);
      row -= share * other;
      rest -= share * rhs_[j];
    }
    const double length = row.norm();
    row /= length;
    rhs_[k] = rest / length;
    change_.head(r) += rhs_[k] * row.head(r);
  }
  // from W L u to u
  for (int i = 0; i < r; ++i) {
    const int t = first + i;
    change_[i] /= weight_of_pivot(problem, t);
    if (!pivots_[t].is_unit) {
      change_[i] -= VectorView(factors(t) + first, i).dot(change_.head(i));
    }
  }
  return true;
}

void GaussElimination::solve_by_reflections(const Problem& problem, int first) noexcept {
  const int r = rank_ - first;
  const int m = r + dependents_;
  Eigen::Map<Eigen::MatrixXd> A(matrix_.data(), m, r);
  for (int i = 0; i < r; ++i) {
    const int t = first + i;
    const double weight = weight_of_pivot(problem, t);
    A.row(i).setZero();
    A(i, i) = weight;
    if (pivots_[t].is_unit) continue;
    A.row(i).head(i) = weight * VectorView(factors(t) + first, i).transpose();
  }
  rhs_.head(r).setZero();
  for (int i = 0; i < dependents_; ++i) {
    const double weight = dependent_weight_[i];
    A.row(r + i) = weight * VectorView(dependent_rows_.data() + i * n_, r).transpose();
    rhs_[r + i] = weight * dependent_rest_[i];
  }
  solve_least_squares(m, r, A.data(), rhs_.data(), order_.data(), change_.data());
}

bool GaussElimination::find_point(double* x) const noexcept {
  std::fill_n(x, n_, 0.0);
  double largest_term = 0.0;
  for (int t = rank_ - 1; t >= 0; --t) {
    const Pivot& pivot = pivots_[t];
    const double others = pivot.is_unit ? 0.0 : dot(n_, reduced_row(t), x);
    x[pivot.variable] = (pivot.value - others) * pivot.inverse;
    largest_term = std::max(largest_term, std::abs(pivot.value * pivot.inverse));
  }
  return VectorView(x, n_).cwiseAbs().maxCoeff() <= kLargestGrowth * largest_term;  // false for NaN
}

double GaussElimination::reduce_to_free(const Problem& problem, int row, double* y) noexcept {
  const int variable = problem.variable(row);
  if (variable >= 0) return reduce_to_free(variable, y);
  load(problem.coefficients(row).data(), y);
  Rest rest;
  subtract_pivots(0, rank_, y, factors(rank_), rest);
  return -rest.value;
}

double GaussElimination::reduce_to_free(int variable, double* y) noexcept {
  std::fill_n(y, stride_, 0.0);
  y[variable] = 1.0;
  const int t = pivot_of_variable_[variable];
  if (t < 0) return 0.0;
  Rest rest;
  subtract_pivots(t, rank_, y, factors(rank_), rest);
  return -rest.value;
}

void GaussElimination::complete(double* x) const noexcept {
  for (int t = 0; t < rank_; ++t) x[pivots_[t].variable] = 0.0;  // 0 * NaN is not 0
  for (int t = rank_ - 1; t >= 0; --t) {
    const Pivot& pivot = pivots_[t];
    const double others = pivot.is_unit ? 0.0 : dot(n_, reduced_row(t), x);
    x[pivot.variable] = (pivot.value - others) * pivot.inverse;
  }
}

double GaussElimination::find_multipliers(const double* g, int rank, int first,
                                          double* mu) noexcept {
  double* y = reduced_row(n_);
  Eigen::Map<Eigen::VectorXd> factor(factors(n_), n_);
  load(g, y);
  Rest unused;
  subtract_pivots(0, rank, y, factor.data(), unused);
  for (int t = rank - 1; t >= first; --t) {
    mu[t] = -factor[t];
    if (!pivots_[t].is_unit) factor.head(t) += mu[t] * VectorView(factors(t), t);
  }
  return VectorView(y, n_).cwiseAbs().maxCoeff();
}

}  // namespace hg::hqp::solver
