#include "hg/identify/block_regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeast = 1e-12;  // of a column's own square

// Factors of a normal matrix with columns of any size; directions without rows stay near 0.
class Factors {
 public:
  explicit Factors(const MatrixXd& H)
      : scale_(H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()) {
    MatrixXd scaled = scale_.asDiagonal() * H * scale_.asDiagonal();
    scaled.diagonal().array() += kLeast;
    ldlt_.compute(scaled);
  }
  VectorXd solve(const VectorXd& g) const {
    return scale_.cwiseProduct(ldlt_.solve(scale_.cwiseProduct(g)));
  }
  MatrixXd inverse() const {
    const Eigen::Index n = scale_.size();
    return scale_.asDiagonal() * ldlt_.solve(MatrixXd::Identity(n, n)) * scale_.asDiagonal();
  }

 private:
  VectorXd scale_;
  Eigen::LDLT<MatrixXd> ldlt_;
};

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

// With the columns in `used` only, and this precision of their prior; inflation is that of
// `judged`.
Regressed BlockRegression::solve(const std::vector<Eigen::Index>& used, const VectorXd& precision,
                                 const std::vector<Eigen::Index>& judged) const {
  const Block sum = total();
  const auto blocks = static_cast<double>(blocks_.size());
  MatrixXd H = sum.H(used, used);
  const VectorXd g = sum.g(used);
  H.diagonal() += precision;
  const Factors factors(H);
  Regressed result;
  result.x = factors.solve(g);
  result.inverse = factors.inverse();
  const double squares =
      sum.yy - 2.0 * result.x.dot(g) + result.x.dot(sum.H(used, used) * result.x);
  result.residual = std::sqrt(std::max(0.0, squares) / sum.rows);

  MatrixXd without(g.size(), blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    without.col(static_cast<Eigen::Index>(b)) =
        Factors(H - blocks_[b].H(used, used)).solve(g - VectorXd(blocks_[b].g(used)));
  }
  without.colwise() -= VectorXd(without.rowwise().mean());
  result.covariance = (blocks - 1.0) / blocks * without * without.transpose();

  result.inflation = inflation_of(used, result.x, judged);
  return result;
}

// A block's rows pull at a parameter together: the mean square of that over what independent rows
// of variance 1 would do.
double BlockRegression::inflation_of(const std::vector<Eigen::Index>& used, const VectorXd& x,
                                     const std::vector<Eigen::Index>& judged) const {
  VectorXd pulls = VectorXd::Zero(columns_), sizes = VectorXd::Zero(columns_);
  for (const Block& block : blocks_) {
    const VectorXd pull = block.g - block.H(Eigen::all, used) * x;
    pulls += pull.cwiseAbs2();
    sizes += block.H.diagonal();
  }
  double logarithms = 0.0, count = 0.0;
  for (const Eigen::Index i : judged) {
    if (!(pulls[i] > 0.0 && sizes[i] > 0.0)) continue;
    logarithms += std::log(pulls[i] / sizes[i]);
    ++count;
  }
  return count > 0.0 ? std::exp(logarithms / count) : 1.0;
}

Regressed BlockRegression::solve(const VectorXd& prior) const {
  std::vector<Eigen::Index> all, open;
  for (Eigen::Index i = 0; i < columns_; ++i) {
    all.push_back(i);
    if (prior[i] == kInfinity) open.push_back(i);
  }
  // how much the rows count against the prior follows from what they leave
  constexpr int kRounds = 3;
  const VectorXd shares = prior.array().square().inverse();
  double inflation = solve(open, VectorXd::Zero(std::ssize(open)), open).inflation;
  Regressed result;
  for (int round = 0; round < kRounds; ++round) {
    result = solve(all, inflation * shares, open);
    inflation = result.inflation;
  }
  return result;
}

}  // namespace hg::identify
