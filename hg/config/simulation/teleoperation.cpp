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
  if (config.mapping == teleoperation::Mapping::kTool) {
    config.machine.x_start = draft.tool_start;
    for (int i = 0; i < 3; ++i) {
      axis.range = {draft.lowest[i], draft.highest[i]};
      config.limiter.axes.push_back(axis);
    }
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
  }
  return config;
}

}  // namespace hg::config
