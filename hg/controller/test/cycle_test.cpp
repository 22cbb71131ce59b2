#include "hg/controller/cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "hg/controller/cycle_config.h"
#include "hg/controller/cycle_state.h"
#include "hg/controller/rendering/test/test_models.h"
#include "hg/core/allocation_counter.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::controller {
namespace {

const VectorM kPosture = rendering::posture({0.3, 1.5, -0.6, 1.3, 0.2, 0.4});

// A free body in the hand of a device that follows perfectly, and a constant push.
struct Loop {
  DeviceModel device;
  std::unique_ptr<Cycle> cycle;
  SensorFrame sensors;
  OperatorFrame operator_input;
  CommandFrame command;
  CycleRecord record;
  std::array<double, 2> gantry_speed{};
  std::array<CommandDelay, 2> delay{};

  std::uint64_t latency = 1;  // periods; 0: the device does not answer

  explicit Loop(bool needs_tare = false, bool has_torque_loop = false, bool has_imu = false,
                const CycleConfig& base = {},
                const DeviceModel& model = rendering::unlimited_device())
      : device(model) {
    rendering::TwinModel twin = rendering::unlimited_twin(
        model::ChainModel::free_body({.mass = 6.0}, {.gravity = false}), "handle");
    twin.q_start =
        rendering::floating_at(rendering::handle_pose(device, Eigen::Vector2d::Zero(), kPosture));
    CycleConfig config = base;
    config.estimation.wrench.tare.is_needed = needs_tare;
    config.estimation.wrench.has_imu = has_imu;
    device.has_closed_form = true;
    device.gantry_range.assign(2, {-1.4, 1.4});
    for (limits::JointLimits& joint : device.joint_limits) {
      joint.q_min = std::max(joint.q_min, -10.0);
      joint.q_max = std::min(joint.q_max, 10.0);
      joint.dq_max = std::min(joint.dq_max, 10.0);
    }
    if (has_torque_loop) {
      config.control.method = tracking::Method::kModal;
      device.actuators = reference_actuators();
      // the joint torques that it measures are always zero, whatever moves it
      config.monitor.motor_tolerance = config.monitor.unexplained_tolerance = kInfinity;
      config.monitor.plausibility = kInfinity;
    }
    cycle = std::make_unique<Cycle>(config, device, twin);
    sensors.q_m = kPosture;
    sensors.dq_m = VectorM::Zero(6);
    sensors.q_p = VectorP::Zero(2);
    sensors.dead_man = true;
    if (has_imu) {
      const Pose handle = rendering::handle_pose(device, sensors.q_p, kPosture);
      sensors.a_S = handle.R.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
    }
    if (!has_torque_loop) return;
    sensors.theta_m = kPosture;
    sensors.tau_m = VectorM::Zero(6);
  }

  void step() {
    cycle->step(sensors, operator_input, command, record);
    if (command.enable) {
      sensors.q_m = command.q_m;
      sensors.dq_m = command.dq_m;
      if (sensors.theta_m.size() > 0) sensors.theta_m = command.q_m;
    }
    for (int i = 0; i < 2; ++i) {
      const double ddq =
          drive_acceleration({}, gantry_speed[i], delay[i].shift(command.dq_p[i], 4));
      sensors.q_p[i] += 1e-3 * gantry_speed[i] + 0.5e-6 * ddq;
      gantry_speed[i] += 1e-3 * ddq;
    }
    ++sensors.sequence;
    sensors.time_s += 1e-3;
    const bool answers = latency > 0 && sensors.sequence > latency;
    sensors.answered_sequence = answers ? sensors.sequence - latency : 0;
  }

  void start_running() {
    for (const ModeRequest request : {ModeRequest::kNone, ModeRequest::kArm, ModeRequest::kRun}) {
      operator_input.request = request;
      step();
    }
    ASSERT_EQ(record.mode, Mode::kRunning);
    operator_input.request = ModeRequest::kNone;
  }

  void run(int steps) {
    for (int k = 0; k < steps; ++k) step();
  }
};

TEST(Cycle, ArmsRunsAndMovesTheTwinWithTheHand) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 3.0;
  loop.run(300);
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
  EXPECT_GT(loop.record.v_H.norm(), 0.05);
  EXPECT_LT(loop.record.sync_error, 1e-4);
}

TEST(Cycle, ForcesComeInWithARampWhenRenderingBegins) {
  Loop loop;
  loop.sensors.w_S[0] = 20.0;
  loop.run(50);  // a person leans on the handle before it runs
  loop.start_running();
  double last = loop.record.a_H.norm(), largest_change = last;
  for (int k = 0; k < 320; ++k) {
    loop.step();
    const double a_H = loop.record.a_H.norm();
    largest_change = std::max(largest_change, std::abs(a_H - last));
    last = a_H;
  }
  EXPECT_LT(largest_change, 1.5 * 20.0 / 6.0 / 300.0);  // F / m in 0.3 s
  EXPECT_GT(last, 0.5);
  // and again with the next run
  loop.operator_input.request = ModeRequest::kStop;
  loop.run(1000);
  ASSERT_EQ(loop.record.mode, Mode::kArmed);
  loop.operator_input.request = ModeRequest::kRun;
  loop.step();
  ASSERT_EQ(loop.record.mode, Mode::kRunning);
  EXPECT_LT(loop.record.a_H.norm(), 0.02);
}

