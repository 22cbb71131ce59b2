/// Writes the solver's problems that failed or were slow while a run goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
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

  /// Writes a file whole or not at all; false: not. On a thread of its own.
  using Write = std::function<bool(const std::filesystem::path& file, const std::string& text)>;

  explicit ProblemDumps(Place place);
  /// With another way to write.
  ProblemDumps(Place place, Write write);

  /// Has the next one of `problems` written, if there is one, by a thread of its own. Returns what
  /// the user should know now: how to look at the first file, or that a file cannot be written,
  /// after which no more is tried; else empty.
  std::string look_at(const hqp::KeptProblems& problems);
  /// The same until all are written, or until one has not been within two seconds (a network disk
  /// that hangs): then it says how many are lost.
  std::string finish(const hqp::KeptProblems& problems);

  /// How many there were, for the end of a run; empty when there was none.
  std::string summary(const hqp::KeptProblems& problems) const;

 private:
  struct Written {
    std::filesystem::path file;
    std::uint64_t cycle;
    std::string ended;  ///< how the solve did
    bool is_whole;
  };
  bool has_next(const hqp::KeptProblems& problems) const;

  Place place_;
  Write write_;
  std::future<Written> writing_;
  std::size_t next_ = 0;
  int files_ = 0;
  bool has_failed_ = false;
};

}  // namespace hg::apps
