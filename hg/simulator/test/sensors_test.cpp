#include "hg/simulator/sensors/sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"

namespace hg::simulator {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;
constexpr int kSteps = 4;  // of the plant in a period

SensedDevice device() {
  SensedDevice device;
  device.is_endless = {true};
  device.gear_ratio = VectorM::Constant(6, 121.0);
  device.torque_full_scale = VectorM::Constant(6, 110.0);
  device.T_H_S.p = {0.01, -0.02, -0.0375};
  device.T_H_S.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
  device.payload.mass = 1.18;
  device.payload.com = {0.005, -0.01, 0.04};
  device.payload.inertia << 3e-3, 2e-4, 0, 2e-4, 3.5e-3, 1e-4, 0, 1e-4, 1.2e-3;
  return device;
}

// The handle turns and moves along smooth curves, pulled by a hand.
struct Motion {
  static Eigen::Vector3d p(double t) { return {std::sin(2.0 * t), 0.5 * t * t, std::cos(3.0 * t)}; }
  static Eigen::Matrix3d R(double t) {
    return (Eigen::AngleAxisd(std::sin(4.0 * t), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(3.0 * t, Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(t * t, Eigen::Vector3d::UnitY()))
        .toRotationMatrix();
  }
  static constexpr double kH = 1e-4;  // s, for differences: errors near 1e-7
  static Eigen::Vector3d omega(double t) {
    const Eigen::Matrix3d W = (R(t + kH) - R(t - kH)) / (2.0 * kH) * R(t).transpose();
    return {W(2, 1), W(0, 2), W(1, 0)};
  }

  static Truth truth(double t) {
    Truth truth;
    truth.is_known = true;
    truth.T_B_H = {p(t), R(t)};
    truth.twist << (p(t + kH) - p(t - kH)) / (2.0 * kH), omega(t);
    truth.acceleration << (p(t + kH) - 2.0 * p(t) + p(t - kH)) / (kH * kH),
        (omega(t + kH) - omega(t - kH)) / (2.0 * kH);
    truth.w_H << 10.0, -20.0, 5.0, 1.0, 0.5, -2.0;
    truth.q_m = VectorM::LinSpaced(6, 2.0, 4.5).array() + t;
    truth.dq_m = VectorM::Ones(6);
    truth.theta_m = truth.q_m.array() + 1e-3;
    truth.tau_J = VectorM::LinSpaced(6, -20.0, 30.0);
    truth.q_p = VectorP::Constant(2, 0.3 * t);
    return truth;
  }
};

SensorFrame next(Sensors& sensors, const Truth& truth) {
  SensorFrame frame;
  for (int k = 0; k < kSteps; ++k) sensors.observe(truth);
  sensors.sample(truth, frame);
  return frame;
}

SensorFrame ideal_frame(const Truth& truth) {
  Sensors sensors(ideal_sensors(), device());
  return next(sensors, truth);
}

// 100 frames of the motion, one after the other; the first one has no velocities yet.
std::vector<double> recorded(const SensorsConfig& config) {
  Sensors sensors(config, device());
  std::vector<double> values;
  const auto keep = [&](const auto& vector) {
    values.insert(values.end(), vector.data(), vector.data() + vector.size());
  };
  for (int k = 0; k < 100; ++k) {
    const SensorFrame frame = next(sensors, Motion::truth(0.01 * k));
    keep(frame.dq_m), keep(frame.q_m), keep(frame.theta_m), keep(frame.tau_m), keep(frame.q_p);
    keep(frame.w_S), keep(frame.a_S), keep(frame.omega_S);
  }
  return values;
}

TEST(Sensors, IdealOnesReportWhatIsTrue) {
  Truth truth = Motion::truth(0.4);
  const SensorFrame frame = ideal_frame(truth);
  truth.q_m[0] = 2.4;  // the endless joint, within its turn
  EXPECT_TRUE(frame.q_m == truth.q_m);
  EXPECT_TRUE(frame.dq_m == truth.dq_m);
  EXPECT_TRUE(frame.theta_m == truth.theta_m);
  EXPECT_TRUE(frame.tau_m == truth.tau_J);
  EXPECT_TRUE(frame.q_p == truth.q_p);
  EXPECT_EQ(frame.time_s, 0.0);
}

TEST(Sensors, OnlyEndlessJointsAreWrapped) {
  Truth truth = Motion::truth(0.0);
  truth.q_m << 4.0, 4.0, -4.0, 0.0, 0.0, 0.0;
  truth.theta_m = truth.q_m;
  const SensorFrame frame = ideal_frame(truth);
  EXPECT_NEAR(frame.q_m[0], 4.0 - 2.0 * kPi, 1e-15);
  EXPECT_NEAR(frame.theta_m[0], 4.0 - 2.0 * kPi, 1e-15);
  EXPECT_EQ(frame.q_m[1], 4.0);
  EXPECT_EQ(frame.q_m[2], -4.0);
}

TEST(Sensors, TimeCountsPeriods) {
  Sensors sensors(ideal_sensors(), device());
  for (int k = 0; k < 5; ++k) EXPECT_DOUBLE_EQ(next(sensors, Motion::truth(0.0)).time_s, 1e-3 * k);
}

TEST(Sensors, ADriveReportsTheDifferenceOfItsEncoderAlsoWhereItWraps) {
  SensorsConfig config = ideal_sensors();
  config.link_encoder.resolution = 1e-3;
  config.has_differenced_velocity = true;
  Sensors sensors(config, device());
  Truth truth = Motion::truth(0.0);
  truth.q_m.setConstant(3.0);
  EXPECT_EQ(next(sensors, truth).dq_m[0], 0.0);
  double sum = 0.0;
  for (int k = 1; k <= 500; ++k) {
    truth.q_m.setConstant(3.0 + 0.6e-3 * k);  // 0.6 rad/s, through pi
    const SensorFrame frame = next(sensors, truth);
    EXPECT_NEAR(std::remainder(frame.dq_m[0], 1.0), 0.0, 1e-9);  // LSB over period
    EXPECT_LE(std::abs(frame.dq_m[0]), 1.0 + 1e-9);
    sum += frame.dq_m[0];
  }
  EXPECT_NEAR(sum / 500.0, 0.6, 1e-9);
}

TEST(Sensors, WhatTheTruthDoesNotHaveStaysEmpty) {
  Truth truth = Motion::truth(0.0);
  truth.theta_m.resize(0);
  truth.tau_J.resize(0);
  truth.q_p.resize(0);
  Sensors sensors(SensorsConfig{}, device());
  SensorFrame frame = next(sensors, truth);
  EXPECT_EQ(frame.theta_m.size(), 0);
  EXPECT_EQ(frame.tau_m.size(), 0);
  EXPECT_EQ(frame.q_p.size(), 0);
}

TEST(Sensors, AtRestTheSensorCarriesTheWeightOfThePayload) {
  for (double angle : {0.0, 0.5, 1.6, 3.0, -2.0}) {
    Truth truth = Motion::truth(0.0);
    truth.T_B_H.R =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, angle, 0.3).normalized()).matrix();
    truth.twist.setZero();
    truth.acceleration.setZero();
    truth.w_H.setZero();
    const SensorFrame frame = ideal_frame(truth);
    const Eigen::Vector3d down_S =
        (truth.T_B_H.R * device().T_H_S.R).transpose() * -Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d weight = device().payload.mass * kGravity * down_S;
    EXPECT_LT((frame.w_S.head<3>() - weight).norm(), 1e-12);
    EXPECT_LT((frame.w_S.tail<3>() - device().payload.com.cross(weight)).norm(), 1e-12);
    EXPECT_LT((frame.a_S + kGravity * down_S).norm(), 1e-12);
    EXPECT_LT(frame.omega_S.norm(), 1e-12);
  }
}

TEST(Sensors, ASpinningPayloadPullsOutwards) {
  SensedDevice spun = device();
  spun.T_H_S = {};
  spun.payload = {.mass = 2.0, .com = {0.1, 0.0, 0.0}};
  Truth truth = Motion::truth(0.0);
  truth.T_B_H = {};
  truth.w_H.setZero();
  truth.acceleration.setZero();
  truth.twist << 0, 0, 0, 0, 0, 5.0;
  Sensors sensors(ideal_sensors(), spun);
  const SensorFrame frame = next(sensors, truth);
  EXPECT_NEAR(frame.w_S[0], 2.0 * 25.0 * 0.1, 1e-12);  // m omega^2 r
  EXPECT_NEAR(frame.w_S[2], -2.0 * kGravity, 1e-12);
  EXPECT_LT((frame.omega_S - Eigen::Vector3d(0, 0, 5.0)).norm(), 1e-12);
}

// Newton and Euler with the momentum of the payload by differences, all in B.
TEST(Sensors, TheWrenchChangesTheMomentumOfThePayload) {
  const SensedDevice sensed = device();
  const Payload& payload = sensed.payload;
  const auto com = [&](double t) {
    return Eigen::Vector3d(Motion::p(t) +
                           Motion::R(t) * (sensed.T_H_S.p + sensed.T_H_S.R * payload.com));
  };
  const auto spin = [&](double t) {
    const Eigen::Matrix3d R_B_S = Motion::R(t) * sensed.T_H_S.R;
    return Eigen::Vector3d(R_B_S * payload.inertia * R_B_S.transpose() * Motion::omega(t));
  };
  const double h = Motion::kH;
  for (double t : {0.1, 0.5, 0.9}) {
    const Truth truth = Motion::truth(t);
    const SensorFrame frame = ideal_frame(truth);
    const Eigen::Matrix3d R_B_S = truth.T_B_H.R * sensed.T_H_S.R;
    const Eigen::Vector3d f = R_B_S * frame.w_S.head<3>(), n = R_B_S * frame.w_S.tail<3>();
    const Eigen::Vector3d p_B_S = truth.T_B_H.p + truth.T_B_H.R * sensed.T_H_S.p;
    const Eigen::Vector3d weight(0.0, 0.0, -payload.mass * kGravity);
    const Eigen::Vector3d f_user = truth.w_H.head<3>(), n_user = truth.w_H.tail<3>();

    // what user and weight give, less what goes into the sensor, moves the payload
    const Eigen::Vector3d a_com = (com(t + h) - 2.0 * com(t) + com(t - h)) / (h * h);
    EXPECT_LT((f_user + weight - f - payload.mass * a_com).norm(), 1e-4);
    const Eigen::Vector3d dspin = (spin(t + h) - spin(t - h)) / (2.0 * h);
    EXPECT_LT(
        (n_user + (truth.T_B_H.p - com(t)).cross(f_user) - n - (p_B_S - com(t)).cross(f) - dspin)
            .norm(),
        1e-4);

    const auto p_S = [&](double s) {
      return Eigen::Vector3d(Motion::p(s) + Motion::R(s) * sensed.T_H_S.p);
    };
    const Eigen::Vector3d a_S = (p_S(t + h) - 2.0 * p_S(t) + p_S(t - h)) / (h * h);
    EXPECT_LT((R_B_S * frame.a_S - a_S - Eigen::Vector3d(0, 0, kGravity)).norm(), 1e-4);
    EXPECT_LT((R_B_S * frame.omega_S - truth.twist.tail<3>()).norm(), 1e-12);
  }
}

TEST(Sensors, WrenchAndAccelerationHaveTheirOwnDelays) {
  SensorsConfig config = ideal_sensors();
  config.wrench.filter = {.average = 1e-3, .delay = 1e-3};
  config.imu_filter = {.average = 1e-3, .delay = 2e-3};
  SensedDevice still = device();
  still.payload = {};
  still.T_H_S = {};
  Sensors sensors(config, still);
  Truth truth = Motion::truth(0.0);
  truth.T_B_H = {};
  truth.w_H.setZero();
  truth.twist.setZero();
  truth.acceleration.setZero();
  next(sensors, truth);
  truth.w_H[0] = truth.acceleration[0] = truth.twist[3] = 1.0;
  std::vector<double> wrench, acceleration, turn;
  for (int k = 0; k < 4; ++k) {
    const SensorFrame frame = next(sensors, truth);
    wrench.push_back(frame.w_S[0]);
    acceleration.push_back(frame.a_S[0]);
    turn.push_back(frame.omega_S[0]);
  }
  EXPECT_EQ(wrench, (std::vector<double>{0, 1, 1, 1}));
  EXPECT_EQ(acceleration, (std::vector<double>{0, 0, 1, 1}));
  EXPECT_EQ(turn, acceleration);
}

TEST(Sensors, TheSameSeedGivesTheSameBitsAndAnotherSeedOthers) {
  SensorsConfig config;
  const std::vector<double> once = recorded(config), again = recorded(config);
  EXPECT_EQ(std::memcmp(once.data(), again.data(), once.size() * sizeof(double)), 0);
  config.seed = 2;
  const std::vector<double> other = recorded(config);
  for (std::size_t k = 6; k < once.size() / 100; ++k) EXPECT_NE(once[k], other[k]) << k;
}

TEST(Sensors, SwitchingOneEffectOffLeavesTheOthersAsTheyWere) {
  Sensors all(SensorsConfig{}, device());
  SensorsConfig config;
  config.wrench.force_noise = config.wrench.bias_walk = 0.0;
  config.torque.noise = 0.0;
  config.gyroscope = {};
  Sensors some(config, device());
  for (int k = 0; k < 50; ++k) {
    const SensorFrame a = next(all, Motion::truth(0.0)), b = next(some, Motion::truth(0.0));
    EXPECT_TRUE(a.a_S == b.a_S);
    EXPECT_TRUE(a.q_m == b.q_m);
    EXPECT_FALSE(a.w_S.head<3>() == b.w_S.head<3>());
    EXPECT_FALSE(a.omega_S == b.omega_S);
    EXPECT_FALSE(a.tau_m == b.tau_m);
  }
}

TEST(Sensors, ACopyContinuesIndependently) {
  Sensors sensors(SensorsConfig{}, device());
  for (int k = 0; k < 10; ++k) next(sensors, Motion::truth(0.01 * k));
  Sensors copy = sensors;
  for (int k = 0; k < 10; ++k) {
    const SensorFrame a = next(sensors, Motion::truth(0.2)), b = next(copy, Motion::truth(0.2));
    EXPECT_TRUE(a.w_S == b.w_S && a.a_S == b.a_S && a.omega_S == b.omega_S);
    EXPECT_TRUE(a.tau_m == b.tau_m && a.dq_m == b.dq_m);
    EXPECT_EQ(a.time_s, b.time_s);
  }
}

TEST(Sensors, OfTheHandbookStayWithinItsAccuracies) {
  SensorsConfig config;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    config.seed = seed;
    Sensors sensors(config, device());
    const Truth truth = Motion::truth(0.0);
    const SensorFrame ideal = ideal_frame(truth);
    SensorFrame frame;
    for (int k = 0; k < 20; ++k) frame = next(sensors, truth);
    EXPECT_LT((frame.q_m - ideal.q_m).cwiseAbs().maxCoeff(), 6e-4);
    EXPECT_LT((frame.theta_m - ideal.theta_m).cwiseAbs().maxCoeff(), 6e-4);
    EXPECT_LT((frame.tau_m - ideal.tau_m).cwiseAbs().maxCoeff(), 1.5);
    EXPECT_LT((frame.q_p - ideal.q_p).cwiseAbs().maxCoeff(), 2.6e-4);
    EXPECT_LT((frame.w_S - ideal.w_S).head<3>().norm(), 20.0);
    EXPECT_LT((frame.w_S - ideal.w_S).tail<3>().norm(), 0.5);
    EXPECT_LT((frame.a_S - ideal.a_S).norm(), 1.2);
    EXPECT_LT((frame.omega_S - ideal.omega_S).norm(), 0.15);
  }
}

TEST(Sensors, AllocateNothing) {
  Sensors sensors(SensorsConfig{}, device());
  const Truth truth = Motion::truth(0.0);
  SensorFrame frame;
  const AllocationCounter allocations;
  for (int k = 0; k < 10; ++k) {
    sensors.observe(truth);
    sensors.sample(truth, frame);
  }
  EXPECT_EQ(allocations.count(), 0u);
}

TEST(Sensors, AFilterThatIsTooLongIsRefused) {
  SensorsConfig config;
  config.imu_filter.delay = 1.0;
  EXPECT_THROW(Sensors(config, device()), SetupError);
}

}  // namespace
}  // namespace hg::simulator
