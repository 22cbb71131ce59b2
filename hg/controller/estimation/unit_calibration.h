/// Learns the mounting of an inertial unit on its link while the link moves.
///
/// Position and orientation of a unit on its link are unknown. Its readings are linear in them,
/// given the motion of its link by the encoders, everything resolved in the axes of the link:
///   gyroscope = W omega + b_g,   accelerometer = A (a - g) + b_a + A S p,
///   S = [alpha]x + [omega]x [omega]x.
/// W and A hold the turn of the unit together with its scale errors, p is its place in the link.
/// The products of A and p are unknowns of their own, so that least squares have one answer. Both
/// sides pass the same low-pass before they are compared: noise of the encoders' second differences
/// does not count. What no motion has shown stays 0. Source: the idea of [21] and [22] of the
/// paper, inertial robots that need no calibration.
///
/// Copyable; no allocation, noexcept.
#pragma once

#include <Eigen/Core>

namespace hg::estimation {

/// Motion of a link, resolved in its own axes.
struct LinkMotion {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      ///< Origin's acceleration minus gravity, m/s^2
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< Angular velocity, rad/s
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< Angular acceleration, rad/s^2
};

/// Reading of a unit, in its own axes.
struct UnitReading {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      ///< accelerometer, m/s^2
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< gyroscope, rad/s
};

/// Least squares of one unit: observations, result, and misfit.
struct UnitCalibration {
  static constexpr int kTurns = 4;  ///< Regressors of the gyroscope: omega and 1
  /// Regressors of the accelerometer: a - g, 1 and the columns of S.
  static constexpr int kMotions = 13;
  static constexpr int kSignals = 21;  ///< Number of low-passed signals
  using Signals = Eigen::Matrix<double, kSignals, 1>;
  using OfTurns = Eigen::Matrix<double, kTurns, 3>;
  using OfMotions = Eigen::Matrix<double, kMotions, 3>;

  bool is_started = false;
  Signals slow = Signals::Zero(), slower = Signals::Zero();
  /// Mean acceleration of the link, over seconds, m/s^2.
  Eigen::Vector3d a_mean = Eigen::Vector3d::Zero();
  double moved_s = 0.0;  ///< Time for which the link was accelerated, s
  Eigen::Matrix<double, kTurns, kTurns> turn_information =
      Eigen::Matrix<double, kTurns, kTurns>::Zero();
  Eigen::Matrix<double, kMotions, kMotions> information =
      Eigen::Matrix<double, kMotions, kMotions>::Zero();
  OfTurns turn_sum = OfTurns::Zero();
  OfMotions sum = OfMotions::Zero();

  OfTurns gyroscope = OfTurns::Zero();          ///< W^T and b_g^T
  OfMotions accelerometer = OfMotions::Zero();  ///< A^T, b_a^T and the products of A and p
  double variance = 1e6;  ///< Variance of the accelerometer's prediction for the present motion
  double misfit = 0.0;    ///< Mean square of the unexplained reading, below 10 Hz, (m/s^2)^2
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const UnitCalibration& unit) {
  const auto& [is_started, slow, slower, a_mean, moved_s, turn_information, information, turn_sum,
               sum, gyroscope, accelerometer, variance, misfit] = unit;
  hash.mix(slower, gyroscope, accelerometer, moved_s, variance, misfit, information.trace());
}

/// Processes a sample, `dt` s after the last.
void learn(double dt, const LinkMotion& motion, const UnitReading& reading,
           UnitCalibration& unit) noexcept;

/// Solves for the calibration from all samples so far; a thousand operations, not needed in each
/// period.
void solve(UnitCalibration& unit) noexcept;

/// Predicted reading of the unit.
UnitReading expected(const UnitCalibration& unit, const LinkMotion& motion) noexcept;

/// Effect of link accelerations, a and alpha, on the accelerometer: A and -A [p]x.
struct AccelerometerGains {
  Eigen::Matrix3d of_a, of_alpha;
};
AccelerometerGains gains_of(const UnitCalibration& unit) noexcept;

/// Whether the unit has moved enough to be calibrated, and its calibration explains the readings.
bool is_known(const UnitCalibration& unit) noexcept;

}  // namespace hg::estimation
