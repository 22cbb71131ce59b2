#include "hg/recording/flight_recorder.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "hg/core/error.h"
#include "hg/messages/cdr_reader.h"

namespace hg::recording {
namespace {

// only recordings of runs enforce the folder's budget: recording a fault deletes no file
constexpr double kNoBudget = 1e18;
constexpr std::size_t kMostEvents = 1000;  // and lab clocks

std::size_t slot_count(const RecordingInfo& info, double seconds) {
  if (!(seconds > 0.0 && info.rate_Hz > 0.0 && std::isfinite(seconds * info.rate_Hz))) {
    throw SetupError("flight recorder: seconds and rate must be positive, got " +
                     std::to_string(seconds) + " s and " + std::to_string(info.rate_Hz) + " Hz");
  }
  return static_cast<std::size_t>(std::ceil(seconds * info.rate_Hz));
}

// creates a new folder of our own; throws std::exception
std::filesystem::path temporary_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "hapticgiant_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), name);
  return name;
}

}  // namespace

FlightRecorder::FlightRecorder(RecordingInfo info, double seconds)
    : info_(std::move(info)), slots_(slot_count(info_, seconds)) {
  info_.disk_budget_bytes = kNoBudget;
  // large enough for these joints and limits
  Sample sample;
  const auto n_m = static_cast<Eigen::Index>(info_.manipulator_joints.size());
  sample.record.robot.q_m = VectorM::Zero(n_m);
  sample.record.limit_count = static_cast<int>(info_.limits.size());
  const std::size_t bytes = 2 * cdr_.encode(sample).size();
  // touched, not only reserved, so that the memory of a run does not grow later
  for (std::vector<std::byte>& slot : slots_) slot.resize(bytes);
  events_.reserve(kMostEvents);
}

FlightRecorder::~FlightRecorder() { close(); }

void FlightRecorder::push(const Sample& sample) {
  if (is_writing_.load(std::memory_order_acquire)) return;
  const auto bytes = cdr_.encode(sample);
  slots_[pushed_ % slots_.size()].assign(bytes.begin(), bytes.end());
  ++pushed_;
}

void FlightRecorder::event(double time_s, std::string_view name, std::string_view text) {
  if (is_writing_.load(std::memory_order_acquire)) return;
  if (events_.size() == kMostEvents) events_.erase(events_.begin());
  events_.push_back({time_s, std::string(name), std::string(text)});
}

void FlightRecorder::lab_clock(const LabClock& clock) {
  const std::scoped_lock lock(lab_clocks_mutex_);
  if (lab_clocks_.size() == kMostEvents) lab_clocks_.erase(lab_clocks_.begin());
  lab_clocks_.push_back(clock);
}

void FlightRecorder::write(const std::string& cause) {
  if (thread_.joinable()) thread_.join();
  is_writing_.store(true);
  thread_ = std::thread([this, cause] {
    std::string error;
    try {
      error = write_file(cause);
    } catch (const std::exception& exception) {
      error = exception.what();
    }
    if (error.empty()) {
      pushed_ = 0;
    } else {
      result_.error = error;
    }
    is_writing_.store(false, std::memory_order_release);
  });
}

// Returns the error, empty if successful.
std::string FlightRecorder::write_file(const std::string& cause) {
  if (pushed_ == 0) return {};
  const RecordingSummary first = write_to(info_.folder, cause);
  if (first.error.empty()) {
    result_.files.push_back(first.file);
    return {};
  }
  const RecordingSummary second = write_to(temporary_folder(), cause);
  const RecordingSummary& best = second.samples > first.samples ? second : first;
  const RecordingSummary& other = &best == &first ? second : first;
  std::error_code ignored;
  std::filesystem::remove(other.file, ignored);
  if (best.samples > 0) result_.files.push_back(best.file);
  return second.error.empty() ? "" : first.error;
}

// The clocks of the samples from `first_s` on; the first of them may be an older one, which holds.
std::vector<LabClock> FlightRecorder::lab_clocks_from(double first_s) {
  const std::scoped_lock lock(lab_clocks_mutex_);
  std::vector<LabClock> clocks;
  for (LabClock clock : lab_clocks_) {
    clock.time_s = std::max(clock.time_s, first_s);
    if (clock.time_s == first_s) clocks.clear();
    clocks.push_back(clock);
  }
  return clocks;
}

// Reports also the error of a file that cannot be created, in the summary.
RecordingSummary FlightRecorder::write_to(const std::filesystem::path& folder,
                                          const std::string& cause) try {
  RecordingInfo info = info_;
  info.folder = folder;
  info.name += "_" + cause;
  info.is_reproducible = false;  // recording.mcap is that of the run
  Recorder recorder(info);
  const std::uint64_t kept = std::min<std::uint64_t>(pushed_, slots_.size());
  const auto sample = std::make_unique<Sample>();
  double first_s = 0.0;
  for (std::uint64_t i = pushed_ - kept; i < pushed_; ++i) {
    if (!messages::CdrReader(slots_[i % slots_.size()]).decode(*sample)) continue;
    if (i == pushed_ - kept) first_s = sample->record.time_s;
    recorder.push_waiting(*sample);
  }
  for (const Event& event : events_) {
    if (event.time_s >= first_s) recorder.event(event.time_s, event.name, event.text);
  }
  for (const LabClock& clock : lab_clocks_from(first_s)) recorder.lab_clock(clock);
  return recorder.close();
} catch (const SetupError& error) {
  return {.error = error.what()};
}

FlightRecorder::Result FlightRecorder::close() {
  if (thread_.joinable()) thread_.join();
  return result_;
}

}  // namespace hg::recording
