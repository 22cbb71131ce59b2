/// Fig. 9, the door, phase by phase. Source: [HANDBOOK] 10.3.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/scenarios/trace.h"

namespace hg {
namespace {

constexpr double kHeld = 1e-4;         // rad, [HANDBOOK] 10.3: motion of a locked hinge
constexpr double kFirm = 10.0 * 0.75;  // Nm: 10 N at the handle, [HANDBOOK] 10.3
constexpr double kClosingSpeed = 1.2;  // rad/s, limit of the closer
constexpr double kUnlocks = 0.5;       // rad of the lever
constexpr double kGrasp = 0.7;         // s, script time counts from here
enum Joint { kHinge, kLever };

double hinge(const CycleRecord& record) { return record.twin.q_a[kHinge]; }
double hinge_speed(const CycleRecord& record) { return record.twin.dq_a[kHinge]; }

class Door : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { trace_ = std::make_unique<Trace>(law_alone("door")); }
  static void TearDownTestSuite() { trace_.reset(); }

  static const Trace& trace() { return *trace_; }
  static const LimitReport& limit(const CycleRecord& record) {
    return trace_->limit(record, "hinge");
  }
  static bool is_felt(const CycleRecord& record) {
    return record.felt_limit == trace_->run().limit("hinge");
  }

 private:
  static std::unique_ptr<Trace> trace_;
};
std::unique_ptr<Trace> Door::trace_;

TEST_F(Door, LockedItYieldsToNoForce) {
  int firm = 0;
  for (const CycleRecord& record : trace().records()) {
    if (record.time_s < trace().time_of("locked") ||
        record.time_s > trace().time_of("handle pressed"))
      continue;
    if (record.twin.q_a[kLever] >= kUnlocks) continue;
    ASSERT_EQ(limit(record).cause, LimitCause::kLock) << record.time_s;
    ASSERT_LT(std::abs(hinge(record)), kHeld) << record.time_s;
    if (std::abs(record.tau_a[kHinge]) <= kFirm) continue;
    ++firm;
    ASSERT_TRUE(is_felt(record)) << record.time_s;
  }
  EXPECT_GT(firm * trace().period(), 1.5);  // s, of three seconds of pushing and pulling at 30 N
}

TEST_F(Door, UnlockedAndPulledItRestsOnItsLowerLimit) {
  int firm = 0;
  for (const CycleRecord& record : trace().records()) {
    if (record.time_s < trace().time_of("handle pressed") ||
        record.time_s > trace().time_of("locked again")) {
      continue;
    }
    ASSERT_LT(std::abs(hinge(record)), kHeld) << record.time_s;
    if (limit(record).cause == LimitCause::kLock || std::abs(record.tau_a[kHinge]) <= kFirm)
      continue;
    ++firm;
    ASSERT_EQ(limit(record).state, LimitState::kLower) << record.time_s;
    ASSERT_GT(limit(record).reaction, 0.0);
  }
  EXPECT_GT(firm * trace().period(), 1.0);             // s, of 1.3 s of pulling
  EXPECT_GT(trace().time_of("pulled"), kGrasp + 5.0);  // not while the lever is only pressed
}

TEST_F(Door, PressedWhileTheHandLeansItPopsOpen) {
  const double leans = trace().time_of("locked again") + 1.0;  // the hand leans from 7.5 s on
  const double unlocks = trace().first(
      leans, [](const CycleRecord& r) { return limit(r).cause != LimitCause::kLock; });
  ASSERT_GT(unlocks, leans);
  const double speed_before = std::abs(hinge_speed(trace().record(unlocks)));
  EXPECT_LT(speed_before, 1e-3);
  // half of what the acceleration rating of the hinge, 3 rad/s^2, gives in that time
  EXPECT_GT(trace().largest(unlocks, unlocks + 0.1, hinge_speed), 0.15);
  EXPECT_LT(trace().time_of("unlocked") - unlocks, 0.15);
}

TEST_F(Door, FullyOpenItStopsAtItsUpperLimit) {
  const CycleRecord& open = trace().event("open stop");
  EXPECT_NEAR(hinge(open), 1.75, 5e-3);
  EXPECT_TRUE(is_felt(open));
  EXPECT_LE(trace().largest(0.0, kGrasp + 14.0, hinge), 1.75 + 1e-9);
}

TEST_F(Door, ReleasedItFallsShutNoFasterThanItsCloserAllows) {
  int at_limit = 0;
  for (const CycleRecord& record : trace().records()) {
    ASSERT_GE(hinge_speed(record), -kClosingSpeed - 1e-9) << record.time_s;
    if (hinge_speed(record) < -kClosingSpeed + 1e-6) ++at_limit;
  }
  EXPECT_GT(at_limit * trace().period(), 0.3);  // s
  EXPECT_GT(trace().time_of("closed and locked"), trace().time_of("velocity limit"));
  const CycleRecord& last = trace().records().back();
  EXPECT_EQ(limit(last).cause, LimitCause::kLock);
  EXPECT_LT(std::abs(hinge(last)), kHeld);
}

// without a closer nothing presses the hinge onto its bolt: rounding must not seem to open it
TEST(DoorAtRest, ALockHoldsInEveryCycle) {
  config::Scenario scenario = law_alone("door");
  scenario.twin.model.dofs[0].preload = scenario.twin.model.dofs[0].stiffness = 0.0;
  scenario.script.script.segments.clear();
  // rad; locked but not quite there: both bounds come close to zero and differ by rounding
  scenario.twin.model.q_start[kHinge] = 1e-5;
  const Trace trace(scenario);
  int released = 0;
  for (const CycleRecord& record : trace.records()) {
    if (record.time_s < kGrasp + 2.0 || record.mode != Mode::kRunning) continue;
    if (trace.limit(record, "hinge").cause != LimitCause::kLock) ++released;
  }
  EXPECT_EQ(released, 0);
}

// the hand leans from 7.5 s on, with 35 N as it ships
config::Scenario leaning(double force_N) {
  constexpr int kPush = person::kWrenchChannel + 2;  // along z of the handle, out of the leaf
  config::Scenario scenario = law_alone("door");
  for (person::Segment& segment : scenario.script.script.segments) {
    if (segment.channel == kPush && segment.start_s == 7.5) segment.value = -force_N;
  }
  return scenario;
}

// The hinge's own acceleration rating ends that: 3 rad/s^2 is reached with 12 N.
TEST(DoorLeaning, TheHarderTheHandLeansTheFasterTheDoorPops) {
  double last_speed = 0.0;
  for (const double force_N : {5.0, 7.5, 10.0, 20.0}) {
    SCOPED_TRACE(force_N);
    const Trace trace(leaning(force_N));
    expect_sound(trace.run());
    const double unlocks = trace.first(kGrasp + 8.0, [&](const CycleRecord& record) {
      return trace.limit(record, "hinge").cause != LimitCause::kLock;
    });
    EXPECT_LT(std::abs(hinge(trace.record(unlocks))), kHeld);
    const double speed = hinge_speed(trace.record(unlocks + 0.1));
    EXPECT_GT(speed, last_speed + 0.02);
    EXPECT_LE(speed, 0.1 * 3.0);
    last_speed = speed;
  }
}

}  // namespace
}  // namespace hg
