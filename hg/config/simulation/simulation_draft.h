/// A simulation in the making.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/simulation/simulation.h"

namespace hg::config {

struct FlexibleDraft {
  JointUnit unit = JointUnit::kEither;
  double stiffness = 0.0, damping = 0.0;
};

struct StructureDraft {
  double frequency_Hz = 0.0, damping_ratio = 0.02;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  bool has_axis = false;
};

/// Content of simulation.yaml, before it becomes a Simulation.
struct SimulationDraft {
  SimulationConfig simulation;
  double seed = 1.0;
  std::filesystem::path base, urdf;
  /// Structure per joint of the device, where given
  std::vector<std::optional<StructureDraft>> structure;
  std::vector<std::string> joint_names;  ///< joint names of that URDF
  std::vector<JointUnit> joint_units;    ///< joint units of that URDF
  /// Flexibility per joint of that URDF, where given
  std::vector<std::optional<FlexibleDraft>> flexible;
};

}  // namespace hg::config