TEST(Cycle, BeforeRunningNothingMoves) {
  Loop loop;
  loop.sensors.w_S[0] = 30.0;
  loop.run(5);
  EXPECT_EQ(loop.record.mode, Mode::kReady);
  EXPECT_FALSE(loop.command.enable);
  loop.operator_input.request = ModeRequest::kArm;
  loop.run(100);
  EXPECT_EQ(loop.record.mode, Mode::kArmed);
  EXPECT_TRUE(loop.command.enable);
  EXPECT_EQ(loop.command.q_m, kPosture);
  EXPECT_TRUE(loop.command.dq_p.isZero());
  EXPECT_TRUE(loop.command.ddq_m.isZero());
  EXPECT_NEAR(loop.record.robot.w_H.norm(), 30.0, 1e-9);  // the user wrench is still reported
}

TEST(Cycle, AStopBringsEverythingToRestAgainstAPushingHand) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(500);
  loop.operator_input.request = ModeRequest::kStop;
  loop.run(500);
  EXPECT_EQ(loop.record.mode, Mode::kArmed);
  const VectorM q_m = loop.command.q_m;
  loop.run(200);
  EXPECT_EQ(loop.command.q_m, q_m);
}

// in this very cycle: drives off, brakes closed
void expect_safe_stop(Loop& loop, FaultCode code) {
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  EXPECT_EQ(loop.record.stop, Stop::kSto);
  EXPECT_EQ(loop.record.fault.code, code);
  EXPECT_FALSE(loop.command.enable);
  EXPECT_TRUE(loop.command.dq_p.isZero());
  EXPECT_TRUE(loop.command.q_m.allFinite() && loop.command.dq_m.allFinite());
}

// braked first, under power all the time, if it moves; returns the cycles that it took
int expect_controlled_stop(Loop& loop, FaultCode code, Stop stop) {
  int cycles = 0;
  do {
    loop.step();  // as long as the rule's debounce takes
  } while (loop.record.mode == Mode::kRunning && ++cycles < 30);
  for (; loop.record.mode == Mode::kStopping && cycles < 2000; ++cycles) {
    EXPECT_TRUE(loop.command.enable);
    EXPECT_EQ(loop.record.fault.code, code);
    EXPECT_EQ(loop.record.stop, stop);
    EXPECT_TRUE(loop.command.q_m.allFinite() && loop.command.ddq_m.allFinite());
    loop.step();
  }
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  EXPECT_EQ(loop.record.fault.code, code);
  EXPECT_EQ(loop.record.stop, stop);
  EXPECT_FALSE(loop.command.enable);
  return cycles;
}

void reset(Loop& loop) {
  loop.operator_input.request = ModeRequest::kReset;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kReady);
  EXPECT_EQ(loop.record.fault.code, FaultCode::kNone);
  EXPECT_EQ(loop.record.stop, Stop::kNone);
}

TEST(Cycle, ANanInTheWrenchEndsInASafeCommandWithItsCause) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[2] = std::numeric_limits<double>::quiet_NaN();
  expect_safe_stop(loop, FaultCode::kSensorNotFinite);
  EXPECT_EQ(loop.record.fault.index, 16);
}

TEST(Cycle, AWrenchBeyondTheSensorsRangeIsNeverUsed) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 4.0;
  loop.run(500);
  const Vector6 good = loop.record.robot.w_H;
  loop.sensors.w_S[0] = 500.0;
  int cycles = 0;
  for (; loop.record.mode != Mode::kFault && cycles < 2000; ++cycles) {
    loop.step();
    ASSERT_EQ(loop.record.robot.w_H, good) << cycles;
  }
  EXPECT_EQ(loop.record.fault.code, FaultCode::kWrenchTooLarge);
  EXPECT_GT(cycles, 10);
}

TEST(Cycle, OnlyItsOwnSolveIsKeptForASlowStep) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[2] = std::numeric_limits<double>::quiet_NaN();
  loop.step();
  loop.cycle->keep_problem(99.0);  // nothing was solved
  EXPECT_EQ(loop.cycle->kept_problems().count(), 0U);
  loop.sensors.w_S[2] = 0.0;
  loop.step();
  loop.cycle->keep_problem(99.0);
  ASSERT_EQ(loop.cycle->kept_problems().size(), 1U);
  EXPECT_EQ(loop.cycle->kept_problems()[0].cycle, loop.record.cycle);
}

