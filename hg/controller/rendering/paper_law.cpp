#include "hg/controller/rendering/paper_law.h"

#include <cmath>

namespace hg::rendering {
namespace {

// of 1 + |bound|; well above what the solver leaves, well below what a hand feels
constexpr double kTouchTolerance = 1e-7;

double value_of(const hqp::Problem& problem, int row, std::span<const double> x) noexcept {
  const int variable = problem.variable(row);
  if (variable >= 0) return x[variable];
  const std::span<const double> c = problem.coefficients(row);
  double value = 0.0;
  for (std::size_t i = 0; i < c.size(); ++i) value += c[i] * x[i];
  return value;
}

bool reaches(double value, double end) noexcept {
  return std::isfinite(end) && value >= end - kTouchTolerance * (1.0 + std::abs(end));
}

}  // namespace

bool touches_lower(const hqp::Problem& problem, int row, std::span<const double> x) noexcept {
  return reaches(-value_of(problem, row, x), -problem.bounds(row).lb);
}

bool touches_upper(const hqp::Problem& problem, int row, std::span<const double> x) noexcept {
  return reaches(value_of(problem, row, x), problem.bounds(row).ub);
}

PaperLaw::PaperLaw(const DeviceModel& device, const TwinModel& twin)
    : n_m_(device.n_m),
      n_a_(twin.chain.nv()),
      device_limits_(device.limit_count()),
      response_(n_a_, n_a_ + device_limits_ + 1),
      coefficients_(n_m_ + 2 * n_a_ + device_limits_, 0.0) {}

int PaperLaw::alpha(int limit) const noexcept {
  const int first = n_m_ + n_a_;
  return limit < device_limits_ ? first + n_a_ + limit : first + limit - device_limits_;
}

void PaperLaw::add_levels(hqp::Problem& problem) {
  const int first = n_m_ + n_a_;
  const int count = n_a_ + device_limits_;
  problem.add_level();
  dynamics_row_ = problem.rows();
  for (int i = 0; i < n_a_; ++i) problem.add_row(coefficients_, {});
  problem.add_level();
  range_row_ = problem.rows();
  for (int i = 0; i < count; ++i) problem.add_bound(first + i, {0.0, 0.0});
  problem.add_level();
  for (int i = 0; i < count; ++i) problem.add_bound(first + i, {0.0, 0.0});
}

// [HG] (20): ddq_a - M_a^-1 sum of direction times alpha = M_a^-1 tau
void PaperLaw::fill(const MatrixA& L, const VectorA& tau, int first_limit_row,
                    ConstraintDirections& directions, hqp::Problem& problem) noexcept {
  const int count = n_a_ + device_limits_;
  response_.leftCols(n_a_).setIdentity();
  for (int limit = 0; limit < device_limits_; ++limit) {
    directions.find(problem, first_limit_row + limit, limit);
    response_.col(n_a_ + limit) = directions.torque(limit);
  }
  response_.col(count) = tau;
  L.triangularView<Eigen::Lower>().solveInPlace(response_);
  L.triangularView<Eigen::Lower>().adjoint().solveInPlace(response_);

  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), n_m_ + n_a_ + count);
  row.head(n_m_).setZero();
  for (int i = 0; i < n_a_; ++i) {
    row.segment(n_m_, n_a_).setZero();
    row[n_m_ + i] = 1.0;
    row.tail(count) = -response_.row(i).head(count);
    problem.set_row(dynamics_row_ + i, coefficients_);
    problem.set_bounds(dynamics_row_ + i, {response_(i, count), response_(i, count)});
  }
}

void PaperLaw::set_range(int limit, bool lower_touched, bool upper_touched, bool is_locked,
                         hqp::Problem& problem) const noexcept {
  const int row = range_row_ + alpha(limit) - n_m_ - n_a_;
  problem.set_bounds(row, {upper_touched || is_locked ? -kInfinity : 0.0,
                           lower_touched || is_locked ? kInfinity : 0.0});
}

}  // namespace hg::rendering
