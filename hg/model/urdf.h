/// Reads a URDF into plain structs and checks what can be checked link by link and joint by joint.
///
/// Visual elements, transmissions and other extensions are skipped. Every fault throws SetupError
/// that starts with `file:line:`. The shape of the chain is checked where it is built.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg::model {

/// Mass distribution of a link, resolved in the axes of the link.
struct Inertial {
  double mass = 0.0;                                  ///< kg
  Eigen::Vector3d p_com = Eigen::Vector3d::Zero();    ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about the COM
};

enum class UrdfShape { kSphere, kCylinder, kBox, kOther };

/// What of a link may touch something.
struct UrdfCollision {
  std::string name;  ///< may be empty
  Pose T_link_shape;
  UrdfShape shape = UrdfShape::kOther;  ///< kOther: a mesh, or what URDF does not know
  /// m; sphere: (radius, -, -), cylinder along z: (radius, length, -), box: its edges
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::optional<Inertial> inertial;
  std::string inertial_fault;  ///< what no body has; only matters for links that move
  std::vector<UrdfCollision> collisions;
};

enum class UrdfJointType { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };

struct UrdfJoint {
  std::string name;
  int line = 0;
  UrdfJointType type = UrdfJointType::kFixed;
  int parent = 0;       ///< index of a link
  int child = 0;        ///< index of a link
  Pose T_parent_joint;  ///< at position 0
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();     ///< unit vector in the joint frame; of a planar joint: normal
  Interval position;                ///< rad or m
  double velocity_max = kInfinity;  ///< rad/s or m/s
  double effort_max = kInfinity;    ///< Nm or N
  int mimic_line = 0;               ///< where it says <mimic>; 0 = nowhere
};

struct Urdf {
  std::string name;
  std::string source;  ///< file name, for messages
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
};

Urdf read_urdf_file(const std::filesystem::path& file);
Urdf read_urdf_text(std::string_view text, std::string_view source);

/// Throws SetupError, beginning with `item`, unless a rigid body can have this mass distribution.
void check(const Inertial& inertial, std::string_view item);

/// `value` with the fewest digits that read back as the same number.
std::string to_text(double value);

}  // namespace hg::model
