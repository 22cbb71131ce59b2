// Stops of the whole machine: simulated person, plant, sensors and safety controller around the
// same cycle as in the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/rules.h"
#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/session.h"

namespace hg {
namespace {

config::Scenario shipped_scenario(const std::string& name) {
  return config::load_scenario("models/scenarios/" + name + ".yaml");
}

// An operator who tares, arms and runs, and a panel for the test's hands.
struct Machine {
  config::Scenario scenario;
  scenario::Session session;
  OperatorFrame& input = session.input();
  const SensorFrame& sensors = session.sample().sensors;
  const CommandFrame& command = session.sample().command;
  const CycleRecord& record = session.record();
  bool is_alone = false;      // runs autonomously instead of by hand
  bool requests_next = true;  // makes the next request; false: only the test does
  double handle_speed = 0.0, gantry_speed = 0.0, last_lateness = 0.0;
  int sanitised = 0;

  explicit Machine(config::Scenario s) : scenario(std::move(s)), session(scenario) {}
  explicit Machine(const std::string& name) : Machine(shipped_scenario(name)) {}

  void step() {
    if (requests_next) session.request(next());
    session.advance();
    const Truth& truth = *session.device().truth();
    handle_speed = truth.twist.head<3>().norm();
    gantry_speed = truth.dq_p.norm();
    if (record.sanitised != 0) ++sanitised;
  }
  ModeRequest next() const {
    if (record.mode == Mode::kArmed && is_alone) return ModeRequest::kAutonomous;
    return runtime::next_request(record, session.cycle().is_held(sensors), false);
  }
  // until `condition` holds; false when it does not within `seconds`
  template <typename Condition>
  bool run_until(Condition condition, double seconds) {
    const auto cycles = static_cast<int>(seconds * scenario.device.model.rate_Hz);
    for (int k = 0; k < cycles; ++k) {
      step();
      if (condition()) return true;
    }
    return false;
  }
  void run(double seconds) {
    run_until([] { return false; }, seconds);
  }
  bool run_until_fast(double speed) {
    return run_until([&] { return record.mode == Mode::kRunning && handle_speed > speed; }, 20.0);
  }
  void make(ModeRequest request) {
    requests_next = false;
    step();
    session.request(request);
    step();
  }
  // of the safety controller
  void press_reset() {
    input.panel.reset = true;
    step();
    input.panel.reset = false;
    step();
  }
};

TEST(Safety, SensorErrorsTriggerNoRuleInShippedScenarios) {
  struct Case {
    const char* name;
    double rate_Hz;
    person::HandPreset hand;
    unsigned seed;
  };
  using enum person::HandPreset;
  const Case cases[] = {{"door", 1000, kNormal, 2},        {"door", 2000, kStiff, 3},
                        {"excavator", 1000, kStiff, 4},    {"excavator", 2000, kRelaxed, 5},
                        {"free_space", 1000, kRelaxed, 6}, {"free_space", 2000, kNormal, 7},
                        {"path", 1000, kStiff, 8},         {"walk", 1000, kNormal, 9},
                        {"walk", 2000, kRelaxed, 10}};
  for (const Case& c : cases) {
    config::Scenario s = shipped_scenario(c.name);
    s.device.model.rate_Hz = c.rate_Hz;
    s.script.hand = person::hand(c.hand);
    s.device.simulation.seed = s.device.simulation.sensors.seed = c.seed;
    Machine machine(std::move(s));
    const double seconds = scenario::planned_duration_s(machine.scenario);
    const bool has_stopped =
        machine.run_until([&] { return machine.record.fault.code != FaultCode::kNone; }, seconds);
    EXPECT_FALSE(has_stopped) << c.name << " " << c.rate_Hz << " Hz at " << machine.record.time_s
                              << " s: " << to_string(machine.record.fault.code) << " "
                              << machine.record.fault.index << " " << machine.record.fault.value;
    EXPECT_EQ(machine.sanitised, 0) << c.name << " " << c.rate_Hz;
  }
}

TEST(Safety, AfterAnEmergencyStopAResetLeadsBackToRunning) {
  Machine machine("path");
  ASSERT_TRUE(machine.run_until_fast(0.6));
  machine.input.panel.emergency_stop = true;
  const double pressed = machine.record.time_s;
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kStopping; }, 0.05));
  EXPECT_EQ(machine.record.stop, Stop::kSs1);
  EXPECT_EQ(machine.record.fault.code, FaultCode::kEmergencyStop);
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kFault; }, 2.0));
  EXPECT_EQ(machine.record.stop, Stop::kSs1) << "it came to rest without the safety controller";
  EXPECT_LT(machine.record.time_s - pressed, 1.0);
  EXPECT_LT(machine.handle_speed, 0.1);
  EXPECT_FALSE(machine.command.enable);

  machine.make(ModeRequest::kReset);
  EXPECT_EQ(machine.record.refusal, Refusal::kCauseRemains);
  machine.input.panel.emergency_stop = false;
  machine.run(0.1);
  machine.make(ModeRequest::kReset);
  EXPECT_EQ(machine.record.refusal, Refusal::kCauseRemains) << "the safety controller has latched";
  machine.press_reset();
  machine.make(ModeRequest::kReset);
  EXPECT_EQ(machine.record.mode, Mode::kReady);
  machine.requests_next = true;
  EXPECT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kRunning; }, 5.0));
}

