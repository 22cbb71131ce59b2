/// Whether a computer is ready for a control loop, line by line, with what to change.
///
/// Assessed at the rate of the loop with the limits below; reasons: docs/reference/runtime.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hg/doctor/jitter.h"

namespace hg::doctor {

enum class Readiness {
  kOk,
  kWarn,  ///< usable, with less certainty
  kBad,   ///< a device must not be driven from here
};

std::string_view to_string(Readiness level) noexcept;

/// Assessment of one property of the computer.
struct Assessment {
  Readiness level = Readiness::kOk;
  std::string item;   ///< "kernel"
  std::string found;  ///< value found
  std::string fix;    ///< commands that fix it, or why it cannot be fixed; empty = no change needed
};

/// Limits of the largest lateness, as a share of the period: a device gets its command within it.
inline constexpr double kGoodShare = 0.1;  ///< share of the period up to which it is ok
inline constexpr double kBadShare = 0.5;   ///< share of the period from which on it is bad

/// Assesses what Linux reports in /proc and /sys below a folder, "/" for this computer. A container
/// or another kernel need not have all of it.
std::vector<Assessment> assess_computer(const std::filesystem::path& root = "/");

/// Assesses two measurements at the same rate, `ordinary` and `real_time`. `must_hold`: a lateness
/// beyond kBadShare is bad, not only a warning.
Assessment assess(const Jitter& ordinary, const Jitter& real_time, bool must_hold);

/// 0 = nothing is bad, else 1.
int exit_code(const std::vector<Assessment>& lines) noexcept;

}  // namespace hg::doctor
