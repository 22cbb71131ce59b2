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
constexpr double kMost = 1e3;      // times the mass in that direction: beyond, nothing moves anyway
constexpr double kLeast = 1e-9;    // m, as small as a singular value may count

// Whether all eigenvalues are larger than `least`; false for NaN.
bool are_larger(const Matrix6& A, double least) noexcept {
  const Eigen::LLT<Matrix6> factor(A - least * Matrix6::Identity());
  return factor.info() == Eigen::Success && factor.matrixLLT()(5, 5) > 0.0;
}

}  // namespace

void LostDirections::find(const model::Jacobian& J, const model::Jacobian& J_a, const MatrixA& L,
                          const VectorA& dq_a, double dt) noexcept {
  count_ = 0;
  dt_ = dt;
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, kLength, kLength, kLength;
  const model::Jacobian scaled = scale.asDiagonal() * J;
  const Matrix6 A = scaled * scaled.transpose();
  if (are_larger(A, kFrom * kFrom)) return;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(A);
  roots_.resize(dq_a.size(), 6);
  for (int i = 0; i < 6; ++i) {
    const double s = std::sqrt(std::max(eigen.eigenvalues()[i], kLeast * kLeast));
    if (!(s < kFrom)) break;  // the smallest come first
    const VectorA along = J_a.transpose() * scale.cwiseProduct(eigen.eigenvectors().col(i));
    const double mobility = L.triangularView<Eigen::Lower>().solve(along).squaredNorm();
    if (!(mobility > 0.0)) continue;                     // the twin does not move there
    const double speed = std::abs(along.dot(dq_a)) / s;  // of a joint
    const double friction = kFriction / (1.0 + speed / kSlow);
    const double b = friction * (1.0 / (s * s) - 1.0 / (kFrom * kFrom));
    roots_.col(count_++) = std::sqrt(std::min(b, kMost / (dt * mobility))) * along;
  }
}

VectorA LostDirections::torque(const VectorA& dq_a) const noexcept {
  VectorA torque = VectorA::Zero(dq_a.size());
  for (int i = 0; i < count_; ++i) torque += roots_.col(i).dot(dq_a) * roots_.col(i);
  return torque;
}

// Rank-one updates of the factor.
void LostDirections::add_to(MatrixA& L) const noexcept {
  for (int d = 0; d < count_; ++d) {
    VectorA x = std::sqrt(dt_) * roots_.col(d);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double diagonal = std::hypot(L(k, k), x[k]);
      const double c = diagonal / L(k, k), s = x[k] / L(k, k);
      L(k, k) = diagonal;
      for (Eigen::Index i = k + 1; i < x.size(); ++i) {
        L(i, k) = (L(i, k) + s * x[i]) / c;
        x[i] = c * x[i] - s * L(i, k);
      }
    }
  }
}

}  // namespace hg::rendering