TEST(Cycle, AnInfinityInTheJointsEndsInASafeCommand) {
  Loop loop;
  loop.start_running();
  loop.sensors.q_m[1] = kInfinity;
  expect_safe_stop(loop, FaultCode::kSensorNotFinite);
}

TEST(Cycle, AVectorThatADriverLeavesOutOrMakesTooLongEndsInASafeCommand) {
  const auto expect_refused = [](bool has_torque_loop, int index, auto&& corrupt) {
    SCOPED_TRACE(index);
    Loop loop(false, has_torque_loop);
    if (has_torque_loop) loop.run(200);  // until the latency is known
    loop.start_running();
    corrupt(loop.sensors);
    loop.step();
    EXPECT_FALSE(loop.command.enable);
    EXPECT_EQ(loop.record.fault.code, FaultCode::kSensorIncomplete);
    EXPECT_EQ(loop.record.fault.index, index);
    EXPECT_TRUE(loop.command.tau_m.allFinite());
  };
  expect_refused(true, 4, [](SensorFrame& s) { s.theta_m.resize(0); });
  expect_refused(true, 5, [](SensorFrame& s) { s.tau_m = VectorM::Zero(7); });
  for (const bool has_torque_loop : {false, true}) {
    expect_refused(has_torque_loop, 0, [](SensorFrame& s) { s.q_m.resize(0); });
    expect_refused(has_torque_loop, 1, [](SensorFrame& s) { s.dq_m = VectorM::Zero(7); });
    expect_refused(has_torque_loop, 2, [](SensorFrame& s) { s.q_p = VectorP::Zero(1); });
    expect_refused(has_torque_loop, 8, [](SensorFrame& s) { s.temperature_m = VectorM::Zero(5); });
  }
}

TEST(Cycle, ADriverThatNeverGivesMotorEncodersIsNotArmed) {
  Loop loop(false, true);
  loop.sensors.theta_m.resize(0);
  loop.run(200);
  loop.operator_input.request = ModeRequest::kArm;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  EXPECT_EQ(loop.record.fault.code, FaultCode::kSensorIncomplete);
  EXPECT_FALSE(loop.command.enable);
}

TEST(Cycle, ALostSampleStopsTheDevice) {
  Loop loop;
  loop.start_running();
  ++loop.sensors.sequence;
  expect_safe_stop(loop, FaultCode::kSequenceGap);
}

TEST(Cycle, ANanDuringAControlledStopSwitchesOffAtOnce) {
  Loop loop;
  loop.start_running();
  loop.sensors.driver_fault = FaultCode::kBusErrors;  // stops under control where it comes alone
  loop.sensors.q_m[2] = std::numeric_limits<double>::quiet_NaN();
  loop.step();
  EXPECT_EQ(loop.record.fault.code, FaultCode::kBusErrors);
  EXPECT_EQ(loop.record.stop, Stop::kSto);
  EXPECT_FALSE(loop.command.enable);
  EXPECT_TRUE(loop.command.q_m.allFinite());
}

TEST(Cycle, ADeviceThatStillMovesIsNotArmed) {
  Loop loop;
  loop.step();
  loop.sensors.dq_m[1] = 0.5;
  loop.step();
  loop.operator_input.request = ModeRequest::kArm;
  loop.step();
  EXPECT_EQ(loop.record.refusal, Refusal::kStillMoving);
  EXPECT_FALSE(loop.command.enable);
  loop.sensors.dq_m[1] = 0.0;
  loop.operator_input.request = ModeRequest::kNone;
  loop.run(2);
  loop.operator_input.request = ModeRequest::kArm;
  loop.step();
  EXPECT_EQ(loop.record.refusal, Refusal::kNone);
  EXPECT_TRUE(loop.command.enable);
}

TEST(Cycle, AfterAStopOfBrakedJointsTheTwinIsAtTheHandle) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(400);
  loop.sensors.dead_man = false;
  loop.run(3);
  ASSERT_EQ(loop.record.mode, Mode::kStopping);
  CycleState state = loop.cycle->state();
  state.motion = Motion::kBrakeJoints;  // as a collision ahead does
  loop.cycle->restore(state);
  loop.sensors.w_S[0] = 0.0;
  double farthest = 0.0;
  for (int k = 0; k < 1000 && loop.record.mode == Mode::kStopping; ++k) {
    loop.step();
    farthest = std::max(farthest, (loop.record.T_B_H.p - loop.record.T_B_E.p).norm());
  }
  ASSERT_EQ(loop.record.mode, Mode::kArmed);
  EXPECT_GT(farthest, 1e-4);
  loop.run(2);
  EXPECT_LT((loop.record.T_B_H.p - loop.record.T_B_E.p).norm(), 1e-5);
}

