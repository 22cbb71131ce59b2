#include "hg/recording/recorder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/spsc_ring.h"
#include "hg/core/text.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/event.h"
#include "hg/messages/lab_clock.h"
#include "hg/messages/ros_messages.h"
#include "hg/messages/schema.h"
#include "hg/messages/tool_messages.h"
#include "hg/recording/column_facts.h"
#include "hg/recording/mcap_file.h"
#include "hg/recording/recording_folder.h"

namespace hg::recording {
namespace {

using messages::CdrWriter;
using messages::ToolMessages;
using namespace std::chrono_literals;

constexpr double kRingSeconds = 0.7;  // outlasts the pauses of a busy disk
// Of nominal time; with the ring: the maximum loss in a crash
constexpr double kFlushSeconds = 0.25;
static_assert(kRingSeconds + kFlushSeconds < 1.0, "the promise of docs/reference/recording.md");
constexpr double kToolRate_Hz = 100.0;  // rate of the messages for other tools
constexpr auto kPollPeriod = 5ms;  // polled: waking the thread from the loop would be a system call
constexpr int kIdlePolls = 50;     // after that, a paused loop is flushed, too
constexpr int kLookPolls = 200;    // 1 s: is the file still there?
// 10 s: other runs must not take the file of a paused run for broken
constexpr int kTouchPolls = 2000;
constexpr auto kWaitForPlace = 100us;
// Share of the budget by which a file grows between two checks
constexpr double kBudgetStep = 0.01;

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

void check_recording_info(const RecordingInfo& info) {
  const auto require_positive = [](const char* item, double value) {
    if (!(value > 0.0 && std::isfinite(value))) {
      throw SetupError(std::string("recording ") + item + ": must be positive, got " +
                       to_text(value));
    }
  };
  require_positive("rate_Hz", info.rate_Hz);
  require_positive("disk_budget_bytes", info.disk_budget_bytes);
  if (!recording_available()) {
    throw SetupError("recording: this program was built without Rust; install cargo and rebuild");
  }
}

std::uint64_t start_ns(const RecordingInfo& info) {
  if (info.is_reproducible) return 0;
  const auto since_1970 = info.start.time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count());
}

KeyValues run_metadata(const RecordingInfo& info) {
  std::vector<std::string> twin_names, twin_units;
  for (const messages::TwinJoint& joint : info.twin_joints) {
    twin_names.push_back(joint.name);
    twin_units.emplace_back(joint.is_floating ? kFloating : joint.is_slide ? "m" : "rad");
  }
  return {{"name", info.name},
          {"version", info.version},
          {"start_ns", std::to_string(start_ns(info))},
          {"rate_Hz", to_text(info.rate_Hz)},
          {"gantry_joints", join(info.gantry_joints)},
          {"gantry_units", join(info.gantry_units)},
          {"manipulator_joints", join(info.manipulator_joints)},
          {"manipulator_units", join(info.manipulator_units)},
          {"twin_joints", join(twin_names)},
          {"twin_units", join(twin_units)}};
}

KeyValues limit_metadata(const LimitCatalogue& limits) {
  KeyValues pairs;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const LimitInfo& limit = limits[i];
    std::string index = std::to_string(i);
    if (i < 10) index.insert(index.begin(), '0');
    pairs.emplace_back(index + ".name", limit.name);
    pairs.emplace_back(index + ".kind", to_string(limit.kind));
    pairs.emplace_back(index + ".unit", limit.is_angle ? "rad" : "m");
    pairs.emplace_back(index + ".lower", to_text(limit.range.lb));
    pairs.emplace_back(index + ".upper", to_text(limit.range.ub));
  }
  return pairs;
}

template <HasFields Message>
std::uint16_t add_topic(McapFile& file, const std::string& topic) {
  return file.add_channel(topic, messages::schema_name<Message>(),
                          messages::schema_text<Message>());
}

}  // namespace

bool recording_available() noexcept { return mcap_sink_available(); }

/// Both sides of the ring: push functions for the loop, run() for the thread.
class Recorder::Writer {
 public:
  explicit Writer(const RecordingInfo& info);
  ~Writer() { close(); }

  bool push(const Sample& sample) noexcept;
  void push_waiting(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);
  void lab_clock(const LabClock& clock);
  RecordingSummary close();
  const std::string& stem() const { return stem_; }
  std::string error() const;

 private:
  void write_head(const RecordingInfo& info);
  void write_description(const std::string& topic, const std::string& urdf);
  void run();
  bool write_waiting_samples();
  void write(const Sample& sample);
  void write_events();
  void write_lab_clocks();
  void flush();
  void show_that_it_is_written();
  void keep_budget();
  void end(const std::string& why);
  std::uint64_t log_time(double time_s) const;

  const std::uint64_t start_ns_;
  const double disk_budget_bytes_;
  const bool is_reproducible_;
  const std::uint64_t flush_samples_, tool_samples_;
  SpscRing<Sample> ring_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> is_closing_{false};

