#include "hg/runtime/runtime.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <semaphore>
#include <thread>
#include <utility>
#include <vector>

#include "hg/core/allowed_to_wait.h"
#include "hg/core/error.h"
#include "hg/core/index.h"
#include "hg/core/monotonic_clock.h"
#include "hg/core/schedule.h"
#include "hg/hqp/problem_capture.h"
#include "hg/runtime/test/still_device.h"

namespace hg::runtime {
namespace {

RuntimeReport run(Parts& parts, const RuntimeOptions& options, std::uint64_t& seen) {
  Runtime runtime(options, *parts.cycle, parts.device);
  runtime.start();
  auto sample = std::make_unique<Sample>();
  seen = 0;
  while (true) {
    const bool is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) ++seen;
    if (is_finished) break;
  }
  return runtime.join();
}

TEST(Runtime, FastModePlaysTheWholeDurationAndLosesNoSample) {
  Parts parts;
  std::uint64_t seen = 0;
  const RuntimeReport report = run(parts, {.is_fast = true, .duration_s = 0.5, .ring = 16}, seen);
  EXPECT_GE(report.cycles, 501u);
  EXPECT_LE(report.cycles, 501u + 1000u);
  EXPECT_EQ(seen, report.cycles);
  EXPECT_EQ(report.dropped, 0u);
  EXPECT_FALSE(report.stop_timed_out);
  EXPECT_EQ(report.allocations, 0u);
}

TEST(Runtime, ADeviceThatIsTheClockIsNotWaitedFor) {
  Parts parts;
  parts.device.keeps_time = true;
  std::uint64_t seen = 0;
  const RuntimeReport report = run(parts, {.duration_s = 6.0}, seen);
  EXPECT_GE(report.cycles, 6001u);
  EXPECT_EQ(report.wake_up_us.count(), 0u);  // it never slept
}

TEST(Runtime, KeepsProblemsOfSlowCyclesOnly) {
  for (const bool all_are_slow : {false, true}) {
    Parts parts;
    RuntimeOptions options = {.is_fast = true, .duration_s = 0.05};
    if (all_are_slow) options.slow_cycle_us = 0.0;
    Runtime runtime(options, *parts.cycle, parts.device);
    runtime.start();
    const RuntimeReport report = runtime.join();
    EXPECT_EQ(report.allocations, 0u);
    EXPECT_EQ(runtime.kept_problems().count(), all_are_slow ? report.cycles : 0u);
    const std::size_t kept = all_are_slow ? hqp::ProblemCapture::kMostSolved : 0u;
    ASSERT_EQ(runtime.kept_problems().size(), kept);
    for (std::size_t i = 0; i < kept; ++i) {
      EXPECT_EQ(runtime.kept_problems()[i].cycle, i);
      EXPECT_GT(runtime.kept_problems()[i].cycle_time_us, 0.0);
    }
  }
}

TEST(Runtime, RealTimeModePlaysTheWholeDuration) {
  Parts parts;
  std::uint64_t seen = 0;
  const RuntimeReport report = run(parts, {.duration_s = 0.2}, seen);
  EXPECT_GE(report.cycles, 100u);
  EXPECT_EQ(report.dropped + seen, report.cycles);
  EXPECT_EQ(report.allocations, 0u);
}

TEST(Runtime, StaysInAFaultThatCanBeResetAndRequestsNothing) {
  Parts parts;
  parts.device.lost_sample = 50;
  const RuntimeOptions options = {.is_fast = true,
                                  .duration_s = 2.0,
                                  .panel = {{0.8, {}, ModeRequest::kReset},
                                            {1.0, {}, ModeRequest::kArm},
                                            {1.2, {}, ModeRequest::kRun}},
                                  .stays_in_fault = true};
  Runtime runtime(options, *parts.cycle, parts.device);
  runtime.start();
  const auto sample = std::make_unique<Sample>();
  while (true) {
    const bool is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) {
      const double t = sample->record.time_s;
      const Mode mode = sample->record.mode;
      const auto expect = [&](double from, double to, Mode expected) {
        if (t > from && t < to) {
          EXPECT_EQ(mode, expected) << t;
        }
      };
      expect(0.06, 0.79, Mode::kFault);
      expect(0.81, 0.99, Mode::kReady);
      expect(1.01, 1.19, Mode::kArmed);
      expect(1.21, 1.99, Mode::kRunning);
    }
    if (is_finished) break;
  }
  EXPECT_GE(runtime.join().cycles, 2001u);
}