TEST(Cycle, RunsAgainInTheCycleAfterJointsBrakedOneByOne) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(400);
  loop.sensors.dead_man = false;
  loop.run(3);
  ASSERT_EQ(loop.record.mode, Mode::kStopping);
  CycleState state = loop.cycle->state();
  state.motion = Motion::kBrakeJoints;
  loop.cycle->restore(state);
  loop.sensors.w_S[0] = 0.0;
  for (int k = 0; k < 1000 && loop.record.mode == Mode::kStopping; ++k) loop.step();
  ASSERT_EQ(loop.record.mode, Mode::kArmed);
  loop.sensors.dead_man = true;
  loop.sensors.w_S[0] = 5.0;
  loop.operator_input.request = ModeRequest::kRun;
  loop.run(400);
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
  EXPECT_GT(loop.record.twin.dq_a.norm(), 0.05);
}

// Of the twin's reference wrench, in the first cycle of a stop.
double force_while_stopping(bool is_alone) {
  Loop loop;
  loop.sensors.safety.override_key = is_alone;
  loop.sensors.dead_man = !is_alone;
  for (const ModeRequest request : {ModeRequest::kNone, ModeRequest::kArm,
                                    is_alone ? ModeRequest::kAutonomous : ModeRequest::kRun}) {
    loop.operator_input.request = request;
    loop.step();
  }
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
  loop.operator_input.request = ModeRequest::kNone;
  loop.operator_input.change = {Parameter::kReferenceWrench, 0, 2.0};
  loop.run(1);
  loop.operator_input.change = {};
  loop.run(400);
  EXPECT_GT(loop.record.budget.surface.norm(), 1.0);
  // a person takes hold, or requests a stop
  loop.sensors.dead_man = true;
  if (!is_alone) loop.operator_input.request = ModeRequest::kStop;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kStopping);
  return loop.record.budget.surface.norm();
}

TEST(Cycle, OnlyARequestedStopLetsForcesFadeOut) {
  EXPECT_GT(force_while_stopping(false), 1.0);
  EXPECT_EQ(force_while_stopping(true), 0.0);
}

TEST(Cycle, AFaultLastsUntilItIsResetAndThenRunsAgain) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(300);
  const double speed = loop.record.v_H.norm();
  ASSERT_GT(speed, 0.1);
  loop.sensors.safety.emergency_stop = true;
  const int cycles = expect_controlled_stop(loop, FaultCode::kEmergencyStop, Stop::kSs1);
  EXPECT_GT(cycles, 100);
  EXPECT_LT(cycles, 1000);
  loop.operator_input.request = ModeRequest::kReset;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  EXPECT_EQ(loop.record.refusal, Refusal::kCauseRemains);
  loop.operator_input.request = ModeRequest::kNone;
  loop.sensors.safety.emergency_stop = false;
  loop.run(10);
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  reset(loop);
  loop.start_running();
  EXPECT_EQ(loop.record.fault.code, FaultCode::kNone);
}

TEST(Cycle, TheEmergencyStopOfThePanelStopsADeviceWithoutOne) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(300);
  loop.operator_input.panel.emergency_stop = true;
  expect_controlled_stop(loop, FaultCode::kEmergencyStop, Stop::kSs1);
  loop.operator_input.request = ModeRequest::kReset;
  loop.step();
  EXPECT_EQ(loop.record.refusal, Refusal::kCauseRemains);
  loop.operator_input.request = ModeRequest::kNone;
  loop.operator_input.panel.emergency_stop = false;
  loop.run(10);
  reset(loop);
  loop.start_running();
  EXPECT_EQ(loop.record.fault.code, FaultCode::kNone);
}

TEST(Cycle, SensorsCutOffByAnEmergencyStopLeaveEstimationIntact) {
  Loop loop;
  loop.start_running();
  loop.run(20);
  const SensorFrame good = loop.sensors;
  loop.sensors.safety.emergency_stop = true;
  loop.sensors.q_p[0] = loop.sensors.q_m[0] = std::numeric_limits<double>::quiet_NaN();
  expect_safe_stop(loop, FaultCode::kEmergencyStop);
  const std::uint64_t sequence = loop.sensors.sequence;
  loop.sensors = good;
  loop.sensors.sequence = sequence;
  loop.operator_input.request = ModeRequest::kReset;
  loop.step();
  loop.start_running();
  loop.run(50);
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
  EXPECT_TRUE(loop.command.q_m.allFinite() && loop.record.robot.q_p.allFinite());
}

void expect_to_run_again(Loop& loop) {
  loop.operator_input.request = ModeRequest::kReset;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kReady);
  loop.start_running();
  loop.run(50);
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
  EXPECT_TRUE(loop.command.enable);
  EXPECT_TRUE(loop.command.tau_m.allFinite());
  EXPECT_TRUE(loop.record.robot.dtheta_m.allFinite() && loop.record.robot.w_H.allFinite());
}

