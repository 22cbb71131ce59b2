#include "hg/messages/tool_messages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "hg/core/types.h"

namespace hg::messages {
namespace {

constexpr double kLongestTurn_s = 0.5;  // a mean over a longer time says nothing

enum FrameIndex : std::size_t { kHandle = 0, kElbow = 1, kTwinEnd = 2, kFirstLink = 3 };

template <typename Vector>
double value_or_nan(const Vector& vector, int index) {
  return index < vector.size() ? vector[index] : std::numeric_limits<double>::quiet_NaN();
}

Vector3 to_ros(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Transform to_ros(const Pose& pose) {
  const Eigen::Quaterniond rotation(pose.R);
  return {to_ros(pose.p), {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

void resize(JointState& state) {
  state.position.resize(state.name.size());
  state.velocity.resize(state.name.size());
  state.effort.resize(state.name.size());
}

}  // namespace

ToolMessages::ToolMessages(const RunNames& names, LinkTree links)
    : gantry_joints_(static_cast<int>(names.gantry_joints.size())),
      manipulator_joints_(static_cast<int>(names.manipulator_joints.size())),
      links_(std::move(links)),
      link_poses_(links_.frames.size()) {
  device_.name = names.gantry_joints;
  device_.name.insert(device_.name.end(), names.manipulator_joints.begin(),
                      names.manipulator_joints.end());
  resize(device_);

  Place place = {0, 0};
  for (const TwinJoint& joint : names.twin_joints) {
    if (!joint.is_floating) {
      twin_.name.push_back(joint.name);
      twin_places_.push_back(place);
    }
    place.coordinate += joint.is_floating ? 7 : 1;
    place.velocity += joint.is_floating ? 6 : 1;
  }
  resize(twin_);

  for (const LimitInfo& limit : names.limits) limits_.name.push_back(limit.name);
  resize(limits_);

  user_wrench_.header.frame_id = "handle";
  handle_twist_.header.frame_id = "handle";
  transforms_.transforms.resize(kFirstLink + links_.frames.size());
  transforms_.transforms[kHandle].child_frame_id = "handle";
  transforms_.transforms[kElbow].child_frame_id = "elbow";
  transforms_.transforms[kTwinEnd].child_frame_id = "twin_end";
  for (TransformStamped& transform : transforms_.transforms) transform.header.frame_id = "base";
  for (std::size_t i = 0; i < links_.frames.size(); ++i) {
    TransformStamped& transform = transforms_.transforms[kFirstLink + i];
    transform.header.frame_id = links_.frames[i].parent;
    transform.child_frame_id = links_.frames[i].child;
  }
}

void ToolMessages::update(const Sample& sample, std::uint64_t time_ns) {
  const Time stamp = to_ros(time_ns);
  for (JointState* state : {&device_, &twin_, &limits_}) state->header.stamp = stamp;
  user_wrench_.header.stamp = stamp;
  handle_twist_.header.stamp = stamp;
  for (TransformStamped& transform : transforms_.transforms) transform.header.stamp = stamp;

  update_joints(sample);
  update_frames(sample);
  update_twist(sample.record);
  update_limits(sample.record);
}

void ToolMessages::update_joints(const Sample& sample) {
  const RobotState& robot = sample.record.robot;
  std::size_t row = 0;
  for (int i = 0; i < gantry_joints_; ++i, ++row) {
    device_.position[row] = value_or_nan(robot.q_p, i);
    device_.velocity[row] = value_or_nan(robot.dq_p, i);
    device_.effort[row] = std::numeric_limits<double>::quiet_NaN();
  }
  for (int i = 0; i < manipulator_joints_; ++i, ++row) {
    device_.position[row] = value_or_nan(robot.q_m, i);
    device_.velocity[row] = value_or_nan(robot.dq_m, i);
    device_.effort[row] = value_or_nan(sample.sensors.tau_m, i);
  }

  const TwinState& twin = sample.record.twin;
  for (row = 0; row < twin_places_.size(); ++row) {
    const Place place = twin_places_[row];
    twin_.position[row] = value_or_nan(twin.q_a, place.coordinate);
    twin_.velocity[row] = value_or_nan(twin.dq_a, place.velocity);
    twin_.effort[row] = value_or_nan(sample.record.tau_a, place.velocity);
  }
}

void ToolMessages::update_frames(const Sample& sample) {
  const CycleRecord& record = sample.record;
  const Eigen::Matrix3d R_H_B = record.T_B_H.R.transpose();
  user_wrench_.wrench.force = to_ros(R_H_B * record.robot.w_H.head<3>());
  user_wrench_.wrench.torque = to_ros(R_H_B * record.robot.w_H.tail<3>());

  transforms_.transforms[kHandle].transform = to_ros(record.T_B_H);
  transforms_.transforms[kTwinEnd].transform = to_ros(record.T_B_E);
  transforms_.transforms[kElbow].transform.translation = to_ros(record.p_B_elbow);
  if (links_.frames.empty()) return;
  links_.poses(sample, link_poses_);
  for (std::size_t i = 0; i < link_poses_.size(); ++i) {
    transforms_.transforms[kFirstLink + i].transform = to_ros(link_poses_[i]);
  }
}

void ToolMessages::update_twist(const CycleRecord& record) {
  const Eigen::Matrix3d& R_B_H = record.T_B_H.R;
  handle_twist_.twist.linear = to_ros(R_B_H.transpose() * record.v_H);
  const double elapsed_s = record.time_s - last_time_s_;
  if (has_last_ && elapsed_s > 0.0 && elapsed_s < kLongestTurn_s) {
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(last_R_B_H_.transpose() * R_B_H));
    handle_twist_.twist.angular = to_ros(turn.axis() * (turn.angle() / elapsed_s));
  }
  last_R_B_H_ = R_B_H;
  last_time_s_ = record.time_s;
  has_last_ = true;
}

void ToolMessages::update_limits(const CycleRecord& record) {
  for (std::size_t i = 0; i < limits_.name.size(); ++i) {
    const bool is_there = std::cmp_less(i, record.limit_count);
    const LimitReport& report = record.limits[std::min(i, record.limits.size() - 1)];
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    limits_.position[i] = is_there ? std::min(report.to_lower, report.to_upper) : kNan;
    limits_.velocity[i] = kNan;
    limits_.effort[i] = is_there ? report.reaction : kNan;
  }
}

}  // namespace hg::messages
