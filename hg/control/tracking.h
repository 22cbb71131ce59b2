/// Turns the integrated reference into commands for the joint drives.
///
/// The ideal device takes positions and follows them; controllers for series elastic joints join
/// here and fill torques.
#pragma once

#include "hg/signals/state.h"

namespace hg::control {

/// Fills the manipulator part of `command`.
void track(const ReferenceState& reference, CommandFrame& command) noexcept;

}  // namespace hg::control
