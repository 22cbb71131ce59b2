/// The user's wrench from the robot's own estimate, and the check at rest whether it may be used.
#pragma once

#include <string>

#include "hg/core/types.h"
#include "hg/device/franka/protocol.h"

namespace hg::franka {

/// Values of a state as vectors; `n` values from float to double.
VectorM joints_of(const std::array<float, kJoints>& values) noexcept;

/// The user's wrench on the handle at S, resolved in S. K_F_ext_hat_K of the robot is the wrench of
/// the robot on its surroundings, so its sign is the other one. `T_F_S` is the pose of S in the
/// flange F.
Vector6 user_wrench(const RobotState& state, const Pose& T_F_S) noexcept;

/// Means of the robot's estimates over some states at rest.
struct RestingEstimate {
  int states = 0;
  double fastest = 0.0;  ///< largest speed of a joint, rad/s
  bool has_any = false;  ///< some value of the estimate was not exactly zero
  double m_ee = 0.0;     ///< mass of the end effector that the robot knows, kg
  VectorM q = VectorM::Zero(kJoints), tau_ext = VectorM::Zero(kJoints);
  Vector6 w_S = Vector6::Zero();

  void add(const RobotState& state, const Pose& T_F_S) noexcept;
  void finish() noexcept;  ///< sums to means
};

/// Why the estimate must not be used as the user's wrench; empty: it may. `weight` are the torques
/// that hold the arm, Nm.
std::string objection(const RestingEstimate& estimate, const VectorM& weight);

enum class SignCheck {
  kRight,
  kWrong,
  kUnseen,  ///< the weight does not appear, or is too small
};

/// Compares the weight of a tool as the robot's estimate shows it with the true one; forces on the
/// flange, N.
SignCheck check_weight(const Eigen::Vector3d& seen, const Eigen::Vector3d& weight) noexcept;

}  // namespace hg::franka
