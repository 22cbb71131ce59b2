// Joints of a twin over time: at their stops, with friction, with locks and latches, braked.
#include <gtest/gtest.h>

#include <cmath>

#include "hg/controller/rendering/test/playing.h"

namespace hg::rendering {
namespace {

TEST(TwinJoint, NothingChattersAtAHeldLimit) {
  Playing door(door_with_closer());
  door.run(4.0, 0, 20.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 1.75, 1e-6);
  door.changes = 0;
  door.run(1.0, 0, 20.0);
  EXPECT_EQ(door.changes, 0);
  EXPECT_LE(door.state.twin.q_a[0], 1.75);
  EXPECT_NEAR(door.result.limits[6].reaction, -(20.0 - 3.0 - 4.0 * 1.75), 1e-3);
}

TEST(TwinJoint, AStopThatOnlyCarriesASpringIsNotFelt) {
  Playing door(door_with_closer());
  door.run(0.1, 0, 0.0);
  EXPECT_EQ(door.result.limits[6].state, LimitState::kLower);
  EXPECT_NEAR(door.result.limits[6].reaction, 3.0, 1e-6);  // of the closer
  EXPECT_EQ(door.result.felt_limit, -1);
  door.run(0.1, 0, -5.0);  // pulled against the stop
  EXPECT_EQ(door.result.felt_limit, 6);
}

TEST(TwinJoint, CoulombFrictionHoldsUpToItsTorqueAndSlipsBeyond) {
  TwinModel twin = door_with_closer();
  for (TwinDof& dof : twin.dofs) dof.stiffness = dof.preload = dof.damping = 0.0;
  twin.dofs[0].friction = 4.0;
  twin.q_start[0] = 0.5;
  Playing door(twin);
  door.run(0.5, 0, 3.9);
  EXPECT_EQ(door.state.twin.q_a[0], 0.5);
  EXPECT_EQ(door.result.limits[6].cause, LimitCause::kFriction);
  door.run(0.2, 0, 5.0);
  const double inertia = door.rendering.twin_chain().M()(0, 0);
  EXPECT_NEAR(door.state.twin.dq_a[0], (5.0 - 4.0) * 0.2 / inertia, 1e-3);
  // let go: it brakes with the friction torque, stops, and stays
  door.run(0.1, 0, 0.0);
  const double stopped = door.state.twin.q_a[0];
  EXPECT_NEAR(door.state.twin.dq_a[0], 0.0, 1e-9);
  door.run(0.5, 0, 0.0);
  EXPECT_NEAR(door.state.twin.q_a[0], stopped, 1e-9);
}

TEST(TwinJoint, ALockHoldsUntilTheHandleIsPressed) {
  TwinModel twin = door_with_closer();
  twin.locks = {door_lock()};
  twin.dofs[1].stiffness = twin.dofs[1].preload = 0.0;  // the handle stays where it is put
  Playing door(twin);
  door.run(0.5, 0, 30.0);
  EXPECT_LT(std::abs(door.state.twin.q_a[0]), 1e-4);
  EXPECT_EQ(door.result.limits[6].cause, LimitCause::kLock);
  EXPECT_NEAR(door.result.limits[6].reaction, -(30.0 - 3.0), 0.1);
  door.state.twin.q_a[1] = 0.6;
  door.run(0.1, 0, 30.0);
  EXPECT_GT(door.state.twin.q_a[0], 0.03);
}

TEST(TwinJoint, ALatchLetsTheDoorCloseButNotOpenAgain) {
  TwinModel twin = door_with_closer();
  twin.locks = {door_lock()};
  twin.q_start[0] = 0.02;
  Playing door(twin);
  door.run(0.2, 0, 10.0);  // pushes open, against the latch
  EXPECT_LE(door.state.twin.q_a[0], 0.02 + 1e-9);
  EXPECT_EQ(door.result.limits[6].cause, LimitCause::kLatch);
  door.run(1.0, 0, 0.0);  // the closer pulls it shut
  EXPECT_NEAR(door.state.twin.q_a[0], 0.0, kLockReached);
  EXPECT_EQ(door.result.limits[6].cause, LimitCause::kLock);
  door.run(0.2, 0, 30.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 0.0, kLockReached);
}

TEST(TwinJoint, ALatchBringsTheJointToRestAtALockInMidRange) {
  TwinModel twin = door_with_closer();
  Lock lock = door_lock();
  lock.position = 0.9;
  lock.engaged_while.erase(lock.engaged_while.begin());
  twin.locks = {lock};
  twin.q_start[0] = 1.5;
  Playing door(twin);
  door.run(0.5, 0, 0.0);
  EXPECT_NE(door.result.limits[6].cause, LimitCause::kLatch);  // falls freely towards the lock
  door.run(3.0, 0, 0.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 0.9, kLockReached);
  EXPECT_EQ(door.result.limits[6].cause, LimitCause::kLock);
}

TEST(TwinJoint, BrakingStopsATwinWithASpring) {
  Playing door(door_with_closer());
  door.state.twin.q_a[0] = 1.0;
  door.state.twin.dq_a[0] = -0.8;
  for (int k = 0; k < 600; ++k) {
    const RobotState robot = robot_with(kGantryAtHome, kPosture, door.wrench_for(0, 20.0));
    door.state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    door.rendering.step({.robot = robot, .braking_rate = 20.0, .force_share = 0.0}, door.state,
                        door.result);
    door.rendering.integrate(door.state);
  }
  EXPECT_LT(std::abs(door.state.twin.dq_a[0]), 1e-3);
}

}  // namespace
}  // namespace hg::rendering
