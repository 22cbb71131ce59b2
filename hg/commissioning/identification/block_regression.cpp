#include "hg/commissioning/identification/block_regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hg::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Solves H x = g with columns of any size; directions without rows stay near 0.
VectorXd solve_scaled(MatrixXd H, const VectorXd& g) {
  constexpr double kLeast = 1e-12;  // of a column's own square
  const VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  H = scale.asDiagonal() * H * scale.asDiagonal();
  H.diagonal().array() += kLeast;
  return scale.cwiseProduct(H.ldlt().solve(scale.cwiseProduct(g)));
}

}  // namespace

void BlockRegression::begin_block() {
  blocks_.push_back({MatrixXd::Zero(columns_, columns_), VectorXd::Zero(columns_)});
}

void BlockRegression::add(const MatrixXd& A, const VectorXd& y) {
  Block& block = blocks_.back();
  block.H.noalias() += A.transpose() * A;
  block.g.noalias() += A.transpose() * y;
  block.yy += y.squaredNorm();
  block.rows += static_cast<double>(y.size());
}

BlockRegression::Block BlockRegression::total() const {
  Block sum = {MatrixXd::Zero(columns_, columns_), VectorXd::Zero(columns_)};
  for (const Block& block : blocks_) {
    sum.H += block.H;
    sum.g += block.g;
    sum.yy += block.yy;
    sum.rows += block.rows;
  }
  return sum;
}

Regressed BlockRegression::solve(const VectorXd& prior) const {
  const Block sum = total();
  const auto blocks = static_cast<double>(blocks_.size());
  Regressed result;
  const auto square = [&](const VectorXd& x) {
    return std::max(0.0, sum.yy - 2.0 * x.dot(sum.g) + x.dot(sum.H * x)) / sum.rows;
  };
  const double variance = square(solve_scaled(sum.H, sum.g));

  // rows of one block are no independent evidence against the prior
  MatrixXd H = sum.H;
  H.diagonal().array() += variance * sum.rows / blocks * prior.array().square().inverse();
  result.x = solve_scaled(H, sum.g);
  result.residual = std::sqrt(square(result.x));

  MatrixXd without(columns_, blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    without.col(static_cast<Eigen::Index>(b)) =
        solve_scaled(H - blocks_[b].H, sum.g - blocks_[b].g);
  }
  without.colwise() -= VectorXd(without.rowwise().mean());
  result.covariance = (blocks - 1.0) / blocks * without * without.transpose();
  return result;
}

}  // namespace hg::identification
