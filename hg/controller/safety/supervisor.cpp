#include "hg/controller/safety/supervisor.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace hg::safety {
namespace {

Stop stop_of(State state, Stop reaction) noexcept {
  switch (state) {
    case State::kToArmed:
      return Stop::kSs2;
    case State::kToReady:
      return Stop::kSs1;
    case State::kToFault:
    case State::kFault:
      return reaction;
    default:
      return Stop::kNone;
  }
}

void enter(State next, Stop reaction, SupervisorState& state) noexcept {
  if (next == state.state) return;
  if (!(mode_of(next) == Mode::kStopping && state.mode() == Mode::kStopping)) {
    state.stop_samples = 0;
  }
  state.state = next;
  state.stop = stop_of(next, reaction);
  if (state.stop == Stop::kNone) state.fault = state.also = {};
}

void happen(Event event, SupervisorState& state) noexcept {
  enter(transition(state.state, event).next, state.stop, state);
}

std::optional<Event> event_of(ModeRequest request) noexcept {
  switch (request) {
    case ModeRequest::kArm:
      return Event::kArm;
    case ModeRequest::kRun:
      return Event::kRun;
    case ModeRequest::kAutonomous:
      return Event::kRunAlone;
    case ModeRequest::kStop:
      return Event::kStop;
    case ModeRequest::kReset:
      return Event::kReset;
    case ModeRequest::kNone:
    case ModeRequest::kTare:
      return std::nullopt;
  }
  return std::nullopt;
}

// reason to refuse a request that the state allows
Refusal guard(Event event, const SupervisorInput& input) noexcept {
  switch (event) {
    case Event::kArm:
      return input.safety.operator_enable ? input.to_arm : Refusal::kOperatorReleased;
    case Event::kRun:
      return input.is_held ? Refusal::kNone : Refusal::kNobodyHolds;
    case Event::kRunAlone:
      if (!input.safety.override_key) return Refusal::kNoOverride;
      if (!input.safety.is_field_clear) return Refusal::kFieldOccupied;
      return input.is_held ? Refusal::kSomebodyHolds : Refusal::kNone;
    case Event::kReset:
      return input.is_broken || input.fault.code != FaultCode::kNone ? Refusal::kCauseRemains
                                                                     : Refusal::kNone;
    default:
      return Refusal::kNone;
  }
}

void check_switches(const SupervisorInput& input, SupervisorState& state) noexcept {
  happen(Event::kSample, state);
  if (!input.safety.operator_enable) {
    const State before = state.state;
    happen(Event::kOperatorLetsGo, state);
    if (state.state == State::kToReady && before != State::kToReady) {
      state.fault = {FaultCode::kOperatorReleased, -1, 0.0, 1.0};
    }
  }
  happen(input.is_held ? Event::kHandCloses : Event::kHandOpens, state);
  if (!input.safety.override_key) happen(Event::kKeyTurnsOff, state);
}

}  // namespace

Refusal advance(const SupervisorInput& input, SupervisorState& state) noexcept {
  const bool is_edge = input.request != state.last_request;
  state.last_request = input.request;
  const State before = state.state;
  if (input.fault.code != FaultCode::kNone) {
    break_rule(input.fault, state, input.reaction);
  } else {
    check_switches(input, state);
  }
  const std::optional<Event> event = is_edge ? event_of(input.request) : std::nullopt;
  if (!event) return Refusal::kNone;
  const Transition& cell = transition(before, *event);
  if (cell.refusal != Refusal::kNone) return cell.refusal;
  const Refusal refusal = cell.next == before ? Refusal::kNone : guard(*event, input);
  if (refusal == Refusal::kNone && state.state == before) enter(cell.next, state.stop, state);
  return refusal;
}

void break_rule(const Fault& fault, SupervisorState& state, Stop at_least) noexcept {
  const Stop reaction = std::max(rule_of(fault.code).reaction, at_least);
  const Event event = reaction == Stop::kSto ? Event::kHardRule : Event::kRule;
  const State before = state.state, next = transition(before, event).next;
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
  const bool has_cause = state.fault.code != FaultCode::kNone && before == State::kToFault;
  enter(next, reaction, state);
  (has_cause ? state.also : state.fault) = fault;
}

void continue_stop(bool is_at_rest, int longest, double longest_s,
                   SupervisorState& state) noexcept {
  if (state.mode() != Mode::kStopping) return;
  ++state.stop_samples;
  if (is_at_rest) {
    happen(Event::kStandstill, state);
  } else if (state.stop_samples > longest) {
    break_rule({FaultCode::kStopTooSlow, -1, longest_s, longest_s}, state);
  }
}

Fault check_safety_inputs(const SafetyInputs& safety, const SupervisorState& state) noexcept {
  if (safety.emergency_stop) return {FaultCode::kEmergencyStop, -1, 1.0, 0.0};
  if (safety.has_disagreement) return {FaultCode::kSafetyInputsDisagree, -1, 1.0, 0.0};
  const bool looks_at_field =
      state.state == State::kAutonomous || state.fault.code == FaultCode::kScannerField;
  if (looks_at_field && !safety.is_field_clear) return {FaultCode::kScannerField, -1, 1.0, 0.0};
  return {};
}

}  // namespace hg::safety
