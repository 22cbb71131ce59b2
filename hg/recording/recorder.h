/// Records a run into one MCAP file; docs/reference/recording.md lists topics and schemas.
///
/// The control loop pushes samples into a ring; a thread of the recorder encodes, compresses and
/// writes them. Log times are the start plus the nominal time of the samples. Errors while running
/// (disk full) end the recording, never the run.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hg/messages/event.h"
#include "hg/messages/lab_clock.h"
#include "hg/messages/run_names.h"
#include "hg/signals/state.h"

namespace hg::recording {

using messages::Event;
using messages::LabClock;

/// Whether a Recorder can be made; false when the program was built without Rust.
bool recording_available() noexcept;

struct NamedText {
  std::string name, text;
};

struct RecordingInfo : messages::RunNames {
  std::filesystem::path folder = "recordings";
  std::string name = "run";  ///< first part of the file name, for example "door"
  /// Makes the links of device and twin for /tf, once per thread; empty = without links
  std::function<messages::LinkTree()> make_links;
  std::string device_description, twin_description;          ///< URDF for tools; empty = none
  std::vector<std::string> gantry_units, manipulator_units;  ///< rad or m, of each joint
  std::vector<NamedText> configuration;  ///< files that describe the run, kept as attachments
  std::string version;                   ///< version of the program
  double rate_Hz = 1000.0;               ///< samples per second, > 0
  double disk_budget_bytes = 5e9;        ///< budget for all recordings in the folder, > 0
  std::chrono::system_clock::time_point start = std::chrono::system_clock::now();
  /// Whether the same samples and events give the same bytes: start and computing times are 0,
  /// events come after the samples. The file is recording.mcap and replaces an earlier one;
  /// latest.mcap stays as it is.
  bool is_reproducible = false;
};

struct RecordingSummary {
  /// Recorded file; ends in .partial.mcap after a write error; empty = lost
  std::filesystem::path file;
  std::uint64_t samples = 0;  ///< samples written
  std::uint64_t dropped = 0;  ///< samples not written: the ring was full, or recording had ended
  std::uint64_t bytes = 0;    ///< size of the file
  std::vector<std::string> deleted;  ///< old recordings deleted for the disk budget
  std::string error;                 ///< why recording ended early; empty = it did not
  std::string not_renamed;  ///< why a complete file still ends in .partial.mcap; empty = no
  std::string not_linked;   ///< why latest.mcap is not this file; empty = it is
};

class Recorder {
 public:
  /// Opens the file and starts the thread. Throws SetupError: rate or budget out of range, no Rust,
  /// folder or file cannot be written (which, why).
  explicit Recorder(const RecordingInfo& info);
  /// Closes, unless close() did.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// File name without extensions, common to all files of this recording.
  const std::string& stem() const;

  /// Takes a sample from the control loop: no allocation, lock or system call. False when the
  /// sample is dropped because the ring, which holds 0.7 s, is full.
  bool push(const Sample& sample) noexcept;

  /// The same for a loop that runs as fast as possible: waits for a place instead of dropping.
  void push_waiting(const Sample& sample);

  /// Records an event. From any thread but the control loop.
  void event(double time_s, std::string_view name, std::string_view text);
  /// Records what the lab's clock is from a moment on. From any thread but the control loop.
  void lab_clock(const LabClock& clock);

  /// Writes all pushed samples and completes the file. Later samples are dropped.
  RecordingSummary close();

  /// Why recording ended early; empty while there is no error. From any thread but the control
  /// loop.
  std::string error() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace hg::recording
