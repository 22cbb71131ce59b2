/// Faults on purpose inside the simulated device, which no sensor or command frame can carry.
#pragma once

#include <cstdint>

namespace hg::simulation {

/// Inputs of the safety controller: stop buttons, operator's enabling switch, dead-man, key.
inline constexpr int kSafetyInputs = 4;

/// A bit for each manipulator joint or input of the safety controller.
struct HardwareFaults {
  std::uint32_t closed_brakes = 0;   ///< closed whatever the drives do
  std::uint32_t weak_brakes = 0;     ///< hold nothing, closed or not
  std::uint32_t open_channels = 0;   ///< the first wire of this input is off for ever
  std::uint32_t stuck_channels = 0;  ///< the first wire of this input is on for ever
};

inline bool has_bit(std::uint32_t bits, int i) noexcept { return ((bits >> i) & 1U) != 0; }

}  // namespace hg::simulation