TEST(Runtime, ReportsTheFirstFaultTheLastRefusalAndWhetherItRan) {
  Parts parts;
  std::uint64_t seen = 0;
  RuntimeReport report = run(parts, {.is_fast = true, .duration_s = 0.1}, seen);
  EXPECT_TRUE(report.has_run);
  EXPECT_EQ(report.fault.code, FaultCode::kNone);
  EXPECT_EQ(report.refusal, Refusal::kNone);

  Parts gap;
  gap.device.lost_sample = 50;
  report = run(gap, {.is_fast = true, .duration_s = 0.1}, seen);
  EXPECT_TRUE(report.has_run);
  EXPECT_EQ(report.fault.code, FaultCode::kSequenceGap);

  Parts early;
  const RuntimeOptions options = {
      .is_fast = true, .duration_s = 0.1, .panel = {{0.01, {}, ModeRequest::kRun}}};
  report = run(early, options, seen);
  EXPECT_EQ(report.refusal, Refusal::kNotArmed);
}

TEST(Runtime, EndsAtAFaultOnceTheDeviceRests) {
  Parts parts;
  parts.device.lost_sample = 50;
  std::uint64_t seen = 0;
  EXPECT_NEAR(static_cast<double>(run(parts, {.is_fast = true, .duration_s = 10.0}, seen).cycles),
              50.0 + 100.0, 5.0);
  // one that never comes to rest is left after the time of a stop
  Parts others;
  others.device.lost_sample = 50;
  others.device.speed = 0.5;
  const RuntimeOptions options = {.is_fast = true, .duration_s = 10.0, .longest_stop_s = 0.7};
  EXPECT_NEAR(static_cast<double>(run(others, options, seen).cycles), 50.0 + 700.0, 5.0);
}

// The last mode of a run of one second in which the dead-man is open for a while.
Mode mode_after_open_dead_man(std::uint64_t opens_at, std::uint64_t closes_at) {
  Parts parts;
  parts.device.opens_at = opens_at;
  parts.device.closes_at = closes_at;
  Runtime runtime({.is_fast = true, .duration_s = 1.0}, *parts.cycle, parts.device);
  runtime.start();
  auto sample = std::make_unique<Sample>();
  Mode mode = Mode::kOff;
  while (true) {
    const bool is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) {
      if (sample->record.time_s < 0.99) mode = sample->record.mode;
    }
    if (is_finished) return mode;
  }
}

TEST(Runtime, RunsWhenTheDeadManIsClosedLate) {
  EXPECT_EQ(mode_after_open_dead_man(0, 100), Mode::kRunning);
}

TEST(Runtime, RunsAgainAfterTheDeadManWasOpen) {
  EXPECT_EQ(mode_after_open_dead_man(200, 400), Mode::kRunning);
}

TEST(Runtime, StandsStillWhileTheDeadManIsOpen) {
  EXPECT_EQ(mode_after_open_dead_man(200, 5000), Mode::kArmed);
}

TEST(Runtime, TheLastCommandDisablesTheDrives) {
  for (const std::uint64_t lost_sample : {0u, 50u}) {  // at the end of the duration, at a fault
    Parts parts;
    parts.device.lost_sample = lost_sample;
    std::uint64_t seen = 0;
    run(parts, {.is_fast = true, .duration_s = 0.3}, seen);
    EXPECT_TRUE(parts.device.was_enabled);
    EXPECT_FALSE(parts.device.last_command.enable);
    EXPECT_EQ(parts.device.last_command.dq_p.norm(), 0.0);
    EXPECT_EQ(parts.device.last_command.dq_m.norm(), 0.0);
  }
}

