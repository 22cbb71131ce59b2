/// Whether a computer is ready for a control loop, line by line, with what to change.
///
/// Judged for the rate and with the limits below; docs/runtime.md gives the reasons.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hg/readiness/jitter.h"
#include "hg/readiness/readings.h"

namespace hg::readiness {

enum class Level {
  kOk,
  kWarn,  ///< it runs, with less certainty
  kBad,   ///< a device must not be driven from here
};

std::string_view to_string(Level level) noexcept;

struct Line {
  Level level = Level::kOk;
  std::string item;   ///< "kernel"
  std::string found;  ///< what it is
  std::string mend;   ///< commands that change it, or why nothing can; empty = nothing to change
};

/// Of the largest lateness at the rate of the loop: a device gets its command within the period.
inline constexpr double kGoodShare = 0.1;  ///< of the period: up to here ok
inline constexpr double kBadShare = 0.5;   ///< from here on bad
/// An idle processor that takes longer to wake up is told, us.
inline constexpr double kIdleLatency_us = 50.0;

std::vector<Line> judge(const Readings& readings);

/// `ordinary` and `real_time` are of the same rate. `must_hold`: a lateness beyond kBadShare is
/// bad, not only a warning.
Line judge(const Jitter& ordinary, const Jitter& real_time, bool must_hold);

/// 0 = nothing is bad, else 1.
int exit_code(const std::vector<Line>& lines) noexcept;

}  // namespace hg::readiness
