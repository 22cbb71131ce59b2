#include "hg/hqp/solver/dense_least_squares.h"

#include <Eigen/Core>
#include <cmath>
#include <numeric>
#include <utility>

namespace hg::hqp::solver {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd>;
using Vector = Eigen::Map<Eigen::VectorXd>;

void sort_rows_by_size(Matrix& A, Vector& e) noexcept {
  for (Eigen::Index i = 0; i + 1 < A.rows(); ++i) {
    Eigen::Index largest = i;
    double size = A.row(i).cwiseAbs().maxCoeff();
    for (Eigen::Index k = i + 1; k < A.rows(); ++k) {
      const double size_k = A.row(k).cwiseAbs().maxCoeff();
      if (size_k > size) {
        size = size_k;
        largest = k;
      }
    }
    if (largest != i) {
      A.row(i).swap(A.row(largest));
      std::swap(e[i], e[largest]);
    }
  }
}

void move_longest_column_to(Eigen::Index j, Matrix& A, int* order) noexcept {
  Eigen::Index longest = j;
  double length = -1.0;
  for (Eigen::Index k = j; k < A.cols(); ++k) {
    const double length_k = A.col(k).tail(A.rows() - j).squaredNorm();
    if (length_k > length) {
      length = length_k;
      longest = k;
    }
  }
  if (longest != j) {
    A.col(j).swap(A.col(longest));
    std::swap(order[j], order[longest]);
  }
}

}  // namespace

void solve_least_squares(int m, int r, double* A_data, double* e_data, int* order,
                         double* z) noexcept {
  Matrix A(A_data, m, r);
  Vector e(e_data, m);
  std::iota(order, order + r, 0);
  sort_rows_by_size(A, e);

  // A P = Q R, column j of R ends up in rows 0..j of column j of A
  for (Eigen::Index j = 0; j < r; ++j) {
    move_longest_column_to(j, A, order);
    auto h = A.col(j).tail(m - j);
    const double length = h.norm();
    const double diagonal = h[0] > 0.0 ? -length : length;
    h[0] -= diagonal;
    const double factor = -1.0 / (diagonal * h[0]);
    for (Eigen::Index k = j + 1; k < r; ++k) {
      auto c = A.col(k).tail(m - j);
      c -= (factor * h.dot(c)) * h;
    }
    auto c = e.tail(m - j);
    c -= (factor * h.dot(c)) * h;
    A(j, j) = diagonal;
  }

  for (Eigen::Index j = r - 1; j >= 0; --j) {
    const double value = e[j] / A(j, j);
    e.head(j) -= value * A.col(j).head(j);
    z[order[j]] = value;
  }
}

}  // namespace hg::hqp::solver
