#include "hg/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hg/core/error.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/schema.h"
#include "hg/recording/mcap_sink/mcap_sink.h"

namespace hg::recording {
namespace {

constexpr std::string_view kSamples = "/hapticgiant/sample";
constexpr std::string_view kEvents = "/hapticgiant/events";
constexpr char kOtherVersion[] = "its samples are of another version";
constexpr char kTwoRuns[] = "it has more than one run";
constexpr char kNoTopic[] = "it has no topic /hapticgiant/sample";

[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view what) {
  throw SetupError(file.string() + ": must be a recording of this program: " + std::string(what));
}

// Fields and their order, without the notes behind #, which may differ.
bool is_same_schema(std::string_view recorded) {
  const auto without_notes = [](std::string_view text) {
    std::string fields;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string_view line = text.substr(begin, end - begin);
      line = line.substr(0, line.find('#'));
      line = line.substr(0, line.find_last_not_of(' ') + 1);
      fields.append(line).push_back('\n');
      begin = end + 1;
    }
    return fields;
  };
  return without_notes(recorded) == without_notes(messages::schema_text<Sample>());
}

using Bytes = std::span<const std::byte>;

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Keys and values of a metadata record, each with a zero behind it.
KeyValues pairs_of(std::string_view text) {
  const auto next = [&text] {
    const std::size_t end = std::min(text.find('\0'), text.size());
    std::string word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    return word;
  };
  KeyValues pairs;
  while (!text.empty()) {
    std::string key = next();
    pairs.emplace_back(std::move(key), next());
  }
  return pairs;
}

// Passes all items of the file to `receiver`. Shields the C interface from exceptions: they are
// caught and rethrown afterwards. Also throws SetupError.
template <typename Receiver>
void hand_out(const std::filesystem::path& file, Receiver& receiver) {
  struct Call {
    Receiver& receiver;
    std::exception_ptr thrown;
  } call{receiver, {}};
  const auto take = [](void* context, int kind, const char* name, std::size_t name_size,
                       std::uint64_t time_ns, const std::uint8_t* data, std::size_t size) {
    Call& each = *static_cast<Call*>(context);
    if (each.thrown) return;
    try {
      each.receiver.take(kind, std::string_view(name, name_size), time_ns,
                         Bytes(reinterpret_cast<const std::byte*>(data), size));
    } catch (...) {
      each.thrown = std::current_exception();
    }
  };
  std::array<char, 256> error{};
  const bool is_read = mcap_sink_read(file.c_str(), &call, take, error.data(), error.size());
  if (call.thrown) std::rethrow_exception(call.thrown);
  if (!is_read) refuse(file, error.data());
}

std::uint64_t start_ns(std::uint64_t time_ns, double time_s) {
  return time_ns - static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

// Other tools merge, reorder and concatenate files: refuses what is not one run in its order.
class OneRun {
 public:
  explicit OneRun(const std::filesystem::path& file) : file_(file) {}

  void take(int kind, std::string_view name, std::uint64_t time_ns) {
    if (kind == mcap_metadata && name == "run" && std::exchange(has_run_, true)) {
      refuse(file_, kTwoRuns);
    }
    if (kind != mcap_message || name != kSamples) return;
    if (samples_ > 0 && time_ns <= last_ns_) {
      refuse(file_, "sample " + std::to_string(samples_) + " is not later than the one before");
    }
    last_ns_ = time_ns;
    ++samples_;
  }

 private:
  const std::filesystem::path& file_;
  bool has_run_ = false;
  std::uint64_t samples_ = 0, last_ns_ = 0;
};

// All samples of a run have the same time zero.
void check_start(const std::filesystem::path& file, std::uint64_t known_ns, std::uint64_t time_ns,
                 double time_s) {
  const std::uint64_t its_ns = start_ns(time_ns, time_s);
  const std::uint64_t apart = std::max(its_ns, known_ns) - std::min(its_ns, known_ns);
  if (apart > 1'000'000) refuse(file, kTwoRuns);
}

// Unreadable parts, and the messages lost with them.
class Losses {
 public:
  void take(int kind, std::string_view name, std::uint64_t time_ns) {
    const bool is_own = name.starts_with("/hapticgiant/") || name.ends_with("/robot_description");
    if (kind == mcap_channel) (is_own ? has_own_ : has_others_) = true;
    if (kind == mcap_damage) {
      parts_.push_back({.loss = {.part = std::string(name)}});
      is_open_ = true;
    }
    if (kind == mcap_message && name == kSamples) return take_whole(time_ns);
    if (kind != mcap_lost || parts_.empty()) return;
    Part& part = parts_.back();
    if (name == kEvents) ++part.loss.events;
    if (name != kSamples) return;
    ++open_samples_;
    if (++part.loss.samples == 1) part.first_ns = time_ns;
    part.last_ns = time_ns;
  }
  bool empty() const { return parts_.empty(); }
  // Whether the file describes topics, and none of ours.
  bool is_of_another_tool() const { return has_others_ && !has_own_; }

  // `start_ns`: log time at run time 0
  std::vector<Loss> since(std::uint64_t start_ns) const {
    const auto seconds = [&](std::uint64_t time_ns) {
      return 1e-9 * static_cast<double>(static_cast<std::int64_t>(time_ns - start_ns));
    };
    std::vector<Loss> losses;
    for (const Part& part : parts_) {
      losses.push_back(part.loss);
      if (is_open_ && &part == &parts_.back() && !is_known(part.loss)) {
        losses.back().is_counted = false;
      }
      if (part.loss.samples == 0) continue;
      losses.back().from_s = seconds(part.first_ns);
      losses.back().to_s = seconds(part.last_ns);
    }
    return losses;
  }

 private:
  struct Part {
    Loss loss;
    std::uint64_t first_ns = 0, last_ns = 0;
  };
  static bool is_known(const Loss& loss) {
    if (loss.part.starts_with("bytes 0 ")) return false;  // the first sample is lost with it
    return loss.samples > 0 || !(loss.part.starts_with("chunk") || loss.part.starts_with("bytes"));
  }

  // The loss between two samples follows from their distance, even where the index of the chunk is
  // lost, too.
  void take_whole(std::uint64_t time_ns) {
    const std::uint64_t distance = time_ns - std::exchange(last_ns_, time_ns);
    if (distance == time_ns) {  // first intact sample
      for (Part& part : parts_) part.loss.is_counted = is_known(part.loss);
      is_open_ = false;
      open_samples_ = 0;
      return;
    }
    if (distance > 0 && (period_ns_ == 0 || distance < period_ns_)) period_ns_ = distance;
    const std::uint64_t known = std::exchange(open_samples_, 0);
    if (!std::exchange(is_open_, false) || period_ns_ == 0) return;
    const std::uint64_t between = (distance + period_ns_ / 2) / period_ns_;
    if (between < 2 || between - 1 <= known) return;
    Part& part = parts_.back();
    part.loss.samples += between - 1 - known;
    part.first_ns = time_ns - distance + period_ns_;
    part.last_ns = time_ns - period_ns_;
  }

  std::vector<Part> parts_;
  std::uint64_t last_ns_ = 0, period_ns_ = 0;  // of intact samples
  std::uint64_t open_samples_ = 0;             // lost since the last intact one
  bool is_open_ = false;                       // a part was lost since then
  bool has_own_ = false, has_others_ = false;  // topics that the file describes
};

// What every reader of a file keeps account of.
struct Account {
  explicit Account(const std::filesystem::path& path) : file(path) {}

  const std::filesystem::path& file;
  OneRun run{file};
  Losses losses = {};
  bool has_samples = false;  ///< the file describes their topic
  bool is_complete = false;

  void take(int kind, std::string_view name, std::uint64_t time_ns) {
    run.take(kind, name, time_ns);
    losses.take(kind, name, time_ns);
    if (kind == mcap_end) is_complete = true;
    if (kind == mcap_channel && name == kSamples) has_samples = true;
  }
  void require_topic() const {
    if (has_samples) return;
    if (losses.is_of_another_tool()) refuse(file, kNoTopic);
    if (!losses.empty()) refuse(file, "what describes its samples is damaged");
    refuse(file, is_complete ? kNoTopic : "it is cut off before its first sample");
  }
};

// Notifies a listener.
struct Teller {
  Account account;
  RecordingListener& listener;
  std::uint64_t start = 0;  ///< log time at run time 0, ns
  std::uint64_t samples = 0;
  std::string error;
  Sample sample = {};

  void take(int kind, std::string_view name, std::uint64_t time_ns, Bytes bytes) {
    account.take(kind, name, time_ns);
    if (kind == mcap_attachment) {
      listener.configuration({std::string(name), std::string(text_of(bytes))});
    }
    if (kind == mcap_metadata) listener.metadata(std::string(name), pairs_of(text_of(bytes)));
    const bool describes_samples = kind == mcap_channel && name == kSamples;
    if (describes_samples && error.empty() && !is_same_schema(text_of(bytes))) {
      error = kOtherVersion;
    }
    if (kind != mcap_message || !error.empty()) return;
    if (name == kEvents) {
      Event event;
      if (messages::CdrReader(bytes).decode(event)) listener.event(event);
    }
    if (name != kSamples) return;
    if (messages::CdrReader(bytes).decode(sample)) {
      if (samples == 0) start = start_ns(time_ns, sample.record.time_s);
      check_start(account.file, start, time_ns, sample.record.time_s);
      listener.sample(sample);
    } else {
      error = "sample " + std::to_string(samples) + " is damaged";
    }
    ++samples;
  }
};

}  // namespace

std::string to_text(const std::vector<Loss>& losses) {
  std::string text;
  for (const Loss& loss : losses) {
    std::array<char, 160> lost{" no sample is lost"};
    if (loss.samples > 0) {
      std::snprintf(lost.data(), lost.size(), " %llu samples from %.3f to %.3f s are lost",
                    static_cast<unsigned long long>(loss.samples), loss.from_s, loss.to_s);
    }
    text += "DAMAGED     " + loss.part + ":" + lost.data();
    if (!loss.is_counted) text += " that is known of";
    if (loss.events > 0) text += ", and " + std::to_string(loss.events) + " events";
    text += '\n';
  }
  return text;
}

ReadResult read_recording(const std::filesystem::path& file, RecordingListener& listener) {
  const auto teller =
      std::make_unique<Teller>(Teller{.account = Account(file), .listener = listener});
  try {
    hand_out(file, *teller);
  } catch (const SetupError& error) {
    throw SetupError(to_text(teller->account.losses.since(teller->start)) + error.what());
  }
  teller->account.require_topic();
  if (!teller->error.empty()) refuse(file, teller->error);
  if (teller->samples == 0) refuse(file, "it has no sample");
  return {teller->account.is_complete, teller->account.losses.since(teller->start)};
}

namespace {

// Passes messages on as they are.
struct Passer {
  Account account;
  MessageListener& listener;
  std::uint64_t start = 0;  ///< log time at run time 0, ns
  std::string type;

