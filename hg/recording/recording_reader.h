/// Reads a recording back into memory, downsampled for display. docs/reference/recording.md lists
/// its topics.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/messages/event.h"
#include "hg/recording/key_values.h"
#include "hg/recording/recorder.h"

namespace hg::recording {

/// Receiver of the contents of a recording. All functions are called in the order of the file.
class RecordingListener {
 public:
  virtual ~RecordingListener() = default;
  /// Receives a file that describes the run; called before the first sample.
  virtual void configuration(const NamedText& text) = 0;
  /// Receives a metadata record; called before the first sample.
  virtual void metadata(const std::string& /*name*/, const KeyValues& /*pairs*/) {}
  virtual void event(const Event& event) = 0;
  virtual void sample(const Sample& sample) = 0;
};

/// Damaged part of a file.
struct Loss {
  std::string part;  ///< for example "chunk at byte 81234", "attachment door.yaml"
  std::uint64_t samples = 0, events = 0;
  bool is_counted = true;           ///< false: there may be more, at an end of the recording
  double from_s = 0.0, to_s = 0.0;  ///< run time of the first and the last lost item
};

/// One line per loss: what cannot be read, and which samples were lost with it. Empty for none.
std::string to_text(const std::vector<Loss>& losses);

struct ReadResult {
  bool is_complete = false;  ///< false: cut off by a crash
  std::vector<Loss> losses;  ///< everything else was passed on

  bool is_whole() const noexcept { return is_complete && losses.empty(); }
};

/// Passes all intact contents of a recording to `listener` and keeps no copy. Throws SetupError as
/// RecordedRun, and for a damaged sample; passes on exceptions of `listener`, a SetupError after
/// the losses so far.
ReadResult read_recording(const std::filesystem::path& file, RecordingListener& listener);

/// Topic of a recording.
struct Topic {
  std::string name;
  std::string type;    ///< for example "sensor_msgs/msg/JointState"
  std::string schema;  ///< definition of the type
};

/// Receiver of the contents of a recording as they are, of any version. All functions are called in
/// the order of the file.
class MessageListener {
 public:
  virtual ~MessageListener() = default;
  virtual void configuration(const NamedText& text) = 0;
  virtual void metadata(const std::string& name, const KeyValues& pairs) = 0;
  virtual void topic(const Topic& topic) = 0;
  virtual void message(std::string_view topic, std::uint64_t time_ns,
                       std::span<const std::byte> bytes) = 0;
};

/// Passes all intact messages of a recording to `listener`. Throws SetupError: no Rust, the file
/// cannot be read or is no recording; passes on exceptions of `listener`.
ReadResult read_messages(const std::filesystem::path& file, MessageListener& listener);

class RecordedRun {
 public:
  /// Keeps one sample per `period_s` and the last one. Throws SetupError: no Rust, the file cannot
  /// be read, it is no recording, has no sample or more than one run, is out of order, or is of a
  /// version with other samples.
  RecordedRun(const std::filesystem::path& file, double period_s);

  const std::vector<NamedText>& configuration() const noexcept { return configuration_; }
  const std::vector<Event>& events() const noexcept { return events_; }
  const std::vector<Loss>& losses() const noexcept { return losses_; }

  /// Number of kept samples, at least one, in order.
  std::size_t size() const noexcept { return moments_.size(); }
  /// Time of a kept sample since the first, s.
  double time_s(std::size_t index) const;
  double duration_s() const { return time_s(size() - 1); }
  /// Run time at the first kept sample: a flight recording does not begin with its run.
  double begin_s() const noexcept { return begin_s_; }
  /// Time zero of the run by the wall clock, as in the times of the file.
  std::chrono::system_clock::time_point start() const;
  /// Index of the last kept sample up to `time_s`; of the first one for earlier times.
  std::size_t at(double time_s) const;
  /// Decodes a kept sample. Throws SetupError when its bytes are damaged or of another run.
  void read(std::size_t index, Sample& sample) const;

 private:
  struct Moment {
    std::uint64_t time_ns;
    std::vector<std::byte> bytes;
  };
  struct Taker;
  void decode(std::size_t index, Sample& sample) const;

  std::filesystem::path file_;
  double begin_s_ = 0.0;
  std::uint64_t start_ns_ = 0;  ///< log time at run time 0
  std::vector<NamedText> configuration_;
  std::vector<Event> events_;
  std::vector<Loss> losses_;
  std::vector<Moment> moments_;
};

}  // namespace hg::recording
