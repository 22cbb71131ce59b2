#include "hg/device/franka/velocity.h"

#include <gtest/gtest.h>

#include "hg/device/franka/protocol.h"

namespace hg::franka {
namespace {

const VectorM kPosture{{0, 0.028, 0, -2.091, 0, 2.119, 0}};
const VectorM kRest = VectorM::Zero(kJoints);

// A robot that integrates its commands, and the largest values on its way.
struct Way {
  VectorM q = kPosture, speed = kRest, acceleration = kRest;
  double most_acceleration = 0.0, most_jerk = 0.0;

  void step(const VectorM& wanted) {
    const VectorM next = limited_speeds(wanted, q, speed, acceleration);
    const VectorM next_acceleration = (next - speed) / kPeriod_s;
    const VectorM jerk = (next_acceleration - acceleration) / kPeriod_s;
    most_acceleration = std::max(most_acceleration, next_acceleration.cwiseAbs().maxCoeff());
    most_jerk = std::max(most_jerk, jerk.cwiseAbs().maxCoeff());
    speed = next;
    acceleration = next_acceleration;
    q += kPeriod_s * speed;
  }
};

TEST(Velocity, FollowsTheReferenceAndDrawsNearToIt) {
  CommandFrame command;
  command.q_m = kPosture;
  command.dq_m = VectorM::Constant(kJoints, 0.3);
  EXPECT_TRUE(led_speeds(command, kPosture).isApprox(command.dq_m));
  const VectorM behind = kPosture - VectorM::Constant(kJoints, 0.01);
  EXPECT_GT(led_speeds(command, behind).minCoeff(), 0.3);
}

TEST(Velocity, WhatTheRobotAllowsIsNotChanged) {
  const VectorM last = VectorM::Constant(kJoints, 0.2);
  const VectorM wanted = last + VectorM::Constant(kJoints, 1e-3);
  EXPECT_TRUE(limited_speeds(wanted, kPosture, last, kRest).isApprox(wanted));
}

TEST(Velocity, StepsAreLimitedInAccelerationAndJerk) {
  Way way;
  for (int i = 0; i < 100; ++i) way.step(VectorM::Constant(kJoints, 1.0));
  EXPECT_GT(way.speed[0], 0.9);
  for (int i = 0; i < 150; ++i) way.step(VectorM::Constant(kJoints, -1.0));
  for (int i = 0; i < 300; ++i) way.step(kRest);
  EXPECT_NEAR(way.speed.norm(), 0.0, 1e-6);
  EXPECT_GT(way.most_acceleration, 9.5);
  EXPECT_LE(way.most_acceleration, 10.0);
  EXPECT_GT(way.most_jerk, 4500.0);
  EXPECT_LE(way.most_jerk, 5000.0 * (1 + 1e-9));
}

TEST(Velocity, SpeedFallsTowardsTheEndOfAJoint) {
  Way way;
  const VectorM wanted{{10, 10, 10, 10, 0, 10, 0}};
  for (int i = 0; i < 5000; ++i) way.step(wanted);
  const VectorM q_max{{2.7501, 1.7918, 2.9065, -0.1458, 2.8101, 4.5205, 3.0196}};
  EXPECT_LT((way.q - q_max).maxCoeff(), 0.0);
  EXPECT_LT(way.speed.cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace hg::franka
