#include "hg/controller/rendering/lost_directions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kLength = 0.3;    // m, at which a rotation counts
constexpr double kFrom = 0.05;     // singular value from which on a direction is as it is, m
constexpr double kFriction = 0.1;  // of a joint, Nms/rad
constexpr double kSlow = 0.1;      // rad/s, of a joint, up to which its friction is viscous
constexpr double kLeast = 1e-12;   // m^2, of a squared singular value: none is divided by zero

// Whether all squared singular values are larger than `least`: their inverses add up to the trace
// of the inverse.
bool are_larger(const Matrix6& A, double least) noexcept {
  const Eigen::LLT<Matrix6> factor(A);
  if (factor.info() != Eigen::Success) return false;
  const Matrix6 inverse_root = factor.matrixL().solve(Matrix6::Identity());
  return inverse_root.squaredNorm() * least < 1.0;
}

}  // namespace

VectorA lost_directions_torque(const model::Jacobian& J_H, int n_m, const model::Jacobian& J_a,
                               const MatrixA& L, const VectorA& dq_a, const VectorA& tau,
                               double dt) noexcept {
  VectorA damping = VectorA::Zero(dq_a.size());
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, kLength, kLength, kLength;
  const model::Jacobian J = scale.asDiagonal() * J_H.rightCols(n_m);
  const Matrix6 A = J * J.transpose();
  if (are_larger(A, kFrom * kFrom)) return damping;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(A);
  const auto factor = L.triangularView<Eigen::Lower>();
  for (int i = 0; i < 6; ++i) {
    const double squared = std::max(eigen.eigenvalues()[i], kLeast);
    if (squared >= kFrom * kFrom) break;  // the smallest come first
    const VectorA along = J_a.transpose() * scale.cwiseProduct(eigen.eigenvectors().col(i));
    const double speed = std::abs(along.dot(dq_a)) / std::sqrt(squared);  // of a joint
    const double b = kFriction / (1.0 + speed / kSlow) * (1.0 / squared - 1.0 / (kFrom * kFrom));
    const VectorA root = factor.solve(along);
    const VectorA rest = factor.solve(tau - damping);
    const double v = along.dot(dq_a) + dt * root.dot(rest);
    damping += b * v / (1.0 + dt * b * root.squaredNorm()) * along;
  }
  return damping;
}

}  // namespace hg::rendering
