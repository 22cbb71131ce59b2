// An inertial unit against encoders: what turns, what drifts, and where gravity is.

#include "hg/controller/estimation/inertial_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
const Eigen::Vector3d kGyroscopeZero(0.01, -0.02, 0.005);

// A unit that is turned about a horizontal axis of B, and moved along another one.
struct Bench {
  InertialCheck check;
  Eigen::Vector3d a_error_S = Eigen::Vector3d::Zero();
  double place = 0.0, place_encoder = 0.0;  // m
  double v = 0.0;                           // m/s, true
  double angle = 0.3;                       // rad, true
  double encoder = 0.3;                     // rad, as the encoders say
  double acceleration = 0.0;                // m/s^2
  double most_slip = 0.0;                   // m/s

  void step(double speed, double drift, bool is_moving) {
    angle += kDt * speed;
    encoder += kDt * (speed + drift);
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    const Eigen::Matrix3d R_true = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    advance(kDt,
            {.R_B_S = Eigen::AngleAxisd(encoder, axis).toRotationMatrix(),
             .p_S = Eigen::Vector3d(0.0, place_encoder, 1.0),
             .omega_S = speed * axis + kGyroscopeZero,
             .a_S = R_true.transpose() * Eigen::Vector3d(0.0, acceleration, 9.81) + a_error_S},
            is_moving, check);
  }
  // to a speed within 0.4 s and on with it, of which the encoders miss a share
  void go(double speed, double missed, double seconds) {
    for (int k = 0; k < seconds / kDt; ++k) {
      acceleration = k < 400 ? speed / 0.4 : 0.0;
      v += kDt * acceleration;
      place += kDt * v;
      place_encoder += kDt * v * (1.0 - missed);
      step(0.0, 0.0, true);
      most_slip = std::max(most_slip, check.slip.norm());
    }
  }
  void run(double seconds, double speed, double drift, bool is_moving) {
    for (int k = 0; k < seconds / kDt; ++k) step(speed, drift, is_moving);
  }
};

TEST(InertialCheck, LearnsTheGyroscopeBiasAtRestAndThenMatchesTheEncoders) {
  Bench bench;
  bench.run(0.2, 0.0, 0.0, false);
  EXPECT_LT((bench.check.bias - kGyroscopeZero).norm(), 1e-4);
  bench.run(2.0, 1.5, 0.0, true);
  EXPECT_LT(bench.check.turn.norm(), 2e-3);
  EXPECT_NEAR(bench.check.turned.norm(), 2.36, 0.1);  // 3 rad, of which some is forgotten
}

TEST(InertialCheck, TurnsThereAndBackExplainLessThanATurn) {
  Bench once, there_and_back;
  once.run(2.0, 1.5, 0.0, true);
  for (int k = 0; k < 2; ++k) {
    there_and_back.run(0.5, 1.5, 0.0, true);
    there_and_back.run(0.5, -1.5, 0.0, true);
  }
  EXPECT_NEAR(turn_uncertainty(once.check), 2.36 * 0.018, 0.003);
  EXPECT_NEAR(turn_uncertainty(there_and_back.check), 2.36 * 0.003, 0.006);
}

TEST(InertialCheck, AnAccelerometerFollowsWhatTheEncodersSay) {
  Bench bench;
  bench.a_error_S = {0.2, -0.1, 0.15};
  bench.run(2.0, 0.0, 0.0, false);
  EXPECT_LT((bench.check.offset_S - bench.a_error_S).norm(), 0.01);
  bench.go(1.0, 0.0, 3.0);
  EXPECT_LT(bench.most_slip, 0.01);
}

TEST(InertialCheck, ASlipThatEncodersDoNotSeeIsSeenByTheAccelerometer) {
  Bench bench;
  bench.run(2.0, 0.0, 0.0, false);
  bench.go(0.5, 1.0, 1.0);
  EXPECT_NEAR(bench.most_slip, 0.33, 0.03);  // 0.5 m/s, of which some is forgotten
}

TEST(InertialCheck, ABaseThatIsNotLevelIsNoSlip) {
  Bench level, tilted;
  level.a_error_S = {0.1, 0.1, 0.05};  // of the unit: 15 mg
  level.run(2.0, 0.0, 0.0, false);
  EXPECT_EQ(slip_uncertainty(level.check), 0.0);
  tilted.encoder += 0.08;  // the encoders miss that the base leans by 80 mrad
  tilted.run(2.0, 0.0, 0.0, false);
  tilted.run(1.0, std::numbers::pi, 0.0, true);
  EXPECT_LT(tilted.check.slip.norm(), 0.15 + slip_uncertainty(tilted.check));
}

TEST(InertialCheck, AnErrorThatBeginsWithPowerIsLearntInSomeSeconds) {
  Bench bench;
  bench.run(2.0, 0.0, 0.0, false);
  bench.a_error_S = {0.1, 0.1, 0.0};
  bench.go(0.0, 0.0, 8.0);
  EXPECT_LT(bench.most_slip, 0.06);
  EXPECT_LT(bench.check.slip.norm(), 0.01);
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

TEST(InertialCheck, GravityRevealsAWronglyHomedEncoder) {
  Bench right;
  right.run(2.0, 0.0, 0.0, false);
  EXPECT_LT(tilt(right.check), 1e-6);
  Bench wrong;
  wrong.encoder += 0.3;
  wrong.run(2.0, 0.0, 0.0, false);
  EXPECT_NEAR(tilt(wrong.check), 0.3, 1e-6);
}

TEST(InertialCheck, AnAccelerometerThatShowsNothingIsNoSignOfARightPosture) {
  InertialCheck check;
  EXPECT_EQ(tilt(check), 0.0);  // nothing is known yet
  for (int k = 0; k < 10; ++k) advance(kDt, {}, false, check);
  EXPECT_EQ(tilt(check), std::numbers::pi);
}

}  // namespace
}  // namespace hg::estimation