TEST(Cycle, ANanOfAnySensorOfATorqueLoopIsAFaultAndLeavesNothingBehind) {
  using Corrupt = void (*)(SensorFrame&, double);
  const std::array<Corrupt, 4> corruptions = {[](SensorFrame& s, double x) { s.theta_m[2] += x; },
                                              [](SensorFrame& s, double x) { s.tau_m[0] += x; },
                                              [](SensorFrame& s, double x) { s.a_S[1] += x; },
                                              [](SensorFrame& s, double x) { s.omega_S[2] += x; }};
  for (const Corrupt corrupt : corruptions) {
    Loop loop(false, true, true);
    loop.run(110);
    loop.start_running();
    const SensorFrame good = loop.sensors;
    corrupt(loop.sensors, std::numeric_limits<double>::quiet_NaN());
    expect_safe_stop(loop, FaultCode::kSensorNotFinite);
    loop.sensors.theta_m = good.theta_m;
    loop.sensors.tau_m = good.tau_m;
    loop.sensors.a_S = good.a_S;
    loop.sensors.omega_S = good.omega_S;
    expect_to_run_again(loop);
  }
}

TEST(Cycle, ATorqueThatIsNotFiniteIsAFaultAndAResetRestarts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool in_estimation : {false, true}) {
    Loop loop(false, true);
    loop.run(110);
    loop.start_running();
    CycleState state = loop.cycle->state();
    if (in_estimation) state.estimation.motor[1].dtheta = nan;
    if (!in_estimation) state.control.friction[1] = nan;
    loop.cycle->restore(state);
    expect_safe_stop(loop, FaultCode::kCommandNotFinite);
    EXPECT_GE(loop.record.fault.index, 18);  // behind q, q', q''
    expect_to_run_again(loop);
  }
}

TEST(Cycle, ATorqueLoopIsNotArmedBeforeAHundredCommandsWereAnswered) {
  for (const std::uint64_t latency : {0U, 2U}) {
    Loop loop(false, true);
    loop.latency = latency;
    loop.run(50);
    loop.operator_input.request = ModeRequest::kArm;
    loop.step();
    EXPECT_EQ(loop.record.mode, Mode::kReady);
    EXPECT_EQ(loop.record.refusal, Refusal::kLatencyUnknown);
    EXPECT_FALSE(loop.record.is_latency_known);
    loop.operator_input.request = ModeRequest::kNone;
    loop.run(100);
    EXPECT_EQ(loop.record.is_latency_known, latency > 0);
    loop.operator_input.request = ModeRequest::kArm;
    loop.step();
    EXPECT_EQ(loop.record.mode, latency > 0 ? Mode::kArmed : Mode::kReady);
  }
  Loop drives;  // have no torque loop
  drives.latency = 0;
  drives.start_running();
}

// Cycles after a change of the latency until the device stops; -1: it does not.
int cycles_until_latency_fault(std::uint64_t before, const std::vector<std::uint64_t>& after) {
  Loop loop(false, true);
  loop.latency = before;
  loop.run(200);
  loop.start_running();
  for (int k = 0; k < 1000; ++k) {
    loop.latency = after[k % after.size()];
    loop.step();
    if (loop.record.mode != Mode::kFault) continue;
    EXPECT_EQ(loop.record.fault.code, FaultCode::kLatencyGrew);
    EXPECT_FALSE(loop.command.enable);
    return k;
  }
  return -1;
}

TEST(Cycle, ALatencyThatGrowsWhileTheDrivesAreOnStopsTheDevice) {
  EXPECT_NEAR(cycles_until_latency_fault(1, {2}), 50, 2);
  EXPECT_NEAR(cycles_until_latency_fault(2, {9}), 50, 2);
  EXPECT_NEAR(cycles_until_latency_fault(2, {0}), 50, 2);           // answers no more
  EXPECT_GT(cycles_until_latency_fault(1, {3, 3, 1, 3, 3, 1}), 0);  // mostly late
  EXPECT_EQ(cycles_until_latency_fault(1, {1}), -1);
  EXPECT_EQ(cycles_until_latency_fault(3, {1, 2, 3}), -1);
  // frames that were lost and filled in, see docs/reference/device_protocol.md
  EXPECT_EQ(cycles_until_latency_fault(1, {2, 3, 4, 1, 1, 1, 1}), -1);
}

// Commands of so many periods do not reach the device, and from the period `at` on (-1: never) a
// joint comes away from its reference. The fault; kNone: it continues.
FaultCode fault_of_lost_commands(int periods, int at, bool has_torque_loop = true) {
  Loop loop(false, has_torque_loop, false);
  loop.run(200);
  loop.start_running();
  loop.run(100);
  for (int k = 0; k < 300; ++k) {
    loop.latency = k < periods ? static_cast<std::uint64_t>(k) + 2 : 1;
    if (at >= 0 && k >= at) loop.sensors.q_m[2] += std::min(0.02 * (k - at), 0.5);
    loop.step();
    if (loop.record.fault.code == FaultCode::kNone) continue;
    EXPECT_GT(loop.record.fault.value, loop.record.fault.limit);
    return loop.record.fault.code;
  }
  return FaultCode::kNone;
}