  void take(int kind, std::string_view name, std::uint64_t time_ns, Bytes bytes) {
    account.take(kind, name, time_ns);
    switch (kind) {
      case mcap_attachment:
        return listener.configuration({std::string(name), std::string(text_of(bytes))});
      case mcap_metadata:
        return take_metadata(std::string(name), pairs_of(text_of(bytes)));
      case mcap_type:
        type = text_of(bytes);
        return;
      case mcap_channel:
        return listener.topic({std::string(name), type, std::string(text_of(bytes))});
      case mcap_message:
        return listener.message(name, time_ns, bytes);
      default:
        return;
    }
  }

  void take_metadata(const std::string& name, const KeyValues& pairs) {
    for (const auto& [key, value] : pairs) {
      if (name == "run" && key == "start_ns")
        std::from_chars(value.data(), value.data() + value.size(), start);
    }
    listener.metadata(name, pairs);
  }
};

}  // namespace

ReadResult read_messages(const std::filesystem::path& file, MessageListener& listener) {
  Passer passer{.account = Account(file), .listener = listener};
  hand_out(file, passer);
  passer.account.require_topic();
  return {passer.account.is_complete, passer.account.losses.since(passer.start)};
}

// Collects the kept samples of a run, and an error.
struct RecordedRun::Taker {
  RecordedRun& run;
  std::uint64_t period_ns;
  std::uint64_t due_ns = 0;
  Moment last = {};  ///< last sample that was not kept
  Account account{run.file_};
  const char* error = "";

