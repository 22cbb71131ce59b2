/// The operator of a simulation, who wants nothing but to run: for loops other than Runtime's, too.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::runtime {

/// What to ask for after a cycle that ended in `mode`: arms, runs, and stops when `is_stopping`.
/// Requests act on their edge, so that running is asked for only while the handle is held.
ModeRequest next_request(Mode mode, bool is_held, bool is_stopping) noexcept;

}  // namespace hg::runtime
