/// Whether the inertial unit at the handle moves as the encoders say.
///
/// An encoder that drifts together with the one it is compared with is seen by nobody else. Turns
/// are compared as angles over some seconds, so that small drifts add up and noise does not; at
/// rest the direction of gravity is compared with the posture. Turns about parallel axes that
/// cancel each other, and homing errors about vertical axes or of a gantry, remain unseen.
#pragma once

#include <Eigen/Core>

namespace hg::estimation {

/// Part of the copyable state of an estimation. S is the frame of the inertial unit.
struct InertialCheck {
  bool is_started = false;
  Eigen::Matrix3d R_B_S = Eigen::Matrix3d::Identity();  ///< of the last sample, by the encoders
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();       ///< of the gyroscope, from rest, rad/s
  /// By how much the gyroscope has turned more than the encoders, forgotten slowly, in S, rad.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double turned = 0.0;      ///< by how much it has turned at all, forgotten likewise, rad
  int rest_samples = 0;     ///< that the zero is the mean of, until that is a moving one
  int gravity_samples = 0;  ///< the same of `up_S`, since the last motion
  /// Specific force at rest, a moving mean, in S, m/s^2.
  Eigen::Vector3d up_S = Eigen::Vector3d::Zero();
};

/// Takes the sample of an inertial unit, `dt` s after the last: angular velocity (rad/s) and
/// acceleration minus gravity (m/s^2), both in S, with the orientation that the encoders say.
/// `is_on`: the drives have power and may move it; otherwise the gyroscope's zero is learnt.
void advance(double dt, const Eigen::Matrix3d& R_B_S, const Eigen::Vector3d& omega_S,
             const Eigen::Vector3d& a_S, bool is_on, InertialCheck& check) noexcept;

/// Angle between gravity as measured and as the posture says, rad, 0..pi; 0 before there is any.
double tilt(const InertialCheck& check) noexcept;

}  // namespace hg::estimation
