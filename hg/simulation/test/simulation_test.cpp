#include "hg/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hg::simulation {
namespace {

const model::Chain& device_chain() {
  static const model::Chain chain =
      model::Chain::from_urdf_file("models/haptic_giant/haptic_giant.urdf");
  return chain;
}

Config config() {
  Config simulation;
  simulation.q_m_start.resize(6);
  simulation.q_m_start << 0.0, 1.5, -0.6, 1.3, 0.2, 0.4;
  simulation.q_p_start = VectorP::Zero(2);
  return simulation;
}

Simulation make(const Config& simulation) {
  const model::Chain body = model::Chain::free_body({}, {.gravity = false});
  user::Config nobody;
  nobody.kind = user::PersonKind::kNone;
  return Simulation(simulation, device_chain(), device_chain().frame("handle"),
                    user::Person(nobody, body, body.frame("handle"), {}));
}

CommandFrame hold(const Config& simulation) {
  CommandFrame command;
  command.enable = true;
  command.q_m = simulation.q_m_start;
  command.dq_m = command.ddq_m = VectorM::Zero(6);
  command.dq_p = VectorP::Zero(2);
  return command;
}

TEST(Simulation, TheGantryWaitsForItsDeadTimeThenFollowsWithItsLag) {
  Config simulation = config();
  simulation.drive.ddq_max = 1e9;  // lag only
  Simulation device = make(simulation);
  CommandFrame command = hold(simulation);
  command.dq_p[0] = 1.0;
  for (int k = 0; k < 4; ++k) device.step(command);
  EXPECT_EQ(device.sensors().q_p[0], 0.0);
  double before = 0.0;
  for (int k = 0; k < 40; ++k) {
    before = device.sensors().q_p[0];
    device.step(command);
  }
  const double speed = (device.sensors().q_p[0] - before) / simulation.dt;
  EXPECT_NEAR(speed, 1.0 - std::exp(-1.0), 0.02);  // one time constant later
}

TEST(Simulation, TheGantryKeepsItsAccelerationAndSpeedRating) {
  const Config simulation = config();
  Simulation device = make(simulation);
  CommandFrame command = hold(simulation);
  command.dq_p[1] = 9.0;
  double q = 0.0, dq = 0.0;
  for (int k = 0; k < 2000; ++k) {
    device.step(command);
    const double speed = (device.sensors().q_p[1] - q) / simulation.dt;
    ASSERT_LE(speed - dq, simulation.drive.ddq_max * simulation.dt + 1e-9);
    q = device.sensors().q_p[1];
    dq = speed;
  }
  EXPECT_NEAR(dq, simulation.drive.dq_max, 1e-6);
}

TEST(Simulation, TheSlipRingJointShowsItsAngleWithinOneTurn) {
  const Config simulation = config();
  Simulation device = make(simulation);
  CommandFrame command = hold(simulation);
  command.q_m[0] = 7.0;
  command.q_m[2] = -2.5;
  device.step(command);
  EXPECT_NEAR(device.sensors().q_m[0], 7.0 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(device.sensors().q_m[2], -2.5);
  EXPECT_EQ(device.sensors().sequence, 1u);
  EXPECT_DOUBLE_EQ(device.sensors().time_s, 1e-3);
}

TEST(Simulation, WithoutPowerTheJointsStayAndTheGantryBrakes) {
  const Config simulation = config();
  Simulation device = make(simulation);
  CommandFrame command = hold(simulation);
  command.dq_p[0] = 1.0;
  for (int k = 0; k < 500; ++k) device.step(command);
  command.enable = false;
  command.q_m.setConstant(1.0);
  for (int k = 0; k < 1000; ++k) device.step(command);
  const double at_rest = device.sensors().q_p[0];
  device.step(command);
  EXPECT_NEAR(device.sensors().q_p[0], at_rest, 1e-9);
  EXPECT_EQ(device.sensors().q_m[1], simulation.q_m_start[1]);
  EXPECT_TRUE(device.sensors().dq_m.isZero());
}

TEST(Simulation, TheSensorShowsTheHandsWrenchInItsOwnFrame) {
  Config simulation = config();
  simulation.T_H_S.p = {0.0, 0.0, -0.1};
  const model::Chain body = model::Chain::free_body({}, {.gravity = false});
  user::Config mouse;
  mouse.kind = user::PersonKind::kMouse;
  mouse.hand.tremor_rms = 0.0;
  const int handle = device_chain().frame("handle");
  Simulation device(simulation, device_chain(), handle,
                    user::Person(mouse, body, body.frame("handle"), {}));
  model::Chain chain = device_chain();
  Eigen::VectorXd q(8);
  q << simulation.q_p_start, simulation.q_m_start;
  chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
  const Pose T_B_H = chain.pose(handle);

  CommandFrame command = hold(simulation);
  command.hand_target.active = true;
  command.hand_target.p_B = T_B_H.p + Eigen::Vector3d(0.1, 0.0, 0.0);
  device.step(command);
  EXPECT_FALSE(device.sensors().dead_man);  // nobody yet
  EXPECT_EQ(device.sensors().w_S.norm(), 0.0);
  for (int k = 0; k < 8000; ++k) device.step(command);
  EXPECT_TRUE(device.sensors().dead_man);
  const Eigen::Vector3d f_B(0.1 * 200.0, 0.0, 0.0);  // 250 N/m of the arm, 1000 of the grip
  EXPECT_LT((device.sensors().w_S.head<3>() - T_B_H.R.transpose() * f_B).norm(), 1e-9);
  const Eigen::Vector3d n_S = -simulation.T_H_S.p.cross(T_B_H.R.transpose() * f_B);
  EXPECT_LT((device.sensors().w_S.tail<3>() - n_S).norm(), 1e-9);
}

}  // namespace
}  // namespace hg::simulation
