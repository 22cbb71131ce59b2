#include "hg/device/franka/franka_device.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <thread>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/device/franka/test/fake_robot.h"

namespace hg::franka {
namespace {

constexpr double kLong = 60.0;  // s; only a broken test waits for so long
constexpr int kMany = 5000;     // cycles; the same

const model::ChainModel& arm() {
  static const model::ChainModel chain =
      model::ChainModel::from_urdf_file("models/arms/fr3/fr3.urdf");
  return chain;
}

FrankaConfig config_for(const FakeRobot& robot) {
  FrankaConfig config;
  config.address = robot.address();
  config.load.mass = 0.35;
  config.flange = "fr3_link8";
  config.timeouts = {.connect_s = kLong, .answer_s = kLong, .first_state_s = kLong};
  config.state_timeout_s = kLong;
  config.settle_s = 0.0;
  config.rest_s = 0.005;
  return config;
}

std::string message_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

std::string refusal_of(const Behaviour& behaviour) {
  const FakeRobot robot(behaviour);
  return message_of([&] { FrankaDevice device(config_for(robot), arm()); });
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

// A robot, its device, and a controller that holds the posture.
struct Bench {
  explicit Bench(const Behaviour& behaviour = {}, double state_timeout_s = kLong,
                 Interface interface = Interface::kTorques)
      : robot(behaviour) {
    FrankaConfig config = config_for(robot);
    config.state_timeout_s = state_timeout_s;
    config.interface = interface;
    device = std::make_unique<FrankaDevice>(config, arm());
    command.q_m = VectorM::Zero(kJoints);
    command.dq_m = command.ddq_m = command.q_m;
    device->read(sensors);
    robot.send_one();
  }
  ~Bench() { robot.send_freely(); }
  void cycle() {
    // a state that is still under way is read first: an answer to an older one is not sent
    if (static_cast<int>(sensors.sequence) >= robot.newest) robot.send_one();
    device->read(sensors);
    command.sequence = sensors.sequence;
    if (!is_led) command.q_m = sensors.q_m;
    device->write(command);
  }
  bool cycle_until(const std::function<bool()>& is_so) {
    for (int i = 0; i < kMany && !is_so(); ++i) cycle();
    return is_so();
  }
  bool start() {
    command.enable = true;
    const int before = robot.commands.load();
    return cycle_until([&] { return robot.commands.load() > before; });
  }
  bool has(FaultCode code) const { return sensors.driver_fault == code; }

  FakeRobot robot;
  std::unique_ptr<FrankaDevice> device;
  SensorFrame sensors;
  CommandFrame command;
  bool is_led = false;  ///< the test chooses the reference
};

TEST(FrankaDevice, SetsLoadAndThresholds) {
  Bench bench;
  EXPECT_EQ(bench.robot.load().mass, 0.35);
  EXPECT_EQ(bench.robot.collision().upper_force[0], CollisionThresholds().force[0]);
  EXPECT_EQ(bench.robot.collision().lower_torque[6], CollisionThresholds().torque[6]);
}

TEST(FrankaDevice, SeesTheWeightOfTheToolWithItsSign) {
  EXPECT_TRUE(Bench().device->has_checked_signs());
  EXPECT_FALSE(Bench({.weight_per_kg = 0.0F}).device->has_checked_signs());
}

TEST(FrankaDevice, GivesOneFramePerState) {
  Bench bench;
  bench.cycle();
  const SensorFrame first = bench.sensors;
  bench.cycle();
  EXPECT_EQ(bench.sensors.sequence, first.sequence + 1);
  EXPECT_NEAR(bench.sensors.time_s - first.time_s, 1e-3, 1e-9);
  ASSERT_EQ(bench.sensors.q_m.size(), kJoints);
  EXPECT_NEAR(bench.sensors.q_m[3], -2.091, 1e-6);
  EXPECT_TRUE(bench.sensors.dead_man);
  EXPECT_TRUE(bench.has(FaultCode::kNone));
  EXPECT_TRUE(bench.device->is_clock());
}

TEST(FrankaDevice, RestsUntilDrivesAreOn) {
  Bench bench;
  for (int i = 0; i < 20; ++i) bench.cycle();
  EXPECT_EQ(bench.robot.motions.load(), 0);
  EXPECT_EQ(bench.robot.commands.load(), 0);
}

TEST(FrankaDevice, MovesWhileDrivesAreOn) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  EXPECT_TRUE(bench.robot.is_moving());
  bench.command.enable = false;
  EXPECT_TRUE(bench.cycle_until([&] { return !bench.robot.is_moving(); }));
  ASSERT_TRUE(bench.start());  // and again
  EXPECT_EQ(bench.robot.motions.load(), 2);
  EXPECT_TRUE(bench.has(FaultCode::kNone));
}

TEST(FrankaDevice, LimitsTheRateOfTorques) {
  Bench bench;
  bench.is_led = true;
  bench.command.q_m = VectorM{{0.2, 0.028, 0, -2.091, 0, 2.119, 0}};  // far away: 120 Nm are wanted
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.cycle_until([&] { return bench.robot.last_torques()[0] > 80.0; }));
  EXPECT_LT(bench.robot.largest_step(), 1.0);
  EXPECT_GT(bench.robot.largest_step(), 0.9);
  for (int i = 0; i < 20; ++i) bench.cycle();
  EXPECT_LE(bench.robot.last_torques()[0], 87.0);
}

TEST(FrankaDevice, LeadsBySpeedsWithinWhatTheRobotAllows) {
  Bench bench({}, kLong, Interface::kSpeeds);
  bench.is_led = true;
  const double goal = 0.1;  // rad, far away for one period
  bench.command.q_m = VectorM{{goal, 0.028, 0, -2.091, 0, 2.119, 0}};
  ASSERT_TRUE(bench.start());
  const AllocationCounter counter;
  ASSERT_TRUE(bench.cycle_until([&] { return bench.robot.speed(0) > 0.5; }));
  ASSERT_TRUE(bench.cycle_until([&] { return std::abs(bench.sensors.q_m[0] - goal) < 1e-3; }));
  EXPECT_EQ(counter.count(), 0U);
  EXPECT_GT(bench.robot.largest_acceleration(), 5.0);
  EXPECT_LE(bench.robot.largest_acceleration(), 10.0);
  EXPECT_LE(bench.robot.largest_jerk(), 5000.0);
  EXPECT_TRUE(bench.has(FaultCode::kNone));
}

TEST(FrankaDevice, BrakesBeforeItEndsAMotionBySpeeds) {
  Bench bench({}, kLong, Interface::kSpeeds);
  bench.is_led = true;
  bench.command.q_m = VectorM{{0.5, 0.028, 0, -2.091, 0, 2.119, 0}};
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.cycle_until([&] { return bench.robot.speed(0) > 0.5; }));
  bench.command.enable = false;
  ASSERT_TRUE(bench.cycle_until([&] { return !bench.robot.is_moving(); }));
  EXPECT_LE(bench.robot.largest_acceleration(), 10.0);
  EXPECT_LE(bench.robot.largest_jerk(), 5000.0);
  bench.command.enable = true;
  EXPECT_TRUE(bench.cycle_until([&] { return bench.robot.is_moving(); }));
  EXPECT_TRUE(bench.has(FaultCode::kNone));
}

