/// Writes the solver's problems that failed or were slow while a run goes on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hg/hqp/kept_problems.h"

namespace hg::apps {

class ProblemDumps {
 public:
  /// Files are folder/NAME_hqp_CYCLE.hqp; those of earlier runs are overwritten. An empty folder:
  /// nothing is written. `origin` is what the files say about where they come from.
  ProblemDumps(std::filesystem::path folder, std::string name, std::string origin);

  /// Writes the next one of `problems`, if there is one. Returns what the user should know now: how
  /// to look at the first file, or that a file cannot be written, after which no more is tried;
  /// else empty.
  std::string look_at(const hqp::KeptProblems& problems);

  /// How many there were, for the end of a run; empty when there was none.
  std::string summary(const hqp::KeptProblems& problems) const;

 private:
  std::filesystem::path folder_;
  std::string name_, origin_;
  std::size_t next_ = 0;
  int files_ = 0;
  bool has_failed_ = false;
};

}  // namespace hg::apps
