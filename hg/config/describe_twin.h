/// Description of twin.yaml.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/describe_common.h"
#include "hg/config/twin.h"
#include "hg/model/chain.h"

namespace hg::config {

inline constexpr std::array<Choice<Surroundings>, 3> kSurroundings = {
    {{"room", Surroundings::kRoom},
     {"door", Surroundings::kDoor},
     {"excavator", Surroundings::kExcavator}}};

/// Damping and friction of a floating joint, the same in all directions, and its start.
struct FloatingPart {
  double damping = 0.0, angular_damping = 0.0;
  double friction = 0.0, angular_friction = 0.0;
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
  bool floating_root = false;
  ChainPart part;
  Eigen::Vector3d force_ref = Eigen::Vector3d::Zero(), torque_ref = Eigen::Vector3d::Zero();
  double mass_scale = 1.0;
  std::vector<std::string> joint_names, frame_names;
  std::vector<TwinJoint> joints;
  std::vector<std::string> scalar_names;  ///< names of the joints that are not floating
  std::vector<int> scalar_joints;         ///< indices of these in `joints`
  int end_effector = -1;
  std::vector<rendering::Lock> locks;
  std::vector<rendering::ConditionalLimit> conditional_limits;

  const TwinJoint& scalar_joint(int index) const {
    return joints[static_cast<std::size_t>(scalar_joints[static_cast<std::size_t>(index)])];
  }
};

template <class V>
void describe_chain(V& v, TwinDraft& d) {
  v.words("name", d.name, "name of the twin", Need::kRequired);
  v.path("urdf", d.urdf,
         "kinematics and inertia, with limits that are the defaults of joints; "
         "together with free_body only what is drawn");
  v.choice("surroundings", d.surroundings, kSurroundings,
           "what the page draws around it, for the eye only: rings on the floor, the wall of "
           "models/twins/door, or a building site");
  d.is_free_body = v.group(
      "free_body",
      [&](auto& child) {
        child.number("mass_kg", d.body.mass, kPositive, "mass");
        child.vector("inertia_kg_m2", d.principal_inertia, kPositive,
                     "moments of inertia about the axes of the handle, at the centre of mass");
        child.vector("centre_of_mass_m", d.body.p_handle_com, kAnyNumber, "in the handle frame");
      },
      "a single rigid body: joint 'root', frame 'handle'");
  v.rule(d.is_free_body || v.is_given("urdf"), "", "a twin needs 'urdf' or 'free_body'");
  v.group(
      "placement", [&](auto& child) { describe(child, d.placement); }, "of the root link in B");
  v.flag("gravity", d.gravity, "whether the twin's links have weight");
  v.flag("floating_root", d.floating_root,
         "whether the root link of the URDF moves freely, by a joint 'root'");
}

/// Values that may change while the twin runs and belong to no joint.
template <class V>
void describe_reference_wrench(V& v, Eigen::Vector3d& force, Eigen::Vector3d& torque) {
  v.group(
      "reference_wrench",
      [&](auto& child) {
        child.vector("force_N", force, kAnyNumber, "at the end effector, along x, y, z of B");
        child.vector("torque_Nm", torque, kAnyNumber, "about x, y, z of B");
      },
      "the wrench of the user at which the twin rests: what the user feels from it is the "
      "opposite");
}

}  // namespace hg::config
