/// Writes the solver's problems that failed or were slow while a run goes on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hg/hqp/kept_problems.h"

namespace hg::apps {

class ProblemDumps {
 public:
  struct Place {
    std::filesystem::path folder;  ///< empty: nothing is written
    std::string stem;              ///< files are folder/STEM_hqp_CYCLE.hqp
    std::string origin;            ///< what the files say about where they come from
    std::string program;           ///< how it was called, for the command that shows a file
  };

  explicit ProblemDumps(Place place);

  /// Writes the next one of `problems`, if there is one. Returns what the user should know now: how
  /// to look at the first file, or that a file cannot be written, after which no more is tried;
  /// else empty.
  std::string look_at(const hqp::KeptProblems& problems);

  /// How many there were, for the end of a run; empty when there was none.
  std::string summary(const hqp::KeptProblems& problems) const;

 private:
  Place place_;
  std::size_t next_ = 0;
  int files_ = 0;
  bool has_failed_ = false;
};

}  // namespace hg::apps
