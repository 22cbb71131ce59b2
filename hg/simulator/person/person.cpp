#include "hg/simulator/person/person.h"

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/model/haptic_giant.h"

namespace hg::person {

Person::Person(const PersonConfig& config, const model::ChainModel& twin, int end_effector,
               const Pose& T_B_twin)
    : config_(config),
      twin_(twin),
      end_effector_(end_effector),
      T_B_twin_(T_B_twin),
      arm_(config.hand),
      tremor_(config.hand.tremor_rms, config.seed),
      walker_(config.script.walk) {
  check_hand_impedance(config_.hand);
  if (!(config_.script.grasp_s >= 0.0)) throw SetupError("grasp_s must not be negative");
}

double Person::duration_s() const noexcept {
  if (config_.kind != PersonKind::kScript) return 0.0;
  return config_.script.grasp_s + config_.script.duration_s;
}

WalkerReport Person::walker_report(double t) const noexcept {
  const bool walks = config_.kind == PersonKind::kScript && walker_.walk().kind != WalkKind::kNone;
  if (!walks || !is_holding(t)) return {};
  return {.is_walking = true,
          .x = walker_.body().x(),
          .y = walker_.body().y(),
          .heading = walker_.heading(),
          .hold = walker_.hold()};
}

bool Person::is_pulling(const HandTarget& target) const noexcept {
  return target.active || config_.kind == PersonKind::kScript;
}

void Person::grasp(double t, const HandleMotion& handle) noexcept {
  arm_.grasp(handle);
  position_.start();
  orientation_.start();
  time_s_ = t;
  if (has_grasped_) return;
  has_grasped_ = true;
  const auto& start = config_.script.start;
  const bool is_at_a_door = config_.script.walk.kind == WalkKind::kDoorway;
  walker_.start(is_at_a_door ? handle.T_B_H.p : Eigen::Vector3d(start[0], start[1], start[2]),
                start[3]);
  last_point_ = last_p_H_ = handle.T_B_H.p.head<2>();
}

Pose Person::channel_pose() noexcept {
  Pose pose;
  switch (config_.script.frame) {
    case ScriptFrame::kBase:
      pose.p = {channels_[0], channels_[1], channels_[2]};
      pose.R = model::haptic_giant::hand_orientation(channels_[3], channels_[4], channels_[5]);
      return pose;
    case ScriptFrame::kCylindrical:
      pose.p = T_B_twin_.p + T_B_twin_.R * Eigen::Vector3d(channels_[1] * std::cos(channels_[0]),
                                                           channels_[1] * std::sin(channels_[0]),
                                                           channels_[2]);
      return pose;
    case ScriptFrame::kTwinJoints: {
      const Eigen::Map<const Eigen::VectorXd> q(channels_.data(), twin_.model().nq());
      const VectorA at_rest = VectorA::Zero(twin_.model().nv());
      twin_.update_kinematics(q, at_rest);
      return twin_.pose(end_effector_);
    }
  }
  return pose;
}

Goal Person::script_goal(double t, double dt, const Pose& T_B_H) noexcept {
  channels_ = evaluate(config_.script, t - config_.script.grasp_s);
  Goal goal;
  if (config_.script.frame == ScriptFrame::kBase) goal.heading = channels_[3];
  const Walk& walk = config_.script.walk;
  if (walk.kind != WalkKind::kNone) {
    walker_.step(dt, T_B_H);
    if (walk.kind == WalkKind::kDoorway) {
      channels_[twin_.model().joints()[walk.doorway.joint].q_index] = walker_.leaf_goal();
      for (int i = kWrenchChannel; i <= kGripChannel; ++i) channels_[i] *= walker_.hold();
    } else {
      const Eigen::Vector3d hand = walker_.hand();
      channels_[0] = hand.x();
      channels_[1] = hand.y();
      channels_[2] += hand.z();
      channels_[3] = walker_.heading() + walk.azimuth_from_heading;
    }
    goal.heading = walker_.heading();
    goal.has_shoulder = true;
    goal.shoulder = walker_.shoulder();
  }
  goal.pose = channel_pose();
  if (walk.kind == WalkKind::kDoorway) goal.pose.p += walker_.bob();
  goal.has_orientation = config_.script.frame != ScriptFrame::kCylindrical;
  return goal;
}

// the goal as the person follows it, with its twist
void Person::approach(double dt, Goal& goal) noexcept {
  const Pose target = goal.pose;
  if (dt > 0.0) {
    goal.twist << position_.step(target.p - target_.p, dt),
        orientation_.step(rotation_between(target_.R, target.R), dt);
    goal.pose.p += position_.rest();
    const double angle = orientation_.rest().norm();
    if (angle > 0.0) {
      goal.pose.R = Eigen::AngleAxisd(angle, orientation_.rest() / angle) * target.R;
    }
  }
  target_ = target;
}

Vector6 Person::wrench(double t, const HandleMotion& handle, const HandTarget& target) noexcept {
  if (!is_holding(t) || !is_pulling(target)) {
    follows_target_ = false;
    return Vector6::Zero();
  }
  const bool is_new = !has_grasped_ || target.active != follows_target_;
  if (!has_grasped_ || (is_new && config_.kind != PersonKind::kScript)) grasp(t, handle);
  const double dt = std::max(t - time_s_, 0.0);
  time_s_ = t;
  follows_target_ = target.active;

  Goal goal;
  double grip = 1.0;
  Vector6 push_in_H = Vector6::Zero();
  if (target.active) {
    goal.pose.p = target.p_B;
    goal.pose.R = target.turns ? target.R_B : handle.T_B_H.R;
    goal.has_orientation = target.turns;
    goal.height_share = 1.0 - target.press;  // a hand that presses holds no height
  } else {
    goal = script_goal(t, dt, handle.T_B_H);
    grip = channels_[kGripChannel];
    push_in_H = Eigen::Map<const Vector6>(channels_.data() + kWrenchChannel);
  }
  const bool begins = is_new && dt == 0.0;
  if (begins) target_ = target.active ? handle.T_B_H : goal.pose;
  if (!target.active && config_.script.walk.kind != WalkKind::kNone) {
    position_.start();  // walks have no jumps
    orientation_.start();
  }
  if (!begins) approach(dt, goal);
  if (target.active && !target.turns) goal.twist.tail<3>().setZero();
  if (dt > 0.0) arm_.step(dt, handle, goal, tremor_.force(t));

  // a weaker grip scales everything: mass, grip and arm
  const Eigen::Matrix3d& R = handle.T_B_H.R;
  Vector6 wrench = grip * arm_.wrench();
  wrench.head<3>() += R * push_in_H.head<3>();
  wrench.tail<3>() += R * push_in_H.tail<3>();
  if (target.active) {
    // plus the sideways pull: a lever turned by up to 45 degrees is not lifted by the pull
    wrench[2] -= target.press * (config_.hand.press_force + wrench.head<2>().norm());
  }
  keep_score(dt, handle);
  return wrench;
}

void Person::keep_score(double dt, const HandleMotion& handle) noexcept {
  const auto& checkpoints = config_.script.walk.checkpoints;
  if (config_.script.walk.kind != WalkKind::kCheckpoints) return;
  if (score_.reached == static_cast<int>(checkpoints.size())) return;
  const Eigen::Vector2d p = handle.T_B_H.p.head<2>();
  way_ += (p - last_p_H_).norm();
  last_p_H_ = p;
  impulse_ += dt * arm_.wrench().head<3>().norm();
  walked_s_ += dt;
  since_point_s_ += dt;
  if (walker_.reached() == score_.reached) return;

  const std::size_t i = score_.reached++;
  score_.time_s[i] = since_point_s_;
  score_.straight_length += (checkpoints[i].p - last_point_).norm();
  score_.path_length = way_;
  score_.mean_force = impulse_ / walked_s_;
  last_point_ = checkpoints[i].p;
  since_point_s_ = 0.0;
}

}  // namespace hg::person
