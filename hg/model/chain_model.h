/// The constant part of a serial kinematic chain: joints, frames, masses; of devices and twins.
///
/// Joints are revolute, continuous, prismatic or floating; fixed joints merge their links, planar
/// ones become three scalar joints. A joint that is coupled to another one (<mimic>, a gear) moves
/// with it and has no coordinate of its own: M, c, Jacobians and limits are those of the joint that
/// leads. So do the joints of a closed loop. Coupled joints may be in branches. A continuous joint
/// has one unwrapped coordinate. A floating joint has seven coordinates (x y z qx qy qz qw: pose of
/// the child in its parent) and six velocities (twist of the child, resolved in the child). SI
/// units.
///
/// Set-up throws SetupError, `file:line: item: rule, got value`. A model never changes after
/// set-up: one model serves any number of chain_data.h, in any thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/coupling_curve.h"

namespace hg::model {

enum class JointType { kRevolute, kContinuous, kPrismatic, kFloating };

std::string_view to_string(JointType type) noexcept;

/// One moving joint, in the order from root to tip.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int q_index = 0;                  ///< Index of its first coordinate in q
  int v_index = 0;                  ///< Index of its first velocity in dq
  int nq = 1;                       ///< Number of coordinates; 7 for a floating joint
  int nv = 1;                       ///< Number of velocities; 6 for a floating joint
  Interval position;                ///< Range, rad or m; unbounded without limit in the URDF
  double velocity_max = kInfinity;  ///< Largest speed, rad/s or m/s
  double effort_max = kInfinity;    ///< Largest effort, Nm or N
  double damping = 0.0;             ///< Viscous friction by the URDF, Nms/rad or Ns/m
  double friction = 0.0;            ///< Coulomb friction by the URDF, Nm or N
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< Axis of a scalar joint in its own frame
  std::string planar;  ///< Planar joint of the URDF containing this one, see urdf_parts.h

  bool is_slide() const noexcept { return type == JointType::kPrismatic; }
};

/// A joint that follows another joint of the chain: q = ratio q_leader + offset, or by a curve.
struct Coupling {
  std::string joint;
  std::string leader;                                    ///< A joint with a coordinate of its own
  double ratio = 1.0;                                    ///< Not 0; rad, m, rad/m or m/rad
  double offset = 0.0;                                   ///< rad or m
  std::shared_ptr<const CouplingCurve> curve = nullptr;  ///< In place of ratio and offset
};

/// A closed loop of joints: the origins of two links meet, see closed_loop.h.
struct ClosedLoop {
  std::string link, meets;          ///< The two links
  std::string leader;               ///< The joint that moves the loop
  std::vector<std::string> follow;  ///< One to three joints that keep it closed
};

/// Tool fixed to a link of a chain, for example a handle with its force/torque sensor.
struct Tool {
  std::string link;                                   ///< Link of the URDF that carries the tool
  std::string handle = "handle";                      ///< Name of the added frame
  Pose T_link_handle;                                 ///< Pose of the added frame in the link
  double mass = 0.0;                                  ///< Mass, kg, >= 0
  Eigen::Vector3d p_com = Eigen::Vector3d::Zero();    ///< Centre of mass in the link, m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< About the COM, axes of the link, kg m^2
};

/// Passive joint inserted between a joint of the URDF and its child link, of the same kind.
struct PassiveJoint {
  std::string behind;                   ///< Revolute, continuous or prismatic joint of the URDF
  std::string name;                     ///< Name of the new joint, unused by joints and links
  std::optional<Eigen::Vector3d> axis;  ///< Unit vector in the child of `behind`; none = its axis
};

/// Options for building a chain.
struct ChainOptions {
  Pose T_B_root;        ///< Pose of the root link in frame B
  bool gravity = true;  ///< false: c() and inverse_dynamics() are without gravity
  std::optional<Tool> tool;
  std::vector<PassiveJoint> passive;  ///< Passive joints added to the URDF: a compliant structure
  bool floating_root = false;         ///< true: the root link floats in B by a joint "root"
  bool moving_base = false;           ///< true: the root link moves by ChainData::move_base()
  std::vector<Coupling> couplings;    ///< In addition to those of the URDF, or in their place
  std::vector<ClosedLoop> loops;
  std::string root_link, tip_link;  ///< Of the part of a branched URDF; empty = all of it
};

/// Factors on the masses and on the earth's gravity.
struct Loads {
  double mass = 1.0;     ///< Factor on all masses, > 0
  double gravity = 1.0;  ///< Factor on the earth's gravity; 0 = weightless
};

/// Single free-floating rigid body: a twin without a URDF.
struct FreeBody {
  double mass = 6.0;  ///< Mass, kg, > 0; light, still stable with a stiff hand
  Eigen::Matrix3d inertia = 0.08 * Eigen::Matrix3d::Identity();  ///< Inertia about the COM, kg m^2
  Eigen::Vector3d p_handle_com = Eigen::Vector3d::Zero();        ///< Centre of mass, m, in "handle"
};
/// Vector argument by reference: pass stored vectors or blocks of them; an expression is copied to
/// the heap.
using VectorIn = Eigen::Ref<const Eigen::VectorXd>;

struct ChainParts;

/// A value: copies share their constant contents, which live as long as the last of them.
class ChainModel {
 public:
  /// Builds a model from a URDF file. Refuses branches, more than kMaxTwin degrees of freedom, and
  /// physically impossible inertias.
  static ChainModel from_urdf_file(const std::filesystem::path& file,
                                   const ChainOptions& options = {});
  /// Builds a model from URDF text; `source` replaces the file name in messages.
  static ChainModel from_urdf_text(std::string_view text, std::string_view source,
                                   const ChainOptions& options = {});
  /// Builds a free body with one floating joint "root" and one frame "handle"; `floating_root` is
  /// implied.
  static ChainModel free_body(const FreeBody& body, const ChainOptions& options = {});

  const std::string& name() const noexcept;                 ///< Name of the robot, from the URDF
  int nq() const noexcept;                                  ///< Number of coordinates
  int nv() const noexcept;                                  ///< Number of velocities, <= nq
  const std::vector<Joint>& joints() const noexcept;        ///< Joints with coordinates
  const std::vector<Coupling>& couplings() const noexcept;  ///< Joints without coordinates
  const std::vector<std::string>& frame_names() const noexcept;  ///< Frames: links of the part

  /// Index of a frame for the accessors of ChainData; throws SetupError with the nearest valid
  /// name.
  int frame(std::string_view name) const;
  /// Index of a joint in joints(); throws SetupError with the nearest valid name.
  int joint(std::string_view name) const;

  /// Loads as built: mass 1, gravity as set in ChainOptions.
  Loads default_loads() const noexcept;
  /// Neutral configuration: 0 for scalar joints, identity for floating ones.
  ConfigurationA neutral() const noexcept;
  /// Configuration q moved by `step` (nv, = dq * dt) for one unit of time; quaternions stay
  /// normalised.
  ConfigurationA integrate(const VectorIn& q, const VectorIn& step) const noexcept;

 private:
  friend class ChainData;
  explicit ChainModel(ChainParts parts);

  std::shared_ptr<const ChainParts> parts_;
};

}  // namespace hg::model
