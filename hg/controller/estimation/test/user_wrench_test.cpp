#include "hg/controller/estimation/user_wrench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "hg/core/cross.h"

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
const Eigen::Vector3d kUp(0.0, 0.0, 9.81);  // acceleration minus gravity of what stands still

Payload handle() {
  Payload payload = {.mass = 1.18, .com = {0.01, -0.02, 0.03}};
  payload.inertia << 3.5e-3, 1e-4, 0, 1e-4, 3.0e-3, -2e-4, 0, -2e-4, 1.2e-3;
  return payload;
}

// The sensor on a path: position and orientation (rotation about a fixed axis and another about the
// turned z axis) as functions of time; all derivatives by central differences in long double steps.
struct Motion {
  double amplitude = 1.0;

  Eigen::Vector3d p(double t) const {
    return amplitude * Eigen::Vector3d(0.1 * std::sin(6 * t), 0.05 * std::cos(9 * t), 0.08 * t * t);
  }
  Eigen::Matrix3d R(double t) const {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
    return (Eigen::AngleAxisd(amplitude * 0.8 * std::sin(4 * t), axis) *
            Eigen::AngleAxisd(amplitude * 1.5 * t, Eigen::Vector3d::UnitZ()))
        .toRotationMatrix();
  }
  static constexpr double kStep = 1e-4;
  Eigen::Vector3d omega_B(double t) const {
    const Eigen::Matrix3d W = (R(t + kStep) - R(t - kStep)) / (2 * kStep) * R(t).transpose();
    return 0.5 * Eigen::Vector3d(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1));
  }
  Eigen::Vector3d a_S(double t) const {
    const Eigen::Vector3d a = (p(t + kStep) - 2 * p(t) + p(t - kStep)) / (kStep * kStep);
    return R(t).transpose() * (a + kUp);
  }
  Eigen::Vector3d omega_S(double t) const { return R(t).transpose() * omega_B(t); }

  // Newton and Euler about the payload's centre of mass, in B: independent of payload_wrench()
  Vector6 w_S(const Payload& payload, const Vector6& w_user, double t) const {
    const auto com = [&](double at) -> Eigen::Vector3d { return p(at) + R(at) * payload.com; };
    const auto spin = [&](double at) -> Eigen::Vector3d {
      return R(at) * payload.inertia * R(at).transpose() * omega_B(at);
    };
    const Eigen::Vector3d a = (com(t + kStep) - 2 * com(t) + com(t - kStep)) / (kStep * kStep);
    const Eigen::Vector3d dspin = (spin(t + kStep) - spin(t - kStep)) / (2 * kStep);
    // what the sensor carries is the user's wrench, less what moves the payload
    const Eigen::Vector3d f = -payload.mass * (a + kUp);
    const Eigen::Vector3d n = (R(t) * payload.com).cross(f) - dspin;
    Vector6 w = w_user;
    w.head<3>() += R(t).transpose() * f;
    w.tail<3>() += R(t).transpose() * n;
    return w;
  }
};

// worst error of force and torque while the user pulls with a constant wrench in S
struct Worst {
  double force = 0.0, torque = 0.0;
};

Worst worst_error(const WrenchConfig& config, const Motion& motion, double dt = kDt) {
  const Vector6 w_user = (Vector6() << 5, -3, 8, 0.2, -0.1, 0.3).finished();
  WrenchState state;
  Worst worst;
  for (double t = 0.0; t < 1.0; t += dt) {
    SensorFrame sensors;
    sensors.w_S = motion.w_S(handle(), w_user, t);
    sensors.a_S = motion.a_S(t);
    sensors.omega_S = motion.omega_S(t);
    estimate(config, dt, sensors, motion.R(t), state);
    if (t < 0.1) continue;
    worst.force = std::max(worst.force, (state.w_S - w_user).head<3>().norm());
    worst.torque = std::max(worst.torque, (state.w_S - w_user).tail<3>().norm());
  }
  return worst;
}

TEST(UserWrench, IsFreeOfWeightAndInertiaOfAnAcceleratingRotatingPayload) {
  // only the angular acceleration is late, by its filter: without it nothing remains
  WrenchConfig config = {.payload = handle(), .alpha_low_pass_Hz = 0.0};
  const Worst fine = worst_error(config, {}, 1e-5);
  EXPECT_LT(fine.force, 1e-3);
  EXPECT_LT(fine.torque, 1e-4);

  config.alpha_low_pass_Hz = 60.0;
  const Worst usual = worst_error(config, {});
  EXPECT_LT(usual.force, 0.02);
  EXPECT_LT(usual.torque, 2e-3);
  // what there is to compensate
  config.payload = {};
  EXPECT_GT(worst_error(config, {}).force, 11.0);
}

