/// Compares the motion of the inertial unit at the handle with the encoders.
///
/// Only this check detects an encoder that drifts together with the one it is compared with, or a
/// gantry whose coupling slips while its encoder shows the commanded motion. Turns are compared as
/// angles over some seconds, so that small drifts add up and noise does not; speeds are compared
/// over half a second, in which the error of an accelerometer adds up to little; at rest the
/// direction of gravity is compared with the posture. Turns about parallel axes that cancel each
/// other, slow slips of a gantry, and homing errors about vertical axes or of a gantry, are not
/// detected.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hg::estimation {

/// Part of the copyable state of an estimation. S is the frame of the inertial unit.
struct InertialCheck {
  bool is_started = false;
  Eigen::Matrix3d R_B_S = Eigen::Matrix3d::Identity();  ///< Last orientation by the encoders
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();       ///< Bias of the gyroscope, from rest, rad/s
  /// Rotation of the gyroscope beyond that of the encoders, slowly forgotten, in S, rad.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  /// Rotation by the encoders, forgotten likewise, in S; and the sum of its absolute values, rad.
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  double turned_in_all = 0.0;
  int rest_samples = 0;     ///< Samples in the mean of `bias`, until that is a moving one
  int gravity_samples = 0;  ///< Samples in the mean of `up_S` since the last motion, likewise
  /// Specific force at rest, a moving mean, in S, m/s^2.
  Eigen::Vector3d up_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_S = Eigen::Vector3d::Zero();  ///< Offset of `up_S` from gravity, m/s^2
  double offset_at_rest = 0.0;                         ///< Norm of `offset_S` at rest, m/s^2
  /// Position in the last sample, by encoders, in B, m.
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();
  /// Velocity in the last sample, by encoders, in B, m/s.
  Eigen::Vector3d v_S = Eigen::Vector3d::Zero();
  /// Speed gained by the unit beyond that of the encoders, quickly forgotten, in B, m/s.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const InertialCheck& check) {
  const auto& [is_started, R_B_S, bias, turn, turned, turned_in_all, rest_samples, gravity_samples,
               up_S, offset_S, offset_at_rest, p_S, v_S, slip] = check;
  hash.mix(std::uint64_t{is_started} | static_cast<std::uint64_t>(rest_samples) << 1U |
               static_cast<std::uint64_t>(gravity_samples) << 32U,
           R_B_S, bias, turn, turned, up_S, offset_S, p_S, v_S, slip, turned_in_all,
           offset_at_rest);
}

/// Measurement of an inertial unit, with its pose by the encoders.
struct InertialSample {
  Eigen::Matrix3d R_B_S = Eigen::Matrix3d::Identity();  ///< Orientation by the encoders
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();        ///< Position by the encoders, in B, m
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();    ///< angular velocity, in S, rad/s
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();        ///< acceleration minus gravity, in S
};

/// Processes a sample, `dt` s after the last. `is_on`: the drives have power and may move the unit;
/// otherwise the zeros of gyroscope and accelerometer are learnt.
void advance(double dt, const InertialSample& sample, bool is_on, InertialCheck& check) noexcept;

/// Part of `turn` that scale and axis errors of a gyroscope explain: 1.5 % of its net rotation, and
/// 0.3 % of its path there and back, rad.
double turn_uncertainty(const InertialCheck& check) noexcept;

/// Part of `slip` that a base off level or a wrongly homed joint explains, m/s: half a turn of the
/// handle doubles the resulting error of gravity's direction. Up to 20 mg of `offset_at_rest` count
/// as the unit's own.
double slip_uncertainty(const InertialCheck& check) noexcept;

/// Angle between measured gravity and gravity by the posture, rad, 0..pi; pi where an accelerometer
/// measures less than half of gravity at rest, 0 before the first sample.
double tilt(const InertialCheck& check) noexcept;

}  // namespace hg::estimation