  void channel(std::string_view topic, std::string_view schema) {
    if (topic == kSamples && !is_same_schema(schema)) error = kOtherVersion;
  }

  void message(std::string_view topic, std::uint64_t time_ns, Bytes bytes) {
    if (topic == kEvents) {
      Event event;
      if (messages::CdrReader(bytes).decode(event)) run.events_.push_back(std::move(event));
    }
    if (topic != kSamples || *error != '\0') return;
    last.time_ns = time_ns;
    last.bytes.assign(bytes.begin(), bytes.end());
    if (time_ns < due_ns) return;
    due_ns = time_ns + period_ns;
    run.moments_.push_back(std::exchange(last, {}));
  }

  void take(int kind, std::string_view name, std::uint64_t time_ns, Bytes bytes) {
    account.take(kind, name, time_ns);
    switch (kind) {
      case mcap_channel:
        return channel(name, text_of(bytes));
      case mcap_message:
        return message(name, time_ns, bytes);
      case mcap_attachment:
        run.configuration_.push_back({std::string(name), std::string(text_of(bytes))});
        return;
      default:
        return;
    }
  }
};

RecordedRun::RecordedRun(const std::filesystem::path& file, double period_s) : file_(file) {
  Taker taker{*this, static_cast<std::uint64_t>(std::llround(1e9 * period_s))};
  hand_out(file, taker);
  taker.account.require_topic();
  if (*taker.error != '\0') refuse(file, taker.error);
  if (!taker.last.bytes.empty()) moments_.push_back(std::move(taker.last));
  if (moments_.empty()) refuse(file, "it has no sample");
  const auto sample = std::make_unique<Sample>();
  decode(0, *sample);
  begin_s_ = sample->record.time_s;
  start_ns_ = start_ns(moments_.front().time_ns, begin_s_);
  losses_ = taker.account.losses.since(start_ns_);
  read(moments_.size() - 1, *sample);  // a second run is refused at once
}

std::chrono::system_clock::time_point RecordedRun::start() const {
  return std::chrono::system_clock::time_point(std::chrono::nanoseconds(start_ns_));
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
  return later - moments_.begin() - 1;
}

void RecordedRun::decode(std::size_t index, Sample& sample) const {
  if (!messages::CdrReader(moments_[index].bytes).decode(sample)) {
    throw SetupError(file_.string() + ": sample " + std::to_string(index) + " is damaged");
  }
}

void RecordedRun::read(std::size_t index, Sample& sample) const {
  decode(index, sample);
  check_start(file_, start_ns_, moments_[index].time_ns, sample.record.time_s);
}

}  // namespace hg::recording