TEST(FrankaDevice, AllocatesNothingInTheLoop) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  const auto allocations_until = [&](FaultCode fault) {
    const std::function<bool()> is_there = [&] { return bench.has(fault); };
    const AllocationCounter counter;
    EXPECT_TRUE(bench.cycle_until(is_there));
    return counter.count();
  };
  bench.robot.reflex(32);
  EXPECT_EQ(allocations_until(FaultCode::kDriveFault), 0U);
  bench.robot.leave();
  EXPECT_EQ(allocations_until(FaultCode::kDeviceGone), 0U);
}

TEST(FrankaDevice, SubtractsTheEstimateAtRest) {
  Behaviour behaviour;
  Bench bench(behaviour);
  bench.cycle();
  EXPECT_NEAR(bench.sensors.w_S.norm(), 0.0, 1e-6);
  behaviour.K_F_ext = {-9.75F, 0, 0, 0, 0, 0};  // the robot on its surroundings: pushed along x
  bench.robot.set(behaviour);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.sensors.w_S[0] > 1.0; }));
  EXPECT_NEAR(bench.sensors.w_S[0], 10.0, 1e-6);
}

TEST(FrankaDevice, CountsAndFillsInLostStates) {
  Bench bench;
  // past what was sent before the robot waits for this test: a socket may have dropped some of it
  for (int i = 0; i < 500; ++i) bench.cycle();
  const LinkCounts before = bench.device->counts();
  const std::uint64_t sequence = bench.sensors.sequence;
  bench.robot.lose(2);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.device->counts().lost > before.lost; }));
  EXPECT_EQ(bench.device->counts().lost, before.lost + 2);
  bench.cycle_until([&] { return bench.device->counts().held >= before.held + 2; });
  EXPECT_EQ(bench.device->counts().held, before.held + 2);
  EXPECT_GT(bench.sensors.sequence, sequence);
}

