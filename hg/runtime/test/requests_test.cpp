#include "hg/runtime/requests.h"

#include <gtest/gtest.h>

namespace hg::runtime {
namespace {

CycleRecord ready(TareStatus tare) {
  CycleRecord record;
  record.mode = Mode::kReady;
  record.tare = tare;
  return record;
}

TEST(NextRequest, ArmsRunsAndStops) {
  CycleRecord record = ready(TareStatus::kNone);
  record.is_tared = record.is_latency_known = true;
  EXPECT_EQ(next_request(record, false, false), ModeRequest::kArm);
  record.mode = Mode::kArmed;
  EXPECT_EQ(next_request(record, false, false), ModeRequest::kNone);
  EXPECT_EQ(next_request(record, true, false), ModeRequest::kRun);
  EXPECT_EQ(next_request(record, true, true), ModeRequest::kNone);
  record.mode = Mode::kRunning;
  EXPECT_EQ(next_request(record, true, false), ModeRequest::kNone);
  EXPECT_EQ(next_request(record, true, true), ModeRequest::kStop);
  for (const Mode mode : {Mode::kOff, Mode::kStopping, Mode::kFault}) {
    record.mode = mode;
    EXPECT_EQ(next_request(record, true, false), ModeRequest::kNone);
  }
}

TEST(NextRequest, WaitsForTheLatencyButRetriesSoThatARefusalIsReported) {
  CycleRecord record = ready(TareStatus::kNone);
  record.is_tared = true;
  int requests = 0, in_a_row = 0;
  ModeRequest last = ModeRequest::kNone;
  for (record.cycle = 0; record.cycle < 3000; ++record.cycle) {
    const ModeRequest request = next_request(record, true, false);
    requests += request == ModeRequest::kArm;
    in_a_row += request == ModeRequest::kArm && last == request;
    if (record.cycle < 500) {
      EXPECT_EQ(request, ModeRequest::kNone);
    }
    last = request;
  }
  EXPECT_EQ(requests, 3);
  EXPECT_EQ(in_a_row, 0);  // requests act on their edge
  record.is_latency_known = true;
  EXPECT_EQ(next_request(record, true, false), ModeRequest::kArm);
}

TEST(NextRequest, TaresFirstWhereTheDeviceNeedsIt) {
  EXPECT_EQ(next_request(ready(TareStatus::kNone), false, false), ModeRequest::kTare);
  // even when held: the refusal shows why nothing happens
  EXPECT_EQ(next_request(ready(TareStatus::kNone), true, false), ModeRequest::kTare);
  EXPECT_EQ(next_request(ready(TareStatus::kUnderWay), false, false), ModeRequest::kNone);
  EXPECT_EQ(next_request(ready(TareStatus::kRefusedUnsteady), false, false), ModeRequest::kTare);
  EXPECT_EQ(next_request(ready(TareStatus::kRefusedMoving), false, false), ModeRequest::kTare);
}

TEST(NextRequest, ArmsAfterATareThatAnotherHasBegun) {
  CycleRecord record = ready(TareStatus::kUnderWay);
  record.is_tared = record.is_latency_known = true;
  EXPECT_EQ(next_request(record, false, false), ModeRequest::kNone);
  record.tare = TareStatus::kRefusedHeld;  // the tare before it holds
  EXPECT_EQ(next_request(record, true, false), ModeRequest::kArm);
}

TEST(NextRequest, RequestsATareOfAHeldHandleOnlyOnce) {
  EXPECT_EQ(next_request(ready(TareStatus::kRefusedHeld), true, false), ModeRequest::kNone);
  EXPECT_EQ(next_request(ready(TareStatus::kRefusedHeld), false, false), ModeRequest::kTare);
}

}  // namespace
}  // namespace hg::runtime
