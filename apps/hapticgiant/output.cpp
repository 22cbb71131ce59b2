#include "apps/hapticgiant/output.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>

namespace hg::apps {
namespace {

constexpr std::size_t kMostBytes = 65536;  // that wait
constexpr std::size_t kAtOnce = 512;       // a pipe that takes any takes as many
constexpr int kLook_ms = 50;
constexpr std::chrono::milliseconds kPatience(500);  // after an interruption

void print_now(int file, const std::string& text) {
  std::FILE* stream = file == STDOUT_FILENO ? stdout : stderr;
  std::fputs(text.c_str(), stream);
  std::fflush(stream);
}

}  // namespace

/// Texts between the thread that prints and the one that writes.
class BackgroundOutput::Queue {
 public:
  void push(int file, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + text.size() > kMostBytes) {
      ++left_out_;
      ++not_told_;
      return;
    }
    waiting_bytes_ += text.size();
    texts_.push_back({file, text});
    news_.notify_all();
  }

  bool is_behind() const {
    const std::lock_guard lock(mutex_);
    return !texts_.empty();
  }
  std::uint64_t left_out() const {
    const std::lock_guard lock(mutex_);
    return left_out_;
  }

  // until end(), and what was pushed before
  void write_all() {
    Text text;
    while (take(text)) write(text);
  }

  // false: there is still something to write when `interrupted` and patience has ended
  bool end(const std::atomic<bool>& interrupted) {
    std::unique_lock lock(mutex_);
    is_ending_ = true;
    news_.notify_all();
    auto patient_until = std::chrono::steady_clock::time_point::max();
    while (!has_ended_) {
      news_.wait_for(lock, std::chrono::milliseconds(kLook_ms));
      const auto now = std::chrono::steady_clock::now();
      if (interrupted.load()) patient_until = std::min(patient_until, now + kPatience);
      if (now >= patient_until) return has_ended_;
    }
    return true;
  }

 private:
  struct Text {
    int file;
    std::string text;
  };

  bool take(Text& text) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return is_ending_ || !texts_.empty(); });
    if (texts_.empty()) {
      has_ended_ = true;
      news_.notify_all();
      return false;
    }
    text = std::move(texts_.front());
    texts_.pop_front();
    waiting_bytes_ -= text.text.size();
    if (texts_.empty() && not_told_ > 0) {
      texts_.push_back({text.file, fmt::format("\n({} texts left out: nobody read them)\n",
                                               std::exchange(not_told_, 0))});
      waiting_bytes_ += texts_.back().text.size();
    }
    return true;
  }

  static void write(const Text& text) {
    std::string_view left = text.text;
    while (!left.empty()) {
      pollfd file = {.fd = text.file, .events = POLLOUT, .revents = 0};
      if (poll(&file, 1, kLook_ms) == 0) continue;
      const ssize_t written = ::write(text.file, left.data(), std::min(left.size(), kAtOnce));
      if (written < 0 && errno != EINTR && errno != EAGAIN) return;  // nobody reads it any more
      if (written > 0) left.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  mutable std::mutex mutex_;  // never held while writing
  std::condition_variable news_;
  std::deque<Text> texts_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t left_out_ = 0, not_told_ = 0;
  bool is_ending_ = false, has_ended_ = false;
};

namespace {

// that of the only BackgroundOutput
std::atomic<BackgroundOutput*> background{nullptr};

}  // namespace

void print_out(const std::string& text) {
  BackgroundOutput* const output = background.load();
  if (output == nullptr) return print_now(STDOUT_FILENO, text);
  output->queue_->push(STDOUT_FILENO, text);
}

void print_error(const std::string& text) {
  BackgroundOutput* const output = background.load();
  if (output == nullptr) return print_now(STDERR_FILENO, text);
  output->queue_->push(STDERR_FILENO, text);
}

BackgroundOutput::BackgroundOutput(const std::atomic<bool>& interrupted)
    : interrupted_(interrupted), queue_(std::make_shared<Queue>()) {
  std::fflush(stdout);
  thread_ = std::thread([queue = queue_] { queue->write_all(); });
  background.store(this);
}

BackgroundOutput::~BackgroundOutput() {
  background.store(nullptr);
  if (queue_->end(interrupted_)) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

bool BackgroundOutput::is_behind() const { return queue_->is_behind(); }

std::uint64_t BackgroundOutput::left_out() const { return queue_->left_out(); }

}  // namespace hg::apps
