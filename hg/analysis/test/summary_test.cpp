#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "hg/analysis/events.h"
#include "hg/analysis/summary.h"

namespace hg::analysis {
namespace {

LimitCatalogue catalogue() {
  return {{LimitKind::kManipulatorJoint, "m4", true, {0.2, 2.45}},
          {LimitKind::kTwinJoint, "hinge", true, {0.0, 1.75}}};
}

CycleRecord running(double time_s) {
  CycleRecord record;
  record.mode = Mode::kRunning;
  record.solver_status = SolverStatus::kSolved;
  record.time_s = time_s;
  record.reference.q_m = VectorM::Zero(6);
  record.twin.q_a = ConfigurationA::Zero(2);
  record.robot.q_p = VectorP::Zero(2);
  record.limit_count = 2;
  return record;
}

EventRule rule(const char* name, std::vector<Condition> all_of) {
  return {name, "", std::move(all_of)};
}

TEST(Summary, ARunThatIsOverBeforeTheDeviceRunsHasItsDuration) {
  Summary summary(catalogue(), {}, 1000.0);
  CycleRecord record = running(0.4);
  record.mode = Mode::kReady;
  Sample sample;
  sample.record = record;
  summary.add(sample);
  const RunFacts facts = {.scenario = "Door", .wall_time_s = 0.1};
  EXPECT_NE(summary.to_text(facts, {}).find(
                "Door, 0.4 s in 0.1 s (4.0x real time): over before the device was running"),
            std::string::npos)
      << summary.to_text(facts, {});
}

TEST(EventDetector, FindsRulesInTheirOrderOnly) {
  EventDetector detector(
      {rule("opened", {{.kind = ConditionKind::kTwinAbove, .index = 0, .value = 1.0}}),
       rule("closed", {{.kind = ConditionKind::kTwinBelow, .index = 0, .value = 0.1}})},
      catalogue());
  CycleRecord record = running(0.0);
  EXPECT_FALSE(detector.observe(record));  // closed, but it has not been open
  record.twin.q_a[0] = 1.2;
  ASSERT_TRUE(detector.observe(record));
  EXPECT_EQ(detector.missing(), std::vector<std::string>{"closed"});
  record.twin.q_a[0] = 0.0;
  EXPECT_EQ(detector.observe(record)->name, "closed");
  EXPECT_TRUE(detector.missing().empty());
}

TEST(EventDetector, ALimitIsHitWhenItActsAndIsNear) {
  const Condition upper{.kind = ConditionKind::kLimit, .index = 0, .side = LimitState::kUpper};
  EventDetector detector({rule("hit", {upper})}, catalogue());
  CycleRecord record = running(1.0);
  LimitReport& limit = record.limits[0];
  limit.to_upper = 0.004;
  EXPECT_FALSE(detector.observe(record));  // near, but inactive
  limit.state = LimitState::kUpper;
  limit.to_upper = 0.2;
  EXPECT_FALSE(detector.observe(record));  // active (braking), but not near
  limit.to_upper = 0.004;
  limit.cause = LimitCause::kLock;
  EXPECT_FALSE(detector.observe(record));  // a lock is not the limit
  limit.cause = LimitCause::kPosition;
  EXPECT_TRUE(detector.observe(record));
}

TEST(EventDetector, AllConditionsMustHoldTogether) {
  EventDetector detector({rule("leaning", {{.kind = ConditionKind::kLocked, .index = 1},
                                           {.kind = ConditionKind::kForceAbove, .value = 10.0}})},
                         catalogue());
  CycleRecord record = running(0.0);
  record.robot.w_H[0] = 11.0;
  EXPECT_FALSE(detector.observe(record));
  record.limits[1].cause = LimitCause::kLock;
  record.robot.w_H[0] = 9.0;
  EXPECT_FALSE(detector.observe(record));
  record.robot.w_H[0] = 11.0;
  EXPECT_TRUE(detector.observe(record));
}

TEST(EventDetector, WithoutRulesEveryLimitThatBeginsToActIsAnEvent) {
  EventDetector detector({}, catalogue());
  CycleRecord record = running(0.0);
  EXPECT_FALSE(detector.observe(record));
  record.limits[1].state = LimitState::kLower;
  record.limits[1].to_lower = 0.0;
  record.limits[0].state = LimitState::kUpper;
  record.limits[0].to_upper = 0.0;
  EXPECT_EQ(detector.observe(record)->name, "m4");
  EXPECT_EQ(detector.observe(record)->what, "lower limit reached");  // at the same time: hinge
  EXPECT_FALSE(detector.observe(record));
}

TEST(EventDetector, ALimitThatIsPressedWithAChangingForceIsReachedOnce) {
  EventDetector detector({}, catalogue());
  CycleRecord record = running(0.0);
  EXPECT_FALSE(detector.observe(record));
  const auto press = [&](LimitState state, double to_lower) {
    record.limits[1].state = state;
    record.limits[1].to_lower = to_lower;
    return detector.observe(record).has_value();
  };
  EXPECT_TRUE(press(LimitState::kLower, 0.0));
  EXPECT_FALSE(press(LimitState::kInactive, 1e-3));
  EXPECT_FALSE(press(LimitState::kLower, 0.0));
  EXPECT_FALSE(press(LimitState::kInactive, 0.1));  // it has moved away
  EXPECT_TRUE(press(LimitState::kLower, 0.0));
}

TEST(EventDetector, WithoutRulesLocksThatOpenAndCloseAreEvents) {
  EventDetector detector({}, catalogue());
  CycleRecord record = running(0.0);
  record.limits[1].state = LimitState::kLower;
  record.limits[1].cause = LimitCause::kLock;
  EXPECT_FALSE(detector.observe(record));  // it began locked
  record.limits[1] = {};
  EXPECT_EQ(detector.observe(record)->what, "unlocked");
  record.limits[1].cause = LimitCause::kLock;
  EXPECT_EQ(detector.observe(record)->what, "locked");
  record.limits[1].cause =
      LimitCause::kPosition;  // the bolt opens while the door rests on its stop
  record.limits[1].state = LimitState::kLower;
  record.limits[1].to_lower = 0.0;
  EXPECT_EQ(detector.observe(record)->what, "unlocked");
}

TEST(EventDetector, TurnsAndSpeedLimitsHaveASide) {
  EventDetector detector(
      {rule("back", {{.kind = ConditionKind::kTurns, .index = 0, .value = -1.0}}),
       rule("fast",
            {{.kind = ConditionKind::kSpeedLimit, .index = 1, .side = LimitState::kLower}})},
      catalogue());
  CycleRecord record = running(0.0);
  EXPECT_FALSE(detector.observe(record));
  record.reference.q_m[0] = 6.3;
  EXPECT_FALSE(detector.observe(record));
  record.reference.q_m[0] = -6.3;
  EXPECT_EQ(detector.observe(record)->name, "back");
  record.limits[1].cause = LimitCause::kVelocity;
  record.limits[1].state = LimitState::kUpper;
  EXPECT_FALSE(detector.observe(record));
  record.limits[1].state = LimitState::kLower;
  EXPECT_EQ(detector.observe(record)->name, "fast");
}

Sample known(int k) {
  Sample sample;
  sample.record = running(1e-3 * k);
  sample.record.reference.q_m = VectorM::Zero(2);
  sample.record.tracking.torque_share = VectorM::Constant(2, 0.1);
  sample.truth.is_known = true;
  sample.truth.q_m = sample.truth.tau_motor = VectorM::Zero(2);
  return sample;
}

TruthSummary truth() {
  const auto positions = [](const Truth& truth, std::vector<double>& values) {
    values = {truth.q_m[0]};
  };
  return {catalogue(), positions, 1000.0, VectorM::Constant(2, 20.0)};
}

TEST(TruthSummary, JudgesTheTrueLinksNotTheBelievedOnes) {
  TruthSummary summary = truth();
  for (int k = 0; k < 100; ++k) {
    Sample sample = known(k);
    sample.truth.q_m << (k == 50 ? 2.452 : 1.0), 0.0;  // m4 ends at 2.45
    sample.record.reference.q_m << 1.0, (k == 70 ? 1.5 : 0.0);
    sample.truth.T_B_H.p.x() = k == 20 ? 3e-3 : 0.0;
    summary.add(sample);
  }
  EXPECT_NEAR(summary.worst_excess()[0], 2e-3, 1e-12);
  EXPECT_NEAR(summary.max_joint_error(), 1.5, 1e-12);
  EXPECT_EQ(summary.worst_joint(), 1);
  EXPECT_NEAR(summary.max_hand_distance(), 3e-3, 1e-12);
}

TEST(TruthSummary, LimitsCountInEveryModeAndJointsWhileTheyAreStopped) {
  TruthSummary summary = truth();
  for (const Mode mode : {Mode::kRunning, Mode::kStopping, Mode::kFault}) {
    Sample sample = known(0);
    sample.record.mode = mode;
    const double beyond = mode == Mode::kFault ? 0.02 : 0.0;
    sample.truth.q_m << 2.45 + beyond, (mode == Mode::kStopping ? 0.3 : 0.0);
    sample.record.reference.q_m << 2.45, 0.0;
    summary.add(sample);
  }
  EXPECT_NEAR(summary.worst_excess()[0], 0.02, 1e-12);
  EXPECT_NEAR(summary.max_joint_error(), 0.3, 1e-12);
}

TEST(TruthSummary, TorquesAreComparedWithWhatTheMotorsCanGiveForEver) {
  TruthSummary summary = truth();
  EXPECT_EQ(summary.rated_torque_share().size(), 0);
  for (int k = 0; k < 1000; ++k) {
    Sample sample = known(k);
    sample.truth.tau_motor << 10.0, (k % 2 == 0 ? 30.0 : -30.0);
    sample.record.tracking.torque_share[1] = k == 10 ? 1.2 : 0.3;
    summary.add(sample);
  }
  EXPECT_NEAR(summary.rated_torque_share()[0], 0.5, 1e-12);
  EXPECT_NEAR(summary.rated_torque_share()[1], 1.5, 1e-12);
  EXPECT_EQ(summary.max_torque_share()[1], 1.2);
}

TEST(TruthSummary, VibrationIsWhatIsFasterThanPeopleMove) {
  const auto vibration_at = [](double f_Hz) {
    TruthSummary summary = truth();
    for (int k = 0; k < 20000; ++k) {
      Sample sample = known(k);
      sample.truth.acceleration[1] = std::sin(2.0 * std::numbers::pi * f_Hz * 1e-3 * k);
      summary.add(sample);
    }
    return std::pair(summary.vibration(), summary.vibration_20());
  };
  const double rms = std::numbers::sqrt2 / 2.0;
  EXPECT_LT(vibration_at(0.5).first, 0.011 * rms);                              // (0.5 / 5)^2
  EXPECT_NEAR(vibration_at(5.0).first, rms * std::numbers::sqrt2 / 2.0, 0.01);  // -3 dB
  EXPECT_NEAR(vibration_at(50.0).first, rms, 0.01);
  EXPECT_NEAR(vibration_at(20.0).second, rms * std::numbers::sqrt2 / 2.0, 0.01);
}

TEST(Summary, ReportsATimedOutStop) {
  const Summary summary(catalogue(), {}, 1000.0);
  const auto text = [&](const RunFacts& facts) { return summary.to_text(facts, {}); };
  EXPECT_EQ(text({}).find("timed out"), std::string::npos);
  EXPECT_NE(text({.stop_timed_out = true}).find("timed out"), std::string::npos);
  EXPECT_EQ(text({}).find("LOST"), std::string::npos);
  EXPECT_NE(text({.dropped = 7}).find("7 samples: neither analysed nor recorded"),
            std::string::npos);
  EXPECT_NE(text({.unrecorded = 8}).find("8 samples of the recording"), std::string::npos);
  EXPECT_NE(text({.recording_error = "disk full"}).find("0 samples of the recording: disk full"),
            std::string::npos);
  const auto json = summary.to_json({.stop_timed_out = true, .recording_error = "disk full"}, {});
  EXPECT_EQ(json["recording_error"].get<std::string>(), "disk full");
  EXPECT_TRUE(json["stop_timed_out"].get<bool>());
  EXPECT_FALSE(json["real_time"].get<bool>());
}

TEST(Summary, SaysThatEventsAreInOrderOnlyWhereSomeWereExpected) {
  Summary summary(catalogue(), {}, 1000.0);
  summary.add(RunEvent{.name = "upper limit", .time_s = 1.0, .what = ""});
  const auto text = [&](const RunFacts& facts, const std::vector<std::string>& missing) {
    return summary.to_text(facts, missing);
  };
  EXPECT_NE(text({}, {}).find("events       1 seen, none was expected\n"), std::string::npos);
  EXPECT_NE(text({.expects_events = true}, {}).find("events       1 of 1 in order\n"),
            std::string::npos);
  EXPECT_NE(text({.expects_events = true}, {"shut"}).find("1 happened; missing: shut"),
            std::string::npos);
}

TEST(Summary, NamesTheLawThatLeadsTheGantry) {
  const Summary summary(catalogue(), {}, 1000.0);
  RunFacts facts = {.law = "gauss", .bounds = "recoverable", .gantry = "rule"};
  EXPECT_NE(summary.to_text(facts, {}).find("gauss, recoverable bounds\n"), std::string::npos);
  facts.gantry = "law";
  EXPECT_NE(summary.to_text(facts, {}).find("bounds, gantry led by the law\n"), std::string::npos);
  const auto json = summary.to_json(facts, {});
  EXPECT_EQ(json["gantry"].get<std::string>(), "law");
}

TEST(Summary, NamesPlantAndSensorsOfASimulation) {
  const Summary summary(catalogue(), {}, 1000.0);
  const RunFacts facts = {.plant = "ideal drives", .sensors = "encoders ideal"};
  EXPECT_NE(summary.to_text(facts, {}).find("plant        ideal drives\n"), std::string::npos);
  EXPECT_EQ(summary.to_json(facts, {})["sensors"].get<std::string>(), "encoders ideal");
  EXPECT_FALSE(summary.to_json({}, {}).contains("plant"));  // a machine
}

TEST(Summary, ReportsWhereLimitsBrakeTogether) {
  const Summary summary(catalogue(), {}, 1000.0);
  RunFacts facts = {.law = "gauss", .bounds = "recoverable", .braking = "alone"};
  EXPECT_NE(summary.to_text(facts, {}).find("gauss, recoverable bounds\n"), std::string::npos);
  facts.braking = "together";
  EXPECT_NE(summary.to_text(facts, {}).find("bounds, limits brake together\n"), std::string::npos);
  const auto json = summary.to_json(facts, {});
  EXPECT_EQ(json["braking"].get<std::string>(), "together");
}

TEST(Summary, ReportsHowOftenTheBudgetOfTheSolverWasSpent) {
  Summary summary(catalogue(), {}, 1000.0);
  const auto has = [&](const char* part) {
    return summary.to_text({}, {}).find(part) != std::string::npos;
  };
  for (int k = 0; k < 5; ++k) {
    Sample sample;
    sample.record = running(1e-3 * k);
    if (k >= 3) sample.record.solver_status = SolverStatus::kBudgetSpent;
    EXPECT_EQ(has("not proven"), k > 3);
    summary.add(sample);
  }
  EXPECT_TRUE(has("3 solved, 2 not proven, 0 not")) << summary.to_text({}, {});
  EXPECT_EQ(summary.to_json({}, {})["solver"]["status"]["budget spent"], 2);
}

TEST(Summary, TheJsonHoldsWhatScriptsNeed) {
  Summary summary(catalogue(), {}, 1000.0);
  Sample sample;
  for (int k = 0; k < 10; ++k) {
    sample.record = running(1e-3 * k);
    sample.record.limits[1].excess = 1e-3;
    sample.record.robot.w_H[1] = 4.0;
    sample.record.a_H = Eigen::Vector3d(k, 0, 0);
    sample.record.active_set_changes = 1;
    sample.cycle_time_us = k;
    summary.add(sample);
  }
  summary.add(RunEvent{"open", 0.5, "the door is open"});
  const auto json = summary.to_json({.version = "1.2.3"}, {"closed"});
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["events"][0]["name"], "open");
  EXPECT_EQ(json["events"][0]["time_s"], 0.5);
  EXPECT_EQ(json["missing_events"][0], "closed");
  EXPECT_EQ(json["limits"]["hinge"]["worst_violation"], 1e-3);
  EXPECT_EQ(json["limits"]["m4"]["worst_violation"], 0.0);
  EXPECT_EQ(json["force"]["mean_N"], 4.0);
  EXPECT_EQ(json["solver"]["status"]["solved"], 10);
  EXPECT_NEAR(json["solver"]["active_set_changes_per_second"].get<double>(), 10 / 9e-3, 1e-6);
  EXPECT_NEAR(json["acceleration_change_per_cycle"]["median"].get<double>(), 1.0, 0.01);
  EXPECT_EQ(json["cycle_time_us"]["max"], 9.0);
  EXPECT_EQ(json["allocations_in_loop"], 0);
  EXPECT_TRUE(json["limits_held"].get<bool>());
}

TEST(Summary, MoreThanFiveMilliradiansOutsideIsALimitExceeded) {
  Summary summary(catalogue(), {}, 1000.0);
  Sample sample;
  sample.record = running(0.0);
  sample.record.limits[0].excess = 5.1e-3;
  summary.add(sample);
  EXPECT_FALSE(summary.limits_held());
}

TEST(Summary, ReportsThatHandAndDeviceShookEachOther) {
  Summary summary(catalogue(), {}, 1000.0);
  Sample sample;
  for (int n = 0; n < 1000; ++n) {
    sample.record = running(1e-3 * n);
    if (n >= 300 && n < 550) sample.record.warning = {FaultCode::kOscillation, 2, 1.0, 1.0};
    EXPECT_EQ(summary.has_shaken(), n > 300);
    summary.add(sample);
  }
  EXPECT_NE(summary.to_text({}, {}).find("SHAKING      hand and device oscillate against each "
                                         "other, 0.25 s in all, first at 0.300 s: "
                                         "force above 30 Hz"),
            std::string::npos);
  const auto json = summary.to_json({}, {});
  EXPECT_NEAR(json["shaking"]["duration_s"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(json["shaking"]["what"], "force above 30 Hz");
}

}  // namespace
}  // namespace hg::analysis
