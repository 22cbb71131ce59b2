/// Keeps the last seconds of a run in memory, at full rate, and writes them after a fault: an
/// ordinary recording, in the same folder, even when the run itself is not recorded.
///
/// For the observer thread. Memory is allocated at the start; writing happens on a thread of its
/// own, and no sample is kept until it ends.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hg/messages/cdr_writer.h"
#include "hg/messages/event.h"
#include "hg/recording/recorder.h"

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

  /// Adds a sample, in order; the oldest one is dropped.
  void push(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);
  /// Adds a clock, which holds until the next one.
  void lab_clock(const LabClock& clock);

  /// Writes all kept samples, with `cause` (letters, digits, dashes) in the file name: to the
  /// folder of `info` or, where that is full or missing, to a new folder hapticgiant_XXXXXX among
  /// the temporary files. Samples that fit nowhere are still kept. The next call waits until it is
  /// done.
  void write(const std::string& cause);

  struct Result {
    std::vector<std::filesystem::path> files;  ///< files written, in order
    std::string error;  ///< error of the last file that is incomplete; empty = none
  };
  /// Waits until everything is written.
  Result close();

 private:
  std::string write_file(const std::string& cause);
  std::vector<LabClock> lab_clocks_from(double first_s);
  RecordingSummary write_to(const std::filesystem::path& folder, const std::string& cause);

  RecordingInfo info_;
  messages::CdrWriter cdr_;
  std::vector<std::vector<std::byte>> slots_;  ///< encoded samples, a ring
  std::uint64_t pushed_ = 0;                   ///< samples pushed so far
  std::vector<Event> events_;                  ///< events of the kept samples, and some older
  std::mutex lab_clocks_mutex_;                ///< also while a file is written
  std::vector<LabClock> lab_clocks_;           ///< the last ones
  std::atomic<bool> is_writing_{false};
  Result result_;
  std::thread thread_;
};

}  // namespace hg::recording
