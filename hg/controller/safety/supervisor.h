/// Decides the operating state of the device: first step of a cycle, called again whenever a rule
/// is broken. Allowed transitions: transitions.h.
///
/// Stops are level-triggered, starts edge-triggered: closing a switch again starts nothing. The
/// cause of a stop is kept until its reset. No allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/transitions.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Part of the copyable state of a cycle.
struct SupervisorState {
  SafetyState state = SafetyState::kOff;
  /// Request of the last cycle; requests act on their edge.
  ModeRequest last_request = ModeRequest::kNone;
  Stop stop = Stop::kNone;  ///< Kind of the present stop, or of the one by a fault
  Fault fault;              ///< Cause of the stop; kept until reset
  Fault also;               ///< Further cause, for example one that ended a controlled stop early
  int stop_samples = 0;     ///< Samples since the present stop began

  Mode mode() const noexcept { return mode_of(state); }
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const SupervisorState& supervisor) {
  const auto& [state, last_request, stop, fault, also, stop_samples] = supervisor;
  hash.mix(static_cast<std::uint64_t>(state) | static_cast<std::uint64_t>(last_request) << 8U |
               static_cast<std::uint64_t>(stop) << 16U |
               static_cast<std::uint64_t>(fault.code) << 32U |
               static_cast<std::uint64_t>(also.code) << 48U,
           stop_samples);
  for (const Fault* one : {&fault, &also}) hash.mix(one->index, one->value, one->limit);
}

/// Inputs of the supervisor, once per cycle.
struct SupervisorInput {
  ModeRequest request = ModeRequest::kNone;
  bool is_held = false;             ///< The handle is held
  SafetyInputs safety;              ///< Inputs of the safety controller
  Refusal to_arm = Refusal::kNone;  ///< Other reason that forbids arming, or kNone
  bool is_broken = false;           ///< The monitor saw a broken rule in the last cycle
  Fault fault;                      ///< Broken rule, or kNone
  /// Reaction of that rule, or of a worse one broken at the same time.
  Stop reaction = Stop::kNone;
};

/// Processes the inputs of a cycle. Returns the reason why the request was refused, or kNone.
Refusal advance(const SupervisorInput& input, SupervisorState& state) noexcept;

/// Handles a broken rule with the reaction of its row, or `at_least` where that is harder.
void break_rule(const Fault& fault, SupervisorState& state, Stop at_least = Stop::kNone) noexcept;

/// Number of samples of period `dt` (s) in `time_s`.
int samples_of(double time_s, double dt) noexcept;

/// Counts one more sample of a stop, of period `dt` (s). Ends it when the device `is_at_rest`;
/// reports kStopTooSlow once it has taken longer than `longest_s`. No effect in other states.
void continue_stop(bool is_at_rest, double longest_s, double dt, SupervisorState& state) noexcept;

/// Broken rule that the safety controller's inputs mean in the present state, or kNone.
Fault check_safety_inputs(const SafetyInputs& safety, const SupervisorState& state) noexcept;

}  // namespace hg::safety
