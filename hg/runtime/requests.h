/// Automatic operator of a simulation that brings the device to running; also for loops other than
/// Runtime's.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::runtime {

/// Next request after the cycle of `record`: tares where the device needs it, arms once the latency
/// is known and no tare is under way, runs, and stops when `is_stopping`. Requests act on their
/// edge: running is requested only while the handle is held; a tare refused because the handle was
/// held is repeated only after its release.
ModeRequest next_request(const CycleRecord& record, bool is_held, bool is_stopping) noexcept;

/// Whether a request from outside ends the automatic ones: one that changes the mode does.
inline bool takes_over(ModeRequest request) noexcept {
  return request != ModeRequest::kTare && request != ModeRequest::kNone;
}

}  // namespace hg::runtime
