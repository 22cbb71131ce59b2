#include "hg/teleoperation/turn.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "hg/core/cross.h"
#include "hg/core/rotation.h"

namespace hg::teleoperation {
namespace {

constexpr double kSmall = 1e-6;  // rad

Eigen::Matrix3d orientation(const Eigen::Vector3d& turn) noexcept {
  const double angle = turn.norm();
  if (angle < kSmall) return Eigen::Matrix3d::Identity() + cross_matrix(turn);
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

// The turn to `R` that is nearest to `before`: beyond half a turn it grows, and does not begin
// from the other side.
Eigen::Vector3d turn_to(const Eigen::Matrix3d& R, const Eigen::Vector3d& before) noexcept {
  const Eigen::Vector3d shortest = rotation_between(Eigen::Matrix3d::Identity(), R);
  const double angle = shortest.norm();
  if (angle < kSmall) return shortest;
  const Eigen::Vector3d other = shortest * (1.0 - 2.0 * std::numbers::pi / angle);
  return (other - before).norm() < (shortest - before).norm() ? other : shortest;
}

// Chirikjian 2012, eq. 10.86: left Jacobian of the exponential map.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn) noexcept {
  const double angle = turn.norm();
  const Eigen::Matrix3d K = cross_matrix(turn);
  if (angle < 1e-3) return Eigen::Matrix3d::Identity() + 0.5 * K + K * K / 6.0;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / a2 * K +
         (angle - std::sin(angle)) / (a2 * angle) * K * K;
}

}  // namespace

void Turn::begin(const Eigen::Matrix3d& R, const Eigen::Vector3d& x) noexcept {
  x_ = x;
  C_ = R.transpose() * orientation(x / lever_);
}

void Turn::follow(const Eigen::Matrix3d& R) noexcept {
  const Eigen::Vector3d turn = turn_to(R * C_, x_ / lever_);
  x_ = lever_ * turn;
  J_ = left_jacobian(turn);
  constexpr double kAlmostWhole = 6.0;  // rad, J has no inverse at a whole turn
  if (turn.norm() < kAlmostWhole) J_inverse_ = J_.inverse();
}

Eigen::Vector3d Turn::speed(const Eigen::Vector3d& angular_velocity) const noexcept {
  return lever_ * (J_inverse_ * angular_velocity);
}

Eigen::Vector3d Turn::force(const Eigen::Vector3d& torque) const noexcept {
  return J_.transpose() * torque / lever_;
}

Eigen::Vector3d Turn::torque(const Eigen::Vector3d& force) const noexcept {
  return lever_ * (J_inverse_.transpose() * force);
}

}  // namespace hg::teleoperation
