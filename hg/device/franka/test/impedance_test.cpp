#include "hg/device/franka/impedance.h"

#include <gtest/gtest.h>

#include "hg/device/franka/protocol.h"

namespace hg::franka {
namespace {

const VectorM kPosture{{0, 0.028, 0, -2.091, 0, 2.119, 0}};

Impedance impedance() {
  return {model::ChainModel::from_urdf_file("models/arms/fr3/fr3.urdf"), ImpedanceGains()};
}

CommandFrame standing() {
  CommandFrame command;
  command.q_m = kPosture;
  command.dq_m = command.ddq_m = VectorM::Zero(kJoints);
  return command;
}

TEST(Impedance, LeavesGravityToTheRobot) {
  Impedance arm = impedance();
  const VectorM rest = VectorM::Zero(kJoints);
  EXPECT_LT(arm.torques(standing(), kPosture, rest).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(arm.weight(kPosture).cwiseAbs().maxCoeff(), 20.0);
}

TEST(Impedance, PullsTowardsTheReferenceAndFollowsItsSpeed) {
  Impedance arm = impedance();
  CommandFrame command = standing();
  command.q_m[0] += 0.01;
  const VectorM rest = VectorM::Zero(kJoints);
  EXPECT_NEAR(arm.torques(command, kPosture, rest)[0], 6.0, 1e-9);
  command = standing();
  command.dq_m[6] = 0.2;
  EXPECT_NEAR(arm.torques(command, kPosture, rest)[6], 3.0, 1e-9);
}

TEST(Impedance, AcceleratesWithTheMassOfTheArm) {
  Impedance arm = impedance();
  CommandFrame command = standing();
  command.ddq_m[6] = 1.0;
  model::ChainData chain(model::ChainModel::from_urdf_file("models/arms/fr3/fr3.urdf"));
  const VectorM rest = VectorM::Zero(kJoints);
  chain.update(kPosture, rest);
  const VectorM tau = arm.torques(command, kPosture, rest);
  EXPECT_LT((tau - chain.M().col(6)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Impedance, StaysBelowThePeakTorque) {
  Impedance arm = impedance();
  CommandFrame command = standing();
  command.q_m = kPosture.array() + 1.0;
  const VectorM tau = arm.torques(command, kPosture, VectorM::Zero(kJoints));
  EXPECT_EQ(tau[0], 87.0);
  EXPECT_EQ(tau[6], 12.0);
}

TEST(RateLimited, ComesNearerByOneMillisecondOfTheRobotsRate) {
  const VectorM last{{0, 1, -1, 5, 0, 0, 0}}, wanted{{10, 1.5, -9, 5, 0, 0, 0}};
  const VectorM tau = rate_limited(wanted, last);
  EXPECT_NEAR(tau[0], 1.0, 1e-5);
  EXPECT_LT(tau[0], 1.0);
  EXPECT_EQ(tau[1], 1.5);
  EXPECT_NEAR(tau[2], -2.0, 1e-5);
  EXPECT_EQ(tau[3], 5.0);
}

}  // namespace
}  // namespace hg::franka
