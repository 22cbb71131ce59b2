/// Cholesky factors of the small matrices of one simulation step: plain loops, faster at this size
/// than general ones, with bitwise identical results on all machines.
///
/// Only lower triangles are read and written. No allocation, noexcept.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace hg::simulator {

/// Replaces the lower triangle of a positive definite matrix A by its factor L, L L^T = A.
template <typename Matrix>
void factorise(Matrix& A) noexcept {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < j; ++k) {
      for (Eigen::Index i = j; i < n; ++i) A(i, j) -= A(i, k) * A(j, k);
    }
    const double root = std::sqrt(A(j, j));
    A(j, j) = root;
    for (Eigen::Index i = j + 1; i < n; ++i) A(i, j) /= root;
  }
}

/// Solves L x = b in place; `first`: entries of b before it are zero.
template <typename Matrix, typename Vector>
void solve_lower(const Matrix& L, Vector&& x, Eigen::Index first = 0) noexcept {
  for (Eigen::Index j = first; j < L.rows(); ++j) {
    x[j] /= L(j, j);
    for (Eigen::Index i = j + 1; i < L.rows(); ++i) x[i] -= L(i, j) * x[j];
  }
}

/// Solves L^T x = b in place.
template <typename Matrix, typename Vector>
void solve_upper(const Matrix& L, Vector&& x) noexcept {
  for (Eigen::Index j = L.rows() - 1; j >= 0; --j) {
    for (Eigen::Index i = j + 1; i < L.rows(); ++i) x[j] -= L(i, j) * x[i];
    x[j] /= L(j, j);
  }
}

}  // namespace hg::simulator
