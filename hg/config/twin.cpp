#include "hg/config/twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/twin_schema.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/haptic_giant.h"

namespace hg::config {
namespace {

std::optional<model::ChainModel> make_free_body(LoaderFile& file, TwinDraft& draft,
                                                const model::ChainOptions& options) {
  draft.body.inertia = draft.principal_inertia.asDiagonal();
  try {
    return model::ChainModel::free_body(draft.body, options);
  } catch (const SetupError& error) {
    file.faults.add_all(InputError(
        InputFault{.file = file.path.generic_string(), .item = "free_body", .what = error.what()}));
    return no_chain(file);
  }
}

// false: what is wrong has been reported
bool is_whole(const model::Coupling& coupling) {
  return !coupling.joint.empty() && !coupling.leader.empty() && coupling.ratio != 0.0 &&
         coupling.joint != coupling.leader;
}

bool is_whole(const model::ClosedLoop& loop) {
  return !loop.link.empty() && !loop.meets.empty() && !loop.leader.empty() && !loop.follow.empty();
}

std::optional<model::ChainModel> make_chain(LoaderFile& file, Loader& loader, TwinDraft& draft) {
  // the URDF of a free body is only drawn, but a recording needs it, too
  const bool has_urdf = !draft.is_free_body || !draft.urdf.empty();
  const std::optional<UrdfText> urdf =
      has_urdf ? read_urdf(file, draft.urdf) : std::optional<UrdfText>();
  UrdfParts parts;
  if (urdf && !draft.is_free_body) parts = {urdf->link_names, urdf->joint_names, urdf->joints};
  describe(loader, draft.part, parts.links);
  describe_followers(loader, draft, parts);
  model::ChainOptions options = {.T_B_root = pose_of(draft.placement),
                                 .gravity = draft.gravity,
                                 .floating_root = draft.floating_root,
                                 .moving_base = draft.has_moving_base};
  if (draft.is_free_body) return make_free_body(file, draft, options);
  if (!urdf || !draft.part.is_usable) return no_chain(file);
  options.root_link = name_of(parts.links, draft.part.root_link);
  options.tip_link = name_of(parts.links, draft.part.tip_link);
  const auto whole = [](const auto& item) { return is_whole(item); };
  std::ranges::copy_if(draft.couplings, std::back_inserter(options.couplings), whole);
  std::ranges::copy_if(draft.loops, std::back_inserter(options.loops), whole);
  return read_chain(file, *urdf, options);
}

// Stands for all joints where there is no chain, of either unit and without limits.
void take_unknown_joint(TwinDraft& draft) {
  draft.joints.emplace_back();
  draft.scalar_joints.push_back(0);
}

void take_joints(const model::ChainModel& chain, TwinDraft& draft) {
  draft.frame_names = chain.frame_names();
  for (const model::Joint& joint : chain.joints()) {
    const bool is_floating = joint.type == model::JointType::kFloating;
    if (!is_floating) {
      draft.scalar_joints.push_back(static_cast<int>(draft.joints.size()));
      draft.scalar_names.push_back(joint.name);
    }
    draft.joint_names.push_back(joint.name);
    TwinJoint& taken = draft.joints.emplace_back();
    taken.type = joint.type;
    taken.v_index = joint.v_index;
    taken.unit = unit_of(joint.type);
    taken.dof.name = joint.name;
    taken.dof.q_index = is_floating ? -1 : joint.q_index;
    taken.dof.is_angle = taken.unit == JointUnit::kAngle;
    taken.dof.limits = {
        .q_min = joint.position.lb, .q_max = joint.position.ub, .dq_max = joint.velocity_max};
    taken.dof.damping = joint.damping;
    taken.dof.friction = joint.friction;
  }
}

void check_types(Loader& loader, const model::ChainModel& chain) {
  for (std::size_t i = 1; i < chain.joints().size(); ++i) {
    loader.rule(chain.joints()[i].type != model::JointType::kFloating, "urdf",
                "only the first joint of a twin may be floating",
                "'" + chain.joints()[i].name + "'");
  }
}

double start_of(const TwinJoint& joint) {
  if (!std::isnan(joint.start)) return joint.start;
  return std::clamp(0.0, joint.dof.limits.q_min, joint.dof.limits.q_max);
}

void add_dofs(const TwinJoint& joint, std::vector<rendering::TwinDof>& dofs) {
  if (joint.type != model::JointType::kFloating) {
    dofs.push_back(joint.dof);
    return;
  }
  constexpr std::array<const char*, 6> kDirections = {"x", "y", "z", "rx", "ry", "rz"};
  for (std::size_t i = 0; i < kDirections.size(); ++i) {
    rendering::TwinDof dof;
    dof.name = joint.dof.name + " " + kDirections[i];
    dof.is_angle = i >= 3;
    for (std::size_t k = 0; k < kFloatingParameters.size(); ++k) {
      const FloatingParameter& key = kFloatingParameters[k];
      if ((key.first_dof == 3) != dof.is_angle) continue;
      (key.parameter == Parameter::kDamping ? dof.damping : dof.friction) =
          joint.floating.values[k];
    }
    dofs.push_back(dof);
  }
}

// Coordinates at the start. A floating first joint takes the end effector to its start pose.
ConfigurationA start_of(const rendering::TwinModel& model, const Pose& T_B_root,
                        const TwinDraft& draft) {
  ConfigurationA q = model.chain.neutral();
  for (std::size_t i = 0; i < draft.joints.size(); ++i) {
    if (draft.joints[i].type != model::JointType::kFloating) {
      q[model.chain.joints()[i].q_index] = start_of(draft.joints[i]);
    }
  }
  if (draft.joints.empty() || draft.joints[0].type != model::JointType::kFloating) return q;

  // at the identity the body is at the root link: T_B_E = T_B_root T_root_E
  model::ChainData chain(model.chain);
  chain.update_kinematics(q, VectorA::Zero(chain.model().nv()));
  const Pose T_root_E = inverse(T_B_root) * chain.pose(model.end_effector);
  const Pose T_root_body =
      inverse(T_B_root) * pose_of(draft.joints[0].floating.start) * inverse(T_root_E);
  q.head<3>() = T_root_body.p;
  q.segment<4>(3) = Eigen::Quaterniond(T_root_body.R).normalized().coeffs();
  return q;
}

}  // namespace

Pose pose_of(const HandPose& hand) {
  return {hand.p, model::haptic_giant::hand_orientation(hand.azimuth, hand.pitch, hand.roll)};
}

HandPose hand_of(const Pose& pose) {
  constexpr double kVertical = 1e-9;  // sine of the tilt below which azimuth and roll are one
  const Eigen::Matrix3d& R = pose.R;
  const double sine = std::hypot(R(0, 2), R(1, 2));
  HandPose hand;
  hand.p = pose.p;
  hand.pitch = M_PI - std::atan2(sine, R(2, 2));
  if (sine > kVertical) {
    hand.azimuth = std::atan2(R(1, 2), R(0, 2));
    hand.roll = std::remainder(std::atan2(R(2, 1), -R(2, 0)) - M_PI, 2.0 * M_PI);
  } else {
    const double turn = std::atan2(R(1, 0), R(0, 0));
    hand.azimuth = std::remainder(R(2, 2) > 0.0 ? turn - M_PI : turn, 2.0 * M_PI);
  }
  return hand;
}

Twin load_twin(const std::filesystem::path& file) {
  SourceReader reader;
  return load_twin(file, reader);
}

Twin load_twin(const std::filesystem::path& path, SourceReader& reader, bool has_moving_base) {
  const std::size_t first_source = reader.texts().size();
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  TwinDraft draft;
  draft.has_moving_base = has_moving_base;
  std::optional<model::ChainModel> chain;
  load_file_of_kind(FileKind::kTwin, file, [&](Loader& loader) {
    describe_chain(loader, draft);
    chain = make_chain(file, loader, draft);
    if (chain) {
      take_joints(*chain, draft);
      check_types(loader, *chain);
    } else {
      take_unknown_joint(draft);
    }
    describe_joints(loader, draft);
  });

  Vector6 w_ref;
  w_ref << draft.force_ref, draft.torque_ref;
  Vector6 felt_scale;
  felt_scale << draft.force_scale, draft.torque_scale;
  Twin twin = {.name = draft.name,
               .urdf = draft.urdf,
               .surroundings = draft.surroundings,
               .T_B_root = pose_of(draft.placement),
               .model = {.chain = std::move(*chain),
                         .end_effector = draft.end_effector,
                         .q_start = {},
                         .dofs = {},
                         .locks = draft.locks,
                         .conditional_limits = draft.conditional_limits,
                         .spheres = draft.spheres,
                         .w_ref = w_ref,
                         .mass_scale = draft.mass_scale,
                         .felt_scale = felt_scale},
               .sources = reader.since(first_source),
               .places = std::move(file.places)};
  for (const TwinJoint& joint : draft.joints) add_dofs(joint, twin.model.dofs);
  twin.model.q_start = start_of(twin.model, twin.T_B_root, draft);
  return twin;
}

}  // namespace hg::config
