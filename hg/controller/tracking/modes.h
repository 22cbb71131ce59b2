/// Modes of a series elastic arm and the feedback gains that place their poles; [C] 1.
///
/// With shaped rotor inertias Jt = K / w0^2 the links' mass matrix M, the springs K and Jt have
/// common modes: the eigenvectors of K^-1/2 M K^-1/2. Every mode is a two-mass oscillator of its
/// own. No allocation, noexcept.
#pragma once

#include "hg/core/types.h"

namespace hg::tracking {

using MatrixM = MatrixUpTo<kMaxManipulator, kMaxManipulator>;

/// Poles of the closed loop. rad/s; slowed down for the latency of the loop by poles_for().
///
/// The fast pair has little damping because latency reduces damping first: with
/// z2 = 0.5, [C] 1, modes of 28 to 40 Hz are unstable at 200 rad/s (9 of 200 random postures,
/// loop_stability.h), with 0.25 none is at 175 rad/s, also where rotors, links and springs differ
/// by a quarter or the latency by a half. Modes near w2_max tolerate least, hence 270 rad/s.
struct Poles {
  double w0 = 175.0;  ///< Pole of the shaped rotor on its spring
  double w1 = 57.0;   ///< Slow pair: how the link follows
  double z1 = 0.85;   ///< Damping ratio of the slow pair
  double z2 = 0.25;   ///< Damping ratio of the fast pair, which keeps its natural frequency
  /// Frequency from about which a mode is controlled from the motor side alone.
  double w2_max = 270.0;
  double w_motor = 90.0;  ///< Double pole of modes controlled from the motor side alone
};

/// Largest w0 that tolerates `latency` (s), which includes the lag of the current, rad/s.
double largest_rotor_pole(double latency) noexcept;

/// Poles `fastest`, slowed down to largest_rotor_pole(); w1 and w_motor scale along, w2_max and
/// damping ratios do not.
Poles poles_for(const Poles& fastest, double latency) noexcept;

/// Stiffness share of a mode with the eigenvalue `mu` (s^2): 0 from 0.9 w2_max down, 1 from 1.1
/// w2_max up, linear between. w2 is its frequency with motors free, sqrt(w0^2 + 1 / mu).
double stiffness_share(const Poles& poles, double mu) noexcept;

/// Gains of v = motor (theta_r - theta) + motor_rate (theta_r' - theta') + link (q_r - q) +
/// link_rate (..).
struct ModeGains {
  double motor = 0.0, motor_rate = 0.0, link = 0.0, link_rate = 0.0;
};

/// Gains of a mode with the eigenvalue `mu` in s^2: 1/sqrt(mu) is its frequency with brakes closed.
/// From soft to stiff modes they change with stiffness_share().
ModeGains gains_of(const Poles& poles, double mu) noexcept;

/// Eigenvectors Q and eigenvalues mu of a symmetric matrix that changes slowly: every call turns
/// the vectors of the last call by one cyclic sweep of Jacobi rotations, which converges
/// quadratically.
class Modes {
 public:
  /// Starts with the identity.
  explicit Modes(int n = 0);

  void follow(const MatrixM& A, int sweeps = 1) noexcept;
  const MatrixM& Q() const noexcept { return Q_; }
  const VectorM& mu() const noexcept { return mu_; }

 private:
  MatrixM Q_;
  VectorM mu_;
};

}  // namespace hg::tracking
