#include "hg/controller/estimation/gantry_observer.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace hg::estimation {
namespace {

// Stationary gains of the Kalman filter of the drive model, sampled with dt, for the densities that
// gantry_observer.h states; by iterating the Riccati equation until it stands still.
Eigen::Vector3d kalman_gains(double f_Hz, double lag, double dt) {
  const double a = 2.0 * std::numbers::pi * f_Hz;
  const double b = 1.0 / lag;
  Eigen::Matrix3d F;
  F << 1, dt - 0.5 * dt * dt * b, 0.5 * dt * dt, 0, 1 - dt * b, dt, 0, 0, 1;
  const Eigen::Vector3d density(
      3 * a * a, 3 * std::pow(a, 4) + 16 * std::pow(a, 3) * b + 6 * a * a * b * b, std::pow(a, 6));
  const Eigen::Matrix3d Q = (density * dt).asDiagonal();
  const double r = 1.0 / dt;  // density 1
  Eigen::Matrix3d P = Q;
  Eigen::Vector3d K;
  for (int k = 0; k < 400'000; ++k) {
    P = F * P * F.transpose() + Q;
    K = P.col(0) / (P(0, 0) + r);
    P -= K * P.row(0);
    P = (0.5 * (P + P.transpose())).eval();
  }
  return K;
}

TEST(GantryObserver, IsTheStationaryKalmanFilterOfTheDriveModel) {
  for (const double f : {4.0, 8.0, 20.0}) {
    for (const double lag : {0.02, 0.04, 0.2}) {
      for (const double dt : {1e-3 / f, 1e-4 / f}) {
        const GantryGains gains = gantry_gains(f, dt);
        const Eigen::Vector3d expected = kalman_gains(f, lag, dt);
        // equal in the limit of small periods: the difference is of first order in dt
        const double tolerance = 3.0 * 2.0 * std::numbers::pi * (f + 1.0 / lag) * dt;
        EXPECT_NEAR(gains.q / expected[0], 1.0, tolerance) << f << " Hz, lag " << lag;
        EXPECT_NEAR(gains.dq / expected[1], 1.0, tolerance) << f << " Hz, lag " << lag;
        EXPECT_NEAR(gains.disturbance / expected[2], 1.0, tolerance) << f << " Hz, lag " << lag;
      }
    }
  }
}

TEST(GantryObserver, FindsAnAccelerationOutsideTheDriveModel) {
  const DriveModel drive;
  const GantryGains gains = gantry_gains(8.0, 1e-3);
  GantryObserver axis;
  double dq = 0.0, q = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double ddq = drive_acceleration(drive, dq, 0.0) + 0.4;  // a person pushes the trolley
    q += 1e-3 * dq + 0.5e-6 * ddq;
    dq += 1e-3 * ddq;
    observe(drive, gains, 1e-3, q, 0.0, axis);
  }
  EXPECT_NEAR(axis.disturbance, 0.4, 1e-3);
  EXPECT_NEAR(axis.dq, dq, 1e-4);
}

TEST(GantryObserver, MakesUseOfA10MicrometreEncoder) {
  const DriveModel drive;
  const GantryGains gains = gantry_gains(8.0, 1e-3);
  GantryObserver axis;
  double dq = 0.0, q = 0.0, sum = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double command = 0.25 * std::sin(2e-3 * k);
    const double ddq = drive_acceleration(drive, dq, command);
    q += 1e-3 * dq + 0.5e-6 * ddq;
    dq += 1e-3 * ddq;
    observe(drive, gains, 1e-3, 1e-5 * std::round(q / 1e-5), command, axis);
    if (k >= 1000) sum += (axis.ddq - ddq) * (axis.ddq - ddq);
  }
  // second differences of it would be wrong by 10 m/s^2, [HANDBOOK] 1.5
  EXPECT_LT(std::sqrt(sum / 3000), 0.01);
}

}  // namespace
}  // namespace hg::estimation
