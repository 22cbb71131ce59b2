/// Checks that the data sent by one side are what the other expects.
#pragma once

#include <string>

#include "hg/device/udp/protocol.h"

namespace hg::udp {

/// First difference of two descriptions, as "rate: 1000 Hz, expected 2000 Hz"; empty: no
/// difference.
std::string difference(const Description& actual, const Description& expected);

/// Whether all vectors of a frame have the agreed sizes and all values are finite. noexcept, no
/// allocation.
bool fits(const Description& agreed, const SensorFrame& sensors) noexcept;
/// The same for a command, and its hand press lies in 0..1: such a command may go to drives.
bool fits(const Description& agreed, const CommandFrame& command) noexcept;

/// Command with drives off and brakes closed, for a device of this description.
CommandFrame off_command(const Description& agreed);

}  // namespace hg::udp