TEST(UserWrench, NeedsEveryTermOfThePayload) {
  WrenchConfig no_com = {.payload = handle(), .alpha_low_pass_Hz = 60.0};
  no_com.payload.com.setZero();
  EXPECT_GT(worst_error(no_com, {}).force, 0.1);
  WrenchConfig no_inertia = {.payload = handle(), .alpha_low_pass_Hz = 60.0};
  no_inertia.payload.inertia.setZero();
  EXPECT_GT(worst_error(no_inertia, {}).torque, 0.02);
}

TEST(UserWrench, LeavesTheShareOfAWrongMass) {
  WrenchConfig config = {.payload = handle()};
  config.payload.mass *= 1.05;
  const Worst still = worst_error(config, {.amplitude = 0.0});
  EXPECT_NEAR(still.force, 0.05 * 1.18 * 9.81, 1e-6);
  EXPECT_NEAR(still.torque, 0.05 * 1.18 * handle().com.cross(kUp).norm(), 1e-6);
}

TEST(UserWrench, WithoutAccelerometerTakesTheWeightByThePose) {
  WrenchConfig config = {.payload = handle(), .has_imu = false};
  EXPECT_LT(worst_error(config, {.amplitude = 0.0}).force, 1e-6);
  // slow turns: the weight follows the pose, the inertia stays
  const Worst moving = worst_error(config, {.amplitude = 0.5});
  EXPECT_GT(moving.force, 0.5);
  WrenchState state;
  for (const double angle : {0.0, 1.0, 2.5}) {
    SensorFrame sensors;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
    sensors.w_S = payload_wrench(handle(), R.transpose() * kUp, {0, 0, 0}, {0, 0, 0});
    estimate(config, kDt, sensors, R, state);
    EXPECT_LT(state.w_S.norm(), 1e-12) << angle;
  }
}

TEST(UserWrench, IsLateByTheStatedTime) {
  for (const double f : {0.0, 25.0, 50.0}) {
    const WrenchConfig config = {.low_pass_Hz = f};
    WrenchState state;
    SensorFrame sensors;
    for (int k = 0; k < 1000; ++k) {
      sensors.w_S = Vector6::Constant(20.0 * k * kDt);  // rises by 20 per second
      estimate(config, kDt, sensors, Eigen::Matrix3d::Identity(), state);
    }
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR((sensors.w_S[i] - state.w_S[i]) / 20.0, wrench_delay(config, kDt), 1e-12);
    }
  }
  EXPECT_NEAR(wrench_delay({.low_pass_Hz = 50.0}, kDt), 2.71e-3, 1e-5);
  EXPECT_NEAR(wrench_delay({.low_pass_Hz = 50.0}, 0.5e-3), 2.94e-3, 1e-5);
}

TEST(UserWrench, BeginsWithoutTransient) {
  WrenchState state;
  SensorFrame sensors;
  sensors.w_S = Vector6::Constant(7.0);
  sensors.omega_S = {1.0, 2.0, 3.0};
  estimate({.low_pass_Hz = 50.0}, kDt, sensors, Eigen::Matrix3d::Identity(), state);
  EXPECT_EQ(state.w_S, sensors.w_S);
  EXPECT_EQ(state.alpha_S, Eigen::Vector3d::Zero());
}

TEST(UserWrench, TakesOffTheTare) {
  WrenchState state;
  state.tare.offset = (Vector6() << 1, 2, 3, 4, 5, 6).finished();
  SensorFrame sensors;
  sensors.w_S = Vector6::Constant(10.0);
  estimate({}, kDt, sensors, Eigen::Matrix3d::Identity(), state);
  EXPECT_EQ(state.w_S, sensors.w_S - state.tare.offset);
}

TEST(PayloadWrench, IsTheWeightAtRest) {
  const Payload payload = handle();
  const Vector6 w = payload_wrench(payload, kUp, {0, 0, 0}, {0, 0, 0});
  EXPECT_LT((w.head<3>() - Eigen::Vector3d(0, 0, -1.18 * 9.81)).norm(), 1e-12);
  EXPECT_LT((w.tail<3>() - cross_matrix(payload.com) * w.head<3>()).norm(), 1e-12);
}

}  // namespace
}  // namespace hg::estimation
