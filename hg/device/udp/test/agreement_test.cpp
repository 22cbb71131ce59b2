#include "hg/device/udp/agreement.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "hg/device/udp/test/example_messages.h"

namespace hg::udp {
namespace {

const Description kTorqueDevice{
    .device = "arm", .n_p = 2, .n_m = 6, .rate_Hz = 1000.0, .interface = Interface::kTorque};

TEST(Difference, NamesTheFirstThingThatDiffers) {
  EXPECT_EQ(difference(kTorqueDevice, kTorqueDevice), "");
  Description other = kTorqueDevice;
  other.is_lock_step = true;
  EXPECT_EQ(difference(kTorqueDevice, other), "time: real time, expected lock-step (--fast)");
  other.interface = Interface::kPosition;
  EXPECT_EQ(difference(kTorqueDevice, other), "drives take torques, expected positions");
  other.rate_Hz = 2000.0;
  EXPECT_EQ(difference(kTorqueDevice, other), "rate: 1000 Hz, expected 2000 Hz");
  other.n_m = 7;
  EXPECT_EQ(difference(kTorqueDevice, other), "joints: 6, expected 7");
  other.n_p = 0;
  EXPECT_EQ(difference(kTorqueDevice, other), "gantry axes: 2, expected 0");
  other.device = "leg";
  EXPECT_EQ(difference(kTorqueDevice, other), "device: 'arm', expected 'leg'");
}

TEST(Difference, ShowsNamesWithoutControlCharacters) {
  Description other = kTorqueDevice;
  other.device = "\x1B[2Jleg";
  EXPECT_EQ(difference(other, kTorqueDevice), "device: '?[2Jleg', expected 'arm'");
}

TEST(Fits, SensorsHaveTheAgreedSizes) {
  std::mt19937 random(1);
  SensorFrame sensors = example_sensors(random, 1);
  EXPECT_TRUE(fits(kTorqueDevice, sensors));
  sensors.theta_m.resize(5);
  EXPECT_FALSE(fits(kTorqueDevice, sensors));
  sensors = example_sensors(random, 1);
  sensors.dq_m.resize(5);
  EXPECT_FALSE(fits(kTorqueDevice, sensors));
  sensors = example_sensors(random, 1);
  sensors.q_p.resize(1);
  EXPECT_FALSE(fits(kTorqueDevice, sensors));
}

TEST(Fits, SensorsAreFinite) {
  std::mt19937 random(1);
  const SensorFrame good = example_sensors(random, 1);
  SensorFrame sensors = good;
  const auto corrupt = [&](double& value) {
    for (const double wrong :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      value = wrong;
      EXPECT_FALSE(fits(kTorqueDevice, sensors));
    }
    sensors = good;
    EXPECT_TRUE(fits(kTorqueDevice, sensors));
  };
  corrupt(sensors.time_s);
  for (VectorM* v : {&sensors.q_m, &sensors.dq_m, &sensors.theta_m, &sensors.tau_m})
    corrupt((*v)[5]);
  corrupt(sensors.q_p[1]);
  corrupt(sensors.w_S[5]);
  corrupt(sensors.a_S[2]);
  corrupt(sensors.omega_S[2]);
}

TEST(Fits, OnlyDrivesThatTakePositionsMayLackMotorSensors) {
  std::mt19937 random(1);
  Description position = kTorqueDevice;
  position.interface = Interface::kPosition;
  for (const auto member : {&SensorFrame::theta_m, &SensorFrame::tau_m}) {
    SensorFrame sensors = example_sensors(random, 1);
    (sensors.*member).resize(0);
    EXPECT_FALSE(fits(kTorqueDevice, sensors));
    EXPECT_TRUE(fits(position, sensors));
  }
}

TEST(Fits, OnlyFiniteCommandsOfTheRightKindGoToDrives) {
  std::mt19937 random(1);
  CommandFrame command = example_command(random, 1);
  command.enable = true;
  EXPECT_TRUE(fits(kTorqueDevice, command));
  EXPECT_TRUE(fits(kTorqueDevice, off_command(kTorqueDevice)));
  CommandFrame not_finite = command;
  not_finite.tau_m[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fits(kTorqueDevice, not_finite));
  command.tau_m.resize(0);
  for (const bool enable : {true, false}) {
    command.enable = enable;
    EXPECT_FALSE(fits(kTorqueDevice, command));
  }
  Description position = kTorqueDevice;
  position.interface = Interface::kPosition;
  EXPECT_TRUE(fits(position, command));
  for (VectorM* v : {&command.q_m, &command.dq_m, &command.ddq_m}) {
    const double kept = (*v)[3];
    (*v)[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(fits(position, command));
    (*v)[3] = kept;
  }
  for (const double press : {-0.01, 1.01, std::numeric_limits<double>::quiet_NaN()}) {
    command.hand_target.press = press;
    EXPECT_FALSE(fits(position, command)) << press;
  }
  for (const double press : {0.0, 1.0}) {
    command.hand_target.press = press;
    EXPECT_TRUE(fits(position, command)) << press;
  }
  command.dq_p[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(fits(position, command));
}

}  // namespace
}  // namespace hg::udp
