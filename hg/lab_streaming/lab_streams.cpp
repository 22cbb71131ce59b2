#include "hg/lab_streaming/lab_streams.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <thread>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/spsc_ring.h"
#include "hg/lab_streaming/run_clock.h"

namespace hg::lab_streaming {
namespace {

using namespace std::chrono_literals;

constexpr double kRing_s = 4.0;  // a library that hangs for longer loses samples
constexpr std::size_t kMostMarkers = 4096;
constexpr std::int32_t kBuffered_s = 60;  // kept by the library for each slow reader
constexpr auto kPoll = 5ms;
constexpr auto kFarewell = 500ms;  // for what readers have not fetched yet
constexpr std::size_t kMostAtOnce = 256;

struct Item {
  double time_s, clock_s;
  std::array<double, kMaxChannels> values;
};

struct Marker {
  double time_s;
  std::string text;
};

}  // namespace

std::vector<Channel> channels(const std::vector<Channel>& twin) {
  std::vector<Channel> all = {{"time", "s"}};
  const auto add = [&all](const char* name, std::initializer_list<const char*> entries,
                          const char* unit) {
    for (const char* entry : entries) all.push_back({fmt::format("{}.{}", name, entry), unit});
  };
  add("position", {"x", "y", "z"}, "m");
  add("orientation", {"qx", "qy", "qz", "qw"}, "");
  add("velocity", {"x", "y", "z"}, "m/s");
  add("angular_velocity", {"x", "y", "z"}, "rad/s");
  add("force", {"x", "y", "z"}, "N");
  add("torque", {"x", "y", "z"}, "Nm");
  for (const Channel& coordinate : twin) {
    all.push_back({"twin." + coordinate.label, coordinate.unit});
  }
  return all;
}

std::string to_text(const ClockNews& news) {
  return fmt::format("{}local clock of LSL = run time + {:.6f} s",
                     news.was_known ? "run time has stood still, from now on " : "", news.offset_s);
}

const std::array<double, kMaxChannels>& ChannelValues::of(const CycleRecord& record) noexcept {
  std::size_t next = 0;
  const auto add = [&](const auto& vector) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) values_[next++] = vector[i];
  };
  const double passed_s = record.time_s - last_time_s_;
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();
  if (has_last_ && passed_s > 0.0) {
    const Eigen::AngleAxisd turn(record.T_B_H.R * last_R_.transpose());
    omega = turn.angle() / passed_s * turn.axis();
  }
  has_last_ = true;
  last_R_ = record.T_B_H.R;
  last_time_s_ = record.time_s;

  values_[next++] = record.time_s;
  add(record.T_B_H.p);
  add(Eigen::Quaterniond(record.T_B_H.R).coeffs());
  add(record.v_H);
  add(omega);
  add(record.robot.w_H);
  add(record.twin.q_a);
  return values_;
}

/// Both sides of the ring: push functions for the observer, run() for the thread.
class LabStreams::Sender {
 public:
  Sender(const Liblsl& library, const StreamPlan& plan);
  ~Sender() { close(); }

  void push(const Sample& sample) noexcept {
    items_.push({sample.record.time_s, lsl_.local_clock(), values_.of(sample.record)});
  }
  void mark(double time_s, std::string_view name, std::string_view text);
  std::optional<ClockNews> news();
  StreamCounts close();

 private:
  void run();
  void send(const Item& item);
  void append(const Item& item);
  void send_early();
  void flush();
  void send_markers();

  const Liblsl& lsl_;
  const std::size_t channels_;
  ChannelValues values_;
  SpscRing<Item> items_;
  std::atomic<bool> is_closing_{false};

  std::mutex mutex_;  // guards the next three
  std::vector<Marker> markers_;
  std::uint64_t lost_markers_ = 0;
  std::optional<ClockNews> news_;

  // used only by the thread while it runs
  Liblsl::Outlet numbers_ = nullptr, texts_ = nullptr;
  RunClock clock_;
  std::vector<Item> waiting_;  ///< samples until the offset is known
  std::vector<double> chunk_, times_s_;
  StreamCounts counts_;

  std::thread thread_;
};

