#include "hg/safety/monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace hg::safety {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SensorFrame good_sensors() {
  SensorFrame sensors;
  sensors.sequence = 7;
  sensors.q_m = VectorM::Zero(6);
  sensors.dq_m = VectorM::Zero(6);
  sensors.q_p = VectorP::Zero(2);
  return sensors;
}

MonitorConfig config() {
  MonitorConfig monitor;
  monitor.joint_range.assign(6, {-2.0, 2.0});
  monitor.joint_speed_max.assign(6, 3.0);
  monitor.first_cartesian = 6;
  monitor.end_cartesian = 9;
  return monitor;
}

CycleRecord good_record() {
  CycleRecord record;
  record.solver_status = SolverStatus::kSolved;
  record.robot.q_m = VectorM::Zero(6);
  record.reference = {VectorM::Zero(6), VectorM::Zero(6), VectorM::Zero(6)};
  record.twin.ddq_a = VectorA::Zero(2);
  record.limit_count = 9;
  return record;
}

TEST(CheckSensors, GoodOnesPass) {
  EXPECT_EQ(check_sensors(config(), good_sensors(), 7).code, FaultCode::kNone);
}

TEST(CheckSensors, NamesTheComponentThatIsNotFinite) {
  // counted through: 6 joints, 6 speeds, 2 gantry axes, 6 wrench components
  SensorFrame sensors = good_sensors();
  sensors.q_m[3] = kNan;
  EXPECT_EQ(check_sensors(config(), sensors, 7).code, FaultCode::kSensorNotFinite);
  EXPECT_EQ(check_sensors(config(), sensors, 7).index, 3);
  sensors = good_sensors();
  sensors.q_p[1] = kInfinity;
  EXPECT_EQ(check_sensors(config(), sensors, 7).index, 13);
  sensors = good_sensors();
  sensors.w_S[5] = kNan;
  EXPECT_EQ(check_sensors(config(), sensors, 7).index, 19);
}

TEST(CheckSensors, LooksAtMotorsJointTorquesAndTheInertialUnitToo) {
  SensorFrame complete = good_sensors();
  complete.theta_m = complete.tau_m = VectorM::Zero(6);
  EXPECT_TRUE(is_finite(config(), complete));
  const auto expect_named = [&](auto&& spoil, int index) {
    SensorFrame sensors = complete;
    spoil(sensors);
    EXPECT_FALSE(is_finite(config(), sensors)) << index;
    EXPECT_EQ(check_sensors(config(), sensors, 7).code, FaultCode::kSensorNotFinite) << index;
    EXPECT_EQ(check_sensors(config(), sensors, 7).index, index);
  };
  expect_named([](SensorFrame& s) { s.theta_m[0] = kNan; }, 20);
  expect_named([](SensorFrame& s) { s.tau_m[5] = kInfinity; }, 31);
  expect_named([](SensorFrame& s) { s.a_S[1] = kNan; }, 33);
  expect_named([](SensorFrame& s) { s.omega_S[2] = -kInfinity; }, 37);
}

TEST(CheckSensors, WhatADeviceWithoutInertialUnitSaysOfItDoesNotMatter) {
  SensorFrame sensors = good_sensors();
  sensors.a_S[0] = sensors.omega_S[0] = kNan;
  MonitorConfig without = config();
  without.has_imu = false;
  EXPECT_TRUE(is_finite(without, sensors));
  EXPECT_EQ(check_sensors(without, sensors, 7).code, FaultCode::kNone);
}

TEST(CheckSensors, AFaultThatTheDriverReportsComesFirst) {
  SensorFrame sensors = good_sensors();
  sensors.driver_fault = FaultCode::kDeviceSilent;
  EXPECT_EQ(check_sensors(config(), sensors, 6).code, FaultCode::kDeviceSilent);
}

TEST(CheckSensors, SeesGapsAndWrenchesBeyondTheSensor) {
  EXPECT_EQ(check_sensors(config(), good_sensors(), 6).code, FaultCode::kSequenceGap);
  SensorFrame sensors = good_sensors();
  sensors.w_S[0] = 151.0;
  EXPECT_EQ(check_sensors(config(), sensors, 7).code, FaultCode::kWrenchTooLarge);
  sensors = good_sensors();
  sensors.w_S[4] = -14.5;
  EXPECT_EQ(check_sensors(config(), sensors, 7).code, FaultCode::kWrenchTooLarge);
}

TEST(CheckReference, FindsEachKindOfFault) {
  EXPECT_EQ(check_reference(config(), good_record()).code, FaultCode::kNone);
  CycleRecord record = good_record();
  record.solver_status = SolverStatus::kIterationLimit;
  EXPECT_EQ(check_solution(record).code, FaultCode::kSolverFailed);
  record = good_record();
  record.twin.ddq_a[1] = kNan;
  EXPECT_EQ(check_solution(record).code, FaultCode::kReferenceNotFinite);
  record = good_record();
  record.reference.q_m[2] = record.robot.q_m[2] = 2.031;
  EXPECT_EQ(check_reference(config(), record).code, FaultCode::kLimitExceeded);
  record = good_record();
  record.reference.dq_m[4] = -3.31;
  EXPECT_EQ(check_reference(config(), record).code, FaultCode::kSpeedExceeded);
  record = good_record();
  record.robot.q_m[5] = 0.081;
  EXPECT_EQ(check_reference(config(), record).code, FaultCode::kTrackingLost);
  record = good_record();
  record.limits[7].excess = 0.031;
  EXPECT_EQ(check_reference(config(), record).code, FaultCode::kLimitExceeded);
  EXPECT_EQ(check_reference(config(), record).index, 7);
  record = good_record();
  record.sync_error = 0.021;
  EXPECT_EQ(check_reference(config(), record).code, FaultCode::kSyncLost);
}

CommandFrame good_command() {
  CommandFrame command;
  command.enable = true;
  command.q_m = VectorM::Constant(6, 0.1);
  command.dq_m = VectorM::Constant(6, -0.2);
  command.ddq_m = VectorM::Constant(6, 3.0);
  command.dq_p = VectorP::Constant(2, 1.0);
  return command;
}

TEST(Sanitise, LeavesAGoodCommandUntouched) {
  CommandFrame command = good_command();
  EXPECT_EQ(sanitise(config(), command).code, FaultCode::kNone);
  const CommandFrame expected = good_command();
  EXPECT_TRUE(command.enable);
  EXPECT_EQ(command.q_m, expected.q_m);
  EXPECT_EQ(command.dq_m, expected.dq_m);
  EXPECT_EQ(command.ddq_m, expected.ddq_m);
  EXPECT_EQ(command.dq_p, expected.dq_p);
}

TEST(Sanitise, ClampsTheGantryAndDisablesWhatIsNotFinite) {
  CommandFrame command = good_command();
  command.dq_p[1] = -9.0;
  EXPECT_EQ(sanitise(config(), command).code, FaultCode::kNone);
  EXPECT_EQ(command.dq_p[1], -1.5);
  EXPECT_TRUE(command.enable);
  command.ddq_m[0] = kNan;
  const Fault fault = sanitise(config(), command);
  EXPECT_EQ(fault.code, FaultCode::kCommandNotFinite);
  EXPECT_EQ(fault.index, 12);
  EXPECT_FALSE(command.enable);
  EXPECT_TRUE(command.q_m.allFinite() && command.dq_m.isZero() && command.dq_p.isZero());
}

}  // namespace
}  // namespace hg::safety
