/// What is read of a teleoperation in a scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/controller/rendering/twin_model.h"
#include "hg/teleoperation/teleoperation.h"

namespace hg::config {

/// A teleoperation before it is checked against the twin.
struct TeleoperationDraft {
  std::vector<std::string> joints;  ///< of the twin, those that are not floating
  std::vector<teleoperation::AxisLimits> joint_limits;
  std::vector<double> joint_starts;
  bool is_machine = true;  ///< All joints turn, and they are 1 to 7
  Eigen::Vector3d tool_start = Eigen::Vector3d::Zero();
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(-0.5);
  Eigen::Vector3d highest = Eigen::Vector3d::Constant(0.5);
  double v_max = 1.0, a_max = 20.0, yaw = 0.0, turn_max = 1.5;
  std::optional<teleoperation::TeleoperationConfig> config;
};

/// Whether the tool of a machine is led, and not its joints.
inline bool leads_tool(const TeleoperationDraft& draft) {
  return draft.config && draft.config->mapping != teleoperation::Mapping::kJoints;
}

/// The joints of the twin, which are those of the remote machine in an indirect teleoperation.
inline TeleoperationDraft teleoperation_of(const rendering::TwinModel& twin) {
  TeleoperationDraft draft;
  for (const rendering::TwinDof& dof : twin.dofs) {
    draft.is_machine = draft.is_machine && dof.q_index >= 0 && dof.is_angle;
    if (dof.q_index < 0) continue;
    draft.joints.push_back(dof.name);
    draft.joint_limits.push_back({.range = {dof.limits.q_min, dof.limits.q_max}});
    draft.joint_starts.push_back(twin.q_start[dof.q_index]);
  }
  draft.is_machine = draft.is_machine && twin.dofs.size() <= kMaxPort;
  return draft;
}

}  // namespace hg::config
