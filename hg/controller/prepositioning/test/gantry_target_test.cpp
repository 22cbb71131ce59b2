#include "hg/controller/prepositioning/gantry_target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/model/haptic_giant.h"

namespace hg::prepositioning {
namespace {

using std::numbers::pi;

constexpr double kNoGoal = std::numeric_limits<double>::quiet_NaN();
constexpr model::haptic_giant::Lengths kLengths;
constexpr auto kSolved = model::haptic_giant::InverseStatus::kSolved;
constexpr double kSame = 1e-6;  // m and rad, tolerance of the numeric target

const model::ChainModel& haptic_giant() {
  static const model::ChainModel chain =
      model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf");
  return chain;
}

DeviceModel numeric() {
  DeviceModel device = {
      .chain = haptic_giant(), .n_p = 2, .n_m = 6, .handle = haptic_giant().frame("handle")};
  device.posture = VectorM::Constant(6, kNoGoal);
  device.posture[1] = 0.5 * pi;
  device.posture[2] = -std::atan2(kLengths.L1, kLengths.L2);
  device.gantry_range.resize(2);
  device.joint_limits.resize(6);
  return device;
}

RobotState gantry_at(double x, double y) {
  RobotState robot;
  robot.q_p = Eigen::Vector2d(x, y);
  return robot;
}

VectorP converged(GantryTarget& target, const RobotState& robot, const VectorM& q_m) {
  TargetState state;
  VectorP result;
  for (int k = 0; k < 200; ++k) result = target.step(robot, q_m, state);
  return result;
}

TEST(GantryTarget, EqualsTheClosedForm) {
  constexpr unsigned kSeed = 4;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const auto between = [&](double lb, double ub) {
    return std::uniform_real_distribution<double>(lb, ub)(random);
  };
  GantryTarget target(numeric());
  for (int sample = 0; sample < 100; ++sample) {
    const RobotState robot = gantry_at(between(-1, 1), between(-1, 1));
    Vector6 q_m;
    q_m << between(-10, 10), between(0.2, 2.75), between(-2.6, 2.6), between(0.3, 2.4), 0.0, 0.0;
    q_m[4] = between(0.26, 2.88) - q_m[3];
    q_m[5] = between(-2, 2);
    const Eigen::Vector2d expected = model::haptic_giant::gantry_target(robot.q_p, q_m);
    EXPECT_LT((converged(target, robot, q_m) - expected).norm(), kSame) << q_m.transpose();
  }
}

TEST(GantryTarget, FollowsAMovingHandAndAMovingGantryWithoutAllocation) {
  GantryTarget target(numeric());
  TargetState state;
  Eigen::Vector2d q_p(0.0, 0.0);
  Vector6 q_m;
  Pose T_B_H;
  double worst = 0.0;
  std::uint64_t allocations = 0;
  for (int k = 0; k < 4000; ++k) {
    // 1.2 m/s on a circle of 0.3 m, turning the hand; the gantry comes after it
    const double angle = 4.0 * k * 1e-3;
    T_B_H.p = {0.6 + 0.3 * std::cos(angle), 0.3 * std::sin(angle), -0.8};
    T_B_H.R = model::haptic_giant::hand_orientation(0.8 * std::sin(angle), 1.5, 0.3);
    if (k == 0) {
      ASSERT_EQ(model::haptic_giant::inverse_at_target(T_B_H, q_p, q_m), kSolved);
    }
    ASSERT_EQ(model::haptic_giant::inverse(T_B_H, q_p, {}, q_m), kSolved);
    const VectorM q_m_now = q_m;
    const RobotState robot = gantry_at(q_p.x(), q_p.y());
    const AllocationCounter counter;
    const VectorP q_target = target.step(robot, q_m_now, state);
    allocations += counter.count();
    const Eigen::Vector2d expected = model::haptic_giant::gantry_target(q_p, q_m);
    if (k > 500) worst = std::max(worst, (q_target - expected).norm());
    q_p += 4e-3 * (q_target - q_p);
  }
  EXPECT_LT(worst, 1e-3);  // m
  EXPECT_EQ(allocations, 0u);
}

TEST(GantryTarget, StaysSaneWhereTheArmIsStretchedOrFolded) {
  GantryTarget target(numeric());
  for (const double q2 : {1e-9, 1e-3, pi - 1e-3}) {
    for (const double s : {1e-9, 1e-3, pi - 1e-9}) {
      Vector6 q_m;
      q_m << 0.4, q2, -0.5, 1.2, s - 1.2, 0.1;
      TargetState state;
      const RobotState robot = gantry_at(0.2, -0.1);
      VectorP last = robot.q_p;
      for (int k = 0; k < 500; ++k) {
        const VectorP now = target.step(robot, q_m, state);
        ASSERT_TRUE(now.allFinite());
        ASSERT_LT((now - last).lpNorm<Eigen::Infinity>(), 0.11) << k;  // two steps of 0.05
        last = now;
      }
      EXPECT_LT((last - robot.q_p).norm(), 2.0);  // the arm is 1.2 m long
    }
  }
}

TEST(GantryTarget, KeepsTheRangesOfAllJoints) {
  DeviceModel device = numeric();
  device.gantry_range = {{-0.1, 0.1}, {-0.2, 0.2}};
  device.joint_limits[2] = {.q_min = -0.3, .q_max = 0.3};  // m3 cannot have its goal, -0.67
  GantryTarget target(device);
  Vector6 q_m;
  q_m << 0.4, 0.9, 0.1, 1.2, 0.2, 0.1;
  const RobotState robot = gantry_at(0.05, -0.1);
  model::ChainData chain(haptic_giant());
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(8);
  Eigen::VectorXd q(8);
  q << robot.q_p, q_m;
  chain.update_kinematics(q, at_rest);
  const Pose T_B_H = chain.pose(device.handle);
  TargetState state;
  for (int k = 0; k < 300; ++k) {
    target.step(robot, q_m, state);
    q = state.q;
    chain.update_kinematics(q, at_rest);
    ASSERT_LT((chain.pose(device.handle).p - T_B_H.p).norm(), 5e-3) << k;
    for (int i = 0; i < 8; ++i) {
      const Interval range =
          i < 2 ? device.gantry_range[i]
                : Interval{device.joint_limits[i - 2].q_min, device.joint_limits[i - 2].q_max};
      ASSERT_GE(state.q[i], range.lb - 1e-12) << k << " " << i;
      ASSERT_LE(state.q[i], range.ub + 1e-12) << k << " " << i;
    }
  }
  q = state.q;
  chain.update_kinematics(q, at_rest);
  EXPECT_LT((chain.pose(device.handle).p - T_B_H.p).norm(), 1e-4);
  EXPECT_LT(std::abs(q[3] - device.posture[1]),
            std::abs(q_m[1] - device.posture[1]) - 0.02);  // m2 gains
}

// A hand that jumps leaves the posture behind: a new one begins at the device's own.
TEST(GantryTarget, FindsAHandAgainThatHasJumped) {
  GantryTarget target(numeric());
  Vector6 q_m;
  q_m << 0.4, 0.9, 0.1, 1.2, 0.2, 0.1;
  TargetState state;
  for (int k = 0; k < 50; ++k) target.step(gantry_at(0.0, 0.0), q_m, state);
  q_m[0] += 3.0;
  const RobotState robot = gantry_at(0.5, 0.4);
  VectorP last;
  for (int k = 0; k < 200; ++k) last = target.step(robot, q_m, state);
  EXPECT_LT((last - model::haptic_giant::gantry_target(robot.q_p, q_m)).norm(), kSame);
}

TEST(GantryTarget, WithoutAGantryThereIsNone) {
  const model::ChainModel chain = model::ChainModel::from_urdf_text(
      R"(<robot name="arm"><link name="base"/>
      <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="2"/></joint>
      <link name="tip"><inertial><mass value="1"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)",
      "arm.urdf");
  GantryTarget target({.chain = chain, .n_p = 0, .n_m = 1, .handle = 1, .joint_limits = {{}}});
  TargetState state;
  RobotState robot;
  robot.q_p = VectorP(0);
  EXPECT_EQ(target.step(robot, VectorM::Zero(1), state).size(), 0);
}

TEST(GantryTarget, RefusesTheClosedFormForOtherDevices) {
  DeviceModel device = numeric();
  device.has_closed_form = true;
  device.n_p = 1;
  device.n_m = 7;
  EXPECT_THROW(GantryTarget{device}, SetupError);
}

}  // namespace
}  // namespace hg::prepositioning
