#include "hg/controller/tracking/modes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "hg/controller/tracking/test/control_setup.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/linear_algebra.h"

namespace hg::tracking {
namespace {

using Complex = std::complex<double>;

double mu_of(double frequency_Hz) {
  return std::pow(2.0 * std::numbers::pi * frequency_Hz, -2);  // with brakes closed
}

// One mode: theta'' / w0^2 = v - (theta - q), mu q'' = theta - q, v from the gains, references 0.
Eigen::Matrix4d closed_loop(const Poles& poles, const ModeGains& gains, double mu) {
  const double w0_2 = poles.w0 * poles.w0;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();  // of (theta, theta', q, q')
  A(0, 1) = A(2, 3) = 1.0;
  A.row(1) << -w0_2 * (1.0 + gains.motor), -w0_2 * gains.motor_rate, w0_2 * (1.0 - gains.link),
      -w0_2 * gains.link_rate;
  A.row(3) << 1.0 / mu, 0.0, -1.0 / mu, 0.0;
  return A;
}

std::vector<Complex> pair(double w, double z) {
  const Complex root = w * std::sqrt(Complex(z * z - 1.0, 0.0));
  return {-w * z + root, -w * z - root};
}

double distance_to_nearest(const Eigen::Vector4cd& values, Complex wanted) {
  return (values.array() - wanted).abs().minCoeff();
}

TEST(Poles, ASoftModeGetsExactlyTheRequestedPoles) {
  for (const double latency : {1.5e-3, 2.5e-3, 4e-3}) {
    const Poles poles = poles_for({}, latency);
    for (const double frequency_Hz : {2.0, 4.1, 9.0, 11.4, 12.4, 20.0}) {
      SCOPED_TRACE(frequency_Hz);
      const double mu = mu_of(frequency_Hz);
      const Eigen::Vector4cd values = closed_loop(poles, gains_of(poles, mu), mu).eigenvalues();
      const double w2 = std::sqrt(poles.w0 * poles.w0 + 1.0 / mu);  // its own, motors free
      std::vector<Complex> wanted = pair(poles.w1, poles.z1);
      for (const Complex& pole : pair(w2, poles.z2)) wanted.push_back(pole);
      for (const Complex& pole : wanted) {
        EXPECT_LT(distance_to_nearest(values, pole), 1e-7 * std::abs(pole)) << pole;
      }
    }
  }
}

TEST(Poles, AStiffModeIsLedByItsMotorAlone) {
  const Poles poles;
  for (const double frequency_Hz : {77.0, 252.0}) {
    SCOPED_TRACE(frequency_Hz);
    const double mu = mu_of(frequency_Hz);
    const ModeGains gains = gains_of(poles, mu);
    EXPECT_EQ(gains.link, 0.0);
    EXPECT_EQ(gains.link_rate, 0.0);
    // with a spring without end the mode would be one body with a double pole
    EXPECT_DOUBLE_EQ(gains.motor,
                     poles.w_motor * poles.w_motor * (mu + 1.0 / (poles.w0 * poles.w0)));
    EXPECT_DOUBLE_EQ(gains.motor_rate * poles.w_motor, 2.0 * gains.motor);
    const Eigen::Vector4cd values = closed_loop(poles, gains, mu).eigenvalues();
    EXPECT_LT(values.real().maxCoeff(), 0.0);  // its own oscillation keeps what damping it has
    int slow = 0;
    for (const Complex& value : values) {
      if (std::abs(value) > 2.0 * poles.w_motor) continue;
      ++slow;
      EXPECT_NEAR(std::abs(value), poles.w_motor, 0.1 * poles.w_motor);
      EXPECT_LT(value.real(), -0.9 * poles.w_motor);
    }
    EXPECT_EQ(slow, 2);
  }
}

TEST(Poles, ModesAreStiffFromTheirOwnFrequencyOnNotTheLockedOne) {
  const Poles poles;
  const auto at = [&](double w2) { return gains_of(poles, 1.0 / (w2 * w2 - poles.w0 * poles.w0)); };
  EXPECT_NE(at(1.09 * poles.w2_max).link_rate, 0.0);
  EXPECT_EQ(at(1.11 * poles.w2_max).link_rate, 0.0);
}

// a posture that changes slowly turns soft modes into stiff ones
TEST(Poles, FromSoftToStiffNoGainJumps) {
  const Poles poles;
  ModeGains last;
  for (double w2 = 0.85 * poles.w2_max; w2 < 1.15 * poles.w2_max; w2 += 0.1) {
    const ModeGains gains = gains_of(poles, 1.0 / (w2 * w2 - poles.w0 * poles.w0));
    if (last.motor != 0.0) {
      EXPECT_NEAR(gains.motor, last.motor, 0.01) << w2;
      EXPECT_NEAR(gains.link, last.link, 0.01) << w2;
      EXPECT_NEAR(gains.motor_rate, last.motor_rate, 1e-4) << w2;
      EXPECT_NEAR(gains.link_rate, last.link_rate, 1e-4) << w2;
    }
    last = gains;
  }
}

TEST(Poles, StiffnessGrowsFromSoftToStiffWithoutAJump) {
  const Poles poles;
  const auto share_at = [&](double w2) {
    return stiffness_share(poles, 1.0 / (w2 * w2 - poles.w0 * poles.w0));
  };
  EXPECT_EQ(share_at(0.89 * poles.w2_max), 0.0);
  EXPECT_NEAR(share_at(poles.w2_max), 0.5, 1e-12);
  EXPECT_NEAR(share_at(1.05 * poles.w2_max), 0.75, 1e-12);
  EXPECT_EQ(share_at(1.11 * poles.w2_max), 1.0);
}

// [C] 1, "Latency decides w0": at most 0.75 of the largest stable w0, and not much less
TEST(Poles, FollowTheTableOfLatencies) {
  struct Row {
    double latency_s, largest_w0;  // latency without the lag of the current
  };
  double last_w0 = kInfinity;
  for (const Row& row :
       {Row{0.5e-3, 260.0}, {1e-3, 260.0}, {1.5e-3, 200.0}, {2e-3, 160.0}, {3e-3, 120.0}}) {
    SCOPED_TRACE(row.latency_s);
    const Poles poles = poles_for({}, row.latency_s + 0.5e-3);
    EXPECT_LE(poles.w0, 0.75 * row.largest_w0);
    EXPECT_GE(poles.w0, 0.55 * row.largest_w0);
    EXPECT_LE(poles.w0, last_w0);
    EXPECT_NEAR(poles.w1 / poles.w0, Poles{}.w1 / Poles{}.w0, 1e-12);
    EXPECT_NEAR(poles.w_motor / poles.w0, Poles{}.w_motor / Poles{}.w0, 1e-12);
    last_w0 = poles.w0;
  }
  EXPECT_EQ(poles_for({}, 1.5e-3).w0, Poles{}.w0);
  EXPECT_EQ(poles_for({}, 0.2e-3).w0, Poles{}.w0);  // no faster than the defaults
  EXPECT_LT(poles_for({}, 2.5e-3).w0, Poles{}.w0);
}

MatrixM scaled_mass(const VectorM& q_m) {
  const auto scale = stiffness().cwiseSqrt().cwiseInverse().eval();
  return scale.asDiagonal() * link_mass(q_m) * scale.asDiagonal();
}

// Largest errors of modes: eigenvalues against Eigen's, Q mu Q^T against A, Q against a rotation.
struct ModeErrors {
  double mu, product, orthogonality;
};
ModeErrors errors(const Modes& modes, const MatrixM& A) {
  const SymmetricEigen exact = symmetric_eigen(A);
  Eigen::VectorXd mu = modes.mu();
  std::sort(mu.begin(), mu.end());
  const double scale = exact.values.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd Q = modes.Q();
  const auto n = A.rows();
  return {(mu - exact.values).lpNorm<Eigen::Infinity>() / scale,
          (Q * modes.mu().asDiagonal() * Q.transpose() - A).lpNorm<Eigen::Infinity>() / scale,
          (Q.transpose() * Q - Eigen::MatrixXd::Identity(n, n)).lpNorm<Eigen::Infinity>()};
}

TEST(Modes, FromTheIdentityTheyConvergeToAnySymmetricMatrix) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> one(-1.0, 1.0);
    const int n = 1 + static_cast<int>(seed % kMaxManipulator);
    const MatrixM B = MatrixM::NullaryExpr(n, n, [&] { return one(random); });
    const MatrixM A = B * B.transpose();
    Modes modes(n);
    modes.follow(A, 12);
    const ModeErrors error = errors(modes, A);
    EXPECT_LT(error.mu, 1e-14);
    EXPECT_LT(error.product, 1e-13);
    EXPECT_LT(error.orthogonality, 1e-13);
  }
}