  mutable std::mutex mutex_;  // guards the next three
  std::vector<Event> events_;
  std::vector<LabClock> lab_clocks_;
  std::string error_;

  // used only by the thread while it runs
  RecordingFolder folder_;
  std::filesystem::path path_;
  const std::string stem_;
  McapFile file_;
  CdrWriter cdr_;
  ToolMessages tool_messages_;
  std::uint16_t sample_topic_ = 0, event_topic_ = 0;
  std::optional<std::uint16_t> lab_clock_topic_;  // once there is a clock
  std::vector<std::uint16_t> tool_topics_;        // in the order of the messages for tools
  Sample sample_;
  std::uint64_t flushed_samples_ = 0;
  std::uint64_t event_count_ = 0, lab_clock_count_ = 0;
  double budget_checked_bytes_ = 0.0;
  bool has_ended_ = false;
  RecordingSummary summary_;

  std::thread thread_;
};

Recorder::Writer::Writer(const RecordingInfo& info)
    : start_ns_(start_ns(info)),
      disk_budget_bytes_(info.disk_budget_bytes),
      is_reproducible_(info.is_reproducible),
      flush_samples_(static_cast<std::uint64_t>(std::ceil(kFlushSeconds * info.rate_Hz))),
      tool_samples_(
          static_cast<std::uint64_t>(std::max(1LL, std::llround(info.rate_Hz / kToolRate_Hz)))),
      ring_(static_cast<std::size_t>(std::ceil(kRingSeconds * info.rate_Hz))),
      folder_(info.folder),
      path_(info.is_reproducible ? folder_.new_fixed_path()
                                 : folder_.new_path(info.name, info.start)),
      stem_(path_.stem().stem().string()),
      file_(path_),
      tool_messages_(info, info.make_links ? info.make_links() : messages::LinkTree()) {
  // a file that could not be created may belong to another run
  const bool is_mine = !file_.has_failed();
  write_head(info);
  file_.flush();
  if (file_.has_failed()) {
    std::error_code ignored;
    if (is_mine) std::filesystem::remove(path_, ignored);
    throw SetupError("recording file " + path_.string() +
                     ": must be writable, got: " + file_.error());
  }
  if (!is_reproducible_) summary_.not_linked = folder_.link_latest(path_);
  keep_budget();
  thread_ = std::thread([this] { run(); });
}

/// Data that a reader needs besides messages is written first, so that a crash cannot lose it.
void Recorder::Writer::write_head(const RecordingInfo& info) {
  file_.add_metadata("run", run_metadata(info));
  file_.add_metadata("limits", limit_metadata(info.limits));
  for (const NamedText& text : info.configuration) file_.attach(text.name, text.text, start_ns_);
  write_description("/robot_description", info.device_description);
  write_description("/twin/robot_description", info.twin_description);
  sample_topic_ = add_topic<Sample>(file_, "/hapticgiant/sample");
  event_topic_ = add_topic<Event>(file_, "/hapticgiant/events");
  tool_messages_.pass_recorded([this]<typename Message>(const char* topic, const Message&) {
    tool_topics_.push_back(add_topic<Message>(file_, topic));
  });
}

void Recorder::Writer::write_description(const std::string& topic, const std::string& urdf) {
  if (urdf.empty()) return;
  const std::uint16_t number = add_topic<messages::TextMessage>(file_, topic);
  file_.write(number, 0, start_ns_, cdr_.encode(messages::TextMessage{urdf}));
}

bool Recorder::Writer::push(const Sample& sample) noexcept {
  const bool is_accepted = !is_closing_.load(std::memory_order_relaxed) && ring_.push(sample);
  if (!is_accepted) dropped_.fetch_add(1, std::memory_order_relaxed);
  return is_accepted;
}

