/// Orientation of a remote tool that a leader turns, as three coordinates of a port.
///
/// The tool turns as the leader does from where both were when they were coupled:
///
///   R_tool = R_leader C,   C = R_leader(0)^T R_tool(0),   R_tool = exp(x / l),
///
/// with the turn from the tool's orientation at its start, times a lever l, so that all coordinates
/// of a port are lengths and all its forces are N. With the left Jacobian J of the exponential map
/// at x / l and the angular velocity w and torque n:
///
///   dx/dt = l J^-1 w,   f = J^T n / l,   f dx/dt = n w.
///
/// Valid below a whole turn. No allocation, noexcept.
#pragma once

#include <Eigen/Core>

namespace hg::teleoperation {

class Turn {
 public:
  explicit Turn(double lever) : lever_(lever) {}

  /// Couples a leader with orientation `R` with a tool at `x`.
  void begin(const Eigen::Matrix3d& R, const Eigen::Vector3d& x) noexcept;
  /// The leader has orientation `R` now.
  void follow(const Eigen::Matrix3d& R) noexcept;

  const Eigen::Vector3d& x() const noexcept { return x_; }
  Eigen::Vector3d speed(const Eigen::Vector3d& angular_velocity) const noexcept;
  Eigen::Vector3d force(const Eigen::Vector3d& torque) const noexcept;
  Eigen::Vector3d torque(const Eigen::Vector3d& force) const noexcept;

 private:
  double lever_;
  Eigen::Matrix3d C_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d J_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d J_inverse_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
};

}  // namespace hg::teleoperation
