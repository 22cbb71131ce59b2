/// Whether the inertial unit at the handle moves as the encoders say.
///
/// An encoder that drifts together with the one it is compared with is seen by nobody else, nor a
/// gantry whose coupling slips while its encoder says what was asked for. Turns are compared as
/// angles over some seconds, so that small drifts add up and noise does not; speeds are compared
/// over half a second, in which the error of an accelerometer adds up to little; at rest the
/// direction of gravity is compared with the posture. Turns about parallel axes that cancel each
/// other, slow slips of a gantry, and homing errors about vertical axes or of a gantry, remain
/// unseen.
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
  /// By how much it has turned by the encoders, forgotten likewise, in S; and there and back, rad.
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  double turned_in_all = 0.0;
  int rest_samples = 0;     ///< that the zero is the mean of, until that is a moving one
  int gravity_samples = 0;  ///< the same of `up_S`, since the last motion
  /// Specific force at rest, a moving mean, in S, m/s^2.
  Eigen::Vector3d up_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_S = Eigen::Vector3d::Zero();  ///< of `up_S` from gravity, m/s^2
  double offset_at_rest = 0.0;                         ///< its size then, m/s^2
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();       ///< of the last sample, by encoders, in B, m
  Eigen::Vector3d v_S = Eigen::Vector3d::Zero();       ///< the same, m/s
  /// By how much the unit has become faster than the encoders say, forgotten soon, in B, m/s.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();
};

/// What an inertial unit has measured, with where and how the encoders say that it is.
struct InertialSample {
  Eigen::Matrix3d R_B_S = Eigen::Matrix3d::Identity();  ///< by the encoders
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();        ///< by the encoders, in B, m
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();    ///< angular velocity, in S, rad/s
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();        ///< acceleration minus gravity, in S
};

/// Takes a sample, `dt` s after the last. `is_on`: the drives have power and may move the unit;
/// otherwise the zeros of gyroscope and accelerometer are learnt.
void advance(double dt, const InertialSample& sample, bool is_on, InertialCheck& check) noexcept;

/// What of `turn` scale and directions of a gyroscope explain: 1.5 % of how far it has turned, and
/// 0.3 % of its way there and back, rad.
double turn_uncertainty(const InertialCheck& check) noexcept;

/// What of `slip` is explained by a base that is not level or a joint that was homed wrongly, m/s:
/// a turn of the handle by half a turn makes twice the error of gravity's direction of it. Up to
/// 20 mg of `offset_at_rest` are taken for the unit's own.
double slip_uncertainty(const InertialCheck& check) noexcept;

/// Angle between gravity as measured and as the posture says, rad, 0..pi; pi where an accelerometer
/// measures less than half of gravity at rest, 0 before there is any sample.
double tilt(const InertialCheck& check) noexcept;

}  // namespace hg::estimation
