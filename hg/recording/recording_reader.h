/// A recording back in memory, thinned to what people see. docs/recording.md lists its topics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/recording/recorder.h"
#include "hg/recording/sample_fields.h"

namespace hg::recording {

/// Who is told what a recording holds. All are called in the order of the file.
class RecordingListener {
 public:
  virtual ~RecordingListener() = default;
  /// A file that describes the run; before the first sample.
  virtual void configuration(const NamedText& text) = 0;
  virtual void event(const Event& event) = 0;
  virtual void sample(const Sample& sample) = 0;
};

/// A part of a file that is not as it was written.
struct Loss {
  std::string part;  ///< "chunk at byte 81234", "attachment door.yaml"
  std::uint64_t samples = 0, events = 0;
  bool is_counted = true;           ///< false: there may be more, at an end of the recording
  double from_s = 0.0, to_s = 0.0;  ///< time of the run of the first and the last of them
};

/// One line for each: what cannot be read, and which samples went with it. Empty for none.
std::string to_text(const std::vector<Loss>& losses);

struct ReadResult {
  bool is_complete = false;  ///< false: a crash has cut it off
  std::vector<Loss> losses;  ///< all else was handed out

  bool is_whole() const noexcept { return is_complete && losses.empty(); }
};

/// Hands out all of a recording that is as it was written, and keeps nothing. Throws SetupError as
/// RecordedRun, and for a damaged sample; passes on what `listener` throws, a SetupError behind the
/// losses so far.
ReadResult read_recording(const std::filesystem::path& file, RecordingListener& listener);

class RecordedRun {
 public:
  /// Keeps one sample per `period_s` and the last one. Throws SetupError: no Rust, the file cannot
  /// be read, it is no recording, has no sample, or is of a version with other samples.
  RecordedRun(const std::filesystem::path& file, double period_s);

  const std::vector<NamedText>& configuration() const noexcept { return configuration_; }
  const std::vector<Event>& events() const noexcept { return events_; }
  const std::vector<Loss>& losses() const noexcept { return losses_; }

  /// Kept samples, at least one, in their order.
  std::size_t size() const noexcept { return moments_.size(); }
  /// Of a kept sample, in s since the first.
  double time_s(std::size_t index) const;
  double duration_s() const { return time_s(size() - 1); }
  /// Time of the run at the first kept sample: a flight recording does not begin with its run.
  double begin_s() const noexcept { return begin_s_; }
  /// The last kept sample up to `time_s`; the first before it.
  std::size_t at(double time_s) const;
  /// Throws SetupError when its bytes are damaged.
  void read(std::size_t index, Sample& sample) const;

 private:
  struct Moment {
    std::uint64_t time_ns;
    std::vector<std::byte> bytes;
  };
  struct Taker;

  std::filesystem::path file_;
  double begin_s_ = 0.0;
  std::vector<NamedText> configuration_;
  std::vector<Event> events_;
  std::vector<Loss> losses_;
  std::vector<Moment> moments_;
};

}  // namespace hg::recording
