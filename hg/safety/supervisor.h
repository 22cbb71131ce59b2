/// Decides in which state the device is: first in the line of a cycle, and asked again whenever a
/// rule is found broken. What may follow what stands in transitions.h.
///
/// Stops act on levels, starts on edges: no switch that is closed again starts anything. The cause
/// of a stop is kept until its reset. No allocation, noexcept.
#pragma once

#include "hg/safety/rules.h"
#include "hg/safety/transitions.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Part of the copyable state of a cycle.
struct SupervisorState {
  State state = State::kOff;
  ModeRequest last_request = ModeRequest::kNone;  ///< requests act on their edge
  Stop stop = Stop::kNone;                        ///< how it is being stopped, or was by a fault
  Fault fault;           ///< why it is being stopped, or has stopped; kept until reset
  Fault also;            ///< what made an end of a controlled stop before it was over
  int stop_samples = 0;  ///< that the present stop has taken

  Mode mode() const noexcept { return mode_of(state); }
};

/// What the supervisor looks at once per cycle.
struct SupervisorInput {
  ModeRequest request = ModeRequest::kNone;
  bool is_held = false;             ///< somebody holds the handle
  SafetyInputs safety;              ///< of the safety controller
  Refusal to_arm = Refusal::kNone;  ///< what else forbids arming
  bool is_broken = false;           ///< the monitor has seen a broken rule in the last cycle
  Fault fault;                      ///< a broken rule; kNone: there is none
  Stop reaction = Stop::kNone;      ///< of it, or of a worse one that is broken at once
};

/// Takes all that is new in this cycle. Returns why the request was not followed, or kNone.
Refusal advance(const SupervisorInput& input, SupervisorState& state) noexcept;

/// A rule is broken, with the reaction of its row, or `at_least` where that is harder.
void break_rule(const Fault& fault, SupervisorState& state, Stop at_least = Stop::kNone) noexcept;

/// One more sample of a stop: at its end when the device `is_at_rest`, and broken off with
/// kStopTooSlow once it has taken longer than `longest_s`, which is `longest` samples. Nothing in
/// other states.
void go_on_stopping(bool is_at_rest, int longest, double longest_s,
                    SupervisorState& state) noexcept;

/// What the safety controller's inputs mean as a broken rule, in the state of `state`.
Fault check_safety_inputs(const SafetyInputs& safety, const SupervisorState& state) noexcept;

}  // namespace hg::safety
