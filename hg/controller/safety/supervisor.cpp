#include "hg/controller/safety/supervisor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hg::safety {
namespace {

Stop stop_of(SafetyState state, Stop reaction) noexcept {
  switch (state) {
    case SafetyState::kToArmed:
      return Stop::kSs2;
    case SafetyState::kToReady:
      return Stop::kSs1;
    case SafetyState::kToFault:
    case SafetyState::kFault:
      return reaction;
    default:
      return Stop::kNone;
  }
}

void enter(SafetyState next, Stop reaction, SupervisorState& state) noexcept {
  if (next == state.state) return;
  if (!(mode_of(next) == Mode::kStopping && state.mode() == Mode::kStopping)) {
    state.stop_samples = 0;
  }
  state.state = next;
  state.stop = stop_of(next, reaction);
  if (state.stop == Stop::kNone) state.fault = state.also = {};
}

void happen(SafetyEvent event, SupervisorState& state) noexcept {
  enter(transition(state.state, event).next, state.stop, state);
}

std::optional<SafetyEvent> event_of(ModeRequest request) noexcept {
  switch (request) {
    case ModeRequest::kArm:
      return SafetyEvent::kArm;
    case ModeRequest::kRun:
      return SafetyEvent::kRun;
    case ModeRequest::kAutonomous:
      return SafetyEvent::kRunAlone;
    case ModeRequest::kStop:
      return SafetyEvent::kStop;
    case ModeRequest::kReset:
      return SafetyEvent::kReset;
    case ModeRequest::kNone:
    case ModeRequest::kTare:
      return std::nullopt;
  }
  return std::nullopt;
}

// reason to refuse a request that the state allows
Refusal guard(SafetyEvent event, const SupervisorInput& input) noexcept {
  switch (event) {
    case SafetyEvent::kArm:
      return input.safety.operator_enable ? input.to_arm : Refusal::kOperatorReleased;
    case SafetyEvent::kRun:
      return input.is_held ? Refusal::kNone : Refusal::kNobodyHolds;
    case SafetyEvent::kRunAlone:
      if (!input.safety.override_key) return Refusal::kNoOverride;
      if (!input.safety.is_field_clear) return Refusal::kFieldOccupied;
      return input.is_held ? Refusal::kSomebodyHolds : Refusal::kNone;
    case SafetyEvent::kReset:
      return input.is_broken || input.fault.code != FaultCode::kNone ? Refusal::kCauseRemains
                                                                     : Refusal::kNone;
    default:
      return Refusal::kNone;
  }
}

void check_switches(const SupervisorInput& input, SupervisorState& state) noexcept {
  happen(SafetyEvent::kSample, state);
  if (!input.safety.operator_enable) {
    const SafetyState before = state.state;
    happen(SafetyEvent::kOperatorLetsGo, state);
    if (state.state == SafetyState::kToReady && before != SafetyState::kToReady) {
      state.fault = {FaultCode::kOperatorReleased, -1, 0.0, 1.0};
    }
  }
  happen(input.is_held ? SafetyEvent::kHandCloses : SafetyEvent::kHandOpens, state);
  if (!input.safety.override_key) happen(SafetyEvent::kKeyTurnsOff, state);
}

}  // namespace

Refusal advance(const SupervisorInput& input, SupervisorState& state) noexcept {
  const bool is_edge = input.request != state.last_request;
  state.last_request = input.request;
  const SafetyState before = state.state;
  if (input.fault.code != FaultCode::kNone) {
    break_rule(input.fault, state, input.reaction);
  } else {
    check_switches(input, state);
  }
  const std::optional<SafetyEvent> event = is_edge ? event_of(input.request) : std::nullopt;
  if (!event) return Refusal::kNone;
  const Transition& cell = transition(before, *event);
  if (cell.refusal != Refusal::kNone) return cell.refusal;
  const Refusal refusal = cell.next == before ? Refusal::kNone : guard(*event, input);
  if (refusal == Refusal::kNone && state.state == before) enter(cell.next, state.stop, state);
  return refusal;
}

void break_rule(const Fault& fault, SupervisorState& state, Stop at_least) noexcept {
  const Stop reaction = std::max(rule_of(fault.code).reaction, at_least);
  const SafetyEvent event = reaction == Stop::kSto ? SafetyEvent::kHardRule : SafetyEvent::kRule;
  const SafetyState before = state.state, next = transition(before, event).next;
  if (next == before) {
    // a brake that slips outranks the reason for which it was closed
    const bool is_worse =
        fault.code == FaultCode::kBrakesSlip && state.fault.code != FaultCode::kBrakesSlip;
    if (is_worse) {
      state.also = std::exchange(state.fault, fault);
      state.stop = reaction;
    }
    return;
  }
  const bool has_cause = state.fault.code != FaultCode::kNone && before == SafetyState::kToFault;
  enter(next, reaction, state);
  (has_cause ? state.also : state.fault) = fault;
}

int samples_of(double time_s, double dt) noexcept {
  return static_cast<int>(std::lround(time_s / dt));
}

void continue_stop(bool is_at_rest, double longest_s, double dt, SupervisorState& state) noexcept {
  if (state.mode() != Mode::kStopping) return;
  ++state.stop_samples;
  if (is_at_rest) {
    happen(SafetyEvent::kStandstill, state);
  } else if (state.stop_samples > samples_of(longest_s, dt)) {
    break_rule({FaultCode::kStopTooSlow, -1, longest_s, longest_s}, state);
  }
}

Fault check_safety_inputs(const SafetyInputs& safety, const SupervisorState& state) noexcept {
  if (safety.emergency_stop) return {FaultCode::kEmergencyStop, -1, 1.0, 0.0};
  if (safety.has_disagreement) return {FaultCode::kSafetyInputsDisagree, -1, 1.0, 0.0};
  const bool looks_at_field =
      state.state == SafetyState::kAutonomous || state.fault.code == FaultCode::kScannerField;
  if (looks_at_field && !safety.is_field_clear) return {FaultCode::kScannerField, -1, 1.0, 0.0};
  return {};
}

}  // namespace hg::safety
