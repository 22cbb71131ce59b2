#include "hg/model/capability.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace hg::model {
namespace {

constexpr double kRounding = 1e-12;

// Planar arm in the x-y plane, joints at 0 and at the end of the first link.
Jacobian planar_arm(double l1, double l2, double q1, double q2) {
  Jacobian J = Jacobian::Zero(6, 2);
  J(0, 0) = -l1 * std::sin(q1) - l2 * std::sin(q1 + q2);
  J(1, 0) = l1 * std::cos(q1) + l2 * std::cos(q1 + q2);
  J(0, 1) = -l2 * std::sin(q1 + q2);
  J(1, 1) = l2 * std::cos(q1 + q2);
  J(5, 0) = J(5, 1) = 1.0;
  return J;
}

TEST(Capability, ForceOfAPlanarArmIsItsWeakestTorqueByItsLever) {
  // stretched at a right angle: levers sqrt(2) m and 1 m
  const Jacobian J = planar_arm(1.0, 1.0, 0.4, M_PI / 2.0);
  const Guarantee first = worst_direction(J.topRows<3>(), Eigen::Vector2d(20.0, 100.0));
  EXPECT_NEAR(first.value, 20.0 / std::sqrt(2.0), kRounding);
  EXPECT_EQ(first.joint, 0);
  const Guarantee second = worst_direction(J.topRows<3>(), Eigen::Vector2d(20.0, 10.0));
  EXPECT_NEAR(second.value, 10.0, kRounding);
  EXPECT_EQ(second.joint, 1);
  // folded back onto the first joint: its lever is gone
  const Jacobian folded = planar_arm(1.0, 1.0, 0.4, M_PI);
  EXPECT_EQ(worst_direction(folded.topRows<3>(), Eigen::Vector2d(1e-3, 10.0)).joint, 1);
}

TEST(Capability, ForceHoldsInEveryDirectionAndInTheWorstOnlyJust) {
  const Jacobian J = planar_arm(0.7, 0.5, 0.3, 1.1);
  const Eigen::Vector2d available(12.0, 5.0);
  const double force = worst_direction(J.topRows<3>(), available).value;
  double most_used = 0.0;
  for (int i = 0; i < 3600; ++i) {
    const double angle = i * M_PI / 1800.0;
    const Eigen::Vector3d f = force * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::VectorXd tau = J.topRows<3>().transpose() * f;
    most_used = std::max(most_used, (tau.cwiseAbs().array() / available.array()).maxCoeff());
  }
  EXPECT_LE(most_used, 1.0 + kRounding);
  EXPECT_GT(most_used, 1.0 - 1e-5);
}

TEST(Capability, NothingIsLeftWhereGravityTakesMoreThanTheRating) {
  const Jacobian J = planar_arm(1.0, 1.0, 0.0, 1.0);
  EXPECT_EQ(worst_direction(J.topRows<3>(), Eigen::Vector2d(-1.0, 10.0)).value, 0.0);
}

TEST(Capability, JointsWithoutRatingLimitNothing) {
  const Jacobian J = planar_arm(1.0, 1.0, 0.0, 1.0);
  const Guarantee none = worst_direction(J.topRows<3>(), Eigen::Vector2d::Constant(kInfinity));
  EXPECT_EQ(none.value, kInfinity);
  EXPECT_EQ(none.joint, -1);
}

TEST(Capability, DoesNotDependOnTheOrientationOfB) {
  std::srand(5);
  const Jacobian J = Jacobian::Random(6, 7);
  const Eigen::VectorXd rating = Eigen::VectorXd::Random(7).cwiseAbs() * 30.0;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Jacobian turned = J;
  turned.topRows<3>() = R * J.topRows<3>();
  turned.bottomRows<3>() = R * J.bottomRows<3>();
  EXPECT_NEAR(worst_direction(J.topRows<3>(), rating).value,
              worst_direction(turned.topRows<3>(), rating).value, 1e-10);
  EXPECT_NEAR(worst_acceleration(J, rating).value, worst_acceleration(turned, rating).value, 1e-10);
  EXPECT_NEAR(conditioning(J, 0.4).smallest, conditioning(turned, 0.4).smallest, 1e-10);
}

TEST(Capability, AccelerationOfACartesianDeviceIsThatOfItsSlowestAxis) {
  Jacobian J = Jacobian::Identity(6, 6);
  Eigen::VectorXd ddq_max(6);
  ddq_max << 3.0, 2.0, 4.0, 1.0, 1.0, 1.0;
  EXPECT_NEAR(worst_acceleration(J, ddq_max).value, 2.0, kRounding);
  EXPECT_EQ(worst_acceleration(J, ddq_max).joint, 1);
  J.col(4) = J.col(3);  // singular
  EXPECT_EQ(worst_acceleration(J, ddq_max).value, 0.0);
}

TEST(Capability, ConditioningScalesLengths) {
  Jacobian J = Jacobian::Identity(6, 6);
  J.topRows<3>() *= 0.5;
  EXPECT_NEAR(conditioning(J, 0.5).condition, 1.0, kRounding);
  EXPECT_NEAR(conditioning(J, 1.0).condition, 2.0, kRounding);
  EXPECT_NEAR(conditioning(J, 1.0).smallest, 0.5, kRounding);
}

}  // namespace
}  // namespace hg::model
