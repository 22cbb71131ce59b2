#include "hg/runtime/session.h"

#include <gtest/gtest.h>

#include "hg/core/allocation_counter.h"
#include "hg/runtime/test/still_device.h"

namespace hg::runtime {
namespace {

TEST(Session, RunsTheDeviceStopsItAndEndsAtRest) {
  Parts parts;
  Session session(*parts.cycle, parts.device);
  const AllocationCounter allocations;
  while (session.record().mode != Mode::kRunning) {
    ASSERT_TRUE(session.advance());
    ASSERT_LT(session.record().cycle, 3000U);
  }
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(session.advance());
  EXPECT_TRUE(parts.device.last_command.enable);
  session.stop();
  while (session.advance()) ASSERT_LT(session.record().cycle, 6000U);
  EXPECT_EQ(session.record().mode, Mode::kArmed);
  EXPECT_TRUE(session.is_over());
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(Session, EndsWithItsPlan) {
  Parts parts;
  Session session(*parts.cycle, parts.device, {.duration_s = 0.1});
  int periods = 1;
  while (session.advance()) ++periods;
  EXPECT_EQ(periods, 101);
  EXPECT_TRUE(session.has_played());
  EXPECT_FALSE(session.is_over());
}

TEST(Session, ACallerWhoRequestsModesIsTheOnlyOneUntilTheStop) {
  Parts parts;
  Session session(*parts.cycle, parts.device);
  session.request(ModeRequest::kStop);
  session.advance();
  for (int k = 0; k < 2000; ++k) {
    session.advance();
    ASSERT_EQ(session.sample().operator_input.request, ModeRequest::kNone);
  }
  EXPECT_EQ(session.record().mode, Mode::kReady);
  for (const ModeRequest request : {ModeRequest::kTare, ModeRequest::kArm, ModeRequest::kRun}) {
    session.request(request);
    session.advance();
    EXPECT_EQ(session.sample().operator_input.request, request);
    session.advance();
    EXPECT_EQ(session.sample().operator_input.request, ModeRequest::kNone);
  }
}

TEST(Session, ATareFromOutsideEndsNothingThatIsAutomatic) {
  for (const int at : {0, 100, 499, 500, 501, 600, 900}) {
    Parts parts;
    Session session(*parts.cycle, parts.device);
    for (int k = 0; k < 2000; ++k) {
      // as a page does, so that the request is an edge
      if (k == at || k == at + 1) session.request(ModeRequest::kNone);
      if (k == at + 2) session.request(ModeRequest::kTare);
      session.advance();
      if (k >= at && k < at + 3) {
        EXPECT_EQ(session.sample().operator_input.request,
                  k == at + 2 ? ModeRequest::kTare : ModeRequest::kNone);
      }
    }
    EXPECT_EQ(session.record().mode, Mode::kRunning) << at;
  }
}

TEST(Session, AChangeWaitsWhileAPlannedOneIsDue) {
  Parts parts;
  const ParameterChange planned = {Parameter::kReferenceWrench, 0, 1.0};
  Session session(*parts.cycle, parts.device, {.changes = {{.at_s = 0.002, .change = planned}}});
  session.advance();
  session.advance();
  session.input().change = {Parameter::kReferenceWrench, 0, 2.0};
  for (const double value : {1.0, 2.0, 0.0}) {
    session.advance();
    EXPECT_EQ(session.sample().operator_input.change.value, value);
  }
}

TEST(Session, AllThatIsPlannedForATimeActsInOneCycle) {
  for (int cycle = 1; cycle < 120; ++cycle) {
    const double at_s = cycle * 1e-3;  // for some of them greater than cycle / 1000
    Parts parts;
    Session session(*parts.cycle, parts.device,
                    {.changes = {{.at_s = at_s, .change = {Parameter::kReferenceWrench, 0, 1.0}}},
                     .load = {{.from_s = at_s, .late_cycles = 1}}});
    for (int k = 0; k <= cycle; ++k) {
      session.advance();
      const OperatorFrame& input = session.sample().operator_input;
      ASSERT_EQ(input.change.parameter != Parameter::kNone, k == cycle) << cycle;
      ASSERT_EQ(input.late_cycles, k == cycle ? 1U : 0U) << cycle;
    }
  }
}

TEST(Session, PlaysTheLoadOfTheComputer) {
  Parts parts;
  Session session(*parts.cycle, parts.device, {.load = {{.from_s = 0.0095, .late_cycles = 2}}});
  for (int cycle = 0; cycle < 20; ++cycle) {
    if (cycle == 15) session.input().late_cycles = 3;
    session.advance();
    const std::uint32_t expected = cycle == 10 || cycle == 11 ? 1 : cycle == 15 ? 3 : 0;
    EXPECT_EQ(session.sample().operator_input.late_cycles, expected) << cycle;
  }
}

}  // namespace
}  // namespace hg::runtime
