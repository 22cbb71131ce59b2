/// Operating states and what may follow what. Source: DESIGN.md section 8, [HANDBOOK] 6.5.
#pragma once

#include "hg/signals/state.h"

namespace hg::safety {

struct SupervisorState {
  Mode mode = Mode::kOff;
  ModeRequest last_request = ModeRequest::kNone;  ///< requests act on their edge
  Fault fault;                                    ///< why the device stopped; kept until reset
};

/// Takes one request and the fault of this cycle, if any.
///   off -> ready (first good sample) -> armed (arm) -> running (run, with the dead-man closed)
///   armed -> ready (stop);  running -> stopping (stop, or the dead-man opens)
///   any state -> fault (fault) -> ready (reset, once the cause is gone)
void advance(SupervisorState& state, ModeRequest request, bool dead_man,
             const Fault& fault) noexcept;

/// stopping -> armed: the reference stands still.
void has_stopped(SupervisorState& state) noexcept;

}  // namespace hg::safety