// Cycle by cycle, with what pages do in between: the device keeps the time, and waits.
class PagesAtWork : public ::testing::Test {
 protected:
  class Device : public StillDevice {
   public:
    void read(SensorFrame& sensors) noexcept override {
      const AllowedToWait for_the_test;
      if (!is_free) turns.acquire();
      StillDevice::read(sensors);
    }
    bool is_clock() const noexcept override { return true; }
    std::counting_semaphore<> turns{0};
    std::atomic<bool> is_free = false;
  };

  void begin(std::vector<TimedPanel> script = {}) {
    runtime_ = std::make_unique<Runtime>(
        RuntimeOptions{.panel = std::move(script), .stays_in_fault = true, .desk = &desk_},
        *parts_.cycle, device_);
    runtime_->start();
  }
  // The sample of the next cycle.
  const Sample& next() {
    device_.turns.release();
    while (!runtime_->pop(*sample_)) std::this_thread::yield();
    return *sample_;
  }
  Mode after(int cycles) {
    for (int i = 1; i < cycles; ++i) next();
    return next().record.mode;
  }
  void TearDown() override {
    device_.is_free = true;
    device_.turns.release();
    runtime_.reset();
  }

  Parts parts_;
  Device device_;
  OperatorDesk desk_;
  std::unique_ptr<Runtime> runtime_;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
};

// The cycle that waits for its sample has not looked yet: the stop is in force in that one.
TEST_F(PagesAtWork, AnEmergencyStopIsInForceInTheNextCycle) {
  begin();
  ASSERT_EQ(after(100), Mode::kRunning);
  desk_.press_stop(1);
  const Sample& sample = next();
  EXPECT_TRUE(sample.operator_input.panel.emergency_stop);
  EXPECT_EQ(sample.record.mode, Mode::kFault);
  EXPECT_EQ(sample.record.fault.code, FaultCode::kEmergencyStop);  // at rest, so at once
  ASSERT_EQ(after(500), Mode::kFault);
  EXPECT_TRUE(runtime_->request(ModeRequest::kReset, desk_.stops()));
  EXPECT_EQ(after(3), Mode::kFault) << "the stop is pressed";
  EXPECT_TRUE(desk_.release_stop(1));
  EXPECT_TRUE(runtime_->request(ModeRequest::kNone, desk_.stops()));
  EXPECT_TRUE(runtime_->request(ModeRequest::kReset, desk_.stops()));
  EXPECT_EQ(after(4), Mode::kReady);
  EXPECT_EQ(after(100), Mode::kReady) << "nothing is requested automatically after a stop";
}

TEST_F(PagesAtWork, TheClutchIsAnInputOfTheNextCycle) {
  begin();
  ASSERT_EQ(after(100), Mode::kRunning);
  EXPECT_FALSE(next().operator_input.is_clutch_open);
  desk_.set_clutch(true);
  next();  // of the input that was composed before
  EXPECT_TRUE(next().operator_input.is_clutch_open);
  EXPECT_EQ(after(3), Mode::kRunning) << "it is no stop";
  desk_.set_clutch(false);
  next();
  EXPECT_FALSE(next().operator_input.is_clutch_open);
}

TEST_F(PagesAtWork, HoldAndSwitchesStopItInTheNextCycle) {
  begin();
  ASSERT_EQ(after(100), Mode::kRunning);
  desk_.ask_to_hold();
  EXPECT_EQ(next().record.mode, Mode::kStopping);
  ASSERT_EQ(after(500), Mode::kArmed);
  desk_.set(OperatorDesk::Input::kOperatorEnable, 1, false, now_ns());
  EXPECT_FALSE(next().operator_input.panel.operator_enable);
}

