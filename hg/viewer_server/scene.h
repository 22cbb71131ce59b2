/// What a page draws: two chains, their limits and the box of the handle. Fixed during a run.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/limit.h"

namespace hg::viewer_server {

/// Revolute and prismatic joints have one coordinate, a floating joint seven (x y z qx qy qz qw).
enum class JointType : std::uint8_t { kRevolute, kPrismatic, kFloating };

struct SceneJoint {
  std::string name;  ///< as in the URDF; a floating joint not in it moves the root link
  JointType type = JointType::kRevolute;
  /// Planar joint of the URDF that this one is a part of: two prismatic joints and a revolute one
  /// that follow each other; empty for other joints.
  std::string planar;
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< of such a part, in the frame of the planar joint
};

struct SceneChain {
  std::filesystem::path urdf;      ///< empty: the page draws a plain body at the handle
  Pose T_B_root;                   ///< root link in B
  std::vector<SceneJoint> joints;  ///< in the order of the coordinates
};

struct Scene {
  std::string title;
  SceneChain device;  ///< gantry joints first, then manipulator: coordinates q_p, then q_m
  SceneChain twin;    ///< coordinates q_a
  LimitCatalogue limits;
  Eigen::AlignedBox3d box;  ///< Cartesian limits of the handle in B; dragging ends 0.5 m outside
  double floor_z = 0.0;     ///< height of the floor in B, m
  double rate_hz = 1000.0;  ///< of the cycle
};

/// Number of coordinates of all joints.
int coordinate_count(const SceneChain& chain);

/// Throws SetupError unless the files exist, names are given and the box and rate are finite.
void check(const Scene& scene);

}  // namespace hg::viewer_server
