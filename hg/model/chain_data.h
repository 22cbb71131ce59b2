/// The state of a serial kinematic chain: poses, twists, Jacobians and dynamics in one posture.
///
/// All results are resolved in frame B, wrenches and twists linear part first. SI units.
///
/// Accessors return results of the last update; the next update overwrites them. The constructor
/// and copies allocate, nothing else allocates or throws. Not thread-safe, not even const
/// accessors, which compute on first use: one ChainData per thread.
#pragma once

#include <memory>

#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::model {

/// Jacobian of a frame (6 x nv), linear rows first.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxTwin>;

class ChainData {
 public:
  /// Keeps a copy of `model`, which shares its contents. Results are undefined until an update.
  explicit ChainData(ChainModel model);
  ChainData(const ChainData& other);
  ChainData(ChainData&& other) noexcept;
  ChainData& operator=(const ChainData& other);
  ChainData& operator=(ChainData&& other) noexcept;
  ~ChainData();

  const ChainModel& model() const noexcept;

  /// Motion of the root link for the next updates, where the chain has a moving base (else nothing
  /// happens): its pose, its velocity against B, and classical acceleration of its origin and
  /// angular acceleration, all resolved in B. Twists and bias accelerations then contain that
  /// motion, c() the inertial forces; Jacobians are against the base.
  void move_base(const Pose& T_B_base, const Vector6& twist, const Vector6& acceleration) noexcept;

  void update_poses(const VectorIn& q) noexcept;  ///< Updates poses only, at half the cost
  /// Updates poses, twists, Jacobians, bias accelerations.
  void update_kinematics(const VectorIn& q, const VectorIn& dq) noexcept;
  /// Updates poses, twists, Jacobians, bias accelerations, M, c, gravity.
  void update(const VectorIn& q, const VectorIn& dq) noexcept;
  /// The same update with other masses and gravity.
  void update(const VectorIn& q, const VectorIn& dq, const Loads& loads) noexcept;

  /// Pose of a frame relative to B.
  const Pose& pose(int frame) const noexcept;
  /// Twist of a frame: velocity of its origin and angular velocity (v; omega).
  const Vector6& twist(int frame) const noexcept;
  /// Jacobian of a frame: twist = jacobian * dq, on a moving base plus what that adds.
  const Jacobian& jacobian(int frame) const noexcept;
  /// What a moving base adds to the twist of a frame; zero without one.
  Vector6 carried_twist(int frame) const noexcept;
  /// Bias acceleration dJ * dq (ddq = 0): classical acceleration of the frame's origin, angular
  /// acceleration.
  const Vector6& bias_acceleration(int frame) const noexcept;

  /// Mass matrix (nv x nv), symmetric, both triangles.
  const Eigen::MatrixXd& M() const noexcept;
  /// Coriolis, centrifugal and gravity torques (nv): M ddq + c = tau + J^T w.
  const Eigen::VectorXd& c() const noexcept;
  /// Gravity part of c() (nv); zero without gravity.
  const Eigen::VectorXd& gravity() const noexcept;
  /// Potential energy after update(), J, with default_loads(): zero without gravity, or with all
  /// masses at the height of B.
  double potential_energy() const noexcept;

  /// Inverse dynamics tau = M ddq + c without external wrenches; keeps the results of update().
  VectorA inverse_dynamics(const VectorIn& q, const VectorIn& dq, const VectorIn& ddq) noexcept;

 private:
  struct Impl;

  std::unique_ptr<Impl> impl_;
};

}  // namespace hg::model