TEST_F(PagesAtWork, ARequestBeforeAStopStartsNothingAfterIt) {
  begin();
  ASSERT_EQ(after(100), Mode::kRunning);
  desk_.ask_to_hold();
  ASSERT_EQ(after(500), Mode::kArmed);
  const std::uint32_t before = desk_.stops();
  // a stop overtakes what the program has not handed on yet
  desk_.set(OperatorDesk::Input::kOverrideKey, 1, false, now_ns());
  EXPECT_TRUE(runtime_->request(ModeRequest::kNone, before));
  EXPECT_TRUE(runtime_->request(ModeRequest::kRun, before));
  EXPECT_EQ(after(100), Mode::kArmed);
  EXPECT_TRUE(runtime_->request(ModeRequest::kRun, desk_.stops()));
  EXPECT_EQ(after(3), Mode::kRunning);
}

TEST_F(PagesAtWork, ATareOfAPageBeforeTheRunDoesNotPreventIt) {
  begin();
  for (const ModeRequest request : {ModeRequest::kNone, ModeRequest::kNone, ModeRequest::kTare}) {
    EXPECT_TRUE(runtime_->request(request, desk_.stops()));
  }
  EXPECT_EQ(after(1000), Mode::kRunning);
}

TEST_F(PagesAtWork, TheRunEndsOnRequestOfAPage) {
  begin();
  ASSERT_EQ(after(100), Mode::kRunning);
  desk_.ask_to_end();
  device_.is_free = true;
  device_.turns.release();
  runtime_->join();
  EXPECT_FALSE(desk_.is_open());
  EXPECT_FALSE(device_.last_command.enable);
}

TEST_F(PagesAtWork, AScriptsStopIsReleasedByNameAndPressedAgainByTheScriptOnly) {
  SafetyPanel pressed;
  pressed.emergency_stop = true;
  begin({{0.1, pressed}, {0.3, pressed, ModeRequest::kNone}, {0.4, {}}, {0.5, pressed}});
  const auto is_pressed = [&](int cycles) {
    after(cycles);
    return sample_->operator_input.panel.emergency_stop;
  };
  ASSERT_FALSE(is_pressed(50));
  ASSERT_TRUE(is_pressed(100));
  EXPECT_EQ(desk_.stop_pressed_by(), std::vector<std::uint64_t>{OperatorDesk::kScript});
  EXPECT_TRUE(desk_.release_stop(OperatorDesk::kScript));
  EXPECT_FALSE(is_pressed(1));
  EXPECT_FALSE(is_pressed(200)) << "what is not given in the script stays as it is";
  EXPECT_TRUE(is_pressed(200));
}

// Wall time: a page that is silent, while cycles continue.
TEST_F(PagesAtWork, WhatASilentPageHoldsIsLetGoByTheLoop) {
  begin();
  after(100);
  desk_.set(OperatorDesk::Input::kOverrideKey, 1, true, now_ns());
  const std::int64_t taken_ns = now_ns();
  while (next().operator_input.panel.override_key) {
    ASSERT_LT(now_ns() - taken_ns, 60 * kNanoseconds);
  }
  EXPECT_GT(desk_.stops(), 0u);
  EXPECT_EQ(sample_->record.mode, Mode::kRunning) << "by hand the key does not matter";
}

TEST(Schedule, MakesUpForAShortDelayAndGivesUpALongOne) {
  Schedule schedule(0, 100);
  EXPECT_EQ(schedule.advance(100), 0u);
  EXPECT_EQ(schedule.due_ns(), 100);
  EXPECT_EQ(schedule.advance(450), 1u);  // 250 behind 200: three cycles are late, each counts one
  EXPECT_EQ(schedule.advance(450), 1u);
  EXPECT_EQ(schedule.advance(450), 1u);
  EXPECT_EQ(schedule.advance(450), 0u);
  EXPECT_EQ(schedule.due_ns(), 500);
  EXPECT_EQ(schedule.advance(5600), 51u);  // 5000 behind 600
  EXPECT_EQ(schedule.due_ns(), 5700);      // at a whole period again
  EXPECT_EQ(schedule.advance(5750), 0u);
}

