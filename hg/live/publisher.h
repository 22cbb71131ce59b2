/// Encodes the samples of a run as messages of the live channels.
///
/// Used by the observer thread, never by the control thread.
#pragma once

#include <bitset>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/live/channels.h"
#include "hg/live/frame.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/diagnostics.h"
#include "hg/messages/run_names.h"
#include "hg/messages/tool_messages.h"
#include "hg/signals/state.h"

namespace hg::live {

/// Channels with a subscriber, by number.
using Wanted = std::bitset<kTopicCount>;

/// Messages of one moment.
struct Batch {
  std::uint64_t time_ns = 0;  ///< time of the run; 0 = there is none
  std::vector<Message> messages;
};

class Publisher {
 public:
  static constexpr double kRate_Hz = 100.0;  ///< of messages, in time of the run

  /// Times of messages are `start` plus the nominal time of their sample, as in a recording.
  Publisher(const messages::RunNames& names, messages::LinkTree links, double rate_Hz,
            std::chrono::system_clock::time_point start);

  /// Takes every sample, in order. True when its messages are due.
  bool observe(const Sample& sample);
  /// Messages of the sample on the channels that are wanted.
  Batch batch(const Sample& sample, const Wanted& wanted);
  Message event(double time_s, std::string_view name, std::string_view text);
  /// A latched text, for example a URDF.
  Message description(Topic topic, const std::string& text);

 private:
  std::uint64_t time_ns(double time_s) const;
  template <HasFields Struct>
  Message encoded(Topic topic, std::uint64_t time_ns, const Struct& message);

  std::uint64_t start_ns_;
  std::uint64_t period_;  ///< cycles
  messages::ToolMessages tool_messages_;
  messages::Diagnostics diagnostics_;
  messages::CdrWriter cdr_;
};

}  // namespace hg::live