LabStreams::Sender::Sender(const Liblsl& library, const StreamPlan& plan)
    : lsl_(library),
      channels_(channels(plan.twin).size()),
      items_(static_cast<std::size_t>(std::ceil(kRing_s * plan.rate_Hz))) {
  const Liblsl::Info info =
      lsl_.create_info("HapticGiant", "Haptics", static_cast<std::int32_t>(channels_), plan.rate_Hz,
                       Liblsl::kDouble, plan.source.c_str());
  const Liblsl::Xml description = lsl_.get_description(info);
  lsl_.append_value(description, "manufacturer", "HapticGiant");
  lsl_.append_value(description, "frame", "base");
  const Liblsl::Xml list = lsl_.append_child(description, "channels");
  for (const Channel& channel : channels(plan.twin)) {
    const Liblsl::Xml entry = lsl_.append_child(list, "channel");
    lsl_.append_value(entry, "label", channel.label.c_str());
    lsl_.append_value(entry, "unit", channel.unit.c_str());
    lsl_.append_value(entry, "type", "Haptics");
  }
  numbers_ = lsl_.create_outlet(info, 0, kBuffered_s);
  lsl_.destroy_info(info);
  const Liblsl::Info events = lsl_.create_info("HapticGiantEvents", "Markers", 1, 0.0,
                                               Liblsl::kString, (plan.source + "_events").c_str());
  texts_ = lsl_.create_outlet(events, 0, kBuffered_s);
  lsl_.destroy_info(events);
  if (numbers_ == nullptr || texts_ == nullptr) {
    if (numbers_ != nullptr) lsl_.destroy_outlet(numbers_);
    if (texts_ != nullptr) lsl_.destroy_outlet(texts_);
    throw SetupError("--lsl: no stream can be opened; is there a network, and are ports free?");
  }
  thread_ = std::thread([this] { run(); });
}

void LabStreams::Sender::mark(double time_s, std::string_view name, std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (markers_.size() >= kMostMarkers) {
    ++lost_markers_;
    return;
  }
  markers_.push_back(
      {time_s, text.empty() ? std::string(name) : fmt::format("{}: {}", name, text)});
}

std::optional<ClockNews> LabStreams::Sender::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

StreamCounts LabStreams::Sender::close() {
  if (thread_.joinable()) {
    is_closing_ = true;
    thread_.join();
  }
  StreamCounts counts = counts_;
  counts.dropped = items_.dropped() + lost_markers_ + markers_.size();  // of a run without a sample
  return counts;
}

void LabStreams::Sender::run() {
  Item item;
  for (bool is_last = false; !is_last;) {
    is_last = is_closing_;
    while (items_.pop(item)) send(item);
    if (is_last && clock_.finish()) send_early();  // shorter than what the offset is taken over
    flush();
    send_markers();
    if (!is_last) std::this_thread::sleep_for(kPoll);
  }
  // readers fetch by themselves; nothing shows when they have
  if (lsl_.has_readers(numbers_) != 0 || lsl_.has_readers(texts_) != 0) {
    std::this_thread::sleep_for(kFarewell);
  }
  lsl_.destroy_outlet(numbers_);
  lsl_.destroy_outlet(texts_);
}

void LabStreams::Sender::send(const Item& item) {
  const bool was_known = clock_.is_known();
  if (clock_.see(item.time_s, item.clock_s)) {
    const std::lock_guard lock(mutex_);
    news_ = {.offset_s = clock_.offset_s(), .was_known = was_known};
  }
  if (!clock_.is_known()) {
    waiting_.push_back(item);
    return;
  }
  send_early();
  append(item);
}

void LabStreams::Sender::append(const Item& item) {
  times_s_.push_back(item.time_s + clock_.offset_s());
  chunk_.insert(chunk_.end(), item.values.begin(),
                item.values.begin() + static_cast<std::ptrdiff_t>(channels_));
  if (times_s_.size() >= kMostAtOnce) flush();
}

void LabStreams::Sender::send_early() {
  for (const Item& early : waiting_) append(early);
  waiting_.clear();
}

void LabStreams::Sender::flush() {
  if (times_s_.empty()) return;
  lsl_.push_numbers(numbers_, chunk_.data(), chunk_.size(), times_s_.data(), 1);
  counts_.samples += times_s_.size();
  times_s_.clear();
  chunk_.clear();
}

void LabStreams::Sender::send_markers() {
  if (!clock_.is_known()) return;
  std::vector<Marker> markers;
  {
    const std::lock_guard lock(mutex_);
    markers.swap(markers_);
  }
  for (const Marker& marker : markers) {
    const char* text = marker.text.c_str();
    lsl_.push_text(texts_, &text, marker.time_s + clock_.offset_s(), 1);
    ++counts_.markers;
  }
}

LabStreams::LabStreams(const Liblsl& library, const StreamPlan& plan)
    : sender_(std::make_unique<Sender>(library, plan)) {}
LabStreams::~LabStreams() = default;

void LabStreams::push(const Sample& sample) noexcept { sender_->push(sample); }
void LabStreams::mark(double time_s, std::string_view name, std::string_view text) {
  sender_->mark(time_s, name, text);
}
std::optional<ClockNews> LabStreams::news() { return sender_->news(); }
StreamCounts LabStreams::close() { return sender_->close(); }

}  // namespace hg::lab_streaming
