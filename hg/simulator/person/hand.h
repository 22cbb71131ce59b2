/// Impedance of a person's hand: an arm that pulls the hand's mass towards a goal, and the grip by
/// which the hand holds the handle. Source: [HANDBOOK] 5.1.
///
///   handle --grip spring, damper-- hand mass --arm spring, damper-- goal
///
/// Rotations have no grip in series and no inertia ([HANDBOOK] gives no torsional grip).
/// SI units; wrenches act on the handle, at H, resolved in B. No allocation, noexcept after set-up.
#pragma once

#include <cstdint>

#include "hg/core/arm_mass.h"
#include "hg/core/types.h"

namespace hg::person {

/// Stiffness level of the hand, [HANDBOOK] 5.1 [K].
enum class HandPreset { kRelaxed, kNormal, kStiff };

/// Impedance parameters of a hand. Linear values hold along the person's fore-aft, left-right and
/// vertical axes: x, y, z of B, turned about z by the heading of the goal. Angular ones hold about
/// the axes of H: yaw, pitch and roll of a hand that holds it level. The defaults are the preset
/// kNormal.
struct HandImpedance {
  Eigen::Vector3d stiffness{250, 150, 200};       ///< arm stiffness, N/m
  Eigen::Vector3d damping{20, 15, 18};            ///< arm damping, Ns/m
  Eigen::Vector3d mass{1.0, kArmMass, kArmMass};  ///< effective mass of hand and arm, kg
  double grip_stiffness = 1000;  ///< stiffness of the tissue between hand and handle, N/m
  double grip_damping = 15;      ///< Ns/m
  Eigen::Vector3d angular_stiffness{1.0, 1.5, 2};     ///< Nm/rad
  Eigen::Vector3d angular_damping{0.08, 0.08, 0.08};  ///< Nms/rad, [A]
  double force_max = 60;  ///< maximum pull of the arm, N; [HANDBOOK] 5.3
  double torque_max = 8;  ///< maximum torque, Nm; [HANDBOOK] 5.3
  /// Downward force at the handle with HandTarget::press = 1, N, when the hand does not pull; plus
  /// as much as it pulls sideways
  double press_force = 14;
  double tremor_rms = 0.035;  ///< RMS tremor force along each axis, N; 0 = none
};

/// Hand impedance of a preset, [HANDBOOK] 5.1.
HandImpedance hand(HandPreset preset) noexcept;

/// Throws SetupError naming the field that is out of range.
void check_hand_impedance(const HandImpedance& hand);

/// Pose and twist of the handle.
struct HandleMotion {
  Pose T_B_H;
  Vector6 twist = Vector6::Zero();
};

/// Desired pose and twist of the hand.
struct Goal {
  Pose pose;
  Vector6 twist = Vector6::Zero();
  double heading = 0.0;         ///< person's heading about z of B, rad
  double height_share = 1.0;    ///< share of the vertical stiffness that holds the hand's height
  bool has_orientation = true;  ///< false: the hand holds the handle's orientation loosely
  bool has_shoulder = false;
  /// Shoulder position at the height of the hand
  Eigen::Vector3d shoulder = Eigen::Vector3d::Zero();
};

/// The hand's mass between grip and arm.
class Arm {
 public:
  explicit Arm(const HandImpedance& hand) noexcept : hand_(hand) {}

  /// Starts the hand at the pose and velocity of the handle.
  void grasp(const HandleMotion& handle) noexcept;

  /// Advances by `dt` up to the moment of `handle` and `goal`, in steps of at most 0.25 ms;
  /// linearly implicit, so that it is stable for any stiffness or mass. Times longer than 0.1 s are
  /// cut. `tremor` is a force of the hand on the handle.
  void step(double dt, const HandleMotion& handle, const Goal& goal,
            const Eigen::Vector3d& tremor) noexcept;

  /// Present wrench of the hand on the handle.
  Vector6 wrench() const noexcept { return wrench_; }
  const Eigen::Vector3d& position() const noexcept { return p_; }

 private:
  void move(double dt, const HandleMotion& handle, const Goal& goal,
            const Eigen::Vector3d& tremor) noexcept;
  Eigen::Vector3d torque(const HandleMotion& handle, const Goal& goal) const noexcept;

  HandImpedance hand_;
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();  ///< position of the hand, in B
  Eigen::Vector3d v_ = Eigen::Vector3d::Zero();
  Vector6 wrench_ = Vector6::Zero();
};

}  // namespace hg::person
