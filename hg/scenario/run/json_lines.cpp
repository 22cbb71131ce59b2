#include "hg/scenario/run/json_lines.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "hg/core/error.h"

namespace hg::scenario {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostBytes = 1 << 20;  // most bytes that wait
constexpr std::size_t kAtOnce = PIPE_BUF;    // a pipe that takes any takes as many
constexpr int kLook_ms = 50;
constexpr std::chrono::seconds kPatience(2);
constexpr int kFirstFile = 3;  // below are standard input, output and error

std::string text_of(FaultCode code) {
  return code == FaultCode::kNone ? std::string() : std::string(to_string(code));
}

}  // namespace

void JsonObserver::link(const std::string& url) { take_({{"link", url}}, Worth::kReport); }

void JsonObserver::phase(RunPhase phase, double time_s, const std::string& wanted) {
  take_({{"phase", to_string(phase)}, {"time_s", time_s}, {"wanted", wanted}}, Worth::kReport);
}

void JsonObserver::event(double time_s, std::string_view name, std::string_view text) {
  take_({{"event", name}, {"time_s", time_s}, {"text", text}}, Worth::kReport);
}

void JsonObserver::status(const Sample& sample, const config::Scenario& /*scenario*/) {
  const CycleRecord& record = sample.record;
  take_({{"status",
          {{"time_s", record.time_s},
           {"mode", to_string(record.mode)},
           {"force_N", record.robot.w_H.head<3>().norm()},
           {"fault", text_of(record.fault.code)}}}},
        Worth::kStatus);
}

void JsonObserver::note(std::string_view label, const std::string& text) {
  take_({{"note", text}, {"label", label}}, Worth::kReport);
}

void JsonObserver::problem(const std::string& text) { take_({{"problem", text}}, Worth::kReport); }

void JsonObserver::fault(const RunFault& fault) {
  take_({{"fault", text_of(fault.fault.code)},
         {"code", static_cast<int>(fault.fault.code)},
         {"time_s", fault.time_s},
         {"figures", fault.figures}},
        Worth::kReport);
}

void JsonObserver::summary(const RunSummary& summary) {
  take_({{"summary", summary.json}, {"exit_code", summary.exit_code}}, Worth::kReport);
}

void JsonObserver::refused(const std::string& why) { take_({{"refused", why}}, Worth::kReport); }

std::string to_line(const Json& report) {
  return report.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Text between the thread that reports and the one that writes.
class LineWriter::Queue {
 public:
  explicit Queue(int file) : file_(file) {}
  ~Queue() { close(file_); }

  void push(const std::string& line, Worth worth) {
    const std::lock_guard lock(mutex_);
    if (is_gone_ || (worth == Worth::kStatus && !waiting_.empty())) return;
    if (!waiting_.empty() && waiting_.size() + line.size() > kMostBytes) {
      ++lost_;
      return;
    }
    waiting_ += line;
    news_.notify_one();
  }

  void end() {
    const std::lock_guard lock(mutex_);
    end_at_ = Clock::now() + kPatience;
    news_.notify_one();
  }

  /// Why writing failed, an errno; 0: it did not, or the reader has closed. Once write_all() ends.
  int error() const { return error_; }

  // runs until end(), and then until all is written or patience has ended
  void write_all() {
    std::string part;
    while (take(part)) {
      const ssize_t written = write(part);
      const bool is_gone = written < 0 && errno != EINTR && errno != EAGAIN;
      if (is_gone && errno != EPIPE) error_ = errno;
      give_back(written > 0 ? static_cast<std::size_t>(written) : 0, is_gone);
    }
  }

 private:
  // writes as ::write() does, but waits a moment only; without a reader it fails before a signal
  ssize_t write(const std::string& part) const {
    pollfd place = {.fd = file_, .events = POLLOUT, .revents = 0};
    if (poll(&place, 1, kLook_ms) <= 0) return 0;
    if ((place.revents & POLLOUT) != 0 && (place.revents & POLLERR) == 0) {
      return ::write(file_, part.data(), part.size());
    }
    errno = EPIPE;
    return -1;
  }

  // the beginning of what waits; false: the end
  bool take(std::string& part) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return end_at_ || !waiting_.empty(); });
    if (end_at_ && (waiting_.empty() || Clock::now() >= *end_at_)) return false;
    part = waiting_.substr(0, kAtOnce);
    return true;
  }

  void give_back(std::size_t written, bool is_gone) {
    const std::lock_guard lock(mutex_);
    waiting_.erase(0, is_gone ? std::string::npos : written);
    is_gone_ = is_gone;
    if (waiting_.empty() && lost_ > 0 && !is_gone) {
      waiting_ = to_line({{"lost", std::exchange(lost_, 0)}});
    }
  }

  const int file_;
  std::mutex mutex_;  // never held while writing
  std::condition_variable news_;
  std::string waiting_;
  std::uint64_t lost_ = 0;  // lines, since the last report
  bool is_gone_ = false;    // the reader
  int error_ = 0;
  std::optional<Clock::time_point> end_at_;
};

namespace {

int checked(int file) {
  const int flags = file < kFirstFile ? -1 : fcntl(file, F_GETFL);
  if (flags == -1 || (flags & O_ACCMODE) == O_RDONLY) {
    throw SetupError(fmt::format(
        "--report-to: expected a descriptor from {} on that is open for writing, got {}",
        kFirstFile, file));
  }
  fcntl(file, F_SETFD, FD_CLOEXEC);
  return file;
}

}  // namespace

LineWriter::LineWriter(int file) : queue_(std::make_unique<Queue>(checked(file))) {
  thread_ = std::thread([this] { queue_->write_all(); });
}

LineWriter::~LineWriter() { end(); }

std::string LineWriter::end() {
  if (thread_.joinable()) {
    queue_->end();
    thread_.join();
  }
  return queue_->error() == 0 ? std::string() : std::strerror(queue_->error());
}

void LineWriter::push(const std::string& line, Worth worth) { queue_->push(line, worth); }

}  // namespace hg::scenario
