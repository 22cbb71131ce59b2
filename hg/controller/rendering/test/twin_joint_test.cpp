// Joints of a twin over time: at their stops, with friction, with locks and latches, braked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hg/controller/rendering/test/playing.h"
#include "hg/model/cam.h"
#include "hg/model/chain_data.h"

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

// A hinge with a tooth every 0.1 rad, the first one at 0.02 rad.
TwinModel door_with_ratchet(Way free) {
  TwinModel twin = door();
  twin.dofs[0].limits = {-1.75, 1.75, 2.0, 20.0};
  twin.locks = {{.name = "pawl", .dof = 0, .position = 0.02, .teeth = 0.1, .free = free}};
  twin.locks[0].engaged_while = {{.dof = 1, .range = {-kInfinity, 0.5}}};
  return twin;
}

TEST(TwinJoint, ARatchetIsFreeOneWayAndHoldsAtTheLastToothTheOtherWay) {
  for (const Way free : {Way::kUpper, Way::kLower}) {
    const double side = free == Way::kUpper ? 1.0 : -1.0;
    Playing door(door_with_ratchet(free));
    double most = 0.0;  // reaction on the free way, Nm
    for (int k = 0; k < 1300; ++k) {
      door.run(kDt, 0, 1.0 * side);
      most = std::max(most, std::abs(door.limit(0).reaction));
    }
    EXPECT_EQ(most, 0.0);
    const double turned = door.q(0);
    ASSERT_GT(side * turned, 0.15);  // past some teeth
    const double teeth = (turned - 0.02) / 0.1;
    const double tooth = 0.02 + 0.1 * (side > 0.0 ? std::floor(teeth) : std::ceil(teeth));

    double furthest = 0.0;  // behind the tooth, rad
    for (int k = 0; k < 3000; ++k) {
      door.run(kDt, 0, -15.0 * side);
      furthest = std::max(furthest, side * (tooth - door.q(0)));
    }
    EXPECT_LT(furthest, 1e-6);
    EXPECT_NEAR(door.q(0), tooth, 1e-4);
    EXPECT_EQ(door.limit(0).cause, LimitCause::kLatch);
    EXPECT_NEAR(door.limit(0).reaction, 15.0 * side, 0.1);
    door.changes = 0;
    door.run(0.5, 0, -15.0 * side);
    EXPECT_EQ(door.changes, 0);
  }
}

TEST(TwinJoint, ARatchetHoldsWithTheLawAndTheBoundsOfThePaper) {
  TwinModel twin = door_with_ratchet(Way::kUpper);
  twin.q_start[0] = 0.35;
  RenderingOptions options = without_synchronisation();
  options.law = Law::kPaper;
  options.bounds = Bounds::kPaper;
  Playing door(twin, options);
  door.run(2.0, 0, -5.0);
  EXPECT_NEAR(door.q(0), 0.32, 2e-3);
}

TEST(TwinJoint, ARatchetLetsGoWhileItsPawlIsLifted) {
  TwinModel twin = door_with_ratchet(Way::kUpper);
  twin.q_start[0] = 0.35;
  Playing door(twin);
  door.run(1.0, 0, -5.0);
  EXPECT_NEAR(door.q(0), 0.32, 1e-4);
  door.state.twin.q_a[1] = 0.6;
  door.run(0.5, 0, -5.0);
  EXPECT_LT(door.q(0), 0.2);
  door.state.twin.q_a[1] = 0.0;
  door.state.twin.dq_a[1] = 0.0;
  const double engaged = door.q(0);
  door.run(1.0, 0, -5.0);
  EXPECT_GT(door.q(0), engaged - 0.1 - 0.2);  // caught after braking from its speed
  EXPECT_EQ(door.limit(0).cause, LimitCause::kLatch);
}

