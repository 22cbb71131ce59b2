#include "apps/hapticgiant/terminal_crew.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "hg/core/error.h"

namespace hg::apps {
namespace {

// A key that is held comes again: first after half a second on most machines, then quickly.
constexpr std::int64_t kFirst_ns = 700'000'000, kAgain_ns = 250'000'000;

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace

TerminalCrew::TerminalCrew(const std::atomic<bool>& interrupted, Print print)
    : interrupted_(interrupted), print_(std::move(print)) {
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw SetupError(
        "commission: standard input must be a terminal: a machine moves only while a person holds "
        "the space bar there");
  }
  termios single = before_;
  single.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  // neither Ctrl-S nor Ctrl-Z may hold up a program whose drives are on
  single.c_iflag &= ~static_cast<tcflag_t>(IXON);
  single.c_cc[VSUSP] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &single);
  reader_ = std::thread([this] { read_keys(); });
}

TerminalCrew::~TerminalCrew() {
  is_over_ = true;
  reader_.join();
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void TerminalCrew::read_keys() {
  constexpr int kLook_ms = 50;
  std::int64_t last_ns = 0;  // of the space bar
  while (!is_over_) {
    pollfd input = {.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, kLook_ms) <= 0) continue;
    char key = 0;
    if (read(STDIN_FILENO, &key, 1) != 1) return;  // closed: no key is held any more
    if (key == ' ') {
      const std::int64_t now = now_ns();
      held_until_ns_ = now + (now - last_ns < kAgain_ns ? kAgain_ns : kFirst_ns);
      last_ns = now;
    }
    if (key == 'y' || key == 'n') answer_ = key;
  }
}

bool TerminalCrew::holds_key() { return now_ns() < held_until_ns_; }

void TerminalCrew::say(double time_s, const std::string& words) {
  time_s_ = time_s;
  print_(time_s, words);
}

void TerminalCrew::ask(const commission::Question& question) {
  answer_ = 0;
  if (!question.words.empty()) print_(time_s_, "-> " + question.words + " (y or n)");
}

std::optional<bool> TerminalCrew::answer() {
  const char key = answer_;
  if (key == 0) return std::nullopt;
  return key == 'y';
}

}  // namespace hg::apps
