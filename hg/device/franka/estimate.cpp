#include "hg/device/franka/estimate.h"

#include <fmt/format.h>

#include <algorithm>

namespace hg::franka {
namespace {

constexpr double kAtRest = 0.02;      // rad/s
constexpr double kWeightShare = 0.3;  // of the arm's weight in the estimate
constexpr double kNoMass = 0.01;      // kg
constexpr double kMostForce = 10.0;   // N; more is a hand or a wrong load
constexpr double kMostTorque = 2.0;   // Nm

Pose pose_of(const std::array<float, 16>& columns) noexcept {
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix4f>(columns.data()).cast<double>();
  return {.p = T.topRightCorner<3, 1>(), .R = T.topLeftCorner<3, 3>()};
}

}  // namespace

VectorM joints_of(const std::array<float, kJoints>& values) noexcept {
  return Eigen::Map<const Eigen::Matrix<float, kJoints, 1>>(values.data()).cast<double>();
}

Vector6 user_wrench(const RobotState& state, const Pose& T_F_S) noexcept {
  const std::array<float, 16> T_F_ee = state.T_F_ee, T_ee_K = state.T_ee_K;
  const std::array<float, 6> of_robot = state.K_F_ext_hat_K;
  const Pose T_S_K = inverse(T_F_S) * pose_of(T_F_ee) * pose_of(T_ee_K);
  const Vector6 at_K =
      -Eigen::Map<const Eigen::Matrix<float, 6, 1>>(of_robot.data()).cast<double>();
  Vector6 w_S;
  w_S.head<3>() = T_S_K.R * at_K.head<3>();
  w_S.tail<3>() = T_S_K.R * at_K.tail<3>() + T_S_K.p.cross(w_S.head<3>());
  return w_S;
}

void RestingEstimate::add(const RobotState& state, const Pose& T_F_S) noexcept {
  ++states;
  const VectorM of_joints = joints_of(state.tau_ext_hat_filtered);
  const Vector6 of_hand = user_wrench(state, T_F_S);
  fastest = std::max(fastest, joints_of(state.dq).cwiseAbs().maxCoeff());
  m_ee = state.m_ee;
  has_any = has_any || (of_hand.array() != 0.0).any();
  q += joints_of(state.q);
  tau_ext += of_joints;
  w_S += of_hand;
}

void RestingEstimate::finish() noexcept {
  if (states == 0) return;
  q /= states;
  tau_ext /= states;
  w_S /= states;
}

std::string objection(const RestingEstimate& estimate, const VectorM& weight) {
  if (estimate.fastest > kAtRest) {
    return fmt::format("the arm moves ({:.2f} rad/s): let it come to rest first", estimate.fastest);
  }
  Eigen::Index heaviest = 0;
  const double most = weight.cwiseAbs().maxCoeff(&heaviest);
  const double share = weight.dot(estimate.tau_ext) / std::max(weight.squaredNorm(), 1e-9);
  if (most > 1.0 && std::abs(share) > kWeightShare) {
    return fmt::format(
        "its estimate of external torques contains the weight of the arm: {:.1f} Nm in joint {} at "
        "rest, where the arm weighs {:.1f} Nm. Such a server does not subtract gravity as a Franka "
        "does, and its weight would be taken for the user's hand",
        estimate.tau_ext[heaviest], heaviest + 1, weight[heaviest]);
  }
  if (estimate.m_ee > kNoMass) {
    return fmt::format(
        "Desk knows an end effector of {:.2f} kg: choose none there; the mass of the tool stands "
        "in its file and is sent to the robot",
        estimate.m_ee);
  }
  if (!estimate.has_any) {
    return "its estimate of the external wrench is exactly zero: either the arm stands in a "
           "singular "
           "posture (move it), or this server does not estimate it, and the hand would not be felt";
  }
  const double force = estimate.w_S.head<3>().norm(), torque = estimate.w_S.tail<3>().norm();
  if (force <= kMostForce && torque <= kMostTorque) return "";
  return fmt::format(
      "at rest its estimate says that {:.1f} N and {:.1f} Nm act on the flange, allowed are {:g} N "
      "and "
      "{:g} Nm: let go of the handle, and compare mass and centre of mass of the tool file with "
      "the "
      "tool",
      force, torque, kMostForce, kMostTorque);
}

SignCheck check_weight(const Eigen::Vector3d& seen, const Eigen::Vector3d& weight) noexcept {
  constexpr double kLeastWeight = 1.0;  // N
  constexpr double kShare = 0.5;        // of the weight
  if (weight.norm() < kLeastWeight || seen.norm() < kShare * weight.norm()) {
    return SignCheck::kUnseen;
  }
  const bool is_right = (seen - weight).norm() < kShare * weight.norm();
  return is_right ? SignCheck::kRight : SignCheck::kWrong;
}

}  // namespace hg::franka
