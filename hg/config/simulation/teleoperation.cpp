#include <Eigen/Geometry>

#include "hg/config/simulation/teleoperation_schema.h"

namespace hg::config {

std::optional<teleoperation::TeleoperationConfig> teleoperation_of(
    const TeleoperationDraft& draft) {
  if (!draft.config) return {};
  teleoperation::TeleoperationConfig config = *draft.config;
  config.R_R_B = Eigen::AngleAxisd(draft.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  teleoperation::AxisLimits axis = {
      .v_max = draft.v_max, .a_max = draft.a_max, .f_max = config.machine.force_max};
  if (config.mapping != teleoperation::Mapping::kJoints) {
    const int size = config.mapping == teleoperation::Mapping::kPose ? 6 : 3;
    const double turn = config.lever * draft.turn_max;
    config.machine.x_start = PortVector::Zero(size);
    config.machine.x_start.head<3>() = draft.tool_start;
    for (int i = 0; i < size; ++i) {
      axis.range = i < 3 ? Interval{draft.lowest[i], draft.highest[i]} : Interval{-turn, turn};
      config.limiter.axes.push_back(axis);
      config.machine.ranges.push_back(axis.range);
    }
    for (teleoperation::Wall& wall : config.machine.walls) {
      const Eigen::Vector3d normal = wall.normal;
      wall.normal = PortVector::Zero(size);
      wall.normal.head<3>() = normal;
    }
    // one behind a network has ends of its own, which are not known here
    if (config.address.udp.empty()) config.leader.ranges = config.machine.ranges;
    return config;
  }
  constexpr double kTogether = 0.02;  // rad or m: a twin elsewhere is no model of the machine
  config.leader.snapshot = kTogether;
  const std::size_t joints = std::min<std::size_t>(draft.joints.size(), kMaxPort);
  config.machine.x_start.resize(static_cast<Eigen::Index>(joints));
  for (std::size_t i = 0; i < joints; ++i) {
    config.machine.x_start[static_cast<Eigen::Index>(i)] = draft.joint_starts[i];
    axis.range = draft.joint_limits[i].range;
    config.limiter.axes.push_back(axis);
    config.machine.ranges.push_back(axis.range);
  }
  return config;
}

}  // namespace hg::config