TEST(Schedule, LeavesOutWhatItMayNotMakeUpFor) {
  Schedule schedule(0, 100, 0);
  EXPECT_EQ(schedule.advance(100), 0u);
  EXPECT_EQ(schedule.advance(201), 1u);  // the cycle due at 200 is left out
  EXPECT_EQ(schedule.due_ns(), 300);
  EXPECT_EQ(schedule.advance(650), 3u);  // those due at 400, 500 and 600
  EXPECT_EQ(schedule.due_ns(), 700);
  EXPECT_EQ(schedule.advance(800), 0u);
}

TEST(SpscRing, ReportsThatItIsFullWithoutCounting) {
  SpscRing<int> ring(1);
  EXPECT_FALSE(ring.is_full());
  ring.push(1);
  EXPECT_TRUE(ring.is_full());
  EXPECT_EQ(ring.dropped(), 0u);
  int item = 0;
  ring.pop(item);
  EXPECT_FALSE(ring.is_full());
}

TEST(Runtime, HandsTheHandTargetThrough) {
  Parts parts;
  Runtime runtime({.is_fast = true, .duration_s = 0.1}, *parts.cycle, parts.device);
  HandTarget target;
  target.active = true;
  target.p_B.x() = 0.25;
  ASSERT_TRUE(runtime.set_hand_target(target));
  runtime.start();
  auto sample = std::make_unique<Sample>();
  while (!runtime.is_finished()) runtime.pop(*sample);
  runtime.join();
  EXPECT_TRUE(parts.device.last_target.active);
  EXPECT_EQ(parts.device.last_target.p_B.x(), 0.25);
}

TEST(Runtime, TakesOneChangeOfAParameterPerCycleAfterThoseThatAreDue) {
  Parts parts;
  const ParameterChange planned = {Parameter::kMassScale, -1, 2.0};
  Runtime runtime({.is_fast = true, .duration_s = 0.1, .changes = {{0.0, planned}}}, *parts.cycle,
                  parts.device);
  EXPECT_TRUE(runtime.change({Parameter::kMassScale, -1, 3.0}));
  EXPECT_TRUE(runtime.change({Parameter::kMassScale, -1, 11.0}));  // out of range
  runtime.start();
  auto sample = std::make_unique<Sample>();
  std::vector<std::pair<double, ChangeStatus>> seen;
  while (true) {
    const bool is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) {
      if (sample->operator_input.change.parameter == Parameter::kNone) continue;
      seen.emplace_back(sample->operator_input.change.value, sample->record.change);
    }
    if (is_finished) break;
  }
  runtime.join();
  const std::vector<std::pair<double, ChangeStatus>> expected = {
      {2.0, ChangeStatus::kTaken}, {3.0, ChangeStatus::kTaken}, {11.0, ChangeStatus::kRefused}};
  EXPECT_EQ(seen, expected);
}

// Waits for the next sample: a loop that never runs again fails by the time limit of the test.
void wait_for_sample(Runtime& runtime, Sample& sample) {
  while (!runtime.pop(sample)) std::this_thread::yield();
}