TEST(FrankaDevice, CountsWhatTheRobotDidNotGetInTime) {
  Bench bench({.success_rate = 0.97F});
  ASSERT_TRUE(bench.start());
  const std::uint64_t before = bench.device->counts().late;
  for (int i = 0; i < 1000; ++i) bench.cycle();
  EXPECT_GE(bench.device->counts().late, before + 27);
  EXPECT_LE(bench.device->counts().late, before + 33);
}

TEST(FrankaDevice, NamesAReflexInTheRobotsWordsAndRecovers) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.reflex(32);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kDriveFault); }));
  const int commands = bench.robot.commands.load();
  for (int i = 0; i < 20; ++i) bench.cycle();
  EXPECT_EQ(bench.robot.commands.load(), commands);  // drives on, but not before it has recovered
  expect_says(bench.device->farewell(), "controller_torque_discontinuity");
  expect_says(bench.device->farewell(), "mode 'reflex'");
  bench.command.enable = false;
  bench.command.panel.reset = true;
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kNone); }));
  EXPECT_EQ(bench.robot.recoveries.load(), 1);
  EXPECT_EQ(bench.device->farewell(), "");
  EXPECT_TRUE(bench.start());
}

TEST(FrankaDevice, CommandsThatDidNotArriveAreAFaultOfTheirOwn) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.reflex(kCommunicationError);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.sensors.driver_fault != FaultCode::kNone; }));
  EXPECT_TRUE(bench.has(FaultCode::kCommandsLost));
  expect_says(bench.device->farewell(), "communication_constraints_violation");
}

TEST(FrankaDevice, ARefusedMotionIsNamed) {
  Bench bench(Behaviour{.accepts_moves = false});
  bench.command.enable = true;
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kDriveFault); }));
  expect_says(bench.device->farewell(), "rejected: not possible in the present mode");
  bench.robot.set({});
  bench.command.enable = false;
  bench.command.panel.reset = true;
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kNone); }));
  EXPECT_EQ(bench.robot.recoveries.load(), 0);  // there is nothing to recover from
  EXPECT_TRUE(bench.start());
}

TEST(FrankaDevice, ARecoveryThatFailsIsNamed) {
  Bench bench(Behaviour{.recovers = false});
  ASSERT_TRUE(bench.start());
  bench.robot.reflex(6);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kDriveFault); }));
  bench.command.enable = false;
  bench.command.panel.reset = true;
  const auto is_reported = [&] {
    return bench.device->farewell().find("recovery must be done by hand") != std::string::npos;
  };
  EXPECT_TRUE(bench.cycle_until(is_reported));
  EXPECT_TRUE(bench.has(FaultCode::kDriveFault));
}

TEST(FrankaDevice, TheUserStopIsAnEmergencyStop) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.press_user_stop(true);
  ASSERT_TRUE(bench.cycle_until([&] { return bench.sensors.safety.emergency_stop; }));
  const int motions = bench.robot.motions;
  for (int i = 0; i < 20; ++i) bench.cycle();
  EXPECT_EQ(bench.robot.motions, motions);  // no motion is asked for meanwhile
  bench.command.enable = false;
  bench.robot.press_user_stop(false);
  ASSERT_TRUE(bench.cycle_until([&] { return !bench.sensors.safety.emergency_stop; }));
  EXPECT_TRUE(bench.has(FaultCode::kNone));
  EXPECT_TRUE(bench.start());
}

TEST(FrankaDevice, AStopWhoseAnswerOvertakesTheStatesAsksForNoMotion) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  const int newest = bench.robot.newest, motions = bench.robot.motions;
  bench.robot.send_one();  // still shows the motion
  while (bench.robot.newest == newest) std::this_thread::yield();
  bench.robot.press_user_stop(true);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // until the answer is there
  bench.device->read(bench.sensors);
  EXPECT_FALSE(bench.sensors.safety.emergency_stop);
  bench.command.sequence = bench.sensors.sequence;
  bench.device->write(bench.command);
  EXPECT_TRUE(bench.cycle_until([&] { return bench.sensors.safety.emergency_stop; }));
  EXPECT_EQ(bench.robot.motions, motions);
}

TEST(FrankaDevice, ACommandThatIsNotFiniteIsNotSent) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.is_led = true;
  bench.command.q_m = VectorM::Zero(kJoints);
  bench.command.q_m[3] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kCommandNotFinite); }));
  EXPECT_TRUE(bench.cycle_until([&] { return !bench.robot.is_moving(); }));
  for (const double tau : bench.robot.last_torques()) EXPECT_TRUE(std::isfinite(tau));
  expect_says(bench.device->farewell(), "not finite");
}

