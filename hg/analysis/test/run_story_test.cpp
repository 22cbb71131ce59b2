#include "hg/analysis/run_story.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "hg/controller/safety/rules.h"

namespace hg::analysis {
namespace {

Names names() {
  return {.joints = {"m1", "m2"},
          .gantry = {"p1"},
          .pairs = {"column - forearm"},
          .limits = {{LimitKind::kManipulatorJoint, "m1", true, {-1.0, 1.0}},
                     {LimitKind::kManipulatorJoint, "m2", true, {-1.0, 1.0}},
                     {LimitKind::kTwinJoint, "hinge {}", true, {0.0, 1.0}}}};
}

// A run of `seconds` at 1 kHz, armed at 0.1 s and running from 0.2 s on, that `change` alters.
std::vector<Entry> explained(double seconds,
                             const std::function<void(double, Sample&)>& change = {}) {
  RunStory story(names());
  for (int k = 0; k < static_cast<int>(1000.0 * seconds); ++k) {
    Sample sample;
    const double t = 1e-3 * k;
    sample.record.time_s = t;
    sample.record.mode = t < 0.1 ? Mode::kReady : (t < 0.2 ? Mode::kArmed : Mode::kRunning);
    sample.record.limit_count = 3;
    sample.record.solver_status = SolverStatus::kSolved;
    sample.record.robot.w_H[0] = 5.0;
    sample.sensors.dq_m = VectorM::Zero(2);
    sample.sensors.dead_man = t >= 0.2;
    sample.command.enable = t >= 0.1;
    if (change) change(t, sample);
    story.add(sample);
  }
  return story.finish();
}

std::vector<Entry> of_kind(const std::vector<Entry>& entries, const std::string& kind) {
  std::vector<Entry> found;
  for (const Entry& entry : entries) {
    if (entry.kind == kind) found.push_back(entry);
  }
  return found;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool has_detail(const Entry& entry, const std::string& part) {
  for (const std::string& detail : entry.details) {
    if (has(detail, part)) return true;
  }
  return false;
}

TEST(RunStory, ReportsMissingSamples) {
  RunStory story(names());
  for (const std::uint64_t cycle : {5U, 6U, 7U, 10U, 11U, 500U}) {
    Sample sample;
    sample.record.cycle = cycle;
    sample.record.time_s = 1e-3 * static_cast<double>(cycle);
    story.add(sample);
  }
  const auto lost = of_kind(story.finish(), "LOST");
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost[0].time_s, 0.007);
  EXPECT_TRUE(has(lost[0].text, "490 samples")) << lost[0].text;
  EXPECT_TRUE(has(lost[0].text, "2 gaps, the longest 0.489 s")) << lost[0].text;
}

TEST(RunStory, ReportsOnlyModesOfAnUneventfulRun) {
  const auto entries = explained(0.5);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].text, "off -> ready");
  EXPECT_EQ(entries[1].text, "ready -> armed");
  EXPECT_NEAR(entries[1].time_s, 0.1, 1e-9);
  EXPECT_TRUE(has(entries[2].text, "armed -> running: the user holds the handle"));
}

TEST(RunStory, ReportsWhyARunStops) {
  const auto stopped = [](bool lets_go) {
    return of_kind(explained(0.5,
                             [=](double t, Sample& sample) {
                               if (t < 0.4) return;
                               sample.record.mode = Mode::kStopping;
                               sample.sensors.dead_man = !lets_go;
                               if (!lets_go) sample.operator_input.request = ModeRequest::kStop;
                             }),
                   "mode")
        .back()
        .text;
  };
  EXPECT_TRUE(has(stopped(true), "let go of the handle"));
  EXPECT_TRUE(has(stopped(false), "a stop was requested"));
}

TEST(RunStory, ReportsWhyAnAutonomousRunStops) {
  const auto stopped = [](bool is_held, bool is_key_turned) {
    return of_kind(explained(1.0,
                             [&](double t, Sample& sample) {
                               sample.sensors.dead_man = false;
                               sample.sensors.safety.override_key = true;
                               sample.record.is_autonomous = t < 0.5;
                               if (t < 0.5) return;
                               sample.record.mode = Mode::kStopping;
                               sample.sensors.dead_man = is_held;
                               sample.sensors.safety.override_key = is_key_turned;
                             }),
                   "mode")
        .back()
        .text;
  };
  EXPECT_TRUE(has(stopped(false, false), "the override key was turned off"));
  EXPECT_TRUE(has(stopped(true, true), "the handle was grasped"));
}

TEST(RunStory, JoinsSpansAcrossShortInterruptions) {
  const auto entries =
      of_kind(explained(2.0,
                        [](double t, Sample& sample) {
                          LimitReport& hinge = sample.record.limits[2];
                          const bool acts = (t > 0.3 && t < 0.5) || (t > 0.6 && t < 0.7) || t > 1.5;
                          if (!acts) return;
                          hinge.state = LimitState::kUpper;
                          hinge.cause = LimitCause::kPosition;
                          hinge.reaction = t < 1.0 ? -12.5 : 3.0;
                        }),
              "limit");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_TRUE(has(entries[0].text, "hinge {}: upper position limit")) << entries[0].text;
  EXPECT_TRUE(has(entries[0].text, "up to -12.5 Nm, for 0.298 s until 0.699 s")) << entries[0].text;
  EXPECT_NEAR(entries[1].time_s, 1.501, 1e-9);
}

