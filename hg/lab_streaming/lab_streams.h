/// Streams of a run for the Lab Streaming Layer: samples as "HapticGiant", events as
/// "HapticGiantEvents".
///
/// A thread of its own sends what is pushed into a ring. Time stamps are the run's nominal time
/// plus the offset of RunClock.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/lab_streaming/liblsl.h"
#include "hg/signals/state.h"

namespace hg::lab_streaming {

/// A number in each sample of the stream.
struct Channel {
  std::string label, unit;
};

/// The channels of a run whose twin has these coordinates: run time, pose (position, quaternion),
/// twist and wrench at the handle in the base frame, coordinates of the twin.
std::vector<Channel> channels(const std::vector<Channel>& twin);

inline constexpr int kMaxChannels = 20 + kMaxTwinCoords;

/// The numbers of these channels.
class ChannelValues {
 public:
  /// Angular velocity follows from the last two orientations.
  const std::array<double, kMaxChannels>& of(const CycleRecord& record) noexcept;

 private:
  std::array<double, kMaxChannels> values_{};
  Eigen::Matrix3d last_R_ = Eigen::Matrix3d::Identity();
  double last_time_s_ = 0.0;
  bool has_last_ = false;
};

struct StreamPlan {
  double rate_Hz = 1000.0;
  std::string source;         ///< the same for runs that follow each other: readers then go on
  std::vector<Channel> twin;  ///< coordinates of the twin
};

struct StreamCounts {
  std::uint64_t samples = 0, markers = 0;  ///< sent
  std::uint64_t dropped = 0;               ///< samples and markers not sent: the ring was full
};

/// What has become known of the clock.
struct ClockNews {
  double offset_s = 0.0;   ///< local clock of LSL minus run time
  bool was_known = false;  ///< there was an earlier offset: run time has stood still since
};

/// As the text of the event.
std::string to_text(const ClockNews& news);

class LabStreams {
 public:
  /// Opens the streams and starts the thread. `library` must outlive it. Throws SetupError.
  LabStreams(const Liblsl& library, const StreamPlan& plan);
  /// Closes, unless close() did.
  ~LabStreams();

  /// Takes a sample or an event; never waits. Observer thread only.
  void push(const Sample& sample) noexcept;
  void mark(double time_s, std::string_view name, std::string_view text);
  /// What has become known of the clock since the last call.
  std::optional<ClockNews> news();

  /// Sends what is left and closes the streams.
  StreamCounts close();

 private:
  class Sender;
  std::unique_ptr<Sender> sender_;
};

}  // namespace hg::lab_streaming
