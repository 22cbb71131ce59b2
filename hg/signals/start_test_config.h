/// What the test at each start looks at, and how long its result counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hg {

/// Inputs of a safety controller that the program is told about, in the order of their test.
enum class SafetyInput : std::uint8_t {
  kOverrideKey = 0,
  kScanner = 1,
  kDeadMan = 2,
  kEmergencyStop = 3,
  kEnablingSwitch = 4,
};

inline constexpr std::size_t kSafetyInputCount = 5;
inline constexpr std::array<std::string_view, kSafetyInputCount> kSafetyInputNames = {
    "override key", "scanner", "dead-man switch", "emergency stop", "enabling switch"};

constexpr std::string_view to_string(SafetyInput input) noexcept {
  return kSafetyInputNames[static_cast<std::size_t>(input)];
}

/// Set-up data; SI units.
struct StartTestConfig {
  std::array<bool, kSafetyInputCount> has_input = {true, true, true, true, true};
  double valid_for_s = 86400.0;       ///< after which a result is too old
  double brake_motion = 0.01;         ///< of a braked revolute joint or axis at most, rad
  double slide_brake_motion = 0.002;  ///< of a braked prismatic one at most, m
  double posture = 0.035;             ///< from one run to the next, revolute, rad: 2 degrees
  double slide_posture = 0.02;        ///< the same of a prismatic one, m
};

}  // namespace hg