TEST(RunStory, ExplainsAFaultAndTheReaction) {
  const auto entries = explained(1.0, [](double t, Sample& sample) {
    if (t > 0.35 && t < 0.4) sample.record.robot.w_H[0] = 60.0;
    if (t < 0.4) return;
    sample.record.mode = Mode::kFault;
    sample.record.stop = Stop::kSs1;
    sample.record.fault = {FaultCode::kTrackingLost, 1, 0.083, 0.08};
    if (t < 0.52) sample.sensors.dq_m[0] = 0.5;
    sample.command.enable = t < 0.45;
  });
  const auto faults = of_kind(entries, "FAULT");
  ASSERT_EQ(faults.size(), 1u);
  const Entry& fault = faults.front();
  EXPECT_TRUE(has(fault.text, "302 ")) << fault.text;
  EXPECT_TRUE(has(fault.text, "tracking (m2: 0.083, limit 0.08)")) << fault.text;
  const safety::Rule& rule = safety::rule_of(FaultCode::kTrackingLost);
  EXPECT_TRUE(has_detail(fault, std::string(fault_words(FaultCode::kTrackingLost).meaning)));
  EXPECT_TRUE(has_detail(fault, std::string(rule.release)));
  EXPECT_TRUE(has_detail(fault, "SS1"));
  EXPECT_TRUE(has_detail(fault, "drives off 50 ms after the fault"));
  EXPECT_TRUE(has_detail(fault, "119 ms after the fault"));  // the last motion was seen then
  EXPECT_TRUE(has_detail(fault, "60.0 N"));
}

TEST(RunStory, ReportsAnUnseenStandstill) {
  const auto entries = explained(0.45, [](double t, Sample& sample) {
    if (t < 0.4) return;
    sample.record.mode = Mode::kFault;
    sample.record.fault = {FaultCode::kSensorNotFinite, 13, std::nan(""), 0.0};
    sample.sensors.dq_m[1] = -0.7;
    sample.sensors.q_m = sample.sensors.theta_m = sample.sensors.tau_m = VectorM::Zero(2);
  });
  const auto faults = of_kind(entries, "FAULT");
  ASSERT_EQ(faults.size(), 1u);
  // link encoders 0, 1, speeds 2, 3, wrench 4 .. 9, motors 10, 11, torques 12, 13
  EXPECT_TRUE(has(faults[0].text, "(torque sensor m2: not finite)")) << faults[0].text;
  EXPECT_TRUE(has_detail(faults[0], "not seen: 49 ms later"));
  EXPECT_TRUE(has_detail(faults[0], "0.700"));
}

TEST(RunStory, ReportsWarningsRefusalsLateCyclesAndTheSanitiser) {
  const auto entries = explained(1.0, [](double t, Sample& sample) {
    if (t > 0.3 && t < 0.4) {
      sample.record.warning = {FaultCode::kTrackingLost, 0, 0.05, 0.08};
      sample.record.sanitised = 1U << 1 | 1U << 16;
    }
    if (std::abs(t - 0.5) < 1e-6) {
      sample.record.refusal = Refusal::kNotTared;
      sample.operator_input.late_cycles = 3;
      sample.record.solver_status = SolverStatus::kBudgetSpent;
    }
    if (t > 0.7 && t < 0.8) sample.record.warning = {FaultCode::kOscillation, 4, 1.0, 1.0};
  });
  ASSERT_EQ(of_kind(entries, "warning").size(), 2u);
  EXPECT_TRUE(has(of_kind(entries, "warning")[0].text, "tracking (m1), stops at 0.08, up to 0.05"));
  EXPECT_TRUE(has(
      of_kind(entries, "warning")[1].text,
      "oscillation (bouncing on a surface): hand and device oscillate against each other, for "));
  EXPECT_EQ(of_kind(entries, "command").size(), 2u);
  EXPECT_EQ(of_kind(entries, "refused").size(), 1u);
  EXPECT_TRUE(has(of_kind(entries, "late")[0].text, "up to 3"));
  EXPECT_TRUE(has(of_kind(entries, "solver")[0].text, "before its result was proven"));
}

TEST(RunStory, OperatorReleaseIsNoFault) {
  const auto entries = explained(1.0, [](double t, Sample& sample) {
    if (t < 0.4 || t >= 0.8) return;
    sample.record.mode = t < 0.5 ? Mode::kStopping : Mode::kReady;
    sample.record.stop = Stop::kSs1;
    sample.record.fault = {FaultCode::kOperatorReleased, -1, 0.0, 1.0};
  });
  EXPECT_TRUE(of_kind(entries, "FAULT").empty());
  EXPECT_TRUE(of_kind(entries, "reset").empty());
  EXPECT_EQ(of_kind(entries, "mode")[3].text,
            "running -> stopping: the operator let go of the enabling switch");
}

