#include "hg/safety/supervisor.h"

#include <gtest/gtest.h>

#include <vector>

namespace hg::safety {
namespace {

const Fault kNoFault;
const Fault kStop{FaultCode::kEmergencyStop, -1, 1.0, 0.0};

SupervisorState in(Mode mode) {
  SupervisorState state;
  state.mode = mode;
  return state;
}

TEST(Supervisor, GoesFromOffToRunningStepByStep) {
  SupervisorState state;
  advance(state, ModeRequest::kNone, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kReady);
  advance(state, ModeRequest::kArm, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kArmed);
  advance(state, ModeRequest::kRun, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kRunning);
}

TEST(Supervisor, SkipsNoState) {
  SupervisorState ready = in(Mode::kReady);
  advance(ready, ModeRequest::kRun, true, kNoFault);
  EXPECT_EQ(ready.mode, Mode::kReady);
  SupervisorState off;
  advance(off, ModeRequest::kArm, true, kNoFault);
  EXPECT_EQ(off.mode, Mode::kReady);
}

TEST(Supervisor, DoesNotRunWithoutTheDeadManSwitch) {
  SupervisorState armed = in(Mode::kArmed);
  advance(armed, ModeRequest::kRun, false, kNoFault);
  EXPECT_EQ(armed.mode, Mode::kArmed);
  SupervisorState running = in(Mode::kRunning);
  advance(running, ModeRequest::kNone, false, kNoFault);
  EXPECT_EQ(running.mode, Mode::kStopping);
}

TEST(Supervisor, StoppingEndsOnlyWhenTheDeviceStandsStill) {
  SupervisorState state = in(Mode::kRunning);
  advance(state, ModeRequest::kStop, true, kNoFault);
  advance(state, ModeRequest::kRun, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kStopping);
  has_stopped(state);
  EXPECT_EQ(state.mode, Mode::kArmed);
}

TEST(Supervisor, AHeldRequestActsOnce) {
  SupervisorState state = in(Mode::kReady);
  advance(state, ModeRequest::kArm, true, kNoFault);
  advance(state, ModeRequest::kStop, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kReady);
  advance(state, ModeRequest::kStop, true, kNoFault);
  EXPECT_EQ(state.mode, Mode::kReady);
}

TEST(Supervisor, AFaultStopsEveryStateKeepsItsFirstCauseAndNeedsAReset) {
  for (const Mode mode :
       {Mode::kOff, Mode::kReady, Mode::kArmed, Mode::kRunning, Mode::kStopping}) {
    SupervisorState state = in(mode);
    advance(state, ModeRequest::kNone, true, kStop);
    EXPECT_EQ(state.mode, Mode::kFault);
    advance(state, ModeRequest::kNone, true, {FaultCode::kSequenceGap, -1, 0.0, 0.0});
    EXPECT_EQ(state.fault.code, FaultCode::kEmergencyStop);
    advance(state, ModeRequest::kArm, true, kNoFault);
    EXPECT_EQ(state.mode, Mode::kFault);
    advance(state, ModeRequest::kReset, true, kNoFault);
    EXPECT_EQ(state.mode, Mode::kReady);
    EXPECT_EQ(state.fault.code, FaultCode::kNone);
  }
}

TEST(Supervisor, NoResetWhileTheCauseIsThere) {
  SupervisorState state = in(Mode::kFault);
  advance(state, ModeRequest::kReset, true, kStop);
  EXPECT_EQ(state.mode, Mode::kFault);
}

}  // namespace
}  // namespace hg::safety
