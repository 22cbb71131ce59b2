#include "hg/controller/safety/compliance/compliance.h"

#include <gtest/gtest.h>

#include <random>

#include "hg/core/allocation_counter.h"

namespace hg::compliance {
namespace {

VectorM joints(double a, double b) {
  VectorM v(2);
  v << a, b;
  return v;
}

constexpr double kDt = 1e-3;

VectorM peaks() { return joints(100.0, 50.0); }

// A gantry along x and an arm of two joints in the plane, lengths 1, at 0 and a quarter turn.
Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian() {
  Eigen::Matrix<double, 6, Eigen::Dynamic> J = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, 3);
  J(0, 0) = 1.0;
  J.col(1) << -1.0, 1.0, 0.0, 0.0, 0.0, 1.0;
  J.col(2) << -1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  return J;
}

TouchReport felt(const VectorM& torque, ComplianceState& state,
                 const VectorM& load = joints(0.0, 0.0)) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic> J = jacobian();
  return react_to_contact(peaks(), kDt, {.torque = torque, .load = load, .J = J, .n_p = 1}, state);
}

TEST(Compliance, NoiseIsNoContactWhateverItsSize) {
  for (const double sigma : {0.1, 1.0, 2.0}) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0.0, sigma);
    ComplianceState state;
    double largest = 0.0;
    for (int k = 0; k < 100000; ++k) {
      largest = std::max(largest, felt(joints(normal(random), normal(random)), state).share);
    }
    EXPECT_LT(largest, 1.0) << sigma;
    EXPECT_FALSE(state.is_reported);
  }
}

TEST(Compliance, APushIsReportedWithinMillisecondsAndAtItsJoint) {
  ComplianceState state;
  for (int k = 0; k < 1000; ++k) felt(joints(0.0, 0.0), state);
  int cycles = 0;
  while (!felt(joints(12.0, 0.0), state).is_reported) ASSERT_LT(++cycles, 3);
  TouchReport report;
  for (int k = 0; k < 50; ++k) report = felt(joints(12.0, 4.0), state);
  EXPECT_EQ(report.joint, 1);
  EXPECT_NEAR(report.torque[0], 12.0, 0.01);
}

TEST(Compliance, AThresholdFollowsTheNoiseButNoSlowPush) {
  ComplianceState quiet, noisy;
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 3.0);
  for (int k = 0; k < 5000; ++k) {
    felt(joints(0.0, 0.0), quiet);
    felt(joints(normal(random), 0.0), noisy);
  }
  EXPECT_GT(threshold(peaks(), noisy, 0), 1.5 * threshold(peaks(), quiet, 0));
  // a person who leans harder and harder is detected at twice the least threshold at the latest
  const double least = threshold(peaks(), quiet, 0);
  ComplianceState leaned_on;
  double push = 0.0;
  while (!felt(joints(push, 0.0), leaned_on).is_reported) {
    ASSERT_LT(push, 2.1 * least);
    push += 1e-4;
  }
}

TEST(Compliance, WhatMovesTheJointsRaisesTheThreshold) {
  ComplianceState state;
  for (int k = 0; k < 100; ++k) felt(joints(10.0, 0.0), state, joints(90.0, 0.0));
  EXPECT_FALSE(state.is_reported);
}

TEST(Compliance, TheWrenchDoesTheSameToTheJointsAndTheGantryLeaves) {
  ComplianceState state;
  const VectorM torque = joints(-20.0, -25.0);
  TouchReport report;
  for (int k = 0; k < 100; ++k) report = felt(torque, state);
  ASSERT_TRUE(report.is_reported);
  const VectorM made = jacobian().rightCols(2).transpose() * report.wrench;
  const VectorM beyond =
      torque + joints(threshold(peaks(), state, 0), threshold(peaks(), state, 1));
  EXPECT_LT((made - beyond).norm(), 0.05 * beyond.norm());
  ASSERT_EQ(state.away.size(), 1);
  EXPECT_GT(state.away[0] * report.wrench[0], 0.0);
  EXPECT_LE(std::abs(state.away[0]), kGantrySpeed);
}

TEST(Compliance, TheWrenchIsBounded) {
  ComplianceState state;
  TouchReport report;
  for (int k = 0; k < 100; ++k) report = felt(joints(4000.0, -900.0), state);
  EXPECT_LE(report.wrench.head<3>().norm(), kForceMax * (1.0 + 1e-12));
  EXPECT_LE(report.wrench.tail<3>().norm(), kMomentMax * (1.0 + 1e-12));
}

TEST(Compliance, AContactEnds) {
  ComplianceState state;
  for (int k = 0; k < 10; ++k) felt(joints(50.0, 0.0), state);
  EXPECT_TRUE(state.is_reported);
  for (int k = 0; k < 100; ++k) felt(joints(0.0, 0.0), state);
  EXPECT_FALSE(state.is_reported);
  EXPECT_EQ(state.away.size(), 0);
}

TEST(Compliance, DoesNotAllocate) {
  ComplianceState state;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> J = jacobian();
  const VectorM limits = peaks();
  const AllocationCounter allocations;
  for (int k = 0; k < 100; ++k) {
    react_to_contact(limits, kDt,
                     {.torque = joints(50.0, 1.0), .load = joints(1.0, 1.0), .J = J, .n_p = 1},
                     state);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace hg::compliance