TEST(RunStory, AcceptsARecordingThatBeginsLate) {
  RunStory story(names());
  Sample sample;
  sample.record.mode = Mode::kRunning;
  sample.record.tare = TareStatus::kDone;
  for (std::uint64_t cycle = 2376; cycle < 2500; ++cycle) {
    sample.record.cycle = cycle;
    sample.record.time_s = 1e-3 * static_cast<double>(cycle);
    if (cycle == 2400) sample.record.mode = Mode::kStopping;
    story.add(sample);
  }
  EXPECT_NEAR(story.first_s(), 2.376, 1e-9);
  const auto entries = story.finish();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].text.rfind("running -> stopping", 0), 0u) << entries[0].text;
}

TEST(FaultFigures, NameThePartTheValueAndTheLimit) {
  SensorFrame sensors;
  sensors.q_m = sensors.dq_m = VectorM::Zero(2);
  const auto text = [&](FaultCode code, int index, double value, double limit) {
    const Fault fault{code, static_cast<std::int16_t>(index), value, limit};
    return figures_of(fault, names(), sensors);
  };
  EXPECT_EQ(text(FaultCode::kMotorDeviates, 1, 40.0, 30.0), "m2: 40, limit 30");
  EXPECT_EQ(text(FaultCode::kAccelerationExceeded, 0, 9.0, 8.0), "m1: 9, limit 8");
  EXPECT_EQ(text(FaultCode::kSensorJump, 1, 0.2, 0.1), "m2: 0.2, limit 0.1");
  EXPECT_EQ(text(FaultCode::kSensorJump, 2, 0.2, 0.1), "p1: 0.2, limit 0.1");  // after the joints
  EXPECT_EQ(text(FaultCode::kGantryExceeded, 0, 3.0, 2.0), "p1: 3, limit 2");
  EXPECT_EQ(text(FaultCode::kLimitExceeded, 2, 0.3, 0.1), "hinge {}: 0.3, limit 0.1");
  EXPECT_EQ(text(FaultCode::kWrenchTooLarge, 1, 30.0, 20.0), "torque in Nm: 30, limit 20");
  EXPECT_EQ(text(FaultCode::kSyncLost, -1, 0.3, 0.1), "0.3, limit 0.1");
  EXPECT_EQ(text(FaultCode::kEmergencyStop, -1, 1.0, 0.0), "");  // yes or no
  EXPECT_EQ(text(FaultCode::kOscillation, 3, 3.1, 3.0), "torque above 30 Hz");
  EXPECT_EQ(text(FaultCode::kDeviceSilent, -1, 0.0, 0.0), "");
  EXPECT_EQ(text(FaultCode::kBusErrors, -1, 1.0, 0.0), "1, limit 0");
  EXPECT_EQ(text(FaultCode::kCollisionAhead, 0, 0.029, 0.03),
            "column - forearm: 0.029, limit 0.03");
  EXPECT_EQ(text(FaultCode::kSensorFrozen, 1, 20.0, 20.0), "torque sensor m2: 20, limit 20");
  EXPECT_EQ(text(FaultCode::kSensorFrozen, 4, 20.0, 20.0),
            "force/torque sensor, component 3: 20, limit 20");
  EXPECT_EQ(text(FaultCode::kSensorNotFinite, 3, NAN, 0.0), "speed m2: not finite");
  EXPECT_EQ(text(FaultCode::kSensorNotFinite, 5, NAN, 0.0),
            "force/torque sensor, component 2: not finite");
  EXPECT_EQ(text(FaultCode::kSensorNotFinite, 16, NAN, 0.0), "clock: not finite");
  EXPECT_EQ(text(FaultCode::kSensorIncomplete, 4, 0.0, 2.0), "motor encoder: 0 values, 2 expected");
  EXPECT_EQ(text(FaultCode::kCommandNotFinite, 5, NAN, 0.0), "acceleration m2: not finite");
}

TEST(RunStory, SurvivesInvalidRecords) {
  RunStory nothing({});
  EXPECT_TRUE(nothing.finish().empty());
  RunStory story({});  // without names
  Sample sample;
  sample.record.limit_count = kMaxLimits;
  sample.record.mode = Mode::kRunning;
  for (int code = 0; code < 400; ++code) {
    sample.record.time_s = code;
    sample.record.sanitised = 0xffffffffU;
    for (LimitReport& limit : sample.record.limits) limit.state = LimitState::kViolated;
    sample.record.fault = {static_cast<FaultCode>(code), static_cast<std::int16_t>(code), 1.0,
                           std::numeric_limits<double>::infinity()};
    sample.record.warning = sample.record.fault;
    story.add(sample);
  }
  EXPECT_GT(story.finish().size(), 400u);
}

}  // namespace
}  // namespace hg::analysis
