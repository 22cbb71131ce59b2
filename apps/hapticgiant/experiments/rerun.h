/// Runs the cycle of a recording again, on its recorded inputs, and compares bit for bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hg/signals/state.h"

namespace hg::apps {

struct Rerun {
  std::uint64_t cycles = 0;  ///< that are the same
  bool is_same = true;
  /// The first difference, or why nothing (more) could be compared; empty = all is the same.
  std::string text;
};

/// Throws SetupError when the file is no recording of this version, or its configuration is not
/// understood.
Rerun rerun(const std::filesystem::path& file);

/// The first field in which two cycles differ in what they gave out, in words: "record.twin.q_a[1]
/// was 0.5 and is 0.6"; empty: none does.
std::string first_difference(const Sample& recorded, const Sample& now);

}  // namespace hg::apps
