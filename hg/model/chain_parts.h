/// Contents of a ChainModel, with types of the rigid-body library: for chain_model.cpp and
/// chain_data.cpp only.
#pragma once

#include <pinocchio/multibody.hpp>
#include <pinocchio/spatial.hpp>
#include <string>
#include <vector>

#include "hg/model/chain_model.h"

namespace hg::model {

/// Joints, frames and the rigid-body model.
struct ChainParts {
  /// A frame moves with the child of a joint; joint 0 is the frame B itself.
  struct Frame {
    pinocchio::JointIndex joint = 0;
    pinocchio::SE3 T_joint_frame = pinocchio::SE3::Identity();
  };

  /// Axis of a joint with one coordinate.
  struct Axis {
    bool turns = false;
    Eigen::Vector3d e;  ///< Unit vector in the joint's own frame
    /// Indices of the coordinate axis and of the next two in cyclic order x, y, z; -1 = not
    /// aligned.
    Eigen::Index k = -1, i = -1, j = -1;
  };

  /// Where a coordinate or velocity of the rigid-body model comes from: ratio x[index] + offset,
  /// with x of the chain, or the curve at q[leader].
  struct Source {
    Eigen::Index index = 0;
    double ratio = 1.0, offset = 0.0;
    const CouplingCurve* curve = nullptr;  ///< Belongs to a coupling
    Eigen::Index leader = 0;               ///< Its coordinate
  };

  std::string name;
  std::vector<Joint> joints;
  std::vector<Coupling> couplings;
  /// By coordinate and by velocity of the rigid-body model; empty without couplings and without a
  /// moving base, whose entries have the index -1.
  std::vector<Source> q_from, v_from;
  int nq = 0, nv = 0;  ///< Numbers of coordinates and velocities of the chain
  std::vector<Axis>
      axes;  ///< Axis per joint of the rigid-body model; meaningless for floating ones
  bool has_floating = false, has_branch = false, has_curve = false;
  bool has_moving_base = false;  ///< Joint 1 is that of the base, without coordinates in the chain
  Pose T_B_base;                 ///< Of such a base at rest
  std::vector<std::string> joint_names;
  std::vector<std::string> frame_names;
  std::vector<Frame> frames;
  pinocchio::Model model;

  /// Appends a joint to `parent`, whose child `placement` places it; returns its index.
  pinocchio::JointIndex add_joint(pinocchio::JointIndex parent, Joint joint,
                                  const pinocchio::JointModel& kind,
                                  const pinocchio::SE3& placement);
  pinocchio::JointIndex add_floating_root(const Pose& T_B_root);
  pinocchio::JointIndex add_moving_base(const Pose& T_B_rest);
  void add_frame(const std::string& frame_name, pinocchio::JointIndex joint,
                 const pinocchio::SE3& T_joint_frame);
};

}  // namespace hg::model
