#include "hg/controller/rendering/lost_directions.h"

#include <gtest/gtest.h>

namespace hg::rendering {
namespace {

constexpr double kDt = 1e-3;
constexpr double kMass = 3.0;

// A free body of 3 kg and 3 kg m^2, and an arm that moves each axis of the handle by one joint:
// along x with `share` of what the others have.
struct Body {
  explicit Body(double share) : J_H(model::Jacobian::Identity(6, 6)) { J_H(0, 0) = share; }
  VectorA torque(const VectorA& dq, const VectorA& tau) const {
    return lost_directions_torque(J_H, 6, J_a, L, dq, tau, kDt);
  }
  model::Jacobian J_H;
  model::Jacobian J_a = model::Jacobian::Identity(6, 6);
  MatrixA L = std::sqrt(kMass) * MatrixA::Identity(6, 6);
};

VectorA along(int axis, double value) { return value * VectorA::Unit(6, axis); }

TEST(LostDirections, FarFromSingularPosturesNothingIsDamped) {
  EXPECT_TRUE(Body(1.0).torque(along(0, 1.0), along(0, 10.0)).isZero(0.0));
  EXPECT_TRUE(Body(0.051).torque(along(0, 1.0), along(0, 10.0)).isZero(0.0));
}

TEST(LostDirections, TheDampingGrowsFromZeroInTheLostDirectionAlone) {
  EXPECT_LT(Body(0.0499).torque(along(0, 1.0), along(0, 0.0))[0], 0.3);
  const double v = 0.002;  // 0.1 rad/s of the joint: half of what is viscous
  const VectorA near = Body(0.02).torque(along(0, v), along(0, 0.0));
  const double b = 0.05 * (1.0 / 0.0004 - 1.0 / 0.0025);
  EXPECT_NEAR(near[0], b * v / (1.0 + kDt * b / kMass), 1e-9);
  EXPECT_NEAR(near.tail(5).norm(), 0.0, 1e-12);
  EXPECT_NEAR(Body(0.02).torque(along(1, 1.0), along(1, 5.0)).norm(), 0.0, 1e-12);
}

// However near the singular posture: what the noise of a sensor pushes moves no joint fast, and the
// handle never turns back.
TEST(LostDirections, ASmallForceMovesNoJointFast) {
  for (const double share : {0.03, 0.01, 1e-3, 1e-5, 0.0}) {
    const Body body(share);
    VectorA dq = along(0, 0.0);
    for (int k = 0; k < 3000; ++k) {
      const VectorA tau = along(0, 0.1);
      dq += kDt / kMass * (tau - body.torque(dq, tau));
      ASSERT_GE(dq[0], 0.0);
    }
    EXPECT_LT(dq[0] / std::max(share, 1e-6), 0.1) << share;
  }
}

// The deceleration of a joint of 2 rad/s that reaches half of the singular value is small.
TEST(LostDirections, AFastJointIsNotBrakedHard) {
  const VectorA torque = Body(0.025).torque(along(0, 0.025 * 2.0), along(0, 0.0));
  EXPECT_GT(torque[0], 0.0);
  EXPECT_LT(torque[0] / kMass / 0.025, 5.0);  // rad/s^2
}

// A door that turns across the lost direction does not notice it.
TEST(LostDirections, ATwinThatDoesNotMoveThereFeelsNothing) {
  Body body(0.0);
  body.J_a = model::Jacobian::Zero(6, 1);
  body.J_a(1, 0) = 1.0;
  const VectorA torque = lost_directions_torque(body.J_H, 6, body.J_a, MatrixA::Identity(1, 1),
                                                VectorA::Ones(1), VectorA::Ones(1), kDt);
  EXPECT_NEAR(torque[0], 0.0, 1e-9);
}

}  // namespace
}  // namespace hg::rendering