TEST(Runtime, RunsExactlyTheRequestedCyclesWhilePaused) {
  Parts parts;
  Runtime runtime({}, *parts.cycle, parts.device);
  runtime.pace().pause();
  ASSERT_TRUE(runtime.pace().step(3.0));
  runtime.start();
  auto sample = std::make_unique<Sample>();
  for (int i = 0; i < 4; ++i) wait_for_sample(runtime, *sample);  // the first needs no leave
  const double time_s = sample->record.time_s;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(runtime.pop(*sample));
  EXPECT_FALSE(runtime.is_finished());
  runtime.pace().resume();
  wait_for_sample(runtime, *sample);
  EXPECT_NEAR(sample->record.time_s, time_s + 1e-3, 1e-12);  // the period stays what it is
  runtime.pace().pause();
  runtime.request_stop();  // a paused run comes to rest all the same
  EXPECT_FALSE(runtime.join().stop_timed_out);
}

TEST(Runtime, SlowMotionStretchesTheWallClockOnly) {
  Parts parts;
  Runtime runtime({.duration_s = 0.05}, *parts.cycle, parts.device);
  ASSERT_TRUE(runtime.pace().set_speed(0.1));
  const auto begin = std::chrono::steady_clock::now();
  runtime.start();
  const RuntimeReport report = runtime.join();
  EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(450));
  Parts others;
  std::uint64_t seen = 0;
  EXPECT_EQ(report.cycles, run(others, {.is_fast = true, .duration_s = 0.05}, seen).cycles);
}

TEST(Pace, RefusesWhatIsOutOfRange) {
  Pace pace;
  for (const double speed : {0.0, 0.09, 1.01, -1.0, std::nan("")}) {
    EXPECT_FALSE(pace.set_speed(speed)) << speed;
  }
  EXPECT_EQ(pace.speed(), 1.0);
  EXPECT_FALSE(pace.step(1.0));  // it is not paused
  pace.pause();
  for (const double cycles : {0.0, 1.5, 1001.0, std::nan("")}) {
    EXPECT_FALSE(pace.step(cycles)) << cycles;
  }
  EXPECT_FALSE(pace.may_run());
  EXPECT_TRUE(pace.step(1000.0));
  EXPECT_FALSE(pace.step(1.0));  // too many together
  pace.resume();
  pace.pause();
  EXPECT_FALSE(pace.may_run());  // resuming forgets steps
}

// Late cycles reported to the cycle, by sample; the run is over before the device moves.
std::vector<std::uint32_t> late_cycles(const RuntimeOptions& options, bool keeps_time,
                                       RuntimeReport& report) {
  Parts parts(200.0);
  parts.device.stalls_at = 20;
  parts.device.keeps_time = keeps_time;
  Runtime runtime(options, *parts.cycle, parts.device);
  runtime.start();
  report = runtime.join();
  std::vector<std::uint32_t> late;
  auto sample = std::make_unique<Sample>();
  while (runtime.pop(*sample)) late.push_back(sample->operator_input.late_cycles);
  return late;
}

TEST(Runtime, ReportsMissedCyclesWhereTheThreadIsRealTime) {
  for (const bool keeps_time : {false, true}) {
    RuntimeReport report;
    const auto late =
        late_cycles({.duration_s = 0.2, .reports_late_cycles = true}, keeps_time, report);
    EXPECT_GE(report.overruns, 4u);
    ASSERT_GT(late.size(), 20u);
    EXPECT_EQ(report.reported_late_cycles, report.thread.priority > 0);
    // 25 ms at 200 Hz: at least four periods were missed by then
    EXPECT_EQ(late[20] >= 4, report.reported_late_cycles) << late[20];
  }
}

// A connection whose read() returns once later than its sample could have been read.
class WokenLate final : public device::ConnectedDevice {
 public:
  static constexpr std::uint64_t kSample = 20;
  static constexpr std::int64_t kLate = 24'000'000;  // ns

  explicit WokenLate(device::Device& device) : device_(device) {}
  void read(SensorFrame& sensors) noexcept override {
    device_.read(sensors);
    late_ns_ = sensors.sequence == kSample ? kLate : 0;
  }
  void write(const CommandFrame& command) noexcept override { device_.write(command); }
  std::int64_t late_ns() const noexcept override { return late_ns_; }
  void close(FaultCode) noexcept override {}
  std::string farewell() const override { return ""; }
  LinkCounts counts() const noexcept override { return {}; }

