/// The operator of a simulation, who wants nothing but to run: for loops other than Runtime's, too.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::runtime {

/// What to ask for after the cycle of `record`: tares where the device needs it, arms once the
/// latency is known, runs, and stops when `is_stopping`. Requests act on their edge, so that
/// running is asked for only while the handle is held, and a tare that was refused because it is
/// held only once that ends.
ModeRequest next_request(const CycleRecord& record, bool is_held, bool is_stopping) noexcept;

}  // namespace hg::runtime
