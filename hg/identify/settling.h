/// What recordings leave out where drives settle.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/recording/recording_reader.h"

namespace hg::identify {

/// Time after the drives came on, or after a gap, that is left out: brakes open, s.
inline constexpr double kSettling_s = 0.3;

/// Throws SetupError where gaps leave no sample of use: `used` samples, `gaps` places where some
/// are missing.
inline void refuse_if_cut_up(const std::string& file, const std::vector<recording::Loss>& losses,
                             std::uint64_t used, std::uint64_t gaps) {
  if (used > 0 || gaps == 0) return;
  throw SetupError(fmt::format(
      "{}{}: samples are missing in {} places, after each of which {:g} s are left out, so that "
      "none is of use: record a run without losses",
      recording::to_text(losses), file, gaps, kSettling_s));
}

}  // namespace hg::identify
