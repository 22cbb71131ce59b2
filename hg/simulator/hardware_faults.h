/// Injected faults inside the simulated device, which no sensor or command frame can carry.
#pragma once

#include <cstdint>

namespace hg::simulator {

/// Inputs of the safety controller: stop buttons, operator's enabling switch, dead-man, key.
inline constexpr int kSafetyInputs = 4;

/// Fault masks: one bit per manipulator joint or input of the safety controller.
struct HardwareFaults {
  std::uint32_t closed_brakes = 0;   ///< brakes closed regardless of the drives
  std::uint32_t weak_brakes = 0;     ///< brakes without holding torque, closed or not
  std::uint32_t open_channels = 0;   ///< inputs whose first wire is permanently off
  std::uint32_t stuck_channels = 0;  ///< inputs whose first wire is permanently on
};

inline bool has_bit(std::uint32_t bits, int i) noexcept { return ((bits >> i) & 1U) != 0; }

}  // namespace hg::simulator
