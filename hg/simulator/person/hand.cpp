#include "hg/simulator/person/hand.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/core/rotation.h"

namespace hg::person {
namespace {

constexpr double kStep = 0.25e-3;          // s, the plant's
constexpr double kMaxSteps = 400;          // 0.1 s: a hand left alone for longer has no memory
constexpr double kReach = 0.65;            // m from the shoulder, [HANDBOOK] 5.2
constexpr double kReachStiffness = 500.0;  // N/m beyond it, [A]: soft

// share of `v` that remains when it is shortened to `longest`
double share_below(const Eigen::Vector3d& v, double longest) noexcept {
  const double norm = v.norm();
  return norm > longest ? longest / norm : 1.0;
}

// additional force of an overstretched arm
Eigen::Vector3d reach_force(const Eigen::Vector3d& p, const Goal& goal) noexcept {
  if (!goal.has_shoulder) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d arm = (p - goal.shoulder).head<2>();
  const double length = arm.norm();
  if (length <= kReach) return Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  force.head<2>() = -kReachStiffness * (1.0 - kReach / length) * arm;
  return force;
}

}  // namespace

HandImpedance hand(HandPreset preset) noexcept {
  HandImpedance hand;
  switch (preset) {
    case HandPreset::kNormal:
      break;
    case HandPreset::kRelaxed:
      hand.stiffness = {80, 50, 60};
      hand.damping = {8, 6, 7};
      hand.grip_stiffness = 300;
      hand.grip_damping = 5;
      hand.angular_stiffness = {0.5, 0.5, 0.5};
      hand.angular_damping.setConstant(0.03);
      hand.tremor_rms = 0.02;
      break;
    case HandPreset::kStiff:
      hand.stiffness = {600, 400, 500};
      hand.damping = {45, 35, 40};
      hand.mass = {1.7, 2.5, 2.5};
      hand.grip_stiffness = 3000;
      hand.grip_damping = 40;
      hand.angular_stiffness = {4, 6, 8};
      hand.angular_damping.setConstant(0.2);
      hand.tremor_rms = 0.05;
      break;
  }
  return hand;
}

void check_hand_impedance(const HandImpedance& hand) {
  const auto require = [](bool ok, const char* rule) {
    if (!ok) throw SetupError(std::string("hand: ") + rule);
  };
  require((hand.stiffness.array() >= 0.0).all(), "stiffness must not be negative");
  require((hand.damping.array() >= 0.0).all(), "damping must not be negative");
  require((hand.mass.array() > 0.0).all(), "mass must be positive");
  require(hand.grip_stiffness > 0.0, "grip stiffness must be positive");
  require(hand.grip_damping >= 0.0, "grip damping must not be negative");
  require((hand.angular_stiffness.array() >= 0.0).all(), "angular stiffness must not be negative");
  require((hand.angular_damping.array() >= 0.0).all(), "angular damping must not be negative");
  require(hand.force_max > 0.0 && hand.torque_max > 0.0,
          "largest force and torque must be positive");
  require(hand.press_force >= 0.0, "press force must not be negative");
  require(hand.tremor_rms >= 0.0, "tremor must not be negative");
}

void Arm::grasp(const HandleMotion& handle) noexcept {
  p_ = handle.T_B_H.p;
  v_ = handle.twist.head<3>();
  wrench_.setZero();
}

void Arm::step(double dt, const HandleMotion& handle, const Goal& goal,
               const Eigen::Vector3d& tremor) noexcept {
  // a small excess over a whole number of steps is rounding
  const int steps = static_cast<int>(std::clamp(std::ceil(dt / kStep - 1e-3), 1.0, kMaxSteps));
  const double h = std::min(dt / steps, kStep);
  for (int k = 1; k <= steps; ++k) {
    // handle and goal interpolated towards their values at the end
    const double ahead = h * (steps - k);
    HandleMotion handle_then = handle;
    handle_then.T_B_H.p -= ahead * handle.twist.head<3>();
    Goal goal_then = goal;
    goal_then.pose.p -= ahead * goal.twist.head<3>();
    move(h, handle_then, goal_then, tremor);
  }
  wrench_.tail<3>() = torque(handle, goal);
}

// [HANDBOOK] 5.1 for the mass between grip and arm; one linearly implicit step along its axes
void Arm::move(double dt, const HandleMotion& handle, const Goal& goal,
               const Eigen::Vector3d& tremor) noexcept {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(goal.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d v_H = handle.twist.head<3>();
  Eigen::Array3d K = hand_.stiffness, D = hand_.damping;
  K.z() *= goal.height_share;
  const Eigen::Array3d stretch = R.transpose() * (goal.pose.p - p_);
  const Eigen::Array3d v_goal = R.transpose() * goal.twist.head<3>();
  const Eigen::Array3d v = R.transpose() * v_;

  // the total force is limited: arm and damper weaken together
  const Eigen::Array3d reach = (R.transpose() * reach_force(p_, goal)).array();
  const double share =
      share_below((K * stretch + D * (v_goal - v) + reach).matrix(), hand_.force_max);
  K *= share;
  D *= share;
  const Eigen::Array3d grip = (R.transpose() * (hand_.grip_stiffness * (handle.T_B_H.p - p_) +
                                                hand_.grip_damping * v_H - tremor))
                                  .array();
  const Eigen::Array3d M = hand_.mass;
  const Eigen::Array3d v_next =
      (M * v + dt * (K * stretch + D * v_goal + share * reach + grip)) /
      (M + dt * (D + hand_.grip_damping) + dt * dt * (K + hand_.grip_stiffness));

  v_ = R * v_next.matrix();
  p_ += dt * v_;
  wrench_.head<3>() =
      hand_.grip_stiffness * (p_ - handle.T_B_H.p) + hand_.grip_damping * (v_ - v_H) + tremor;
}

Eigen::Vector3d Arm::torque(const HandleMotion& handle, const Goal& goal) const noexcept {
  const Eigen::Matrix3d& R = handle.T_B_H.R;
  Eigen::Vector3d torque_in_H = hand_.angular_damping.cwiseProduct(
      R.transpose() * (goal.twist.tail<3>() - handle.twist.tail<3>()));
  if (goal.has_orientation) {
    torque_in_H +=
        hand_.angular_stiffness.cwiseProduct(R.transpose() * rotation_between(R, goal.pose.R));
  }
  return R * torque_in_H * share_below(torque_in_H, hand_.torque_max);
}

}  // namespace hg::person
