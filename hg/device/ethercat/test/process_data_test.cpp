#include "hg/device/ethercat/process_data.h"

#include <gtest/gtest.h>

#include "hg/device/ethercat/bits.h"
#include "hg/device/ethercat/drive_state.h"

namespace hg::ethercat {
namespace {

constexpr int kAxes = 1, kJoints = 2;

Station station_of(const Slave& slave) {
  return {.outputs = std::vector<std::uint8_t>(bits_of(slave.outputs) / 8),
          .inputs = std::vector<std::uint8_t>(bits_of(slave.inputs) / 8)};
}

SensorFrame taken(const Slave& slave, Station& station) {
  SensorFrame frame;
  take_inputs(slave, kAxes, kJoints, station, frame);
  return frame;
}

Slave second_joint(DriveMode mode, Output target) {
  return {.joint = kAxes + 1,
          .mode = mode,
          .outputs = {{.bits = 16, .meaning = Output::kControlWord},
                      {.bits = 16, .meaning = target, .scale = -0.5, .offset = 1.0},
                      {.bits = 8, .meaning = Output::kMode}},
          .inputs = {{.bits = 16, .meaning = Input::kStatusWord},
                     {.bits = 16, .meaning = Input::kErrorCode},
                     {.bits = 32, .meaning = Input::kLinkPosition, .scale = -0.5, .offset = 1.0},
                     {.bits = 8, .meaning = Input::kModeNow}}};
}

TEST(ProcessData, OfADriveHasScaleSignAndOffset) {
  const Slave slave = second_joint(DriveMode::kCst, Output::kTargetTorque);
  Station station = station_of(slave);
  write_bits(station.inputs, 0, 16, 0x9237);
  write_bits(station.inputs, 16, 16, 0x8611);
  write_bits(station.inputs, 32, 32, static_cast<std::uint32_t>(-6));
  write_bits(station.inputs, 64, 8, 10);
  const SensorFrame frame = taken(slave, station);
  ASSERT_EQ(frame.q_m.size(), kJoints);
  EXPECT_EQ(frame.q_m[1], 4.0);
  EXPECT_EQ(frame.q_m[0], 0.0);
  EXPECT_EQ(station.status, 0x9237);
  EXPECT_EQ(station.error, 0x8611);
  EXPECT_EQ(station.mode_now, 10);
}

TEST(ProcessData, OfAGantryAxisIsItsPosition) {
  Slave slave = second_joint(DriveMode::kCsv, Output::kTargetVelocity);
  slave.joint = 0;
  Station station = station_of(slave);
  write_bits(station.inputs, 32, 32, 10);
  EXPECT_EQ(taken(slave, station).q_p[0], -4.0);
}

TEST(ProcessData, OfSensorsAndSwitchesGoToTheFrame) {
  Slave slave;
  for (const Input meaning : {Input::kForceX, Input::kTorqueZ, Input::kAccelerationY}) {
    slave.inputs.push_back({.bits = 16, .meaning = meaning, .scale = 0.5});
  }
  slave.inputs.push_back({.bits = 1, .meaning = Input::kDeadMan});
  slave.inputs.push_back({.bits = 1, .meaning = Input::kEmergencyStop, .is_inverted = true});
  slave.inputs.push_back({.bits = 14, .meaning = Input::kNothing});
  Station station = station_of(slave);
  write_bits(station.inputs, 0, 16, 3);
  write_bits(station.inputs, 16, 16, static_cast<std::uint32_t>(-4));
  write_bits(station.inputs, 32, 16, 8);
  write_bits(station.inputs, 48, 1, 1);
  SensorFrame frame = taken(slave, station);
  EXPECT_EQ(frame.w_S[0], 1.5);
  EXPECT_EQ(frame.w_S[5], -2.0);
  EXPECT_EQ(frame.a_S[1], 4.0);
  EXPECT_TRUE(frame.dead_man);
  EXPECT_TRUE(frame.safety.emergency_stop);  // a broken wire stops
  write_bits(station.inputs, 49, 1, 1);
  EXPECT_FALSE(taken(slave, station).safety.emergency_stop);
}

TEST(ProcessData, NoticesACounterThatStands) {
  const Slave slave{.inputs = {{.bits = 32, .meaning = Input::kSampleCounter}}};
  Station station = station_of(slave);
  write_bits(station.inputs, 0, 32, 7);
  taken(slave, station);
  EXPECT_TRUE(station.has_new_samples);
  taken(slave, station);
  EXPECT_FALSE(station.has_new_samples);
}

CommandFrame command() {
  CommandFrame command;
  command.q_m = VectorM::Constant(kJoints, 3.0);
  command.dq_m = VectorM::Constant(kJoints, 5.0);
  command.tau_m = VectorM::Constant(kJoints, 7.0);
  command.dq_p = VectorP::Constant(kAxes, 2.0);
  return command;
}

// The number that a drive gets as its target.
std::int32_t target(const Slave& slave, bool enables) {
  const CommandFrame wanted = command();
  SensorFrame last;
  last.q_m = VectorM::Constant(kJoints, -1.0);
  last.q_p = VectorP::Constant(kAxes, -1.0);
  Station station = station_of(slave);
  put_outputs(slave, kAxes,
              {.command = &wanted, .enables = enables, .control_word = kEnableOperation}, last,
              station);
  EXPECT_EQ(read_bits(station.outputs, 0, 16), 0x0Fu);
  EXPECT_EQ(read_bits(station.outputs, 32, 8), static_cast<std::uint32_t>(slave.mode));
  return signed_of(read_bits(station.outputs, 16, 16), 16);
}

TEST(ProcessData, GivesADriveItsTargetOrItsPlace) {
  // number = (value - 1) / -0.5
  EXPECT_EQ(target(second_joint(DriveMode::kCst, Output::kTargetTorque), true), -12);
  EXPECT_EQ(target(second_joint(DriveMode::kCst, Output::kTargetTorque), false), 2);
  EXPECT_EQ(target(second_joint(DriveMode::kCsv, Output::kTargetVelocity), true), -8);
  EXPECT_EQ(target(second_joint(DriveMode::kCsp, Output::kTargetPosition), true), -4);
  EXPECT_EQ(target(second_joint(DriveMode::kCsp, Output::kTargetPosition), false), 4);
  Slave axis = second_joint(DriveMode::kCsv, Output::kTargetVelocity);
  axis.joint = 0;
  EXPECT_EQ(target(axis, true), -2);
}

TEST(ProcessData, OpensBrakesAndPressesReset) {
  const Slave slave{.outputs = {{.bits = 1, .meaning = Output::kReset},
                                {.bits = 1, .meaning = Output::kOpenBrakes},
                                {.bits = 1, .meaning = Output::kOpenBrakes, .is_inverted = true},
                                {.bits = 5}}};
  CommandFrame wanted = command();
  Station station = station_of(slave);
  put_outputs(slave, kAxes, {.command = &wanted}, {}, station);
  EXPECT_EQ(station.outputs[0], 0b100);
  wanted.panel.reset = true;
  put_outputs(slave, kAxes, {.command = &wanted, .opens_brakes = true}, {}, station);
  EXPECT_EQ(station.outputs[0], 0b011);
}

TEST(ProcessData, LimitsTargetsInsteadOfTurningThemRound) {
  Slave slave = second_joint(DriveMode::kCst, Output::kTargetTorque);
  slave.outputs[1].scale = 1e-6;
  EXPECT_EQ(target(slave, true), 32767);
}

}  // namespace
}  // namespace hg::ethercat