TEST(Safety, AnOperatorWhoLetsGoStopsItAndHoldingAgainStartsNothing) {
  Machine machine("path");
  ASSERT_TRUE(machine.run_until_fast(0.6));
  machine.requests_next = false;
  machine.input.panel.operator_enable = false;
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kReady; }, 2.0));
  EXPECT_EQ(machine.record.fault.code, FaultCode::kNone);
  EXPECT_FALSE(machine.command.enable);
  machine.make(ModeRequest::kArm);
  EXPECT_EQ(machine.record.refusal, Refusal::kOperatorReleased);
  machine.input.panel.operator_enable = true;
  machine.run(0.2);
  EXPECT_EQ(machine.record.mode, Mode::kReady);
  machine.make(ModeRequest::kArm);
  EXPECT_EQ(machine.record.mode, Mode::kArmed);
}

// A program that has gone mad keeps its drives on and moves: the power goes all the same.
TEST(Safety, TheSafetyControllerTakesThePowerAwayWhateverTheProgramDoes) {
  Machine machine("path");
  ASSERT_TRUE(machine.run_until_fast(0.6));
  CommandFrame mad = machine.command;
  mad.panel.emergency_stop = true;
  device::Device& device = machine.session.device();
  SensorFrame sensors;
  for (int k = 0; k < 2500; ++k) {
    device.read(sensors);
    mad.sequence = sensors.sequence;
    device.write(mad);
  }
  EXPECT_TRUE(mad.enable);
  EXPECT_LT(device.truth()->dtheta_m.lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_LT(device.truth()->dq_p.norm(), 1e-3);
}

config::Scenario without_person() {
  config::Scenario s = shipped_scenario("free_space");
  s.person = person::PersonKind::kNone;
  s.script.script.grasp_s = kInfinity;  // nor is the dead-man switch closed
  return s;
}

// pushed by its twin's own force
void run_alone(Machine& machine) {
  machine.is_alone = true;
  machine.input.panel.override_key = true;
  machine.run_until([&] { return machine.record.mode == Mode::kRunning; }, 5.0);
  EXPECT_TRUE(machine.record.is_autonomous);
  machine.input.change = {Parameter::kReferenceWrench, 0, 15.0};
  machine.step();
  machine.input.change = {Parameter::kReferenceWrench, 1, -15.0};
  machine.step();
}

TEST(Safety, WithoutAHandItNeverMovesFasterThanTheSafeSpeed) {
  Machine machine(without_person());
  run_alone(machine);
  double handle = 0.0, gantry = 0.0;
  machine.run_until(
      [&] {
        handle = std::max(handle, machine.handle_speed);
        gantry = std::max(gantry, machine.gantry_speed);
        return machine.record.mode != Mode::kRunning;
      },
      4.0);
  EXPECT_EQ(machine.record.mode, Mode::kRunning) << to_string(machine.record.fault.code);
  EXPECT_GT(handle, 0.15);
  EXPECT_LE(handle, 0.25);
  EXPECT_LE(gantry, 0.25);
}

TEST(Safety, APersonInTheFieldStopsADeviceThatMovesAlone) {
  Machine machine(without_person());
  run_alone(machine);
  machine.run(1.0);
  ASSERT_GT(machine.handle_speed, 0.1);
  machine.input.panel.person_in_field = true;
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kStopping; }, 0.15));
  EXPECT_EQ(machine.record.fault.code, FaultCode::kScannerField);
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kFault; }, 2.0));
  machine.make(ModeRequest::kReset);
  EXPECT_EQ(machine.record.refusal, Refusal::kCauseRemains);
  machine.input.panel.person_in_field = false;
  machine.run(0.2);
  machine.press_reset();
  machine.make(ModeRequest::kReset);
  EXPECT_EQ(machine.record.mode, Mode::kReady);
}

TEST(Safety, TurningTheKeyBackHoldsADeviceThatMovesAlone) {
  Machine machine(without_person());
  run_alone(machine);
  machine.run(1.0);
  machine.requests_next = false;
  machine.input.panel.override_key = false;
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kArmed; }, 2.0));
  EXPECT_EQ(machine.record.fault.code, FaultCode::kNone);
  machine.make(ModeRequest::kAutonomous);
  EXPECT_EQ(machine.record.refusal, Refusal::kNoOverride);
}

TEST(Safety, AStopFromFullSpeedIsOverWithinItsTime) {
  Machine machine("path");
  ASSERT_TRUE(machine.run_until([&] { return machine.gantry_speed > 1.2; }, 43.0));
  machine.input.panel.emergency_stop = true;
  const double pressed = machine.record.time_s;
  ASSERT_TRUE(machine.run_until([&] { return machine.record.mode == Mode::kFault; }, 2.0));
  EXPECT_EQ(machine.record.stop, Stop::kSs1) << to_string(machine.record.warning.code);
  RecordProperty("stop_ms", static_cast<int>(1e3 * (machine.record.time_s - pressed)));
}

}  // namespace
}  // namespace hg
