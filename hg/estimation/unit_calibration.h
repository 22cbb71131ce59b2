/// How an inertial unit sits on its link, learnt while the link moves.
///
/// Nobody has measured where a unit is glued on and how it is turned. What it shows is linear in
/// that, with the motion of its link by the encoders, everything resolved in the axes of the link:
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

/// Of a link, resolved in its own axes.
struct LinkMotion {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      ///< of its origin minus gravity, m/s^2
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< rad/s^2
};

/// What a unit shows, in its own axes.
struct UnitReading {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      ///< accelerometer, m/s^2
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< gyroscope, rad/s
};

/// Least squares of one unit: what was seen, what follows from it, and how well that explains.
struct UnitCalibration {
  static constexpr int kTurns = 4;     ///< omega and 1
  static constexpr int kMotions = 13;  ///< a - g, 1 and the columns of S
  static constexpr int kSignals = 21;  ///< that are low-passed
  using Signals = Eigen::Matrix<double, kSignals, 1>;
  using OfTurns = Eigen::Matrix<double, kTurns, 3>;
  using OfMotions = Eigen::Matrix<double, kMotions, 3>;

  bool is_started = false;
  Signals slow = Signals::Zero(), slower = Signals::Zero();
  Eigen::Vector3d a_mean = Eigen::Vector3d::Zero();  ///< of the link, over seconds, m/s^2
  double moved_s = 0.0;                              ///< for how long the link was accelerated
  Eigen::Matrix<double, kTurns, kTurns> turn_information =
      Eigen::Matrix<double, kTurns, kTurns>::Zero();
  Eigen::Matrix<double, kMotions, kMotions> information =
      Eigen::Matrix<double, kMotions, kMotions>::Zero();
  OfTurns turn_sum = OfTurns::Zero();
  OfMotions sum = OfMotions::Zero();

  OfTurns gyroscope = OfTurns::Zero();          ///< W^T and b_g^T
  OfMotions accelerometer = OfMotions::Zero();  ///< A^T, b_a^T and the products of A and p
  double variance = 1e6;  ///< of the accelerometer's prediction for the motion of the moment
  double misfit = 0.0;    ///< mean square of what it leaves unexplained, below 10 Hz, (m/s^2)^2
};

/// Takes a sample, `dt` s after the last.
void learn(double dt, const LinkMotion& motion, const UnitReading& reading,
           UnitCalibration& unit) noexcept;

/// Solves for what has been learnt so far; a thousand operations, not needed in each period.
void solve(UnitCalibration& unit) noexcept;

/// What the unit should show.
UnitReading expected(const UnitCalibration& unit, const LinkMotion& motion) noexcept;

/// What accelerations of the link, a and alpha, do to the accelerometer: A and -A [p]x.
struct AccelerometerGains {
  Eigen::Matrix3d of_a, of_alpha;
};
AccelerometerGains gains_of(const UnitCalibration& unit) noexcept;

/// Whether the unit has moved enough to be known, and is explained by what is known.
bool is_known(const UnitCalibration& unit) noexcept;

}  // namespace hg::estimation
