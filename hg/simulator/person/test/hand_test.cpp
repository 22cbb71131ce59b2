#include "hg/simulator/person/hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/error.h"

namespace hg::person {
namespace {

using Eigen::Vector3d;

constexpr double kDt = 0.25e-3;  // s, the plant's step
const Vector3d kNoTremor = Vector3d::Zero();

HandImpedance strong() {
  HandImpedance hand;
  hand.force_max = 1e6;
  return hand;
}

// lives `seconds` with handle and goal at rest
void settle(Arm& arm, const HandleMotion& handle, const Goal& goal, double seconds = 5.0) {
  for (double t = 0.0; t < seconds; t += kDt) arm.step(kDt, handle, goal, kNoTremor);
}

TEST(Hand, HasTheValuesOfTheHandbook) {
  const HandImpedance relaxed = hand(HandPreset::kRelaxed), normal = hand(HandPreset::kNormal),
                      stiff = hand(HandPreset::kStiff);
  EXPECT_EQ(relaxed.stiffness, Vector3d(80, 50, 60));
  EXPECT_EQ(relaxed.damping, Vector3d(8, 6, 7));
  EXPECT_EQ(relaxed.mass, Vector3d(1.0, 1.5, 1.5));
  EXPECT_EQ(relaxed.grip_stiffness, 300);
  EXPECT_EQ(relaxed.grip_damping, 5);
  EXPECT_EQ(relaxed.angular_stiffness, Vector3d(0.5, 0.5, 0.5));
  EXPECT_EQ(normal.stiffness, Vector3d(250, 150, 200));
  EXPECT_EQ(normal.damping, Vector3d(20, 15, 18));
  EXPECT_EQ(normal.mass, Vector3d(1.0, 1.5, 1.5));
  EXPECT_EQ(normal.grip_stiffness, 1000);
  EXPECT_EQ(normal.grip_damping, 15);
  EXPECT_EQ(normal.angular_stiffness, Vector3d(1, 1.5, 2));  // yaw, pitch, roll
  EXPECT_EQ(stiff.stiffness, Vector3d(600, 400, 500));
  EXPECT_EQ(stiff.damping, Vector3d(45, 35, 40));
  EXPECT_EQ(stiff.mass.maxCoeff(), 2.5);
  EXPECT_EQ(stiff.grip_stiffness, 3000);
  EXPECT_EQ(stiff.grip_damping, 40);
  EXPECT_EQ(stiff.angular_stiffness, Vector3d(4, 6, 8));
  for (const HandImpedance& h : {relaxed, normal, stiff}) {
    EXPECT_NO_THROW(check_hand_impedance(h));
    EXPECT_GE(h.tremor_rms, 0.02);
    EXPECT_LE(h.tremor_rms, 0.05);
    EXPECT_EQ(h.force_max, 60);
    EXPECT_EQ(h.torque_max, 8);
  }
}

TEST(Arm, AtRestGripAndArmAreSpringsInSeries) {
  const HandImpedance hand = strong();
  Arm arm(hand);
  HandleMotion handle;
  arm.grasp(handle);
  Goal goal;
  goal.pose.p = {0.1, -0.2, 0.3};
  settle(arm, handle, goal);
  for (int axis = 0; axis < 3; ++axis) {
    const double K =
        hand.stiffness[axis] * hand.grip_stiffness / (hand.stiffness[axis] + hand.grip_stiffness);
    EXPECT_NEAR(arm.wrench()[axis], K * goal.pose.p[axis], 1e-6) << axis;
  }
}

TEST(Arm, ItsAxesTurnWithTheHeading) {
  Arm arm(strong());
  arm.grasp({});
  Goal goal;
  goal.heading = 0.5 * M_PI;
  goal.pose.p = {0.0, 0.1, 0.0};  // fore-aft of a person who looks along y
  settle(arm, {}, goal);
  EXPECT_NEAR(arm.wrench()[1], 0.1 * 250.0 * 1000.0 / 1250.0, 1e-6);
  goal.pose.p = {0.1, 0.0, 0.0};
  settle(arm, {}, goal);
  EXPECT_NEAR(arm.wrench()[0], 0.1 * 150.0 * 1000.0 / 1150.0, 1e-6);
}

// M x'' = K (goal - x) - D x' + K_g (x_H - x) + D_g (x_H' - x'),  m x_H'' = -(grip on the hand)
struct TwoMasses {
  double x = 0.0, v = 0.0, x_H = 0.0, v_H = 0.0;
};

double grip_force(const TwoMasses& s, const HandImpedance& hand) {
  return hand.grip_stiffness * (s.x - s.x_H) + hand.grip_damping * (s.v - s.v_H);
}

TwoMasses rate(const TwoMasses& s, const HandImpedance& hand, double goal, double m) {
  const double f = grip_force(s, hand);
  const double arm = hand.stiffness.x() * (goal - s.x) - hand.damping.x() * s.v;
  return {s.v, (arm - f) / hand.mass.x(), s.v_H, f / m};
}

TwoMasses plus(const TwoMasses& s, const TwoMasses& d, double h) {
  return {s.x + h * d.x, s.v + h * d.v, s.x_H + h * d.x_H, s.v_H + h * d.v_H};
}

// one step of the classical Runge-Kutta method
TwoMasses next(const TwoMasses& s, const HandImpedance& hand, double goal, double m, double h) {
  const TwoMasses a = rate(s, hand, goal, m), b = rate(plus(s, a, h / 2), hand, goal, m),
                  c = rate(plus(s, b, h / 2), hand, goal, m),
                  d = rate(plus(s, c, h), hand, goal, m);
  return plus(plus(plus(plus(s, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
}

// the handle is a free body of 6 kg here: hand and handle swing together and against each other
TEST(Arm, AStepOfTheGoalMovesHandAndHandleLikeTwoMasses) {
  constexpr double kBody = 6.0, kGoal = 0.1, kFine = 1e-5;
  for (const HandPreset preset : {HandPreset::kRelaxed, HandPreset::kNormal, HandPreset::kStiff}) {
    HandImpedance hand = person::hand(preset);
    hand.force_max = 1e6;
    Arm arm(hand);
    HandleMotion handle;
    arm.grasp(handle);
    Goal goal;
    goal.pose.p.x() = kGoal;
    TwoMasses truth;
    double largest_force = 0.0, worst_force = 0.0, worst_place = 0.0;
    for (double t = 0.0; t < 1.5; t += kDt) {
      const double a = arm.wrench()[0] / kBody;
      handle.twist[0] += kDt * a;
      handle.T_B_H.p.x() += kDt * handle.twist[0];
      arm.step(kDt, handle, goal, kNoTremor);
      for (int k = 0; k < 25; ++k) truth = next(truth, hand, kGoal, kBody, kFine);
      const double f = grip_force(truth, hand);
      largest_force = std::max(largest_force, std::abs(f));
      worst_force = std::max(worst_force, std::abs(arm.wrench()[0] - f));
      worst_place = std::max(worst_place, std::abs(handle.T_B_H.p.x() - truth.x_H));
    }
    EXPECT_LT(worst_force, 0.03 * largest_force);  // steps of the first order
    EXPECT_LT(worst_place, 0.01 * kGoal);
  }
}

TEST(Arm, LongStepsAreCutIntoThePlants) {
  Arm fine(strong()), coarse(strong());
  HandleMotion handle;
  fine.grasp(handle);
  coarse.grasp(handle);
  handle.twist[1] = 0.3;
  Goal goal;
  goal.twist[0] = 0.5;
  for (int k = 1; k <= 800; ++k) {
    handle.T_B_H.p.y() = 0.3 * k * kDt;
    goal.pose.p.x() = 0.5 * k * kDt;
    fine.step(kDt, handle, goal, kNoTremor);
    if (k % 4 != 0) continue;
    coarse.step(4 * kDt, handle, goal, kNoTremor);
    ASSERT_LT((fine.wrench() - coarse.wrench()).norm(), 1e-9) << k;
  }
  EXPECT_GT(fine.wrench().norm(), 5.0);
}

TEST(Arm, PullsNoHarderThanAPerson) {
  Arm arm{HandImpedance{}};
  arm.grasp({});
  Goal goal;
  goal.pose.p = {-3, 4, 0};
  settle(arm, {}, goal);
  EXPECT_NEAR(arm.wrench().head<3>().norm(), 60.0, 1e-6);
  EXPECT_NEAR(arm.wrench()[1] / arm.wrench()[0], -4.0 * 150.0 / (3.0 * 250.0), 0.01);
}

TEST(Arm, PullsNoHarderAgainstADamper) {
  Arm arm{HandImpedance{}};
  arm.grasp({});
  Goal goal;
  goal.twist[0] = 30.0;  // m/s: 600 N
  double largest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    arm.step(kDt, {}, goal, kNoTremor);
    largest = std::max(largest, arm.wrench()[0]);
  }
  EXPECT_NEAR(arm.wrench()[0], 60.0, 0.1);
  EXPECT_LT(largest, 60.0 * 2.0);  // the mass swings once
}

TEST(Arm, TurnsNoHarderThanAPerson) {
  HandImpedance hand;
  hand.angular_stiffness.setConstant(50);
  Arm arm(hand);
  arm.grasp({});
  Goal goal;
  goal.pose.R = Eigen::AngleAxisd(2.0, Vector3d::UnitX()).toRotationMatrix();
  arm.step(kDt, {}, goal, kNoTremor);
  EXPECT_NEAR(arm.wrench()[3], 8.0, 1e-9);
}

TEST(Arm, TurnsTheHandleBackAboutTheAxisOfTheError) {
  Arm arm{HandImpedance{}};
  HandleMotion handle;
  handle.T_B_H.R = Eigen::AngleAxisd(0.2, Vector3d::UnitZ()).toRotationMatrix();
  arm.grasp(handle);
  arm.step(kDt, handle, {}, kNoTremor);
  EXPECT_NEAR(arm.wrench()[5], -0.4, 1e-9);
  EXPECT_LT(arm.wrench().head<5>().norm(), 1e-9);
  handle.twist[5] = 1.0;
  arm.step(kDt, handle, {}, kNoTremor);
  EXPECT_NEAR(arm.wrench()[5], -0.4 - 0.08, 1e-9);
  Goal loose;
  loose.has_orientation = false;
  arm.step(kDt, handle, loose, kNoTremor);
  EXPECT_NEAR(arm.wrench()[5], -0.08, 1e-9);
}

TEST(Arm, TremorPushesTheHandleAndHoldsAgainstTheHand) {
  Arm arm{HandImpedance{}};
  arm.grasp({});
  arm.step(kDt, {}, {}, {0.0, 0.05, 0.0});
  EXPECT_NEAR(arm.wrench()[1], 0.05, 5e-4);  // the hand has hardly moved yet
  EXPECT_LT(arm.position().y(), 0.0);
}

TEST(Arm, StretchedTooFarItPullsTowardsTheShoulder) {
  HandImpedance hand = strong();
  hand.stiffness.setZero();
  Arm arm(hand);
  HandleMotion handle;
  handle.T_B_H.p.x() = 0.75;
  arm.grasp(handle);
  Goal goal;
  goal.has_shoulder = true;
  settle(arm, handle, goal);
  const double beyond = arm.position().x() - 0.65;
  EXPECT_GT(beyond, 0.0);
  EXPECT_NEAR(arm.wrench()[0], -500.0 * beyond, 1e-6);
  handle.T_B_H.p.x() = 0.6;
  arm.grasp(handle);
  settle(arm, handle, goal);
  EXPECT_NEAR(arm.wrench()[0], 0.0, 1e-6);
}

TEST(Arm, NoMassAndNoStiffnessIsTooExtreme) {
  for (const double mass : {1e-4, 0.5, 50.0}) {
    for (const double stiffness : {0.0, 3000.0, 1e6}) {
      HandImpedance hand = strong();
      hand.mass.setConstant(mass);
      hand.stiffness.setConstant(stiffness);
      hand.grip_stiffness = 1e6;
      hand.damping.setZero();
      hand.grip_damping = 0.0;
      Arm arm(hand);
      arm.grasp({});
      Goal goal;
      goal.pose.p.x() = 0.01;
      double largest = 0.0;
      for (int k = 0; k < 20000; ++k) {
        arm.step(kDt, {}, goal, kNoTremor);
        largest = std::max(largest, std::abs(arm.position().x()));
      }
      EXPECT_LE(largest, 0.02) << mass << " kg, " << stiffness << " N/m";
    }
  }
}

TEST(Arm, LeftAloneForLongItStartsFromThere) {
  Arm left{HandImpedance{}}, known{HandImpedance{}};
  left.grasp({});
  known.grasp({});
  Goal goal;
  goal.pose.p.x() = 0.1;
  left.step(1e6, {}, goal, kNoTremor);
  known.step(0.1, {}, goal, kNoTremor);
  EXPECT_LT((left.wrench() - known.wrench()).norm(), 1e-9);
}

TEST(Hand, RefusesWhatNoHandHas) {
  const auto refuses = [](auto corrupt) {
    HandImpedance hand;
    corrupt(hand);
    EXPECT_THROW(check_hand_impedance(hand), SetupError);
  };
  refuses([](HandImpedance& h) { h.stiffness.x() = -1.0; });
  refuses([](HandImpedance& h) { h.damping.y() = -1.0; });
  refuses([](HandImpedance& h) { h.mass.z() = 0.0; });
  refuses([](HandImpedance& h) { h.grip_stiffness = 0.0; });
  refuses([](HandImpedance& h) { h.grip_damping = -1.0; });
  refuses([](HandImpedance& h) { h.force_max = 0.0; });
  refuses([](HandImpedance& h) { h.tremor_rms = -0.1; });
}

}  // namespace
}  // namespace hg::person
