#include "hg/live/publisher.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/messages/event.h"
#include "hg/messages/ros_messages.h"

namespace hg::live {
namespace {

std::size_t number(Topic topic) { return static_cast<std::size_t>(topic); }

}  // namespace

Publisher::Publisher(const messages::RunNames& names, messages::LinkTree links, double rate_Hz,
                     std::chrono::system_clock::time_point start)
    : start_ns_(static_cast<std::uint64_t>(
          std::chrono::duration_cast<std::chrono::nanoseconds>(start.time_since_epoch()).count())),
      period_(static_cast<std::uint64_t>(std::max(1LL, std::llround(rate_Hz / kRate_Hz)))),
      tool_messages_(names, std::move(links)),
      diagnostics_(names) {}

bool Publisher::observe(const Sample& sample) {
  diagnostics_.observe(sample);
  return sample.record.cycle % period_ == 0;
}

Batch Publisher::batch(const Sample& sample, const Wanted& wanted) {
  Batch batch{.time_ns = time_ns(sample.record.time_s)};
  const auto is_wanted = [&](Topic topic) { return wanted[number(topic)]; };
  const auto add = [&](Topic topic, const auto& message) {
    if (is_wanted(topic)) batch.messages.push_back(encoded(topic, batch.time_ns, message));
  };
  tool_messages_.update(sample, batch.time_ns);
  std::size_t topic = 0;  // those of a recording are the first
  tool_messages_.pass_recorded(
      [&](const char*, const auto& message) { add(static_cast<Topic>(topic++), message); });
  add(Topic::kLimits, tool_messages_.limits());
  if (is_wanted(Topic::kDiagnostics) && diagnostics_.is_due(sample.record)) {
    add(Topic::kDiagnostics, diagnostics_.update(sample, batch.time_ns));
  }
  add(Topic::kSample, sample);
  return batch;
}

Message Publisher::event(double time_s, std::string_view name, std::string_view text) {
  const messages::Event event{time_s, std::string(name), std::string(text)};
  return encoded(Topic::kEvents, time_ns(time_s), event);
}

Message Publisher::description(Topic topic, const std::string& text) {
  return encoded(topic, start_ns_, messages::TextMessage{text});
}

std::uint64_t Publisher::time_ns(double time_s) const {
  return start_ns_ + static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

template <HasFields Struct>
Message Publisher::encoded(Topic topic, std::uint64_t time_ns, const Struct& message) {
  const auto bytes = cdr_.encode(message);
  return {number(topic), time_ns,
          to_bytes(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()))};
}

}  // namespace hg::live