TEST(FrankaDevice, SilenceEndsTheSession) {
  Bench bench({}, 0.05);
  bench.cycle();
  bench.robot.set({.sends_states = false});
  ASSERT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kDeviceSilent); }));
  const std::uint64_t sequence = bench.sensors.sequence;
  bench.robot.set({});
  bench.cycle();
  EXPECT_TRUE(bench.has(FaultCode::kDeviceSilent));  // for good
  EXPECT_EQ(bench.sensors.sequence, sequence + 1);
}

TEST(FrankaDevice, ARobotThatLeavesIsGone) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.leave();
  EXPECT_TRUE(bench.cycle_until([&] { return bench.has(FaultCode::kDeviceGone); }));
}

TEST(FrankaDevice, ALateAnswerIsNotSent) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.send_one();
  bench.device->read(bench.sensors);
  const std::uint64_t late = bench.device->counts().late, sent = bench.device->counts().sent;
  bench.command.sequence = bench.sensors.sequence - 1;
  bench.device->write(bench.command);
  EXPECT_EQ(bench.device->counts().late, late + 1);
  EXPECT_EQ(bench.device->counts().sent, sent);
}

TEST(FrankaDevice, AnswersEachStateOnce) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  std::uint64_t sent = bench.device->counts().sent;
  const auto has_answered = [&] { return bench.device->counts().sent > sent; };
  ASSERT_TRUE(bench.cycle_until(has_answered));
  sent = bench.device->counts().sent;
  bench.command.enable = false;
  bench.device->write(bench.command);  // the state has its answer: the end waits for the next one
  EXPECT_EQ(bench.device->counts().sent, sent);
  EXPECT_TRUE(bench.cycle_until([&] { return !bench.robot.is_moving(); }));
}

TEST(FrankaDevice, EndsItsMotionWhenItGoesAndConnectsAgain) {
  Bench bench;
  ASSERT_TRUE(bench.start());
  bench.robot.send_freely();
  bench.device.reset();
  EXPECT_FALSE(bench.robot.is_moving());
  bench.device = std::make_unique<FrankaDevice>(config_for(bench.robot), arm());
  EXPECT_EQ(bench.robot.connections.load(), 2);
  bench.device->read(bench.sensors);
  EXPECT_TRUE(bench.start());
}

TEST(FrankaDevice, MovesToAStartAndStopsThere) {
  FakeRobot robot({.yields = true});
  FrankaDevice device(config_for(robot), arm());
  const VectorM start{{0.02, 0.04, 0, -2.1, 0, 2.13, 0}};
  device.move_to(start);
  SensorFrame sensors;
  device.read(sensors);
  EXPECT_LT((sensors.q_m - start).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kNone);
  EXPECT_FALSE(robot.is_moving());
  EXPECT_EQ(robot.collision().upper_force[0], CollisionThresholds().force[0]);
}

TEST(FrankaDevice, AMoveToAStartThatIsRefusedSaysWhy) {
  const FakeRobot robot({.accepts_moves = false});
  FrankaDevice device(config_for(robot), arm());
  expect_says(message_of([&] { device.move_to(VectorM::Zero(kJoints)); }),
              "stopped on its way to the start: robot in mode 'idle'; motion rejected");
}

TEST(FrankaDevice, RecoversFromAnOldReflexFirst) {
  Bench bench(Behaviour{.mode = RobotMode::kReflex});
  EXPECT_EQ(bench.robot.recoveries.load(), 1);
  EXPECT_TRUE(bench.start());
}

TEST(FrankaDevice, RefusesWhatItCannotUse) {
  expect_says(refusal_of({.mode = RobotMode::kUserStopped}), "it is in mode 'user stopped'");
  expect_says(refusal_of({.m_ee = 0.73F}), "Desk knows an end effector of 0.73 kg");
  expect_says(refusal_of({.K_F_ext = {}}), "exactly zero");
  expect_says(refusal_of({.K_F_ext = {0, 0, 15.0F, 0, 0, 0}}), "15.0 N");
  expect_says(refusal_of({.weight_per_kg = -9.81F}), "sign or frame of the estimate differ");
  // the estimate of a server that does not subtract gravity, as franky-sim
  Impedance impedance(arm(), {});
  const VectorM weight = impedance.weight(VectorM{{0, 0.028, 0, -2.091, 0, 2.119, 0}});
  Behaviour heavy;
  for (int i = 0; i < kJoints; ++i) heavy.tau_ext[i] = static_cast<float>(weight[i]);
  expect_says(refusal_of(heavy), "contains the weight of the arm");
  heavy.m_ee = 0.73F;  // the server's fault comes before what the user can change
  expect_says(refusal_of(heavy), "contains the weight of the arm");
}

}  // namespace
}  // namespace hg::franka
