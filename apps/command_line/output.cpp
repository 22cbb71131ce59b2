#include "apps/command_line/output.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>

#include "hg/core/visible.h"

namespace hg::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostBytes = 1 << 20;  // most bytes that wait
constexpr std::size_t kAtOnce = 512;         // a pipe that takes any takes as many
constexpr int kLook_ms = 50;
constexpr std::chrono::milliseconds kPatience(500);  // after an interruption

// error that prevented writing standard output; 0 = none
std::atomic<int> output_error{0};
// texts for standard output that were not read in time
std::atomic<std::uint64_t> lost_texts{0};

// no error of the program: a pipe is closed, a terminal hung up
bool reader_has_gone(int file, int error) {
  struct stat status {};
  return error == EPIPE || (error == EIO && fstat(file, &status) == 0 && S_ISCHR(status.st_mode));
}

// waits until all is taken, or until `patient_until`
void write_all(int file, std::string_view text,
               Clock::time_point patient_until = Clock::time_point::max()) {
  while (!text.empty()) {
    pollfd place = {.fd = file, .events = POLLOUT, .revents = 0};
    if (poll(&place, 1, kLook_ms) == 0) {
      if (Clock::now() >= patient_until) return;
      continue;
    }
    const ssize_t written = ::write(file, text.data(), std::min(text.size(), kAtOnce));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) {
      if (file == STDOUT_FILENO && !reader_has_gone(file, errno)) output_error = errno;
      return;
    }
    text.remove_prefix(written);
  }
}

}  // namespace

/// Texts between the thread that prints and the one that writes.
class BackgroundOutput::Queue {
 public:
  void push(int file, const std::string& text, Worth worth) {
    const std::lock_guard lock(mutex_);
    if (!texts_.empty() && waiting_bytes_ + text.size() > kMostBytes) {
      ++left_out_;
      lose({file, text, worth});
      return;
    }
    waiting_bytes_ += text.size();
    texts_.push_back({file, text, worth});
    news_.notify_all();
  }

  bool is_behind() const {
    const std::lock_guard lock(mutex_);
    return !texts_.empty();
  }

  // runs until end(), and writes everything pushed before
  void write_all() {
    Text text;
    while (take(text)) apps::write_all(text.file, text.text);
  }

  // false: there is still something to write when `interrupted` and patience has ended
  bool end(const std::atomic<bool>& interrupted) {
    std::unique_lock lock(mutex_);
    is_ending_ = true;
    news_.notify_all();
    auto patient_until = Clock::time_point::max();
    while (!has_ended_) {
      news_.wait_for(lock, std::chrono::milliseconds(kLook_ms));
      const auto now = Clock::now();
      if (interrupted.load()) patient_until = std::min(patient_until, now + kPatience);
      if (now >= patient_until) break;
    }
    if (has_ended_) return true;
    lose(under_way_);
    for (const Text& text : texts_) lose(text);
    return false;
  }

 private:
  struct Text {
    int file;
    std::string text;
    Worth worth;
  };

  static void lose(const Text& text) {
    if (text.file == STDOUT_FILENO && text.worth == BackgroundOutput::Worth::kText) ++lost_texts;
  }

  bool take(Text& text) {
    std::unique_lock lock(mutex_);
    under_way_ = {};
    news_.wait(lock, [this] { return is_ending_ || !texts_.empty(); });
    if (texts_.empty()) {
      has_ended_ = true;
      news_.notify_all();
      return false;
    }
    text = std::move(texts_.front());
    texts_.pop_front();
    under_way_ = {text.file, {}, text.worth};
    waiting_bytes_ -= text.text.size();
    if (texts_.empty() && left_out_ > 0) {
      texts_.push_back(
          {text.file,
           fmt::format("\n({} texts left out: they were not read)\n", std::exchange(left_out_, 0)),
           BackgroundOutput::Worth::kText});
      waiting_bytes_ += texts_.back().text.size();
    }
    return true;
  }

  mutable std::mutex mutex_;  // never held while writing
  std::condition_variable news_;
  std::deque<Text> texts_;
  Text under_way_ = {};  // text being written, without its content
  std::size_t waiting_bytes_ = 0;
  std::uint64_t left_out_ = 0;  // texts, since the last report
  bool is_ending_ = false, has_ended_ = false;
};

namespace {

// the only BackgroundOutput, if any
std::atomic<BackgroundOutput*> background{nullptr};

// as it is
void print(int file, const std::string& text, BackgroundOutput::Worth worth) {
  BackgroundOutput* const output = background.load();
  if (output == nullptr) return write_all(file, text);
  output->push(file, text, worth);
}

// the cursor back at its beginning: what is printed next takes its place
std::string drawn(const std::string& line) { return "\r\033[K" + visible(line) + "\r"; }

}  // namespace

void open_standard_files() {
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(file, F_GETFD) != -1) continue;
    // the lowest that is free: `file`
    if (open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY) != file) std::abort();
  }
}

void print_out(const std::string& text) {
  print(STDOUT_FILENO, visible(text), BackgroundOutput::Worth::kText);
}

void print_error(const std::string& text) {
  print(STDERR_FILENO, visible(text), BackgroundOutput::Worth::kText);
}

void draw_out(const std::string& line) {
  print(STDOUT_FILENO, drawn(line), BackgroundOutput::Worth::kDecoration);
}

void draw_error(const std::string& line) {
  print(STDERR_FILENO, drawn(line), BackgroundOutput::Worth::kDecoration);
}

int code_after_output(int code) {
  const int error = output_error.load();
  const std::uint64_t lost = lost_texts.load();
  if (error == 0 && lost == 0) return code;
  const std::string why = error != 0
                              ? std::strerror(error)
                              : fmt::format("{} text{} not read", lost, lost == 1 ? "" : "s");
  // standard error may have the same reader, which does not read
  write_all(STDERR_FILENO, fmt::format("standard output could not be written: {}\n", why),
            Clock::now() + kPatience);
  return code == 0 ? kNotWritten : code;
}

BackgroundOutput::BackgroundOutput(const std::atomic<bool>& interrupted)
    : interrupted_(interrupted), queue_(std::make_shared<Queue>()) {
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

void BackgroundOutput::push(int file, const std::string& text, Worth worth) {
  queue_->push(file, text, worth);
}

bool BackgroundOutput::is_behind() const { return queue_->is_behind(); }

}  // namespace hg::apps