TEST(Modes, EqualEigenvaluesAndDiagonalMatricesAreDecomposed) {
  Modes modes(3);
  modes.follow(2.0 * MatrixM::Identity(3, 3));
  EXPECT_EQ(modes.mu(), VectorM::Constant(3, 2.0));
  EXPECT_EQ(modes.Q(), MatrixM::Identity(3, 3));
  modes.follow(MatrixM::Zero(3, 3));
  EXPECT_EQ(modes.mu(), VectorM::Zero(3));
}

// One sweep a period keeps up with the arm at full speed, for minutes.
TEST(Modes, OneSweepPerPeriodFollowsAMovingArm) {
  const auto q_at = [](double t) {
    return joints(0.0, 1.5 + 1.0 * std::sin(2.0 * t), -0.7 + 1.2 * std::sin(2.5 * t + 1.0),
                  1.3 + 0.9 * std::sin(2.8 * t), 0.4 + 0.8 * std::sin(3.4 * t), std::sin(3.0 * t));
  };
  Modes modes(6);
  modes.follow(scaled_mass(q_at(0.0)), 12);
  double worst_mu = 0.0, worst_product = 0.0;
  for (int k = 1; k <= 60'000; ++k) {
    const MatrixM A = scaled_mass(q_at(1e-3 * k));
    modes.follow(A);
    if (k % 7 != 0) continue;
    const ModeErrors error = errors(modes, A);
    worst_mu = std::max(worst_mu, error.mu);
    worst_product = std::max(worst_product, error.product);
  }
  EXPECT_LT(worst_mu, 1e-9);
  EXPECT_LT(worst_product, 1e-5);
  EXPECT_LT(errors(modes, scaled_mass(q_at(60.0))).orthogonality, 1e-10);
}

TEST(Modes, AreTheLockedFrequenciesOfTheHandbook) {
  Modes modes(6);
  modes.follow(scaled_mass(home()), 12);
  Eigen::VectorXd frequencies = modes.mu().cwiseSqrt().cwiseInverse() / (2.0 * std::numbers::pi);
  std::sort(frequencies.begin(), frequencies.end());
  const VectorM handbook = joints(4.1, 9.0, 11.4, 12.4, 77.0, 252.0);  // 1.4
  const VectorM digits = joints(0.05, 0.05, 0.05, 0.05, 0.5, 0.5);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(frequencies[i], handbook[i], digits[i]);
}

TEST(Modes, FollowWithoutAllocating) {
  const MatrixM A = scaled_mass(home());
  const AllocationCounter counter;
  Modes modes(6);
  modes.follow(A, 12);
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace hg::tracking
