/// A serial kinematic chain: poses, Jacobians and dynamics of devices and twins.
///
/// Joints are revolute, continuous, prismatic or floating; fixed joints merge their links, planar
/// ones become three scalar joints. A continuous joint has one unwrapped coordinate. A floating
/// joint has seven coordinates (x y z qx qy qz qw: pose of the child in its parent) and six
/// velocities (twist of the child, resolved in the child). All results are resolved in frame B,
/// wrenches and twists linear part first. Units SI.
///
/// Set-up throws SetupError, `file:line: item: rule, got value`. After it nothing allocates or
/// throws. Accessors return the results of the last update; what they refer to changes with the
/// next one. One chain serves one thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg::model {

enum class JointType { kRevolute, kContinuous, kPrismatic, kFloating };

std::string_view to_string(JointType type) noexcept;

/// One moving joint, in the order from root to tip.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int q_index = 0;                  ///< of its first coordinate in q
  int v_index = 0;                  ///< of its first velocity in dq
  int nq = 1;                       ///< 7 for a floating joint
  int nv = 1;                       ///< 6 for a floating joint
  Interval position;                ///< rad or m; unbounded where the URDF gives no limit
  double velocity_max = kInfinity;  ///< rad/s or m/s
  double effort_max = kInfinity;    ///< Nm or N
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< of a scalar joint, in its own frame
  std::string planar;  ///< planar joint of the URDF that this one is a part of; see urdf_parts.h
};

/// What is screwed onto a link of a chain: a handle with its force/torque sensor, for example.
struct Tool {
  std::string link;                                   ///< of the URDF, to which it is fixed
  std::string handle = "handle";                      ///< name of the frame that it adds
  Pose T_link_handle;                                 ///< that frame in the link
  double mass = 0.0;                                  ///< kg, >= 0
  Eigen::Vector3d p_com = Eigen::Vector3d::Zero();    ///< m, in the link
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about the COM, axes of the link
};

/// A passive joint of the same kind that carries what a joint of the URDF carried.
struct PassiveJoint {
  std::string behind;                   ///< revolute, continuous or prismatic joint of the URDF
  std::string name;                     ///< of the new joint; no joint or link has it
  std::optional<Eigen::Vector3d> axis;  ///< unit vector in the child of `behind`; none = its axis
};

struct ChainOptions {
  Pose T_B_root;        ///< placement of the root link in frame B
  bool gravity = true;  ///< false: c() and inverse_dynamics() are without gravity
  std::optional<Tool> tool;
  std::vector<PassiveJoint> passive;  ///< that the URDF does not have: a structure that yields
  bool floating_root = false;  ///< true: the root link moves freely in B by a floating joint "root"
  /// The serial part of a branched URDF, see serial_part() in urdf_parts.h; empty = all of it.
  std::string root_link, tip_link;
};

/// Heavier or lighter than built: factors of the masses and of the earth's gravity.
struct Loads {
  double mass = 1.0;     ///< > 0
  double gravity = 1.0;  ///< 0 = weightless
};

/// A single rigid body that moves freely: a twin without a URDF.
struct FreeBody {
  double mass = 6.0;  ///< kg, > 0; light, still stable with a stiff hand
  Eigen::Matrix3d inertia = 0.08 * Eigen::Matrix3d::Identity();  ///< kg m^2, about the COM
  Eigen::Vector3d p_handle_com = Eigen::Vector3d::Zero();        ///< m, in frame "handle"
};

/// Vectors enter as references: pass stored vectors or blocks of them; an expression is copied to
/// the heap.
using VectorIn = Eigen::Ref<const Eigen::VectorXd>;
/// Jacobian of a frame (6 x nv), linear rows first.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxTwin>;

class Chain {
 public:
  /// Reads a URDF. Refuses branches, more than kMaxTwin degrees of freedom, and inertias no body
  /// has.
  static Chain from_urdf_file(const std::filesystem::path& file, const ChainOptions& options = {});
  /// The same from text; `source` stands for the file name in messages.
  static Chain from_urdf_text(std::string_view text, std::string_view source,
                              const ChainOptions& options = {});
  /// One floating joint "root" and one frame "handle"; `floating_root` is implied.
  static Chain free_body(const FreeBody& body, const ChainOptions& options = {});

  Chain(const Chain& other);
  Chain(Chain&& other) noexcept;
  Chain& operator=(const Chain& other);
  Chain& operator=(Chain&& other) noexcept;
  ~Chain();

  const std::string& name() const noexcept;  ///< of the robot, from the URDF
  int nq() const noexcept;                   ///< number of coordinates
  int nv() const noexcept;                   ///< number of velocities, <= nq
  const std::vector<Joint>& joints() const noexcept;
  const std::vector<std::string>& frame_names() const noexcept;  ///< every link of the part

  /// Index for the accessors below; throws SetupError with the nearest valid name.
  int frame(std::string_view name) const;
  /// Index in joints(); throws SetupError with the nearest valid name.
  int joint(std::string_view name) const;

  /// Coordinates 0 for scalar joints, identity for floating ones.
  ConfigurationA neutral() const noexcept;
  /// q moved by `step` (nv, = dq * dt) for one unit of time; quaternions stay normalised.
  ConfigurationA integrate(const VectorIn& q, const VectorIn& step) const noexcept;

  void update_poses(const VectorIn& q) noexcept;  ///< poses only, for half the cost
  /// Poses, twists, Jacobians, bias accelerations.
  void update_kinematics(const VectorIn& q, const VectorIn& dq) noexcept;
  /// The same and M, c, gravity.
  void update(const VectorIn& q, const VectorIn& dq) noexcept { update(q, dq, default_loads()); }
  void update(const VectorIn& q, const VectorIn& dq, const Loads& loads) noexcept;
  /// As built: mass 1, gravity as ChainOptions says.
  Loads default_loads() const noexcept;

  /// Pose of a frame relative to B.
  const Pose& pose(int frame) const noexcept;
  /// Velocity of the frame's origin and angular velocity (v; omega).
  const Vector6& twist(int frame) const noexcept;
  /// twist = jacobian * dq.
  const Jacobian& jacobian(int frame) const noexcept;
  /// dJ * dq: classical acceleration of the frame's origin and angular acceleration at ddq = 0.
  const Vector6& bias_acceleration(int frame) const noexcept;

  /// Mass matrix (nv x nv), symmetric, both triangles.
  const Eigen::MatrixXd& M() const noexcept;
  /// Coriolis, centrifugal and gravity torques (nv): M ddq + c = tau + J^T w.
  const Eigen::VectorXd& c() const noexcept;
  /// Part of c() that gravity makes (nv); zero without gravity.
  const Eigen::VectorXd& gravity() const noexcept;
  /// Energy in gravity after update(), J, with default_loads(): zero without gravity, else zero
  /// where all masses are at the height of B.
  double potential_energy() const noexcept;

  /// tau = M ddq + c without external wrenches; leaves the results of update() as they are.
  VectorA inverse_dynamics(const VectorIn& q, const VectorIn& dq, const VectorIn& ddq) noexcept;

 private:
  struct Impl;
  explicit Chain(std::unique_ptr<Impl> impl) noexcept;

  std::unique_ptr<Impl> impl_;
};

}  // namespace hg::model
