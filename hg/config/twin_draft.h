/// A twin in the making.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/twin.h"
#include "hg/model/chain_model.h"
#include "hg/signals/twin_parameter.h"

namespace hg::config {

/// Damping and friction of a floating joint, the same in all directions, and its start.
struct FloatingPart {
  std::array<double, kFloatingParameters.size()>
      values{};  ///< initial values, in the order of kFloatingParameters
  HandPose start;
};

struct TwinJoint {
  model::JointType type = model::JointType::kRevolute;
  int v_index = 0;
  JointUnit unit = JointUnit::kEither;
  rendering::TwinDof dof;
  double start = kNoDefault;
  FloatingPart floating;
};

/// Content of twin.yaml, before it becomes a Twin.
struct TwinDraft {
  std::string name;
  std::filesystem::path urdf;
  Surroundings surroundings = Surroundings::kRoom;
  bool is_free_body = false;
  model::FreeBody body;
  Eigen::Vector3d principal_inertia = Eigen::Vector3d::Constant(0.08);
  Placement placement;
  bool gravity = false;
  bool floating_root = false, has_moving_base = false;
  ChainPart part;
  std::vector<model::Coupling> couplings;
  std::vector<model::ClosedLoop> loops;
  Eigen::Vector3d force_ref = Eigen::Vector3d::Zero(), torque_ref = Eigen::Vector3d::Zero();
  double mass_scale = 1.0;
  Eigen::Vector3d force_scale = Eigen::Vector3d::Ones(), torque_scale = force_scale;
  std::vector<std::string> joint_names, frame_names;
  std::vector<TwinJoint> joints;
  std::vector<std::string> scalar_names;  ///< names of the joints that are not floating
  std::vector<int> scalar_joints;         ///< indices of these in `joints`
  int end_effector = -1;
  std::vector<rendering::Lock> locks;
  std::vector<rendering::ConditionalLimit> conditional_limits;
  std::vector<rendering::CollisionSphere> spheres;

  const TwinJoint& scalar_joint(int index) const { return joints[scalar_joints[index]]; }
};

}  // namespace hg::config
