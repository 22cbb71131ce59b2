#include "hg/hqp/solver/householder_qr.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "hg/hqp/solver/dense_least_squares.h"
#include "hg/hqp/solver/rows.h"

namespace hg::hqp::solver {

HouseholderQr::HouseholderQr(int max_variables, int max_rows)
    : Q_(max_variables * max_variables),
      pivot_row_(max_variables),
      pivot_(max_variables),
      reflection_(max_variables),
      scratch_(max_variables),
      step_(max_variables),
      reduced_(max_variables * max_rows),
      order_(max_rows),
      rhs_(max_rows),
      factor_(max_variables * max_rows),
      z_(max_variables) {}

void HouseholderQr::reset(int n) noexcept {
  n_ = n;
  rank_ = 0;
  Eigen::Map<Eigen::MatrixXd>(Q_.data(), n, n).setIdentity();
}

Eigen::Map<Eigen::MatrixXd> HouseholderQr::free_columns() noexcept {
  return {Q_.data() + rank_ * n_, n_, freedom()};
}

// y = factor * N^T c
void HouseholderQr::reduce(const Problem& problem, int row, double factor, double* y) noexcept {
  const auto N = free_columns();
  Eigen::Map<Eigen::VectorXd> reduced(y, freedom());
  const int variable = problem.variable(row);
  if (variable >= 0) {
    reduced = factor * N.row(variable).transpose();
  } else {
    const VectorView c(problem.coefficients(row).data(), n_);
    for (Eigen::Index k = 0; k < N.cols(); ++k) reduced[k] = factor * N.col(k).dot(c);
  }
}

// Turns the free columns so that the row reduced to y meets only the first of them; returns its
// product with that column. The reflection is kept.
double HouseholderQr::reflect(const double* y, int size) noexcept {
  auto h = reflection_.head(size);
  h = VectorView(y, size);
  const double length = h.norm();
  const double pivot = h[0] > 0.0 ? -length : length;
  h[0] -= pivot;
  reflection_factor_ = -1.0 / (pivot * h[0]);

  auto N = free_columns();
  auto v = scratch_.head(n_);
  v.setZero();
  for (Eigen::Index k = 0; k < size; ++k) v += (reflection_factor_ * h[k]) * N.col(k);
  for (Eigen::Index k = 0; k < size; ++k) N.col(k) -= h[k] * v;
  return pivot;
}

bool HouseholderQr::add_row(const Problem& problem, int row, double tolerance) noexcept {
  if (freedom() == 0) return false;
  double* y = z_.data();
  reduce(problem, row, 1.0, y);
  const double length = Eigen::Map<Eigen::VectorXd>(y, freedom()).norm();
  if (!(length > tolerance * problem.norm(row))) return false;
  pivot_[rank_] = reflect(y, freedom());
  pivot_row_[rank_] = row;
  ++rank_;
  return true;
}

// Reduced rows are in reduced_, `size` numbers each. Afterwards the first r rows of order_ form a
// lower triangular matrix; returns r.
int HouseholderQr::choose_pivots(std::span<const TargetRow> rows, double tolerance,
                                 const Problem& problem) noexcept {
  const int m = static_cast<int>(rows.size());
  const int size = freedom();
  Eigen::Map<Eigen::MatrixXd> reduced(reduced_.data(), size, m);
  std::iota(order_.data(), order_.data() + m, 0);

  int r = 0;
  for (; r < std::min(m, size); ++r) {
    int best = -1;
    double best_share = tolerance;
    for (int i = r; i < m; ++i) {
      const int row = rows[order_[i]].row;
      const double share =
          reduced.col(order_[i]).tail(size - r).norm() / (problem.norm(row) * problem.weight(row));
      if (share > best_share) {
        best_share = share;
        best = i;
      }
    }
    if (best < 0) break;
    std::swap(order_[r], order_[best]);

    const int row = rows[order_[r]].row;
    const double pivot = reflect(reduced.col(order_[r]).data() + r, size - r);
    const auto h = reflection_.head(size - r);
    for (int i = r; i < m; ++i) {
      auto y = reduced.col(order_[i]).tail(size - r);
      y -= (reflection_factor_ * h.dot(y)) * h;
    }
    pivot_[rank_] = pivot / problem.weight(row);
    pivot_row_[rank_] = row;
    ++rank_;
  }
  return r;
}

void HouseholderQr::add_least_squares(const Problem& problem, std::span<const TargetRow> rows,
                                      const double* x, double tolerance) noexcept {
  const int m = static_cast<int>(rows.size());
  const int size = freedom();
  const int first = rank_;
  for (int i = 0; i < m; ++i) {
    const auto [row, target] = rows[i];
    const double weight = problem.weight(row);
    Eigen::Map<Eigen::VectorXd> y(reduced_.data() + i * size, size);
    reduce(problem, row, weight, y.data());
    if (y.norm() <= tolerance * weight * problem.norm(row)) y.setZero();  // not for this level
    rhs_[i] = weight * (target - dot(problem, row, x));
  }
  const int r = choose_pivots(rows, tolerance, problem);

  Eigen::Map<Eigen::MatrixXd> reduced(reduced_.data(), size, m);
  if (r == m) {
    for (int j = 0; j < r; ++j) {
      const auto row = reduced.col(order_[j]);
      z_[j] = (rhs_[order_[j]] - row.head(j).dot(z_.head(j))) / row[j];
    }
  } else if (r > 0) {
    Eigen::Map<Eigen::MatrixXd> A(factor_.data(), m, r);
    for (int i = 0; i < m; ++i) A.row(i) = reduced.col(i).head(r).transpose();
    solve_least_squares(m, r, A.data(), rhs_.data(), order_.data(), z_.data());
  }

  auto d = step_.head(n_);
  d.setZero();
  for (int j = 0; j < r; ++j) d += z_[j] * VectorView(column(first + j), n_);
}

void HouseholderQr::project_to_free(const double* g, double* out) noexcept {
  const auto N = free_columns();
  const VectorView gradient(g, n_);
  Eigen::Map<Eigen::VectorXd> result(out, n_);
  result.setZero();
  for (Eigen::Index k = 0; k < N.cols(); ++k) result += N.col(k).dot(gradient) * N.col(k);
}

}  // namespace hg::hqp::solver
