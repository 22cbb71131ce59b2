#include "hg/controller/rendering/lost_directions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::rendering {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kMass = 3.0;

VectorA along(int axis, double value) { return value * VectorA::Unit(6, axis); }

// A free body of 3 kg and 3 kg m^2, and an arm that moves each axis of the handle by one joint:
// along x with `share` of what the others have.
struct Body {
  explicit Body(double share) : J(model::Jacobian::Identity(6, 6)) { J(0, 0) = share; }
  LostDirections at(const VectorA& dq) const {
    LostDirections lost;
    lost.find(J, J_a, L, dq, kPeriod);
    return lost;
  }
  VectorA torque(const VectorA& dq) const { return at(dq).torque(dq); }
  MatrixA mass(const VectorA& dq) const {
    MatrixA factor = L;
    at(dq).add_to(factor);
    const MatrixA lower = factor.triangularView<Eigen::Lower>();
    return lower * lower.transpose();
  }
  VectorA acceleration(const VectorA& dq, const VectorA& tau) const {
    return mass(dq).ldlt().solve(VectorA(tau - torque(dq)));
  }
  model::Jacobian J;
  model::Jacobian J_a = model::Jacobian::Identity(6, 6);
  MatrixA L = std::sqrt(kMass) * MatrixA::Identity(6, 6);
};

TEST(LostDirections, FarFromSingularPosturesThereAreNone) {
  EXPECT_TRUE(Body(1.0).at(along(0, 1.0)).empty());
  EXPECT_TRUE(Body(0.051).at(along(0, 1.0)).empty());
}

TEST(LostDirections, TheDampingGrowsFromZeroInTheLostDirectionAlone) {
  EXPECT_LT(Body(0.0499).torque(along(0, 1.0))[0], 0.3);
  const double v = 0.002;  // 0.1 rad/s of the joint: half of what is viscous
  const double b = 0.05 * (1.0 / 0.0004 - 1.0 / 0.0025);
  const Body body(0.02);
  EXPECT_NEAR(body.torque(along(0, v))[0], b * v, 1e-9);
  EXPECT_NEAR(body.torque(along(1, 1.0)).norm(), 0.0, 1e-12);
  MatrixA expected = kMass * MatrixA::Identity(6, 6);
  expected(0, 0) += kPeriod * b;
  EXPECT_LT((body.mass(along(0, v)) - expected).norm(), 1e-9);
}

// However near the singular posture: what the noise of a sensor pushes moves no joint fast, and the
// handle never turns back.
TEST(LostDirections, ASmallForceMovesNoJointFast) {
  for (const double share : {0.03, 0.01, 1e-3, 1e-5, 0.0}) {
    const Body body(share);
    VectorA dq = along(0, 0.0);
    for (int k = 0; k < 3000; ++k) {
      dq += kPeriod * body.acceleration(dq, along(0, 0.1));
      ASSERT_GE(dq[0], 0.0);
    }
    EXPECT_LT(dq[0] / std::max(share, 1e-5), 0.1) << share;
  }
}

// The deceleration of a joint of 2 rad/s that reaches half of the singular value is small.
TEST(LostDirections, AFastJointIsNotBrakedHard) {
  const VectorA torque = Body(0.025).torque(along(0, 0.025 * 2.0));
  EXPECT_GT(torque[0], 0.0);
  EXPECT_LT(torque[0] / kMass / 0.025, 5.0);  // rad/s^2
}

// A lock along y takes all that pushes there, and nothing of it moves x, though the lost direction
// is between both.
TEST(LostDirections, WhatALockCarriesMovesNothing) {
  for (const double share : {0.02, 1e-3, 0.0}) {
    Body body(share);
    Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    body.J.topRows<3>() = turn * body.J.topRows<3>();
    const VectorA rest = along(0, 0.0);
    const MatrixA M = body.mass(rest);
    EXPECT_GT(std::abs(M(0, 1)), 0.05) << "oblique";
    // of M ddq = tau - B dq + reaction with ddq_y = 0: x alone is pushed by nothing
    const VectorA tau = along(1, 50.0) - body.torque(rest);
    EXPECT_EQ(tau[0], 0.0);
    EXPECT_EQ(tau[1], 50.0) << "the reaction of the lock";
  }
}

// A door that turns across the lost direction does not notice it.
TEST(LostDirections, ATwinThatDoesNotMoveThereFeelsNothing) {
  Body body(0.0);
  body.J_a = model::Jacobian::Zero(6, 1);
  body.J_a(1, 0) = 1.0;
  body.L = MatrixA::Identity(1, 1);
  EXPECT_NEAR(body.torque(VectorA::Ones(1))[0], 0.0, 1e-9);
  EXPECT_NEAR(body.mass(VectorA::Ones(1))(0, 0), 1.0, 1e-9);
}

}  // namespace
}  // namespace hg::rendering