TEST(TwinJoint, WithinItsPlayTheHandMovesItsOwnSideOnly) {
  const model::ChainModel chain =
      model::ChainModel::from_urdf_file("models/examples/loose_gate.urdf", {.gravity = false});
  TwinModel twin = unlimited_twin(chain, "handle");
  twin.dofs[1].limits = {-0.03, 0.03, kInfinity, 50.0};
  Playing gate(twin);
  constexpr double kBar = 0.05 + 2.0 * 0.4 * 0.4, kPanel = 0.25 + 8.0 * 0.25 * 0.25;
  Vector6 turn = Vector6::Zero();
  turn[5] = 1.0;  // Nm about the hinge
  for (int k = 0; k < 50; ++k) gate.step(turn);
  EXPECT_NEAR(gate.dq(1), 0.05 / kBar, 1e-3);
  EXPECT_NEAR(gate.q(0), 0.0, 1e-6);
  for (int k = 0; k < 950; ++k) gate.step(turn);
  EXPECT_NEAR(gate.q(1), 0.03, 1e-4);
  EXPECT_NEAR(gate.result.ddq_a[0], 1.0 / (kBar + kPanel), 1e-3);
}

TEST(TwinJoint, AGearIsFeltByItsInertiaAndKeepsItsRatio) {
  const model::ChainModel chain = model::ChainModel::from_urdf_file(
      "models/examples/flywheel.urdf", {.gravity = false,
                                        .couplings = {{"wheel_joint", "lever_joint", -3.0, 0.5}},
                                        .tip_link = "handle"});
  constexpr double kInertia = 0.06 + 3.0 * 0.25 * 0.25 + 3.0 * 3.0 * 0.02;  // J1 + n^2 J2
  for (const Law law : {Law::kGauss, Law::kPaper}) {
    RenderingOptions options = without_synchronisation();
    options.law = law;
    Playing gear(unlimited_twin(chain, "handle"), options);
    gear.run(0.5, 0, 2.0);
    EXPECT_NEAR(gear.dq(0), 2.0 * 0.5 / kInertia, 1e-9);
    gear.run(10.0, 0, 0.0);
    EXPECT_NEAR(gear.dq(0), 2.0 * 0.5 / kInertia, 1e-9);
    const model::ChainData& now = gear.rendering.twin_chain();
    const auto angle = [&](const char* link) {
      const Eigen::Matrix3d& R = now.pose(chain.frame(link)).R;
      return std::atan2(R(1, 0), R(0, 0));
    };
    const double expected = 0.5 - 3.0 * angle("lever");
    EXPECT_NEAR(std::remainder(angle("wheel") - expected, 2.0 * M_PI), 0.0, 1e-9);
  }
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

// a crank that moves a ram by a cam, and a knob on it that turns freely
TwinModel cam_press() {
  const model::Cam cam =
      model::make_cam({{0.0, 0.0}, {1.0, 0.02}, {2.0, 0.05}, {3.2, 0.05}, {4.5, 0.01}}, 2.0 * M_PI);
  model::ChainOptions options = {.gravity = false, .tip_link = "handle"};
  options.couplings = {{"ram_guide", "crank", 1.0, 0.0, cam.curve}};
  return unlimited_twin(
      model::ChainModel::from_urdf_file("models/twins/cam_press/cam_press.urdf", options),
      "handle");
}

TEST(TwinJoint, ACrankOnACamThatNothingBrakesKeepsItsEnergyForTenSeconds) {
  Playing press(cam_press());
  press.state.twin.dq_a << 2.0, -2.0;
  const auto energy = [&] {
    model::ChainData chain(press.rendering.twin().chain);
    chain.update(press.state.twin.q_a, press.state.twin.dq_a);
    return 0.5 * press.state.twin.dq_a.dot(chain.M() * press.state.twin.dq_a);
  };
  const double first = energy();
  double least = first, most = first, slowest = 2.0;
  for (int i = 0; i < 10'000; ++i) {
    press.step(Vector6::Zero());
    least = std::min(least, energy());
    most = std::max(most, energy());
    slowest = std::min(slowest, press.dq(0));
  }
  EXPECT_GT(press.q(0), 3.0 * M_PI);
  EXPECT_LT(slowest, 1.9);  // the ram takes its share
  EXPECT_LT(most - least, 0.005 * first);
}

}  // namespace
}  // namespace hg::rendering
