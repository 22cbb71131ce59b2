#include "hg/analysis/run_news.h"

#include <gtest/gtest.h>

namespace hg::analysis {
namespace {

std::string one(RunNews& news, const Sample& sample) {
  const std::vector<News> found = news.observe(sample);
  if (found.empty()) return "nothing";
  return std::string(found.front().name) + ": " + found.front().text;
}

TEST(RunNews, AResultIsReportedOnceAndARefusalEachTime) {
  RunNews news({});
  Sample sample;
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.tare = TareStatus::kUnderWay;
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.tare = TareStatus::kDone;
  EXPECT_EQ(one(news, sample), "tare: done");
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.refusal = Refusal::kNoFault;
  EXPECT_EQ(one(news, sample), "request: not reset: there is no fault");
  EXPECT_EQ(one(news, sample), "request: not reset: there is no fault");
}

TEST(RunNews, ADeviceThatWaitsOutsideOfALimitIsReportedOnce) {
  RunNews news({.limits = {{LimitKind::kManipulatorJoint, "m1", true, {-1.0, 2.0}},
                           {LimitKind::kCartesian, "hand x", false, {-0.5, 0.5}},
                           {LimitKind::kTwinJoint, "hinge", true, {0.0, 1.0}}}});
  Sample sample;
  CycleRecord& record = sample.record;
  record.limit_count = 3;
  record.limits[0].excess = 0.02;  // no more than a hand leaves behind
  record.limits[1].excess = 0.1;
  record.limits[2].excess = 0.1;
  EXPECT_EQ(one(news, sample), "nothing") << "the drives are on, or will never be";
  record.mode = Mode::kReady;
  EXPECT_EQ(
      one(news, sample),
      "outside: hand x stands 100 mm outside of its range of -0.5 to 0.5 m: once the drives are "
      "on, it moves back slowly without a hand; keep clear, or move it back by the arm's own "
      "controls, or widen the range");
  EXPECT_EQ(one(news, sample), "nothing");
  record.limits[0].excess = 0.03;
  record.mode = Mode::kRunning;
  EXPECT_EQ(one(news, sample), "nothing");
  record.mode = Mode::kReady;
  EXPECT_TRUE(
      one(news, sample)
          .starts_with("outside: m1 stands 30 mrad outside of its range of -1 to 2 rad: once"));
}

TEST(RunNews, AContactBeginsOnceAndNamesItsJoint) {
  RunNews news({.joints = {"m1", "m2"}});
  Sample sample;
  sample.record.touch.is_reported = true;
  sample.record.touch.joint = 1;
  EXPECT_EQ(one(news, sample), "contact: something touches the arm beyond joint m2: it gives way");
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.touch.is_reported = false;
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.touch = {.is_reported = true, .joint = -1};
  EXPECT_EQ(one(news, sample), "contact: something touches the arm: it gives way");
}

TEST(RunNews, ADriftOfTheForceSensorIsReportedOnceSettledAndWhenItHasGrown) {
  RunNews news({});
  Sample sample;
  RestReport& rest = sample.record.rest;
  rest.is_untouched = true;
  rest.zero[0] = 2.0;
  EXPECT_EQ(one(news, sample), "nothing");  // on its way
  EXPECT_TRUE(one(news, sample)
                  .starts_with("zero: the force sensor is off by 2 N and 0 Nm while the "
                               "handle is free: taken off; tare it"));
  rest.zero[0] = 2.5;
  EXPECT_EQ(one(news, sample), "nothing");
  EXPECT_EQ(one(news, sample), "nothing");
  rest.zero[0] = 4.0;
  one(news, sample);
  EXPECT_TRUE(one(news, sample).starts_with("zero: the force sensor is off by 4 N"));
}

// Pressed against a limit, the zero stays.
TEST(RunNews, TheForceOfAFreeHandleIsReportedOnceWhereItCannotBeTakenOff) {
  RunNews news({});
  Sample sample;
  sample.record.rest.is_untouched = true;
  sample.record.robot.w_H[2] = 5.0;
  int reported = 0;
  for (int i = 0; i < 5000; ++i) reported += one(news, sample).starts_with("zero: ") ? 1 : 0;
  EXPECT_EQ(reported, 1);
}

TEST(RunNews, AStopByTheOperatorIsNoFault) {
  RunNews news({});
  Sample sample;
  sample.record.fault.code = FaultCode::kOperatorReleased;
  EXPECT_TRUE(one(news, sample).starts_with("stopped: 130 "));
  sample.record.fault.code = FaultCode::kEmergencyStop;
  EXPECT_EQ(one(news, sample), "fault: 102 emergency stop");
  EXPECT_EQ(one(news, sample), "nothing");
  sample.record.fault.code = FaultCode::kNone;
  EXPECT_EQ(one(news, sample), "nothing");
}

}  // namespace
}  // namespace hg::analysis
