/// Whether what one side sends is what the other expects.
#pragma once

#include <string>

#include "hg/remote/protocol.h"

namespace hg::remote {

/// The first thing in which the two differ, as "rate: 1000 Hz, expected 2000 Hz"; empty: nothing.
std::string difference(const Description& actual, const Description& expected);

/// Whether all vectors have the sizes that were agreed upon and all values are finite. noexcept, no
/// allocation.
bool fits(const Description& agreed, const SensorFrame& sensors) noexcept;
/// The same, and the hand presses by 0..1: such a command may go to drives.
bool fits(const Description& agreed, const CommandFrame& command) noexcept;

/// Drives off, brakes closed, for a device like this.
CommandFrame off_command(const Description& agreed);

}  // namespace hg::remote
