/// Options of the test at each start: tested inputs, tolerances, validity of the result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hg/core/index.h"

namespace hg {

/// Inputs of a safety controller that are reported to the program, in the order of their test.
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
  return kSafetyInputNames[index(input)];
}

/// Options of the start test; set-up data, SI units.
struct StartTestConfig {
  std::array<bool, kSafetyInputCount> has_input = {true, true, true, true, true};
  double valid_for_s = 86400.0;       ///< Validity of a result, s
  double brake_motion = 0.01;         ///< Largest motion of a braked revolute joint or axis, rad
  double slide_brake_motion = 0.002;  ///< Largest motion of a braked prismatic joint or axis, m
  double posture = 0.035;             ///< Revolute: largest change between two runs, rad; 2 degrees
  double slide_posture = 0.02;        ///< Prismatic: largest change between two runs, m
};

}  // namespace hg
