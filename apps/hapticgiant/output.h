/// What the program says on standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace hg::apps {

/// Exit code where it would be 0: what was asked for is done, but the recording or standard output
/// does not hold all of it.
inline constexpr int kNotWritten = 4;

/// Opens those of the descriptors 0, 1 and 2 that are closed, for the wrong direction: no file and
/// no socket of the program becomes one of them, and what is printed there fails. Call it before
/// anything else is opened.
void open_standard_files();

/// To standard output, made visible() (hg/core/visible.h). Nothing happens when nobody reads it any
/// more: the run goes on.
void print_out(const std::string& text);
/// To standard error, made visible().
void print_error(const std::string& text);

template <typename First, typename... Rest>
void print_out(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
  print_out(fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...));
}
template <typename First, typename... Rest>
void print_error(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
  print_error(fmt::format(format, std::forward<First>(first), std::forward<Rest>(rest)...));
}

/// Replaces the line of the terminal on which the cursor is, on standard output or standard error.
void draw_out(const std::string& line);
void draw_error(const std::string& line);

/// The exit code of a program that would end with `code`. Says on standard error when standard
/// output could not be written, or did not get all; a reader that has gone is none of that.
int code_after_output(int code);

/// While it lives, print_out() and print_error() never wait for who reads them: a thread of its own
/// writes. Of more than 1 MiB that wait, for example while a terminal is stopped with Ctrl-S, the
/// rest is left out; how many texts that were is said as soon as somebody reads again. What
/// standard output has not got at the end, code_after_output() tells.
///
/// One at a time, made and destroyed by one thread.
class BackgroundOutput {
 public:
  /// `interrupted` must outlive it.
  explicit BackgroundOutput(const std::atomic<bool>& interrupted);
  /// Waits until everything is written, or for half a second once `interrupted` is true.
  ~BackgroundOutput();
  BackgroundOutput(const BackgroundOutput&) = delete;
  BackgroundOutput& operator=(const BackgroundOutput&) = delete;

  /// Nobody misses a decoration, for example a line that shows how far it is.
  enum class Worth { kText, kDecoration };
  /// Takes a text for descriptor `file`, as it is.
  void push(int file, const std::string& text, Worth worth);

  /// Whether something waits to be read: no time for what is only nice to know.
  bool is_behind() const;

 private:
  class Queue;

  const std::atomic<bool>& interrupted_;
  std::shared_ptr<Queue> queue_;  ///< its thread may outlive this: a write can be stuck for ever
  std::thread thread_;
};

}  // namespace hg::apps
