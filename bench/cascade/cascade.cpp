#include "bench/cascade/cascade.h"

#include <algorithm>
#include <cmath>

namespace hg::bench {
namespace {

// Row times its weight.
void coefficients(const hqp::Problem& problem, int row, Eigen::VectorXd& c) {
  if (const int variable = problem.variable(row); variable >= 0) {
    c.setZero();
    c[variable] = problem.weight(row);
  } else {
    c = problem.weight(row) *
        Eigen::Map<const Eigen::VectorXd>(problem.coefficients(row).data(), c.size());
  }
}

}  // namespace

bool Cascade::solve(const hqp::Problem& problem, double* x) {
  const int n = problem.variables();
  x_.setZero(n);
  c_.resize(n);
  Z_.setIdentity(n, n);
  CE_.resize(0, 0);
  ce0_.resize(0);
  kept_.clear();
  bool is_solved = true;
  for (int level = 0; level < problem.levels() && Z_.cols() > 0; ++level) {
    collect(problem, level);
    if (A_.rows() == 0 && own_.empty()) continue;
    fill_objective();
    fill_constraints(problem);
    is_solved &= solve_level();
    keep_inequalities(problem);
    shrink_null_space();
  }
  Eigen::Map<Eigen::VectorXd>(x, n) = x_;
  return is_solved;
}

void Cascade::collect(const hqp::Problem& problem, int level) {
  own_.clear();
  int equalities = 0;
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const Interval bounds = problem.bounds(row);
    if (bounds.lb == bounds.ub) {
      ++equalities;
    } else if (std::isfinite(bounds.lb) || std::isfinite(bounds.ub)) {
      own_.push_back(row);
    }
  }
  A_.resize(equalities, problem.variables());
  b_.resize(equalities);
  int i = 0;
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (problem.bounds(row).lb != problem.bounds(row).ub) continue;
    coefficients(problem, row, c_);
    A_.row(i) = c_;
    b_[i++] = problem.weight(row) * problem.bounds(row).lb;
  }
}

void Cascade::fill_objective() {
  const Eigen::Index free = Z_.cols(), slacks = static_cast<Eigen::Index>(own_.size());
  AZ_.noalias() = A_ * Z_;
  H_.setZero(free + slacks, free + slacks);
  H_.topLeftCorner(free, free).noalias() = AZ_.transpose() * AZ_;
  H_.diagonal().tail(slacks).setOnes();
  H_.diagonal().array() += options_.hessian_epsilon;
  b_.noalias() -= A_ * x_;
  g_.setZero(free + slacks);
  g_.head(free).noalias() = -AZ_.transpose() * b_;
}

// One line per finite end, in the form CI zeta + ci0 >= 0.
void Cascade::fill_constraints(const hqp::Problem& problem) {
  const Eigen::Index free = Z_.cols(), slacks = static_cast<Eigen::Index>(own_.size());
  const auto most = static_cast<Eigen::Index>(2 * (kept_.size() + own_.size()));
  CI_.setZero(most, free + slacks);
  ci0_.resize(most);
  Eigen::Index line = 0;
  const auto add = [&](int row, double slack, double epsilon, Eigen::Index slack_variable) {
    coefficients(problem, row, c_);
    const double value = c_.dot(x_) + slack, weight = problem.weight(row);
    for (const double side : {1.0, -1.0}) {
      const double bound = side > 0.0 ? problem.bounds(row).lb : problem.bounds(row).ub;
      if (!std::isfinite(bound)) continue;
      CI_.row(line).head(free).noalias() = side * c_.transpose() * Z_;
      if (slack_variable >= 0) CI_(line, free + slack_variable) = side;
      ci0_[line++] = side * (value - weight * bound) + epsilon;
    }
  };
  for (const Kept& kept : kept_) add(kept.row, kept.slack, options_.bound_epsilon, -1);
  for (Eigen::Index i = 0; i < slacks; ++i) add(own_[i], 0.0, 0.0, i);
  CI_.conservativeResize(line, Eigen::NoChange);
  ci0_.conservativeResize(line);
}

bool Cascade::solve_level() {
  using eiquadprog::solvers::EIQUADPROG_FAST_OPTIMAL;
  const Eigen::Index size = g_.size();
  CE_.resize(0, size);
  zeta_.resize(size);
  qp_.reset(size, 0, CI_.rows());
  const auto status = qp_.solve_quadprog(H_, g_, CE_, ce0_, CI_, ci0_, zeta_);
  if (status != EIQUADPROG_FAST_OPTIMAL || !zeta_.allFinite()) return false;
  x_.noalias() += Z_ * zeta_.head(Z_.cols());
  return true;
}

void Cascade::keep_inequalities(const hqp::Problem& problem) {
  for (const int row : own_) {
    coefficients(problem, row, c_);
    const double value = c_.dot(x_), weight = problem.weight(row);
    const Interval bounds = problem.bounds(row);
    kept_.push_back({row, std::clamp(value, weight * bounds.lb, weight * bounds.ub) - value});
  }
}

void Cascade::shrink_null_space() {
  if (AZ_.rows() == 0) return;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(AZ_.transpose());
  qr.setThreshold(options_.rank_threshold);
  Z_.applyOnTheRight(qr.householderQ());
  const Eigen::MatrixXd rest = Z_.rightCols(Z_.cols() - qr.rank());
  Z_ = rest;
}

}  // namespace hg::bench

/// Entry point looked up after loading; the cascade exists as long as the program.
extern "C" bool hg_cascade_solve(const hg::hqp::Problem& problem, double* x) {
  static hg::bench::Cascade cascade;
  return cascade.solve(problem, x);
}
