#include "hg/user/person.h"

#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/model/haptic_giant.h"

namespace hg::user {
namespace {

constexpr double kGoalStep = 1e-4;  // s, for the velocity of the goal by differences

Eigen::Vector3d clipped(const Eigen::Vector3d& v, double longest) noexcept {
  const double norm = v.norm();
  return norm > longest ? Eigen::Vector3d(v * (longest / norm)) : v;
}

}  // namespace

void check(const HandImpedance& hand) {
  const auto require = [](bool ok, const char* rule) {
    if (!ok) throw SetupError(std::string("hand: ") + rule);
  };
  require((hand.stiffness.array() >= 0.0).all(), "stiffness must not be negative");
  require((hand.damping.array() >= 0.0).all(), "damping must not be negative");
  require((hand.angular_stiffness.array() >= 0.0).all(), "angular stiffness must not be negative");
  require((hand.angular_damping.array() >= 0.0).all(), "angular damping must not be negative");
  require(hand.force_max > 0.0 && hand.torque_max > 0.0,
          "largest force and torque must be positive");
}

Person::Person(const Config& config, const model::Chain& twin, int end_effector,
               const Pose& T_B_twin)
    : config_(config), twin_(twin), end_effector_(end_effector), T_B_twin_(T_B_twin) {
  check(config_.hand);
}

double Person::duration_s() const noexcept {
  return config_.kind == PersonKind::kScript ? config_.script.duration_s : 0.0;
}

Pose Person::channel_pose(const std::array<double, kChannels>& channels) noexcept {
  Pose pose;
  switch (config_.script.frame) {
    case ScriptFrame::kBase:
      pose.p = {channels[0], channels[1], channels[2]};
      pose.R = model::haptic_giant::hand_orientation(channels[3], channels[4], channels[5]);
      return pose;
    case ScriptFrame::kCylindrical:
      pose.p = T_B_twin_.p + T_B_twin_.R * Eigen::Vector3d(channels[1] * std::cos(channels[0]),
                                                           channels[1] * std::sin(channels[0]),
                                                           channels[2]);
      return pose;
    case ScriptFrame::kTwinJoints: {
      const Eigen::Map<const Eigen::VectorXd> q(channels.data(), twin_.nq());
      const VectorA at_rest = VectorA::Zero(twin_.nv());
      twin_.update_kinematics(q, at_rest);
      return twin_.pose(end_effector_);
    }
  }
  return pose;
}

Person::Goal Person::script_goal(double t, const std::array<double, kChannels>& channels) noexcept {
  Goal goal;
  goal.pose = channel_pose(channels);
  const Pose next = channel_pose(evaluate(config_.script, t + kGoalStep));
  goal.twist.head<3>() = (next.p - goal.pose.p) / kGoalStep;
  goal.twist.tail<3>() = rotation_between(goal.pose.R, next.R) / kGoalStep;
  goal.has_orientation = config_.script.frame != ScriptFrame::kCylindrical;
  return goal;
}

Vector6 Person::wrench(double t, const HandleMotion& handle, const HandTarget& target) noexcept {
  if (config_.kind == PersonKind::kNone && !target.active) return Vector6::Zero();
  if (config_.kind == PersonKind::kMouse && !target.active) return Vector6::Zero();

  Goal goal;
  double grip = 1.0;
  Vector6 push_in_H = Vector6::Zero();
  if (target.active) {
    goal.pose.p = target.p_B;
    goal.has_orientation = false;
  } else {
    const auto channels = evaluate(config_.script, t);
    goal = script_goal(t, channels);
    grip = channels[kGripChannel];
    push_in_H = Eigen::Map<const Vector6>(channels.data() + kWrenchChannel);
  }

  // [HANDBOOK] 5.1 without the arm's mass, clipped: nobody pulls harder than needed
  const HandImpedance& hand = config_.hand;
  const Eigen::Matrix3d& R = handle.T_B_H.R;
  Eigen::Vector3d stretch = goal.pose.p - handle.T_B_H.p;
  if (target.active) stretch.z() *= 1.0 - target.press;  // a hand that presses holds no height
  const Eigen::Vector3d force =
      hand.stiffness.cwiseProduct(stretch) +
      hand.damping.cwiseProduct(goal.twist.head<3>() - handle.twist.head<3>());
  Eigen::Vector3d torque_in_H = hand.angular_damping.cwiseProduct(
      R.transpose() * (goal.twist.tail<3>() - handle.twist.tail<3>()));
  if (goal.has_orientation) {
    torque_in_H +=
        hand.angular_stiffness.cwiseProduct(R.transpose() * rotation_between(R, goal.pose.R));
  }
  Vector6 wrench;
  wrench << grip * clipped(force, hand.force_max) + R * push_in_H.head<3>(),
      R * (grip * clipped(torque_in_H, hand.torque_max) + push_in_H.tail<3>());
  if (target.active) wrench[2] -= target.press * hand.press_force;
  return wrench;
}

}  // namespace hg::user
