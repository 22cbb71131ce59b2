#include "hg/model/capability.h"

#include <algorithm>

#include "hg/core/linear_algebra.h"

namespace hg::model {
namespace {

constexpr double kNoLength = 1e-9;       // m or 1: a column shorter than this is zero by rounding
constexpr double kRankTolerance = 1e-9;  // of singular values

}  // namespace

Guarantee worst_direction(const Eigen::Ref<const Eigen::Matrix3Xd>& columns,
                          const Eigen::Ref<const Eigen::VectorXd>& available) {
  Guarantee worst;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double length = columns.col(i).norm();
    if (length < kNoLength) continue;
    const double value = std::max(0.0, available[i]) / length;
    if (value < worst.value) worst = {value, static_cast<int>(i)};
  }
  return worst;
}

Guarantee worst_acceleration(const Jacobian& J, const Eigen::Ref<const Eigen::VectorXd>& ddq_max) {
  const auto [sigma, U, V] = singular_value_decomposition(J);
  if (sigma.size() < 6 || sigma[5] < kRankTolerance) return {0.0, -1};
  const Eigen::MatrixXd inverse =
      V * sigma.cwiseInverse().asDiagonal() * U.transpose().leftCols<3>();
  return worst_direction(inverse.transpose(), ddq_max);
}

bool holds_wrench(const Jacobian& J, const Eigen::Ref<const Eigen::VectorXd>& available,
                  double force, double torque) {
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const double needed = force * J.col(i).head<3>().norm() + torque * J.col(i).tail<3>().norm();
    if (needed > available[i]) return false;
  }
  return true;
}

Conditioning conditioning(const Jacobian& J, double length) {
  Jacobian scaled = J;
  scaled.topRows<3>() /= length;
  const Eigen::VectorXd sigma = singular_value_decomposition(scaled).sigma;
  if (sigma.size() < 6) return {0.0, kInfinity};
  return {sigma[5], sigma[5] > 0.0 ? sigma[0] / sigma[5] : kInfinity};
}

}  // namespace hg::model
