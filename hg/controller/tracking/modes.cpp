#include "hg/controller/tracking/modes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hg::tracking {
namespace {

// rotates columns p and r of Q and rows and columns p and r of B so that B(p, r) vanishes
void rotate(int p, int r, MatrixM& B, MatrixM& Q) noexcept {
  const double off = B(p, r);
  if (std::abs(off) <= std::numeric_limits<double>::min()) return;
  const double theta = 0.5 * (B(r, r) - B(p, p)) / off;
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(1.0, theta));
  const double c = 1.0 / std::hypot(1.0, t), s = t * c;
  const auto turn = [c, s](auto&& x, auto&& y) noexcept {
    const VectorM x_old = x;
    x = c * x_old - s * y;
    y = s * x_old + c * y;
  };
  turn(B.col(p), B.col(r));
  for (Eigen::Index i = 0; i < B.cols(); ++i) {
    const double x = B(p, i), y = B(r, i);
    B(p, i) = c * x - s * y;
    B(r, i) = s * x + c * y;
  }
  turn(Q.col(p), Q.col(r));
}

// gains of the motor side alone, as if the spring were infinitely stiff
ModeGains stiff_gains(const Poles& poles, double mu) noexcept {
  const double inertia = mu + 1.0 / (poles.w0 * poles.w0);
  return {.motor = poles.w_motor * poles.w_motor * inertia,
          .motor_rate = 2.0 * poles.w_motor * inertia};
}

// gains that place all four poles
ModeGains soft_gains(const Poles& poles, double mu) noexcept {
  const double w0_2 = poles.w0 * poles.w0;
  const double w2_2 = w0_2 + 1.0 / mu;
  const double w2 = std::sqrt(w2_2);
  const double w1 = poles.w1, w1_2 = w1 * w1;
  const double a3 = 2.0 * poles.z1 * w1 + 2.0 * poles.z2 * w2;
  const double a2 = w1_2 + w2_2 + 4.0 * poles.z1 * poles.z2 * w1 * w2;
  const double a1 = 2.0 * poles.z1 * w1 * w2_2 + 2.0 * poles.z2 * w2 * w1_2;
  const double a0 = w1_2 * w2_2;
  ModeGains gains;
  gains.motor_rate = a3 / w0_2;
  gains.motor = a2 / w0_2 - 1.0 / (w0_2 * mu) - 1.0;
  gains.link_rate = a1 * mu / w0_2 - gains.motor_rate;
  gains.link = a0 * mu / w0_2 - gains.motor;
  return gains;
}

}  // namespace

double largest_rotor_pole(double latency) noexcept { return 0.265 / latency; }

Poles poles_for(const Poles& fastest, double latency) noexcept {
  Poles poles = fastest;
  poles.w0 = std::min(fastest.w0, largest_rotor_pole(latency));
  const double share = poles.w0 / fastest.w0;
  poles.w1 *= share;
  poles.w_motor *= share;
  return poles;
}

double stiffness_share(const Poles& poles, double mu) noexcept {
  constexpr double kHalfWidth = 0.1;  // of w2_max
  const double w2 = std::sqrt(poles.w0 * poles.w0 + 1.0 / mu);
  return std::clamp(0.5 + (w2 / poles.w2_max - 1.0) / (2.0 * kHalfWidth), 0.0, 1.0);
}

ModeGains gains_of(const Poles& poles, double mu) noexcept {
  const double stiff = stiffness_share(poles, mu), soft = 1.0 - stiff;
  const ModeGains a = soft_gains(poles, mu), b = stiff_gains(poles, mu);
  return {.motor = soft * a.motor + stiff * b.motor,
          .motor_rate = soft * a.motor_rate + stiff * b.motor_rate,
          .link = soft * a.link,
          .link_rate = soft * a.link_rate};
}

Modes::Modes(int n) : Q_(MatrixM::Identity(n, n)), mu_(VectorM::Zero(n)) {}

void Modes::follow(const MatrixM& A, int sweeps) noexcept {
  const int n = static_cast<int>(A.rows());
  const MatrixM A_Q = A.lazyProduct(Q_);  // small: no blocking
  MatrixM B = Q_.transpose().lazyProduct(A_Q);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int p = 0; p + 1 < n; ++p) {
      for (int r = p + 1; r < n; ++r) rotate(p, r, B, Q_);
    }
  }
  mu_ = B.diagonal();
}

}  // namespace hg::tracking
