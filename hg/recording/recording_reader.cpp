#include "hg/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "hg/core/error.h"
#include "hg/recording/cdr_reader.h"
#include "hg/recording/mcap_sink/mcap_sink.h"
#include "hg/recording/schema.h"

namespace hg::recording {
namespace {

constexpr std::string_view kSamples = "/hapticgiant/sample";
constexpr std::string_view kEvents = "/hapticgiant/events";

}  // namespace

// What the reader calls back; remembers the first thing that is wrong.
struct RecordedRun::Taker {
  RecordedRun& run;
  std::uint64_t period_ns;
  std::uint64_t due_ns = 0;
  Moment last = {};  ///< that was not kept
  bool has_samples = false;
  const char* error = "";

  void channel(std::string_view topic, std::string_view schema) {
    if (topic != kSamples) return;
    has_samples = true;
    if (schema != schema_text<Sample>()) error = "its samples are of another version";
  }

  void message(std::string_view topic, std::uint64_t time_ns, std::span<const std::byte> bytes) {
    if (topic == kEvents) {
      Event event;
      if (CdrReader(bytes).decode(event)) run.events_.push_back(std::move(event));
    }
    if (topic != kSamples || *error != '\0') return;
    last.time_ns = time_ns;
    last.bytes.assign(bytes.begin(), bytes.end());
    if (time_ns < due_ns) return;
    due_ns = time_ns + period_ns;
    run.moments_.push_back(std::exchange(last, {}));
  }

  static void take(void* context, int kind, const char* name, std::size_t name_size,
                   std::uint64_t time_ns, const std::uint8_t* data, std::size_t size) {
    Taker& taker = *static_cast<Taker*>(context);
    const std::string_view text(name, name_size);
    const std::string_view content(reinterpret_cast<const char*>(data), size);
    switch (kind) {
      case mcap_channel:
        return taker.channel(text, content);
      case mcap_message:
        return taker.message(text, time_ns, {reinterpret_cast<const std::byte*>(data), size});
      default:
        taker.run.configuration_.push_back({std::string(text), std::string(content)});
    }
  }
};

RecordedRun::RecordedRun(const std::filesystem::path& file, double period_s) : file_(file) {
  const auto fail = [&](std::string_view what) {
    throw SetupError(file.string() + ": must be a recording of this program: " + std::string(what));
  };
  Taker taker{*this, static_cast<std::uint64_t>(std::llround(1e9 * period_s))};
  std::array<char, 256> error{};
  if (!mcap_sink_read(file.c_str(), &taker, &Taker::take, error.data(), error.size())) {
    fail(error.data());
  }
  if (!taker.has_samples) fail("it has no topic /hapticgiant/sample");
  if (*taker.error != '\0') fail(taker.error);
  if (!taker.last.bytes.empty()) moments_.push_back(std::move(taker.last));
  if (moments_.empty()) fail("it has no sample");
}

double RecordedRun::time_s(std::size_t index) const {
  return 1e-9 * static_cast<double>(moments_[index].time_ns - moments_.front().time_ns);
}

std::size_t RecordedRun::at(double time_s) const {
  if (!(time_s > 0.0)) return 0;
  const double after_s = time_s + 0.5e-9;  // times are whole nanoseconds
  const auto later = std::upper_bound(
      moments_.begin(), moments_.end(), after_s, [this](double t, const Moment& moment) {
        return t < 1e-9 * static_cast<double>(moment.time_ns - moments_.front().time_ns);
      });
  return static_cast<std::size_t>(later - moments_.begin()) - 1;
}

void RecordedRun::read(std::size_t index, Sample& sample) const {
  if (!CdrReader(moments_[index].bytes).decode(sample)) {
    throw SetupError(file_.string() + ": sample " + std::to_string(index) + " is damaged");
  }
}

}  // namespace hg::recording
