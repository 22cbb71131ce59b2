/// Writes the solver's failed or slow problems during a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <string>

#include "hg/hqp/problem_capture.h"

namespace hg::recording {

class ProblemDumps {
 public:
  struct Place {
    std::filesystem::path folder;  ///< output folder; empty = no output
    std::string stem;              ///< files are folder/STEM_hqp_CYCLE.hqp
    std::string origin;            ///< origin stated in the files
    std::string program;           ///< program name as called, for the command that shows a file
  };

  /// Function that writes a file completely or not at all; false = not written. Called on a
  /// separate thread.
  using Write = std::function<bool(const std::filesystem::path& file, const std::string& text)>;

  explicit ProblemDumps(Place place);
  /// Uses `write` to write files.
  ProblemDumps(Place place, Write write);

  /// Writes the next one of `problems`, if any, on a separate thread. Returns a message for the
  /// user: how to view the first file, or that a file cannot be written, after which writing stops;
  /// else empty.
  std::string look_at(const hqp::ProblemCapture& problems);
  /// Writes all remaining problems; gives up when one takes more than two seconds (a network disk
  /// that hangs) and then reports how many are lost.
  std::string finish(const hqp::ProblemCapture& problems);

  /// Number of problems as text for the end of a run; empty without problems.
  std::string summary(const hqp::ProblemCapture& problems) const;

 private:
  struct Written {
    std::filesystem::path file;
    std::uint64_t cycle;
    std::string ended;  ///< end of the solve, as text
    bool is_whole;
  };
  bool has_next(const hqp::ProblemCapture& problems) const;

  Place place_;
  Write write_;
  std::future<Written> writing_;
  std::size_t next_ = 0;
  int files_ = 0;
  bool has_failed_ = false;
};

}  // namespace hg::recording
