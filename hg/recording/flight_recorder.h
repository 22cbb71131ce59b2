/// Keeps the last seconds of a run in memory, at full rate, and writes them when something has gone
/// wrong: a recording like any other, in the same folder, also when the run itself is not recorded.
///
/// For the observer thread. Memory is taken at the start; writing happens on a thread of its own,
/// until whose end no sample is kept.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hg/recording/cdr_writer.h"
#include "hg/recording/recorder.h"
#include "hg/recording/sample_fields.h"

namespace hg::recording {

class FlightRecorder {
 public:
  static constexpr double kSeconds = 10.0;

  /// `info` as for a Recorder; files are called NAME_CAUSE_yyyymmdd_hhmmss.mcap after its name.
  /// Throws SetupError when `seconds` or the rate is not positive.
  explicit FlightRecorder(RecordingInfo info, double seconds = kSeconds);
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Every sample, in their order. The oldest one goes.
  void push(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);

  /// Writes what is kept, `cause` (letters, digits, dashes) in its name: to the folder of `info`
  /// or, where that is full or gone, to a new folder hapticgiant_XXXXXX among the temporary files.
  /// What fits nowhere is still kept. The next call waits until it is done.
  void write(const std::string& cause);

  struct Result {
    std::vector<std::filesystem::path> files;  ///< written, in their order
    std::string error;  ///< of the last one that could not be written as a whole; empty = none
  };
  /// Waits until all is written.
  Result close();

 private:
  std::string write_file(const std::string& cause);
  RecordingSummary write_to(const std::filesystem::path& folder, const std::string& cause);

  RecordingInfo info_;
  CdrWriter cdr_;
  std::vector<std::vector<std::byte>> slots_;  ///< encoded samples, a ring
  std::uint64_t pushed_ = 0;                   ///< samples in the ring, or once in it
  std::vector<Event> events_;                  ///< of the samples that are kept, and some older
  std::atomic<bool> is_writing_{false};
  Result result_;
  std::thread thread_;
};

}  // namespace hg::recording