void Recorder::Writer::push_waiting(const Sample& sample) {
  while (!is_closing_) {
    if (ring_.push(sample)) return;
    std::this_thread::sleep_for(kWaitForPlace);
  }
  dropped_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::Writer::event(double time_s, std::string_view name, std::string_view text) {
  const std::lock_guard lock(mutex_);
  events_.push_back({time_s, std::string(name), std::string(text)});
}

void Recorder::Writer::lab_clock(const LabClock& clock) {
  const std::lock_guard lock(mutex_);
  lab_clocks_.push_back(clock);
}

std::string Recorder::Writer::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

RecordingSummary Recorder::Writer::close() {
  if (thread_.joinable()) {
    is_closing_ = true;
    thread_.join();
  }
  RecordingSummary summary = summary_;
  summary.dropped += dropped_;
  summary.error = error();
  return summary;
}

void Recorder::Writer::show_that_it_is_written() {
  std::error_code ignored;
  std::filesystem::last_write_time(path_, std::filesystem::file_time_type::clock::now(), ignored);
}

void Recorder::Writer::run() {
  int idle_polls = 0;
  try {
    while (!is_closing_) {
      const bool has_written = write_waiting_samples();
      if (!is_reproducible_) {
        write_events();
        write_lab_clocks();
      }
      idle_polls = has_written ? 0 : idle_polls % kTouchPolls + 1;
      const bool is_look = idle_polls > 0 && idle_polls % kLookPolls == 0;
      if ((idle_polls == kIdlePolls || is_look) && !is_reproducible_) flush();
      if (idle_polls == kTouchPolls) show_that_it_is_written();
      if (!has_written) std::this_thread::sleep_for(kPollPeriod);
    }
    write_waiting_samples();
    write_events();
    write_lab_clocks();
    end("");
  } catch (const std::exception& exception) {
    // on any exception the run continues without a recording
    end(exception.what());
    is_closing_ = true;
  }
}

bool Recorder::Writer::write_waiting_samples() {
  bool has_written = false;
  while (ring_.pop(sample_)) {
    if (is_reproducible_) sample_.cycle_time_us = 0.0;
    write(sample_);
    has_written = true;
  }
  return has_written;
}

void Recorder::Writer::write(const Sample& sample) {
  if (has_ended_) {
    ++summary_.dropped;
    return;
  }
  const CycleRecord& record = sample.record;
  const std::uint64_t time_ns = log_time(record.time_s);
  file_.write(sample_topic_, record.cycle, time_ns, cdr_.encode(sample));
  ++summary_.samples;

  if (record.cycle % tool_samples_ == 0) {
    tool_messages_.update(sample, time_ns);
    std::size_t next = 0;
    tool_messages_.pass_recorded([&](const char*, const auto& message) {
      file_.write(tool_topics_[next++], record.cycle, time_ns, cdr_.encode(message));
    });
  }

  if (summary_.samples - flushed_samples_ >= flush_samples_) flush();
}

void Recorder::Writer::write_events() {
  std::vector<Event> events;
  {
    const std::lock_guard lock(mutex_);
    events.swap(events_);
  }
  if (has_ended_) return;
  for (const Event& event : events) {
    file_.write(event_topic_, event_count_++, log_time(event.time_s), cdr_.encode(event));
  }
}

void Recorder::Writer::write_lab_clocks() {
  std::vector<LabClock> clocks;
  {
    const std::lock_guard lock(mutex_);
    clocks.swap(lab_clocks_);
  }
  if (has_ended_ || clocks.empty()) return;
  if (!lab_clock_topic_) lab_clock_topic_ = add_topic<LabClock>(file_, "/hapticgiant/lab_clock");
  for (const LabClock& clock : clocks) {
    file_.write(*lab_clock_topic_, lab_clock_count_++, log_time(clock.time_s), cdr_.encode(clock));
  }
}

void Recorder::Writer::flush() {
  if (has_ended_) return;
  file_.flush();
  if (file_.has_failed()) {
    end("");
    return;
  }
  flushed_samples_ = summary_.samples;
  const double bytes = static_cast<double>(file_.bytes());
  if (bytes - budget_checked_bytes_ >= kBudgetStep * disk_budget_bytes_) keep_budget();
  if (bytes >= disk_budget_bytes_) {
    end("the file has reached the disk budget of " + to_text(disk_budget_bytes_) + " bytes");
  }
}

void Recorder::Writer::keep_budget() {
  budget_checked_bytes_ = static_cast<double>(file_.bytes());
  std::vector<std::string> deleted =
      folder_.make_room(path_, budget_checked_bytes_, disk_budget_bytes_);
  std::move(deleted.begin(), deleted.end(), std::back_inserter(summary_.deleted));
}

/// Completes the file; after a write error it stays as it is. Later samples are dropped.
void Recorder::Writer::end(const std::string& why) {
  if (has_ended_) return;
  has_ended_ = true;
  file_.finish();
  keep_budget();
  const mcap_file_state state = file_.state();
  if (file_.has_failed()) {
    // the content of a file that was changed by others is unknown
    const std::uint64_t kept = state == mcap_file_whole ? flushed_samples_ : 0;
    summary_.dropped += summary_.samples - kept;
    summary_.samples = kept;
  } else {
    path_ = folder_.complete(path_, summary_.not_renamed);
  }
  if (state != mcap_file_gone) summary_.file = path_;
  summary_.bytes = file_.bytes();

  const std::lock_guard lock(mutex_);
  error_ = why.empty() ? file_.error() : why;
}

std::uint64_t Recorder::Writer::log_time(double time_s) const {
  return start_ns_ + static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

Recorder::Recorder(const RecordingInfo& info) {
  check_recording_info(info);
  writer_ = std::make_unique<Writer>(info);
}

Recorder::~Recorder() = default;

const std::string& Recorder::stem() const { return writer_->stem(); }

bool Recorder::push(const Sample& sample) noexcept { return writer_->push(sample); }

void Recorder::push_waiting(const Sample& sample) { writer_->push_waiting(sample); }

void Recorder::event(double time_s, std::string_view name, std::string_view text) {
  writer_->event(time_s, name, text);
}

void Recorder::lab_clock(const LabClock& clock) { writer_->lab_clock(clock); }

RecordingSummary Recorder::close() { return writer_->close(); }

std::string Recorder::error() const { return writer_->error(); }

}  // namespace hg::recording
