#include "hg/controller/estimation/estimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hg/core/allocation_counter.h"

namespace hg::estimation {
namespace {

const DeviceModel& device() {
  static const DeviceModel device = [] {
    DeviceModel model{
        .chain = model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf"),
        .n_p = 2,
        .n_m = 6};
    model.handle = model.chain.frame("handle");
    return model;
  }();
  return device;
}
const model::ChainModel& device_chain() { return device().chain; }

SensorFrame sensors_at(const VectorM& q_m) {
  SensorFrame sensors;
  sensors.q_m = q_m;
  sensors.dq_m = VectorM::Zero(6);
  sensors.q_p = VectorP::Zero(2);
  return sensors;
}

VectorM home() {
  VectorM q(6);
  q << 0.0, 1.5, -0.6, 1.3, 0.2, 0.4;
  return q;
}

Estimation make(const EstimationConfig& config = {}) { return {config, device()}; }

TEST(Estimation, CountsTheTurnsOfTheSlipRingJointInBothDirections) {
  Estimation estimation = make();
  EstimationState state;
  for (const double direction : {1.0, -1.0}) {
    double angle = direction > 0 ? 0.0 : 6.0 * std::numbers::pi;
    for (int k = 0; k < 600; ++k) {
      angle += direction * 6.0 * std::numbers::pi / 600;
      VectorM q = home();
      q[0] = std::remainder(angle, 2.0 * std::numbers::pi);  // as an absolute encoder shows it
      const RobotState robot =
          estimation.step(sensors_at(q), VectorP::Zero(2), VectorM::Zero(6), state);
      ASSERT_NEAR(robot.q_m[0], angle, 1e-12);
    }
  }
}

TEST(Estimation, GivesTheWrenchAtTheHandleInBaseCoordinates) {
  DeviceModel turned = device();
  turned.T_H_S.p = {0.0, 0.0, -0.1};
  turned.T_H_S.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Estimation estimation({}, turned);
  model::ChainData chain(device_chain());
  Eigen::VectorXd q(8);
  q << 0, 0, home();
  chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
  const Eigen::Matrix3d R_B_H = chain.pose(chain.model().frame("handle")).R;

  const Eigen::Vector3d f_B(5, -3, 2), n_B(0.3, 0.1, -0.2);
  SensorFrame sensors = sensors_at(home());
  const Eigen::Matrix3d R_S_B = (R_B_H * turned.T_H_S.R).transpose();
  sensors.w_S << R_S_B * f_B, R_S_B * (n_B - (R_B_H * turned.T_H_S.p).cross(f_B));
  EstimationState state;
  const RobotState robot = estimation.step(sensors, VectorP::Zero(2), VectorM::Zero(6), state);
  EXPECT_LT((robot.w_H.head<3>() - f_B).norm(), 1e-12);
  EXPECT_LT((robot.w_H.tail<3>() - n_B).norm(), 1e-12);
}

// a drive that follows its model, or has another lag than the observer's model
double worst_acceleration_error(double true_lag) {
  const double dt = device().dt();
  Estimation estimation = make();
  EstimationState state;
  DriveModel drive = device().drive;
  drive.lag = true_lag;
  CommandDelay delay;
  double q = 0.0, dq = 0.0, ddq = 0.0, worst = 0.0;
  VectorP command = VectorP::Zero(2);
  for (int k = 0; k < 4000; ++k) {
    SensorFrame sensors = sensors_at(home());
    sensors.q_p[0] = q;
    const RobotState robot = estimation.step(sensors, command, VectorM::Zero(6), state);
    if (k > 500) worst = std::max(worst, std::abs(robot.ddq_p[0] - ddq));
    command[0] = 0.5 * std::sin(2.0 * std::numbers::pi * 0.25 * k * dt);
    ddq = drive_acceleration(drive, dq, delay.shift(command[0], 4));
    q += dt * dq + 0.5 * dt * dt * ddq;
    dq += dt * ddq;
  }
  return worst;
}

TEST(Estimation, FollowsTheGantryExactlyWhenTheDriveModelIsRight) {
  EXPECT_LT(worst_acceleration_error(0.040), 0.01);
}

TEST(Estimation, StaysUsefulWhenTheDriveIsTwiceAsSlow) {
  // peak acceleration is 0.8 m/s^2
  EXPECT_LT(worst_acceleration_error(0.080), 0.08);
}

// what the device measures at time t while joint m1 turns on and on and m2 swings
struct Swing {
  double t = 0.0;
  double q(int i) const {
    return i == 0 ? 2.0 * t : home()[i] + (i == 1 ? 0.3 * std::sin(3 * t) : 0);
  }
  double dq(int i) const { return i == 0 ? 2.0 : (i == 1 ? 0.9 * std::cos(3 * t) : 0.0); }
  double ddq(int i) const { return i == 1 ? -2.7 * std::sin(3 * t) : 0.0; }
  SensorFrame sensors() const {
    SensorFrame frame = sensors_at(home());
    frame.theta_m = frame.tau_m = VectorM::Zero(6);
    for (int i = 0; i < 6; ++i) {
      frame.q_m[i] = i == 0 ? std::remainder(q(i), 2.0 * std::numbers::pi) : q(i);
      frame.theta_m[i] = i == 0 ? std::remainder(q(i) + 0.01, 2.0 * std::numbers::pi) : q(i) + 0.01;
      frame.tau_m[i] = 3.0 + i;
    }
    return frame;
  }
};

TEST(Estimation, FollowsBothSidesOfElasticJointsThroughTurns) {
  Estimation estimation = make();
  EstimationState state;
  RobotState robot;
  const double dt = 1e-3;
  for (int k = 0; k < 8000; ++k) {
    Swing now{k * dt};
    VectorM ddq(6);
    // constant over the period: the mean of the true one
    for (int i = 0; i < 6; ++i) ddq[i] = k == 0 ? 0.0 : Swing{(k - 0.5) * dt}.ddq(i);
    robot = estimation.step(now.sensors(), VectorP::Zero(2), ddq, state);
    if (k < 200) continue;
    for (int i = 0; i < 6; ++i) {
      ASSERT_NEAR(robot.q_m[i], now.q(i), 1e-6) << i << " at " << k;
      ASSERT_NEAR(robot.dq_m[i], now.dq(i), 1e-4) << i << " at " << k;
      ASSERT_NEAR(robot.theta_m[i], now.q(i) + 0.01, 1e-9) << i << " at " << k;
      ASSERT_NEAR(robot.dtheta_m[i], now.dq(i), 4e-3) << i << " at " << k;  // delayed by 0.9 ms
      ASSERT_EQ(robot.tau_m[i], 3.0 + i);
    }
  }
  EXPECT_GT(robot.q_m[0], 15.0);  // it has turned more than twice
}

TEST(Estimation, TakesOffTheWeightByThePoseOfATurnedSensor) {
  DeviceModel turned = device();
  turned.T_H_S.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EstimationConfig config;
  config.wrench.payload = {.mass = 1.18, .com = {0.01, 0.02, 0.03}};
  config.wrench.has_imu = false;
  Estimation estimation(config, turned);
  model::ChainData chain(device_chain());
  Eigen::VectorXd q(8);
  q << 0, 0, home();
  chain.update_poses(q);
  const Eigen::Matrix3d R_B_S = chain.pose(chain.model().frame("handle")).R * turned.T_H_S.R;
  SensorFrame sensors = sensors_at(home());
  sensors.w_S =
      payload_wrench(config.wrench.payload, 9.81 * R_B_S.row(2).transpose(), {0, 0, 0}, {0, 0, 0});
  EstimationState state;
  const RobotState robot = estimation.step(sensors, VectorP::Zero(2), VectorM::Zero(6), state);
  EXPECT_LT(robot.w_H.norm(), 1e-12);
}

TEST(Estimation, BeginsAtRestWhereTheJointsAre) {
  Estimation estimation = make();
  EstimationState state;
  const Swing now;
  const RobotState robot =
      estimation.step(now.sensors(), VectorP::Zero(2), VectorM::Zero(6), state);
  EXPECT_LT((robot.q_m - now.sensors().q_m).norm(), 1e-12);
  EXPECT_LT(robot.dq_m.norm(), 1e-12);
  EXPECT_LT((robot.theta_m - now.sensors().theta_m).norm(), 1e-12);
  EXPECT_LT(robot.dtheta_m.norm(), 1e-12);
}

TEST(Estimation, TakesIdealJointsAsMeasured) {
  Estimation estimation = make();
  EstimationState state;
  SensorFrame sensors = sensors_at(home());
  sensors.dq_m = VectorM::LinSpaced(6, -1.0, 1.0);
  for (int k = 0; k < 3; ++k) {
    sensors.q_m[2] += 0.1;
    const RobotState robot =
        estimation.step(sensors, VectorP::Zero(2), VectorM::Constant(6, 100.0), state);
    EXPECT_EQ(robot.q_m, sensors.q_m);
    EXPECT_EQ(robot.dq_m, sensors.dq_m);
    EXPECT_EQ(robot.theta_m.size(), 0);
    EXPECT_EQ(robot.dtheta_m.size(), 0);
  }
}

TEST(Estimation, AllocatesNothing) {
  EstimationConfig config;
  config.wrench.payload.mass = 1.18;
  config.wrench.low_pass_Hz = 50.0;
  Estimation estimation = make(config);
  EstimationState state;
  const SensorFrame sensors = Swing{}.sensors();
  const VectorP dq_p = VectorP::Zero(2);
  const VectorM ddq_m = VectorM::Zero(6);
  AllocationCounter allocations;
  estimation.tare(true, true, state);
  for (int k = 0; k < 600; ++k) estimation.step(sensors, dq_p, ddq_m, state);
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_EQ(state.wrench.tare.status, TareStatus::kDone);
}

TEST(Estimation, TaresOnlyAtRest) {
  EstimationConfig config;
  config.wrench.tare.is_needed = true;
  Estimation estimation = make(config);
  EstimationState held;
  SensorFrame in_hand = sensors_at(home());
  in_hand.dead_man = true;
  estimation.tare(true, true, held);
  estimation.step(in_hand, VectorP::Zero(2), VectorM::Zero(6), held);
  EXPECT_EQ(held.wrench.tare.status, TareStatus::kRefusedHeld);

  EstimationState state;
  EXPECT_FALSE(estimation.is_tared(state));
  estimation.tare(true, false, state);
  EXPECT_EQ(state.wrench.tare.status, TareStatus::kRefusedRunning);
  estimation.tare(true, true, state);
  const SensorFrame sensors = sensors_at(home());
  for (int k = 0; k < 499; ++k) {
    estimation.step(sensors, VectorP::Zero(2), VectorM::Zero(6), state);
    estimation.tare(k == 200, true, state);  // the one under way continues
  }
  EXPECT_EQ(state.wrench.tare.status, TareStatus::kUnderWay);
  EXPECT_FALSE(estimation.is_tared(state));
  estimation.step(sensors, VectorP::Zero(2), VectorM::Zero(6), state);
  EXPECT_EQ(state.wrench.tare.status, TareStatus::kDone);
  EXPECT_TRUE(estimation.is_tared(state));
  // what ran into a tare that was under way would feel the wrench jump
  estimation.tare(true, true, state);
  estimation.tare(false, false, state);
  EXPECT_EQ(state.wrench.tare.status, TareStatus::kRefusedRunning);
  EXPECT_TRUE(estimation.is_tared(state)) << "the old one holds";
}

}  // namespace
}  // namespace hg::estimation
