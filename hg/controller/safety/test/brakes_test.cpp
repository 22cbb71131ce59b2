#include "hg/controller/safety/brakes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hg/controller/safety/test/test_device.h"

namespace hg::safety {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const DeviceModel& device() {
  static const DeviceModel device = device_with("pprrrrrr", {.dq_max = 2.0});
  return device;
}

// A device whose power has gone, with joint 4 at a speed.
struct Dark {
  MonitorConfig monitor;
  BrakeState state;
  SensorFrame sensors;

  explicit Dark(double speed = 0.0, bool has_motors = true) {
    sensors.q_m = VectorM::Zero(6);
    if (has_motors) sensors.theta_m = VectorM::Zero(6);
    sensors.q_p = VectorP::Zero(2);
    step(true);
    sensors.q_m[4] += 1e-3 * speed;
    if (has_motors) sensors.theta_m[4] += 1e-3 * speed;
    EXPECT_EQ(step().code, FaultCode::kNone);
  }
  Fault step(bool is_powered = false) {
    return watch_brakes(monitor, device(), sensors, is_powered, state);
  }
  // samples until it is reported; -1: not within 2000
  template <typename Change>
  int until_reported(Change change) {
    for (int k = 1; k <= 2000; ++k) {
      change(sensors);
      if (step().code == FaultCode::kBrakesSlip) return k;
    }
    return -1;
  }
};

void turn_link(SensorFrame& s) { s.q_m[4] += 1e-3; }
void turn_motor(SensorFrame& s) { s.theta_m[4] -= 1e-3; }
void turn_both(SensorFrame& s) {
  s.q_m[4] += 1e-3;
  s.theta_m[4] += 1e-3;
}

TEST(Brakes, AnAxisThatMovesWithItsBrakeClosedIsSeenByEitherEncoder) {
  for (const auto turn : {turn_link, turn_motor, turn_both}) {
    Dark dark;
    EXPECT_NEAR(dark.until_reported(turn), 103, 1);  // 0.1 rad and three samples
    EXPECT_EQ(dark.state.slip.index, 4);
    EXPECT_GT(dark.state.slip.value, dark.state.slip.limit);
  }
  Dark without_motors(0.0, false);
  EXPECT_NEAR(without_motors.until_reported(turn_link), 103, 1);
  Dark gantry;
  EXPECT_NEAR(gantry.until_reported([](SensorFrame& s) { s.q_p[1] -= 1e-3; }), 53, 1);  // 0.05 m
  EXPECT_EQ(gantry.state.slip.index, 7);
}

TEST(Brakes, OtherSensorsThatAreWrongHideNothing) {
  Dark dark;
  dark.sensors.a_S[0] = dark.sensors.w_S[1] = kNan;
  dark.sensors.q_m[2] = kNan;
  dark.sensors.driver_fault = FaultCode::kDriveFault;
  EXPECT_NEAR(dark.until_reported(turn_both), 103, 1);
  EXPECT_EQ(dark.state.slip.index, 4);
  Dark frozen;  // the motor encoder of the joint that falls
  EXPECT_NEAR(frozen.until_reported(turn_link), 103, 1);
}

TEST(Brakes, AnEncoderThatGivesNoNumberIsTakenFromWhereItGivesOneAgain) {
  Dark dark;
  dark.sensors.q_m[4] = kNan;
  for (int k = 0; k < 10; ++k) EXPECT_EQ(dark.step().code, FaultCode::kNone);
  dark.sensors.q_m[4] = 0.0;
  EXPECT_NEAR(dark.until_reported(turn_link), 103, 1);
}

TEST(Brakes, ASpeedLeavesAShareOfTheStoppingDistanceForTheTimeOfAStop) {
  Dark fast(2.0);  // its rating: all of 0.8 rad
  EXPECT_NEAR(fast.until_reported(turn_both), 903, 2);
  Dark slow(0.25);  // an eighth
  EXPECT_NEAR(slow.until_reported(turn_both), 203, 2);
  Dark late(2.0);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(late.step().code, FaultCode::kNone);
  EXPECT_NEAR(late.until_reported(turn_both), 103, 1) << "it came to rest in time";
}

TEST(Brakes, ABrakeThatSlippedIsNotTrustedAgain) {
  Dark dark;
  dark.until_reported([](SensorFrame& s) { s.q_m[4] += 0.05; });
  dark.sensors.q_m[4] = 0.0;
  for (const bool is_powered : {false, true, false}) {
    EXPECT_EQ(dark.step(is_powered).code, FaultCode::kBrakesSlip);
  }
}

TEST(Brakes, AJumpOfOneSampleAndAWholeTurnAreNoSlip) {
  Dark dark;
  dark.sensors.q_m[4] = 0.5;
  EXPECT_EQ(dark.step().code, FaultCode::kNone);
  dark.sensors.q_m[4] = 0.0;
  EXPECT_EQ(dark.step().code, FaultCode::kNone);
  dark.sensors.q_m[4] = 2.0 * M_PI;
  for (int k = 0; k < 10; ++k) EXPECT_EQ(dark.step().code, FaultCode::kNone);
}

TEST(Brakes, BeforeTheFirstPowerAndWithPowerTheDeviceMayMove) {
  for (const bool is_powered : {false, true}) {
    Dark dark;
    dark.state = {};
    for (int k = 0; k < 1000; ++k) {
      turn_both(dark.sensors);
      EXPECT_EQ(dark.step(is_powered).code, FaultCode::kNone);
    }
  }
}

TEST(Brakes, AMissingSampleIsNotJudged) {
  Dark dark;
  dark.sensors.q_m.setZero();
  dark.sensors.driver_fault = FaultCode::kDeviceSilent;
  EXPECT_EQ(dark.until_reported([](SensorFrame& s) { s.q_m[4] += 0.05; }), -1);
}

}  // namespace
}  // namespace hg::safety
