/// Records a run into one MCAP file; docs/recording.md lists topics and schemas.
///
/// The control loop pushes samples into a ring; a thread of the recorder encodes, compresses and
/// writes them. Log times are the start plus the nominal time of the samples. Errors while running
/// (disk full) end the recording, never the run.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"

namespace hg::recording {

/// False when the program was built without Rust: then no Recorder can be made.
bool recording_available() noexcept;

struct NamedText {
  std::string name, text;
};

/// A joint of the twin, in the order of its coordinates.
struct TwinJoint {
  std::string name;
  bool is_floating = false;  ///< has 7 coordinates and 6 velocities, and no place in a JointState
};

struct RecordingInfo {
  std::filesystem::path folder = "recordings";
  std::string name = "run";  ///< first part of the file name, for example "door"
  std::vector<std::string> gantry_joints, manipulator_joints;
  std::vector<TwinJoint> twin_joints;
  LimitCatalogue limits;
  std::vector<NamedText> configuration;  ///< files that describe the run, kept as attachments
  std::string version;                   ///< of the program
  double rate_Hz = 1000.0;               ///< samples per second, > 0
  double disk_budget_bytes = 5e9;        ///< for all recordings in the folder, > 0
  std::chrono::system_clock::time_point start = std::chrono::system_clock::now();
  /// The same samples and events give the same bytes: events come after the samples, and how fast
  /// samples come decides nothing.
  bool is_reproducible = false;
};

struct RecordingSummary {
  std::filesystem::path file;        ///< ends in .partial.mcap after a write error; empty = gone
  std::uint64_t samples = 0;         ///< written
  std::uint64_t dropped = 0;         ///< not written: the ring was full, or recording had ended
  std::uint64_t bytes = 0;           ///< size of the file
  std::vector<std::string> deleted;  ///< old recordings that went for the disk budget
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

  /// File name without extensions: that of everything that belongs to this recording.
  const std::string& stem() const;

  /// From the control loop: no allocation, lock or system call. False when the sample is dropped
  /// because the ring, which holds 0.7 s, is full.
  bool push(const Sample& sample) noexcept;

  /// The same for a loop that runs as fast as it can: waits for a place instead of dropping.
  void push_waiting(const Sample& sample);

  /// Notes an event. From any thread but the control loop.
  void event(double time_s, std::string_view name, std::string_view text);

  /// Writes everything that was pushed and completes the file. After it, samples are dropped.
  RecordingSummary close();

  /// Why recording ended early; empty while all is well. From any thread but the control loop.
  std::string error() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace hg::recording