 private:
  device::Device& device_;
  std::int64_t late_ns_ = 0;
};

TEST(Runtime, CountsCyclesThatWereMissedBeforeReadReturned) {
  Parts parts(200.0);
  WokenLate device(parts.device);
  Runtime runtime({.duration_s = 0.2, .reports_late_cycles = true}, *parts.cycle, device);
  runtime.start();
  const RuntimeReport report = runtime.join();
  EXPECT_GE(report.overruns, 4u);
  EXPECT_EQ(report.wake_up_us.count() - report.wake_up_us.below(20e3), 1u);
  auto sample = std::make_unique<Sample>();
  for (std::uint64_t i = 0; i <= WokenLate::kSample + 1; ++i) ASSERT_TRUE(runtime.pop(*sample));
  const std::uint32_t reported = sample->operator_input.late_cycles;
  EXPECT_EQ(reported >= 4, report.thread.priority > 0) << reported;
}

TEST(Runtime, DoesNotReportLateCyclesOfADeviceThatWaits) {
  RuntimeReport report;
  const auto late = late_cycles({.duration_s = 0.2}, false, report);
  EXPECT_GE(report.overruns, 4u);
  for (const std::uint32_t cycles : late) EXPECT_EQ(cycles, 0u);
}

TEST(Runtime, DoesNotReportLateCyclesOfAnOrdinaryThread) {
  RuntimeReport report;
  const auto late = late_cycles(
      {.duration_s = 0.2, .thread = {.priority = 0}, .reports_late_cycles = true}, false, report);
  EXPECT_EQ(report.thread.priority, 0);
  EXPECT_EQ(report.thread.priority_error, 0);  // it was not requested
  EXPECT_FALSE(report.reported_late_cycles);
  for (const std::uint32_t cycles : late) EXPECT_EQ(cycles, 0u);
}

TEST(Runtime, MeasuresWakeUpsAndStagesInRealTimeOnly) {
  for (const bool is_fast : {false, true}) {
    Parts parts;
    std::uint64_t seen = 0;
    const RuntimeReport report = run(parts, {.is_fast = is_fast, .duration_s = 0.05}, seen);
    EXPECT_EQ(report.wake_up_us.count() > 40, !is_fast);
    const Histogram& solver = report.stage_us[index(Stage::kSolver)];
    EXPECT_EQ(solver.count() > 0, !is_fast);
    EXPECT_EQ(report.allocations, 0u);
  }
}

// a container may not use all of them
int first_allowed_processor() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  EXPECT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  int cpu = 0;
  while (cpu < CPU_SETSIZE && !CPU_ISSET(cpu, &allowed)) ++cpu;
  return cpu;
}

TEST(Runtime, RunsOnTheRequestedProcessor) {
  Parts parts;
  std::uint64_t seen = 0;
  const int cpu = first_allowed_processor();
  EXPECT_EQ(run(parts, {.duration_s = 0.01, .thread = {.cpu = cpu}}, seen).thread.cpu, cpu);
  Parts others;
  const RuntimeReport report = run(others, {.duration_s = 0.01, .thread = {.cpu = 1023}}, seen);
  EXPECT_EQ(report.thread.cpu, -1);
  EXPECT_NE(report.thread.cpu_error, 0);
}

TEST(Runtime, RefusesImpossibleOptions) {
  EXPECT_THROW(check_runtime_options({.thread = {.priority = 100}}), SetupError);
  EXPECT_THROW(check_runtime_options({.thread = {.cpu = -2}}), SetupError);
  EXPECT_THROW(Parts(0.0), SetupError);
  EXPECT_THROW(Parts(20001.0), SetupError);
  EXPECT_THROW(check_runtime_options({.duration_s = -1.0}), SetupError);
}

}  // namespace
}  // namespace hg::runtime
