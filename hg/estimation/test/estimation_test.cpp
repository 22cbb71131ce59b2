#include "hg/estimation/estimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hg::estimation {
namespace {

const model::Chain& device_chain() {
  static const model::Chain chain =
      model::Chain::from_urdf_file("models/haptic_giant/haptic_giant.urdf");
  return chain;
}

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

Estimation make(const Config& config = {}) {
  return Estimation(config, device_chain(), 2, 6, device_chain().frame("handle"));
}

TEST(Estimation, CountsTheTurnsOfTheSlipRingJointInBothDirections) {
  Estimation estimation = make();
  State state;
  for (const double direction : {1.0, -1.0}) {
    double angle = direction > 0 ? 0.0 : 6.0 * std::numbers::pi;
    for (int k = 0; k < 600; ++k) {
      angle += direction * 6.0 * std::numbers::pi / 600;
      VectorM q = home();
      q[0] = std::remainder(angle, 2.0 * std::numbers::pi);  // as an absolute encoder shows it
      const RobotState robot = estimation.step(sensors_at(q), VectorP::Zero(2), state);
      ASSERT_NEAR(robot.q_m[0], angle, 1e-12);
    }
  }
}

TEST(Estimation, GivesTheWrenchAtTheHandleInBaseCoordinates) {
  Config config;
  config.T_H_S.p = {0.0, 0.0, -0.1};
  config.T_H_S.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Estimation estimation = make(config);
  model::Chain chain = device_chain();
  Eigen::VectorXd q(8);
  q << 0, 0, home();
  chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
  const Eigen::Matrix3d R_B_H = chain.pose(chain.frame("handle")).R;

  const Eigen::Vector3d f_B(5, -3, 2), n_B(0.3, 0.1, -0.2);
  SensorFrame sensors = sensors_at(home());
  const Eigen::Matrix3d R_S_B = (R_B_H * config.T_H_S.R).transpose();
  sensors.w_S << R_S_B * f_B, R_S_B * (n_B - (R_B_H * config.T_H_S.p).cross(f_B));
  State state;
  const RobotState robot = estimation.step(sensors, VectorP::Zero(2), state);
  EXPECT_LT((robot.w_H.head<3>() - f_B).norm(), 1e-12);
  EXPECT_LT((robot.w_H.tail<3>() - n_B).norm(), 1e-12);
}

// a drive that follows its model, or has another lag than the observer believes
double worst_acceleration_error(double true_lag) {
  const Config config;
  Estimation estimation = make(config);
  State state;
  DriveModel drive = config.drive;
  drive.lag = true_lag;
  CommandDelay delay;
  double q = 0.0, dq = 0.0, ddq = 0.0, worst = 0.0;
  VectorP command = VectorP::Zero(2);
  for (int k = 0; k < 4000; ++k) {
    SensorFrame sensors = sensors_at(home());
    sensors.q_p[0] = q;
    const RobotState robot = estimation.step(sensors, command, state);
    if (k > 500) worst = std::max(worst, std::abs(robot.ddq_p[0] - ddq));
    command[0] = 0.5 * std::sin(2.0 * std::numbers::pi * 0.25 * k * config.dt);
    ddq = drive_acceleration(drive, dq, delay.shift(command[0], 4));
    q += config.dt * dq + 0.5 * config.dt * config.dt * ddq;
    dq += config.dt * ddq;
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

}  // namespace
}  // namespace hg::estimation
