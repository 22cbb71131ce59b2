/// The robot's own words for its errors, modes and answers, as libfranka prints them.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <string_view>

#include "hg/device/franka/protocol.h"

namespace hg::franka {

using ErrorBits = std::bitset<kErrors>;

/// Bits of both lists of errors of a state. noexcept, no allocation.
ErrorBits errors_of(const RobotState& state) noexcept;

/// Name of an error bit, for example "communication_constraints_violation".
std::string_view error_name(int index) noexcept;

/// Names of all errors that are set, separated by commas; empty: none.
std::string to_string(const ErrorBits& errors);

std::string_view to_string(RobotMode mode) noexcept;
std::string_view to_string(MoveStatus status) noexcept;

/// Words for the answer to a command that sets something or recovers; 0 = success.
std::string answer_words(Command command, std::uint8_t status);

}  // namespace hg::franka
