#include "hg/controller/safety/supervisor.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hg::safety {
namespace {

constexpr Fault kRuleFault{FaultCode::kWrenchTooLarge, 0, 151.0, 150.0};  // SS2
constexpr Fault kHardFault{FaultCode::kSensorNotFinite, 3, 0.0, 0.0};     // STO

std::vector<SafetyState> all_states() {
  std::vector<SafetyState> states;
  for (std::size_t i = 0; i < kStateCount; ++i) states.push_back(static_cast<SafetyState>(i));
  return states;
}

std::vector<SafetyEvent> all_events() {
  std::vector<SafetyEvent> events;
  for (std::size_t i = 0; i < kEventCount; ++i) events.push_back(static_cast<SafetyEvent>(i));
  return events;
}

SupervisorState in(SafetyState state) {
  SupervisorState supervisor;
  supervisor.state = state;
  if (state == SafetyState::kToFault || state == SafetyState::kFault) {
    supervisor.fault = {FaultCode::kTooHot, 2, 91.0, 90.0};
    supervisor.stop = Stop::kSs1;
  }
  return supervisor;
}

// input that keeps `state`
SupervisorInput quiet(SafetyState state) {
  SupervisorInput input;
  input.is_held = state == SafetyState::kByHand;
  input.safety.override_key = state == SafetyState::kAutonomous;
  return input;
}

// One cycle in which `event` happens to a device in `state`, with everything granted.
Refusal let_happen(SafetyEvent event, SupervisorState& state) {
  SupervisorInput input = quiet(state.state);
  switch (event) {
    case SafetyEvent::kSample:
      break;
    case SafetyEvent::kArm:
      input.request = ModeRequest::kArm;
      break;
    case SafetyEvent::kRun:
      input.request = ModeRequest::kRun;
      if (state.state != SafetyState::kAutonomous) input.is_held = true;
      break;
    case SafetyEvent::kRunAlone:
      input.request = ModeRequest::kAutonomous;
      input.safety.override_key = true;
      break;
    case SafetyEvent::kStop:
      input.request = ModeRequest::kStop;
      break;
    case SafetyEvent::kReset:
      input.request = ModeRequest::kReset;
      break;
    case SafetyEvent::kHandOpens:
      input.is_held = false;
      break;
    case SafetyEvent::kHandCloses:
      input.is_held = true;
      break;
    case SafetyEvent::kKeyTurnsOff:
      input.safety.override_key = false;
      break;
    case SafetyEvent::kOperatorLetsGo:
      input.safety.operator_enable = false;
      break;
    case SafetyEvent::kStandstill:
      continue_stop(true, 0.1, 1e-3, state);
      return Refusal::kNone;
    case SafetyEvent::kRule:
      break_rule(kRuleFault, state);
      return Refusal::kNone;
    case SafetyEvent::kHardRule:
      break_rule(kHardFault, state);
      return Refusal::kNone;
  }
  return advance(input, state);
}

TEST(Supervisor, FollowsTheTableInEveryStateAtEveryEvent) {
  for (const SafetyState state : all_states()) {
    for (const SafetyEvent event : all_events()) {
      SupervisorState supervisor = in(state);
      const Refusal refusal = let_happen(event, supervisor);
      Transition expected = transition(state, event);
      // a sample makes a device ready that is off, whatever else happens in that cycle
      const bool is_rule = event == SafetyEvent::kRule || event == SafetyEvent::kHardRule;
      if (state == SafetyState::kOff && !is_rule && event != SafetyEvent::kStandstill) {
        expected.next = SafetyState::kReady;
      }
      EXPECT_EQ(supervisor.state, expected.next)
          << to_string(state) << " / " << to_string(event) << " -> " << to_string(supervisor.state);
      EXPECT_EQ(refusal, expected.refusal) << to_string(state) << " / " << to_string(event);
    }
  }
}

// The table itself, written a second time in other words.
TEST(Transitions, PowerComesOnlyByRequestsAndMotionOnlyFromArmed) {
  for (const SafetyState state : all_states()) {
    for (const SafetyEvent event : all_events()) {
      const SafetyState next = transition(state, event).next;
      if (is_powered(next) && !is_powered(state)) {
        EXPECT_TRUE(state == SafetyState::kReady && event == SafetyEvent::kArm);
      }
      if (mode_of(next) == Mode::kRunning && next != state) {
        EXPECT_EQ(state, SafetyState::kArmed);
        EXPECT_EQ(event, next == SafetyState::kByHand ? SafetyEvent::kRun : SafetyEvent::kRunAlone);
      }
      if (state == SafetyState::kFault && next != state) {
        EXPECT_EQ(next, SafetyState::kReady);
        EXPECT_EQ(event, SafetyEvent::kReset);
      }
      // what moves is braked before the drives go off, except by an STO
      const bool moves = mode_of(state) == Mode::kRunning || mode_of(state) == Mode::kStopping;
      if (moves && !is_powered(next)) {
        EXPECT_TRUE(event == SafetyEvent::kHardRule || event == SafetyEvent::kStandstill);
      }
      if (event == SafetyEvent::kHardRule) {
        EXPECT_EQ(next, SafetyState::kFault);
      } else if (event == SafetyEvent::kRule) {
        EXPECT_TRUE(next == SafetyState::kFault || next == SafetyState::kToFault);
      }
    }
  }
}

TEST(Transitions, EveryRefusalHasAReasonAndEveryOtherRequestIsFollowed) {
  const auto refusal = [](SafetyState state, SafetyEvent event) {
    return transition(state, event).refusal;
  };
  for (const SafetyState state : all_states()) {
    const bool is_failed = state == SafetyState::kToFault || state == SafetyState::kFault;
    EXPECT_EQ(refusal(state, SafetyEvent::kArm), state == SafetyState::kReady ? Refusal::kNone
                                                 : is_failed ? Refusal::kFaultPresent
                                                             : Refusal::kNotReady);
    for (const SafetyEvent event : {SafetyEvent::kRun, SafetyEvent::kRunAlone}) {
      EXPECT_EQ(refusal(state, event), state == SafetyState::kArmed ? Refusal::kNone
                                       : is_failed                  ? Refusal::kFaultPresent
                                                                    : Refusal::kNotArmed);
    }
    EXPECT_EQ(refusal(state, SafetyEvent::kReset), state == SafetyState::kFault ? Refusal::kNone
                                                   : state == SafetyState::kToFault
                                                       ? Refusal::kCauseRemains
                                                       : Refusal::kNoFault);
    EXPECT_EQ(refusal(state, SafetyEvent::kStop), Refusal::kNone) << "a stop is never refused";
  }
}

TEST(Supervisor, ARefusedRequestChangesNothingAndEveryRefusalHasWords) {
  const auto refused = [](SafetyState state, ModeRequest request, auto&& change) {
    SupervisorState supervisor = in(state);
    SupervisorInput input = quiet(state);
    input.request = request;
    change(input);
    const Refusal refusal = advance(input, supervisor);
    EXPECT_EQ(supervisor.state, state);
    EXPECT_NE(to_string(refusal), "unknown");
    return refusal;
  };
  const auto nothing = [](SupervisorInput&) {};
  EXPECT_EQ(refused(SafetyState::kReady, ModeRequest::kArm,
                    [](SupervisorInput& i) { i.safety.operator_enable = false; }),
            Refusal::kOperatorReleased);
  EXPECT_EQ(refused(SafetyState::kReady, ModeRequest::kArm,
                    [](SupervisorInput& i) { i.to_arm = Refusal::kNotTared; }),
            Refusal::kNotTared);
  EXPECT_EQ(refused(SafetyState::kArmed, ModeRequest::kRun, nothing), Refusal::kNobodyHolds);
  EXPECT_EQ(refused(SafetyState::kArmed, ModeRequest::kAutonomous, nothing), Refusal::kNoOverride);
  EXPECT_EQ(refused(SafetyState::kArmed, ModeRequest::kAutonomous,
                    [](SupervisorInput& i) {
                      i.safety.override_key = true;
                      i.safety.is_field_clear = false;
                    }),
            Refusal::kFieldOccupied);
  EXPECT_EQ(refused(SafetyState::kArmed, ModeRequest::kAutonomous,
                    [](SupervisorInput& i) { i.safety.override_key = i.is_held = true; }),
            Refusal::kSomebodyHolds);
  EXPECT_EQ(refused(SafetyState::kReady, ModeRequest::kRun, nothing), Refusal::kNotArmed);
  EXPECT_EQ(refused(SafetyState::kArmed, ModeRequest::kReset, nothing), Refusal::kNoFault);
  EXPECT_EQ(refused(SafetyState::kFault, ModeRequest::kArm, nothing), Refusal::kFaultPresent);
  EXPECT_EQ(refused(SafetyState::kFault, ModeRequest::kReset,
                    [](SupervisorInput& i) { i.fault = kRuleFault; }),
            Refusal::kCauseRemains);
  EXPECT_EQ(refused(SafetyState::kFault, ModeRequest::kReset,
                    [](SupervisorInput& i) { i.is_broken = true; }),
            Refusal::kCauseRemains);
}

TEST(Supervisor, StartsActOnEdgesAndStopsOnLevels) {
  SupervisorState state = in(SafetyState::kReady);
  SupervisorInput input;
  input.safety.operator_enable = false;
  input.request = ModeRequest::kArm;
  EXPECT_EQ(advance(input, state), Refusal::kOperatorReleased);
  input.safety.operator_enable = true;  // held again, the arm button still pressed
  for (int k = 0; k < 3; ++k) EXPECT_EQ(advance(input, state), Refusal::kNone);
  EXPECT_EQ(state.state, SafetyState::kReady);
  input.request = ModeRequest::kNone;
  advance(input, state);
  input.request = ModeRequest::kArm;
  advance(input, state);
  EXPECT_EQ(state.state, SafetyState::kArmed);
  input.safety.operator_enable = false;
  advance(input, state);
  EXPECT_EQ(state.state, SafetyState::kReady);
}

TEST(Supervisor, AnOperatorWhoLetsGoStopsItWithoutAFaultToReset) {
  SupervisorState state = in(SafetyState::kByHand);
  SupervisorInput input = quiet(SafetyState::kByHand);
  input.safety.operator_enable = false;
  advance(input, state);
  EXPECT_EQ(state.state, SafetyState::kToReady);
  EXPECT_EQ(state.stop, Stop::kSs1);
  EXPECT_EQ(state.fault.code, FaultCode::kOperatorReleased);
  input.safety.operator_enable = true;
  advance(input, state);
  EXPECT_EQ(state.state, SafetyState::kToReady) << "holding it again does not continue";
  continue_stop(true, 0.1, 1e-3, state);
  EXPECT_EQ(state.state, SafetyState::kReady);
  EXPECT_EQ(state.fault.code, FaultCode::kNone);
  EXPECT_EQ(state.stop, Stop::kNone);
}

TEST(Supervisor, EveryRuleHasTheReactionOfItsRow) {
  for (const Rule& rule : kRules) {
    SupervisorState state = in(SafetyState::kByHand);
    break_rule({rule.code, 1, 2.0, 1.0}, state);
    EXPECT_EQ(state.stop, rule.reaction) << to_string(rule.code);
    EXPECT_EQ(state.fault.code, rule.code) << to_string(rule.code);
    EXPECT_EQ(state.state,
              rule.reaction == Stop::kSto ? SafetyState::kFault : SafetyState::kToFault);
  }
  SupervisorState state = in(SafetyState::kByHand);
  break_rule({static_cast<FaultCode>(999), 0, 0.0, 0.0}, state);
  EXPECT_EQ(state.stop, Stop::kSto) << "an unknown code switches off";
}

TEST(Supervisor, TheFirstCauseIsKeptAndWhatEndsAStopIsRememberedBesides) {
  SupervisorState state = in(SafetyState::kByHand);
  break_rule(kRuleFault, state);
  break_rule({FaultCode::kSpeedExceeded, 1, 2.0, 1.0}, state);
  EXPECT_EQ(state.fault.code, kRuleFault.code);
  EXPECT_EQ(state.also.code, FaultCode::kNone);
  break_rule(kHardFault, state);
  EXPECT_EQ(state.state, SafetyState::kFault);
  EXPECT_EQ(state.stop, Stop::kSto);
  EXPECT_EQ(state.fault.code, kRuleFault.code);
  EXPECT_EQ(state.also.code, kHardFault.code);
}

TEST(Supervisor, ASlippingBrakeIsReportedWhateverMadeItClose) {
  constexpr Fault kSlip{FaultCode::kBrakesSlip, 4, 0.11, 0.1};
  SupervisorState state = in(SafetyState::kFault);
  const FaultCode first = state.fault.code;
  for (int k = 0; k < 2; ++k) {
    break_rule(kSlip, state);
    EXPECT_EQ(state.state, SafetyState::kFault);
    EXPECT_EQ(state.fault.code, FaultCode::kBrakesSlip);
    EXPECT_EQ(state.also.code, first) << "the first cause is kept besides";
  }
  SupervisorState ready = in(SafetyState::kReady);
  break_rule(kSlip, ready);
  EXPECT_EQ(ready.state, SafetyState::kFault);
  EXPECT_EQ(ready.fault.code, FaultCode::kBrakesSlip);
}

TEST(Supervisor, AStopThatTakesTooLongIsBrokenOff) {
  for (const SafetyState stopping :
       {SafetyState::kToArmed, SafetyState::kToReady, SafetyState::kToFault}) {
    SupervisorState state = in(stopping);
    for (int k = 0; k < 100; ++k) continue_stop(false, 0.1, 1e-3, state);
    EXPECT_EQ(state.state, stopping);
    continue_stop(false, 0.1, 1e-3, state);
    EXPECT_EQ(state.state, SafetyState::kFault);
    EXPECT_EQ(state.stop, Stop::kSto);
    const Fault& reported = stopping == SafetyState::kToFault ? state.also : state.fault;
    EXPECT_EQ(reported.code, FaultCode::kStopTooSlow);
  }
}

TEST(Supervisor, AStopDoesNotGetNewTimeWhenItsReasonChanges) {
  SupervisorState state = in(SafetyState::kByHand);
  SupervisorInput input = quiet(SafetyState::kByHand);
  input.request = ModeRequest::kStop;
  advance(input, state);
  for (int k = 0; k < 90; ++k) continue_stop(false, 0.1, 1e-3, state);
  break_rule(kRuleFault, state);
  for (int k = 0; k < 11; ++k) continue_stop(false, 0.1, 1e-3, state);
  EXPECT_EQ(state.state, SafetyState::kFault);
  EXPECT_EQ(state.also.code, FaultCode::kStopTooSlow);
}

TEST(Supervisor, AnUntrustedSensorMakesAnEmergencyStopHarderAndKeepsItsCause) {
  SupervisorState state = in(SafetyState::kByHand);
  SupervisorInput input = quiet(SafetyState::kByHand);
  input.fault = {FaultCode::kEmergencyStop, -1, 1.0, 0.0};
  input.reaction = Stop::kSto;
  advance(input, state);
  EXPECT_EQ(state.state, SafetyState::kFault);
  EXPECT_EQ(state.stop, Stop::kSto);
  EXPECT_EQ(state.fault.code, FaultCode::kEmergencyStop);
}

TEST(CheckSafetyInputs, TheScannerCountsOnlyWhileTheHandleIsNotHeld) {
  SafetyInputs safety;
  safety.is_field_clear = false;
  EXPECT_EQ(check_safety_inputs(safety, in(SafetyState::kByHand)).code, FaultCode::kNone);
  EXPECT_EQ(check_safety_inputs(safety, in(SafetyState::kArmed)).code, FaultCode::kNone);
  SupervisorState state = in(SafetyState::kAutonomous);
  const Fault fault = check_safety_inputs(safety, state);
  EXPECT_EQ(fault.code, FaultCode::kScannerField);
  break_rule(fault, state);
  EXPECT_EQ(check_safety_inputs(safety, state).code, FaultCode::kScannerField)
      << "the cause is there until the field is clear";
  safety.is_field_clear = true;
  EXPECT_EQ(check_safety_inputs(safety, state).code, FaultCode::kNone);
}

TEST(CheckSafetyInputs, AStopComesBeforeADisagreement) {
  SafetyInputs safety;
  EXPECT_EQ(check_safety_inputs(safety, in(SafetyState::kArmed)).code, FaultCode::kNone);
  safety.has_disagreement = true;
  EXPECT_EQ(check_safety_inputs(safety, in(SafetyState::kArmed)).code,
            FaultCode::kSafetyInputsDisagree);
  safety.emergency_stop = true;
  EXPECT_EQ(check_safety_inputs(safety, in(SafetyState::kArmed)).code, FaultCode::kEmergencyStop);
}

TEST(Rules, AllFaultsHaveARuleAndAllTextsAreThere) {
  for (const Rule& rule : kRules) {
    EXPECT_EQ(&rule_of(rule.code), &rule);
    const FaultWords& words = fault_words(rule.code);
    EXPECT_EQ(words.code, rule.code);
    EXPECT_FALSE(words.name.empty() || words.text.empty() || words.meaning.empty());
    EXPECT_FALSE(rule.threshold.empty() || rule.release.empty()) << words.name;
    EXPECT_EQ(words.meaning.back(), '.') << words.name;
    EXPECT_NE(rule.reaction, Stop::kNone) << words.name;
  }
  std::size_t known = 0;
  for (int code = 1; code < 1000; ++code) {
    if (to_string(static_cast<FaultCode>(code)) != "unknown fault") ++known;
  }
  EXPECT_EQ(known, kRuleCount);
}

}  // namespace
}  // namespace hg::safety