TEST(Cycle, CommandsThatDoNotReachTheDeviceAreTheCauseThatIsNamed) {
  for (const bool has_torque_loop : {true, false}) {
    EXPECT_EQ(fault_of_lost_commands(300, -1, has_torque_loop), FaultCode::kCommandsLost);
    EXPECT_EQ(fault_of_lost_commands(11, -1, has_torque_loop), FaultCode::kCommandsLost);
    EXPECT_EQ(fault_of_lost_commands(9, -1, has_torque_loop), FaultCode::kNone);
    EXPECT_EQ(fault_of_lost_commands(40, 10, has_torque_loop), FaultCode::kCommandsLost);
  }
  // another cause is reported, too
  EXPECT_EQ(fault_of_lost_commands(0, 10), FaultCode::kSpeedExceeded);
  EXPECT_EQ(fault_of_lost_commands(3, 3), FaultCode::kSpeedExceeded);
  EXPECT_EQ(fault_of_lost_commands(9, 150), FaultCode::kSpeedExceeded);
}

TEST(Cycle, TheTwinMeetsTheHandleAgainAfterAFaultInMotion) {
  Loop loop;
  loop.start_running();
  loop.sensors.safety.emergency_stop = true;
  expect_controlled_stop(loop, FaultCode::kEmergencyStop, Stop::kSs1);
  loop.sensors.safety.emergency_stop = false;
  for (int k = 0; k < 13; ++k) {
    loop.sensors.q_p[0] += 0.003;  // the gantry gives way a little in its brake
    loop.step();
  }
  loop.operator_input.request = ModeRequest::kReset;
  loop.run(1000);
  EXPECT_LT(loop.record.sync_error, 1e-6);
  loop.start_running();
  loop.run(50);
  EXPECT_EQ(loop.record.mode, Mode::kRunning);
}

TEST(Cycle, AFallingArmIsReportedThoughAnotherSensorIsNotFinite) {
  Loop loop(false, false, true);
  loop.start_running();
  loop.sensors.a_S[1] = std::numeric_limits<double>::quiet_NaN();
  loop.step();
  EXPECT_EQ(loop.record.fault.code, FaultCode::kSensorNotFinite);
  for (int k = 0; k < 200; ++k) {
    loop.sensors.q_m[4] += 1e-3;
    loop.step();
  }
  EXPECT_EQ(loop.record.fault.code, FaultCode::kBrakesSlip);
  EXPECT_EQ(loop.record.fault.index, 4);
  EXPECT_EQ(loop.record.warning.code, FaultCode::kSensorNotFinite) << "the first cause, besides";
  loop.sensors.a_S.setZero();
  loop.operator_input.request = ModeRequest::kReset;
  loop.run(10);
  EXPECT_EQ(loop.record.mode, Mode::kFault);
  EXPECT_EQ(loop.record.refusal, Refusal::kNone);  // it was said in the cycle of the request
}

TEST(Cycle, HandleAndTwinApartIsAFault) {
  Loop loop;
  loop.start_running();
  CycleState state = loop.cycle->state();
  state.rendering.twin.q_a[0] += 0.03;
  loop.cycle->restore(state);
  expect_controlled_stop(loop, FaultCode::kSyncLost, Stop::kSs2);
}

// the largest speed of the joints falls with no more than their rating, under power, to rest
TEST(Cycle, WithoutASolutionTheJointsBrakeAndAResetRunsAgain) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(400);
  const double speed = loop.record.reference.dq_m.lpNorm<Eigen::Infinity>();
  ASSERT_GT(speed, 0.05);
  CycleState state = loop.cycle->state();
  state.rendering.twin.q_a[1] = std::numeric_limits<double>::quiet_NaN();
  loop.cycle->restore(state);
  loop.step();
  const FaultCode code = loop.record.fault.code;
  EXPECT_TRUE(code == FaultCode::kSolverFailed || code == FaultCode::kReferenceNotFinite);
  EXPECT_LT(loop.command.dq_m.lpNorm<Eigen::Infinity>(), speed);
  EXPECT_TRUE(loop.command.dq_p.isZero());
  const int cycles = expect_controlled_stop(loop, code, Stop::kSs2);
  EXPECT_GT(cycles, 5);
  EXPECT_LT(cycles, 1000);
  loop.sensors.w_S[0] = 0.0;
  expect_to_run_again(loop);
}

TEST(Cycle, AReleasedEnablingSwitchEndsReadyAndItsCauseIsReported) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 5.0;
  loop.run(300);
  loop.sensors.safety.operator_enable = false;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kStopping);
  EXPECT_EQ(loop.record.stop, Stop::kSs1);
  EXPECT_EQ(loop.record.fault.code, FaultCode::kOperatorReleased);
  loop.run(1000);
  EXPECT_EQ(loop.record.mode, Mode::kReady);
  EXPECT_EQ(loop.record.fault.code, FaultCode::kNone);
  EXPECT_FALSE(loop.command.enable);
}

