/// Runs the cycle of a recording again, on its recorded inputs, and compares bit for bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hg/signals/state.h"

namespace hg::apps {

struct Rerun {
  std::uint64_t cycles = 0;  ///< number of identical cycles
  bool is_same = true;
  /// First difference, or the reason why nothing (more) could be compared; empty = identical.
  std::string text;
};

/// Runs a recording again. Throws SetupError when the file is no recording of this version, or its
/// configuration is invalid.
Rerun rerun(const std::filesystem::path& file);

/// First output field in which two cycles differ, in words: "record.twin.q_a[1] was 0.5 and is
/// 0.6"; empty = none.
std::string first_difference(const Sample& recorded, const Sample& now);

}  // namespace hg::apps
