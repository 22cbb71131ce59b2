#include "hg/recording/tool_messages.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>

#include "hg/core/types.h"

namespace hg::recording {
namespace {

constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;

enum FrameIndex : std::size_t { kHandle = 0, kElbow = 1, kTwinEnd = 2 };

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

ToolMessages::ToolMessages(const RecordingInfo& info)
    : gantry_joints_(static_cast<int>(info.gantry_joints.size())),
      manipulator_joints_(static_cast<int>(info.manipulator_joints.size())) {
  device_.name = info.gantry_joints;
  device_.name.insert(device_.name.end(), info.manipulator_joints.begin(),
                      info.manipulator_joints.end());
  resize(device_);

  Place place = {0, 0};
  for (const TwinJoint& joint : info.twin_joints) {
    if (!joint.is_floating) {
      twin_.name.push_back(joint.name);
      twin_places_.push_back(place);
    }
    place.coordinate += joint.is_floating ? 7 : 1;
    place.velocity += joint.is_floating ? 6 : 1;
  }
  resize(twin_);

  user_wrench_.header.frame_id = "handle";
  transforms_.transforms.resize(3);
  transforms_.transforms[kHandle].child_frame_id = "handle";
  transforms_.transforms[kElbow].child_frame_id = "elbow";
  transforms_.transforms[kTwinEnd].child_frame_id = "twin_end";
  for (TransformStamped& transform : transforms_.transforms) transform.header.frame_id = "base";
}

void ToolMessages::update(const Sample& sample, std::uint64_t time_ns) {
  const Time stamp = {static_cast<std::int32_t>(time_ns / kNanosecondsPerSecond),
                      static_cast<std::uint32_t>(time_ns % kNanosecondsPerSecond)};
  device_.header.stamp = stamp;
  twin_.header.stamp = stamp;
  user_wrench_.header.stamp = stamp;
  for (TransformStamped& transform : transforms_.transforms) transform.header.stamp = stamp;

  update_joints(sample);
  update_frames(sample.record);
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

void ToolMessages::update_frames(const CycleRecord& record) {
  const Eigen::Matrix3d R_H_B = record.T_B_H.R.transpose();
  user_wrench_.wrench.force = to_ros(R_H_B * record.robot.w_H.head<3>());
  user_wrench_.wrench.torque = to_ros(R_H_B * record.robot.w_H.tail<3>());

  transforms_.transforms[kHandle].transform = to_ros(record.T_B_H);
  transforms_.transforms[kTwinEnd].transform = to_ros(record.T_B_E);
  transforms_.transforms[kElbow].transform.translation = to_ros(record.p_B_elbow);
}

}  // namespace hg::recording