TEST(Cycle, TooManyLateCyclesStopTheDevice) {
  Loop loop;
  loop.start_running();
  loop.operator_input.late_cycles = 3;
  expect_controlled_stop(loop, FaultCode::kCycleOverrun, Stop::kSs2);
}

TEST(Cycle, ASnapshotContinuesBitForBit) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S << 2, 1, -3, 0.1, 0.2, 0.1;
  loop.run(100);
  const CycleState snapshot = loop.cycle->state();
  const SensorFrame sensors = loop.sensors;
  const auto gantry_speed = loop.gantry_speed;
  const auto delay = loop.delay;
  std::vector<std::uint64_t> hashes;
  for (int k = 0; k < 100; ++k) {
    loop.step();
    hashes.push_back(loop.record.state_hash);
  }
  loop.cycle->restore(snapshot);
  loop.sensors = sensors;
  loop.gantry_speed = gantry_speed;
  loop.delay = delay;
  for (int k = 0; k < 100; ++k) {
    loop.step();
    ASSERT_EQ(loop.record.state_hash, hashes[k]) << k;
  }
}

// The elbow at its wall and the handle caught by a surface: the state from which another cycle
// continues.
TEST(Cycle, ASnapshotInContactContinuesBitForBitInAnotherCycle) {
  DeviceModel device = rendering::unlimited_device();
  model::ChainData chain(device.chain);
  chain.update_poses(
      (Eigen::VectorXd(8) << Eigen::Vector2d::Zero(), Eigen::VectorXd(kPosture)).finished());
  const Eigen::Vector3d elbow = chain.pose(device.elbow).p;
  const Eigen::Vector3d handle = chain.pose(device.handle).p;
  CartesianLimit wall = {.name = "elbow", .frame = device.elbow};
  for (int axis = 0; axis < 3; ++axis) {
    wall.axes[axis] = {.q_min = elbow[axis] - 0.01, .q_max = elbow[axis] + 0.01, .ddq_max = 5.0};
  }
  device.cartesian_limits = {wall};
  CycleConfig config;
  config.surfaces = {{.name = "floor",
                      .shape = surfaces::Plane{},
                      .pose = {.p = handle - Eigen::Vector3d(0.0, 0.0, 0.002)},
                      .stiffness = 2e4}};
  Loop loop(false, false, false, config, device);
  Loop other(false, false, false, config, device);
  loop.start_running();
  const Eigen::Matrix3d R = chain.pose(device.handle).R;
  loop.sensors.w_S.head<3>() = R.transpose() * Eigen::Vector3d(20.0, 10.0, -40.0);
  const auto acts = [&] {
    return std::ranges::any_of(loop.record.limits, [](const LimitReport& limit) {
      return limit.state != LimitState::kInactive;
    });
  };
  bool is_both = false;
  for (int k = 0; k < 1000 && !is_both; ++k) {
    loop.step();
    is_both = acts() && loop.cycle->state().rendering.contact.dent > 0.0;
  }
  ASSERT_TRUE(is_both);
  other.cycle->restore(loop.cycle->state());
  other.sensors = loop.sensors;
  other.operator_input = loop.operator_input;
  other.gantry_speed = loop.gantry_speed;
  other.delay = loop.delay;
  for (int k = 0; k < 300; ++k) {
    loop.step();
    other.step();
    ASSERT_EQ(other.record.state_hash, loop.record.state_hash) << k;
    ASSERT_EQ(other.command.q_m, loop.command.q_m) << k;
    ASSERT_EQ(other.record.contact.force, loop.record.contact.force) << k;
  }
}

// A person keeps pressing: the stop gives way for a third of its time and then brakes.
TEST(Cycle, AStopByAContactDoesNotGiveWayForLongerThanItMayTake) {
  CycleConfig config;
  config.compliance.is_on = true;
  DeviceModel device = rendering::unlimited_device();
  for (limits::JointLimits& joint : device.joint_limits) {
    joint.dq_max = 0.5;
    joint.ddq_max = 2.0;
  }
  Loop loop(false, true, false, config, device);
  loop.run(200);
  loop.start_running();
  loop.run(100);  // its torque sensors say nothing of its weight: something carries it
  ASSERT_EQ(loop.record.mode, Mode::kRunning);
  ASSERT_TRUE(loop.record.touch.is_reported);
  ASSERT_GT(loop.record.v_H.norm(), 0.05);
  CycleState state = loop.cycle->state();
  safety::break_rule({.code = FaultCode::kTorqueUnexplained}, state.supervisor);
  loop.cycle->restore(state);
  loop.run(200);
  EXPECT_EQ(loop.record.mode, Mode::kStopping);
  EXPECT_GT(loop.record.v_H.norm(), 0.05);  // it still gives way
  const int cycles = 200 + expect_controlled_stop(loop, FaultCode::kTorqueUnexplained, Stop::kSs1);
  EXPECT_GT(cycles, 333);
  EXPECT_LT(cycles, 1000);
}

