/// Reads a URDF into plain structs and checks each link and joint on its own.
///
/// Elements and attributes that are not read are listed, misspelt ones are errors. Every error
/// throws InputError with file and line. The chain builder checks the topology.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/input_fault.h"
#include "hg/core/interval.h"
#include "hg/core/text.h"
#include "hg/core/types.h"
#include "hg/model/coupling_curve.h"

namespace hg::model {

/// Mass distribution of a link, resolved in the axes of the link.
struct Inertial {
  double mass = 0.0;                                  ///< Mass, kg
  Eigen::Vector3d p_com = Eigen::Vector3d::Zero();    ///< Centre of mass, m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< Inertia about the COM, kg m^2
};

enum class UrdfShape { kSphere, kCylinder, kBox, kOther };

/// Collision shape of a link.
struct UrdfCollision {
  std::string name;  ///< Name; may be empty
  Pose T_link_shape;
  UrdfShape shape = UrdfShape::kOther;  ///< kOther: a mesh, or unknown to URDF
  /// Size, m; sphere: (radius, -, -), cylinder along z: (radius, length, -), box: its edges
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::optional<Inertial> inertial;
  /// What makes its inertia impossible; matters for moving links only
  std::optional<InputFault> inertial_fault;
  std::vector<UrdfCollision> collisions;
};

enum class UrdfJointType { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };

/// The joint follows another one: q = multiplier q_joint + offset, or by a curve.
struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;                                   ///< rad or m
  int line = 0;                                          ///< Line of <mimic>; 0 = not from the URDF
  std::shared_ptr<const CouplingCurve> curve = nullptr;  ///< In place of multiplier and offset
};

struct UrdfJoint {
  std::string name;
  int line = 0;
  UrdfJointType type = UrdfJointType::kFixed;
  int parent = 0;       ///< Index of the parent link
  int child = 0;        ///< Index of the child link
  Pose T_parent_joint;  ///< Pose of the joint in the parent at position 0
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();     ///< Unit vector in the joint frame; planar joint: normal
  Interval position;                ///< Position range, rad or m
  double velocity_max = kInfinity;  ///< Largest speed, rad/s or m/s
  double effort_max = kInfinity;    ///< Largest effort, Nm or N
  double damping = 0.0;             ///< Viscous friction, Nms/rad or Ns/m
  double friction = 0.0;            ///< Coulomb friction, Nm or N
  std::optional<UrdfMimic> mimic;
  /// Moves although it is not between root and tip: it follows a joint that is, see serial_part()
  bool is_branch = false;
  /// What is wrong with its type, axis, limits, dynamics or mimic; matters for joints of the chain
  /// only, and the type is then kFixed
  std::optional<InputFault> fault = {};
};

/// A kind of element or attribute that is not read, or a rating of 0, which stands for an unknown
/// one.
struct UrdfIgnored {
  std::string what;  ///< For example "<transmission>", "<limit> current" or "<limit> effort 0"
  int line = 0;      ///< Line of the first one
  int count = 0;
};

struct Urdf {
  std::string name;
  std::string source;  ///< File name, for messages
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<UrdfIgnored> ignored;
};

Urdf read_urdf_file(const std::filesystem::path& file);
Urdf read_urdf_text(std::string_view text, std::string_view source);

/// Whether a link has mass but no inertia, as what is fixed to a body may.
bool is_point_mass(const UrdfLink& link) noexcept;

/// Throws SetupError, beginning with `item`, unless the mass distribution is physically possible.
void check_inertial(const Inertial& inertial, std::string_view item);

using hg::to_text;

}  // namespace hg::model
