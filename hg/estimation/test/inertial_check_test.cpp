// An inertial unit against encoders: what turns, what drifts, and where gravity is.

#include "hg/estimation/inertial_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
const Eigen::Vector3d kGyroscopeZero(0.01, -0.02, 0.005);

// A unit that is turned about a horizontal axis of B.
struct Bench {
  InertialCheck check;
  double angle = 0.3;    // rad, true
  double encoder = 0.3;  // rad, as the encoders say

  void step(double speed, double drift, bool is_moving) {
    angle += kDt * speed;
    encoder += kDt * (speed + drift);
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    const Eigen::Matrix3d R_true = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    advance(kDt, Eigen::AngleAxisd(encoder, axis).toRotationMatrix(), speed * axis + kGyroscopeZero,
            R_true.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81), is_moving, check);
  }
  void run(double seconds, double speed, double drift, bool is_moving) {
    for (int k = 0; k < seconds / kDt; ++k) step(speed, drift, is_moving);
  }
};

TEST(InertialCheck, LearnsTheZeroOfTheGyroscopeAtRestAndThenAgreesWithTheEncoders) {
  Bench bench;
  bench.run(0.2, 0.0, 0.0, false);
  EXPECT_LT((bench.check.bias - kGyroscopeZero).norm(), 1e-4);
  bench.run(2.0, 1.5, 0.0, true);
  EXPECT_LT(bench.check.turn.norm(), 2e-3);
  EXPECT_NEAR(bench.check.turned, 2.36, 0.1);  // 3 rad, of which some is forgotten
}

TEST(InertialCheck, ADriftThatAllEncodersShareAddsUp) {
  Bench bench;
  bench.run(4.0, 0.0, 0.0, false);
  bench.run(1.0, 0.0, 0.05, true);
  EXPECT_NEAR(bench.check.turn.norm(), 0.044, 2e-3);
}

TEST(InertialCheck, ADriftAtRestIsNoZeroOfTheGyroscope) {
  Bench bench;
  bench.run(4.0, 0.0, 0.2, false);
  EXPECT_GT(bench.check.turn.norm(), 0.05);
}

TEST(InertialCheck, GravityTellsAnEncoderThatWasHomedWrongly) {
  Bench right;
  right.run(2.0, 0.0, 0.0, false);
  EXPECT_LT(tilt(right.check), 1e-6);
  Bench wrong;
  wrong.encoder += 0.3;
  wrong.run(2.0, 0.0, 0.0, false);
  EXPECT_NEAR(tilt(wrong.check), 0.3, 1e-6);
}

TEST(InertialCheck, WithoutAnAccelerometerThereIsNoTilt) {
  InertialCheck check;
  for (int k = 0; k < 10; ++k) {
    advance(kDt, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
            false, check);
  }
  EXPECT_EQ(tilt(check), 0.0);
}

}  // namespace
}  // namespace hg::estimation