TEST(Cycle, WhatTouchesTheArmIsNoSurfaceThatPushesBack) {
  Loop loop;
  loop.start_running();
  loop.run(10);
  CycleState state = loop.cycle->state();
  ASSERT_GT(state.passivity.since_pushed_s, 0.0);
  state.rendering.touch[0] = 5.0;
  loop.cycle->restore(state);
  loop.step();
  EXPECT_NEAR(loop.record.budget.surface.norm(), 5.0, 1e-9);
  EXPECT_GT(loop.cycle->state().passivity.since_pushed_s, state.passivity.since_pushed_s);
}

// Stages in the order in which they ended.
void note(void* listener, Stage stage) noexcept {
  static_cast<std::vector<Stage>*>(listener)->push_back(stage);
}

TEST(Cycle, ARunningStepEndsEveryStageInOrder) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S[0] = 3.0;
  std::vector<Stage> stages;
  stages.reserve(100);  // reports of a step must not allocate, either
  loop.cycle->watch({.ended = note, .listener = &stages});
  loop.step();
  const std::vector<Stage> all = {
      Stage::kSupervision, Stage::kEstimation, Stage::kPrepositioning, Stage::kRenderingSetUp,
      Stage::kSolver,      Stage::kReactions,  Stage::kReactions,      Stage::kIntegration,
      Stage::kControl,     Stage::kSafety,     Stage::kStateHash};
  EXPECT_EQ(stages, all);

  loop.cycle->watch({});
  loop.step();
  EXPECT_EQ(stages.size(), all.size());
}

TEST(Cycle, BeingWatchedChangesNothing) {
  Loop watched, alone;
  std::vector<Stage> stages;
  stages.reserve(100'000);
  watched.cycle->watch({.ended = note, .listener = &stages});
  for (Loop* loop : {&watched, &alone}) {
    loop->start_running();
    loop->sensors.w_S << 2, 1, -3, 0.1, 0.2, 0.1;
  }
  for (int k = 0; k < 100; ++k) {
    watched.step();
    alone.step();
    ASSERT_EQ(watched.record.state_hash, alone.record.state_hash) << k;
  }
}

TEST(Cycle, AStepMakesNoAllocation) {
  Loop loop;
  loop.start_running();
  loop.sensors.w_S << 2, 1, -3, 0.1, 0.2, 0.1;
  const AllocationCounter allocations;
  loop.run(200);
  loop.operator_input.request = ModeRequest::kStop;
  loop.run(10);
  loop.sensors.w_S[0] = std::numeric_limits<double>::quiet_NaN();
  loop.run(2);
  EXPECT_EQ(allocations.count(), 0u);
}

TEST(Cycle, ADeviceThatNeedsATareIsNotArmedWithout) {
  Loop loop(true);
  loop.sensors.dead_man = false;
  loop.sensors.w_S[1] = 4.0;  // offset of the sensor
  loop.step();
  EXPECT_FALSE(loop.record.is_tared);
  loop.operator_input.request = ModeRequest::kArm;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kReady);
  EXPECT_EQ(loop.record.refusal, Refusal::kNotTared);
  loop.run(5);
  EXPECT_EQ(loop.record.refusal, Refusal::kNone) << "one request, one answer";

  loop.operator_input.request = ModeRequest::kTare;
  loop.run(499);
  EXPECT_EQ(loop.record.tare, TareStatus::kUnderWay);
  loop.step();
  EXPECT_EQ(loop.record.tare, TareStatus::kDone);
  EXPECT_TRUE(loop.record.is_tared);
  loop.step();
  EXPECT_LT(loop.record.robot.w_H.norm(), 1e-12);
  loop.operator_input.request = ModeRequest::kArm;
  loop.step();
  EXPECT_EQ(loop.record.mode, Mode::kArmed);
  EXPECT_EQ(loop.record.refusal, Refusal::kNone);
}

TEST(Cycle, AnArmRequestThatWasRefusedDoesNotArmLater) {
  Loop loop(true);
  loop.sensors.dead_man = false;
  loop.step();
  loop.operator_input.request = ModeRequest::kTare;
  loop.step();
  loop.operator_input.request = ModeRequest::kArm;  // held down until the tare is done
  loop.run(600);
  EXPECT_TRUE(loop.record.is_tared);
  EXPECT_EQ(loop.record.mode, Mode::kReady);
}

TEST(Cycle, ATareIsRefusedWhileTheHandleIsHeldOrTheDeviceRuns) {
  Loop held(true);
  held.step();
  held.operator_input.request = ModeRequest::kTare;
  held.step();
  EXPECT_EQ(held.record.tare, TareStatus::kRefusedHeld);
  EXPECT_FALSE(held.record.is_tared);

  Loop running;
  running.start_running();
  running.operator_input.request = ModeRequest::kTare;
  running.step();
  EXPECT_EQ(running.record.tare, TareStatus::kRefusedRunning);
  EXPECT_EQ(running.record.mode, Mode::kRunning);
}

}  // namespace
}  // namespace hg::controller
