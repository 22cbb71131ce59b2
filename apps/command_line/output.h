/// Output of the program on standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace hg::apps {

/// Exit code instead of 0: the task is done, but the recording or standard output is incomplete.
inline constexpr int kNotWritten = 4;

/// Opens closed descriptors among 0, 1 and 2 in the wrong direction, so that no file or socket of
/// the program gets their number and output to them fails. Call it before opening anything else.
void open_standard_files();

/// Prints to standard output, made visible() (hg/core/visible.h). No effect when the reader has
/// closed: the run continues.
void print_out(const std::string& text);
/// Prints to standard error, made visible().
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

/// The exit code of a program that would end with `code`. Reports on standard error when standard
/// output could not be written completely; a closed reader does not count.
int code_after_output(int code);

/// While it exists, print_out() and print_error() never wait for the reader: a separate thread
/// writes. Beyond 1 MiB of waiting text, for example while a terminal is stopped with Ctrl-S, texts
/// are dropped; their number is reported once reading continues. code_after_output() reports text
/// missing on standard output at the end.
///
/// One instance at a time, created and destroyed by one thread.
class BackgroundOutput {
 public:
  /// `interrupted` must outlive it.
  explicit BackgroundOutput(const std::atomic<bool>& interrupted);
  /// Waits until everything is written, or for half a second once `interrupted` is true.
  ~BackgroundOutput();
  BackgroundOutput(const BackgroundOutput&) = delete;
  BackgroundOutput& operator=(const BackgroundOutput&) = delete;

  /// Importance of a text; a decoration, for example a progress line, may be dropped.
  enum class Worth { kText, kDecoration };
  /// Queues a text for descriptor `file`, unchanged.
  void push(int file, const std::string& text, Worth worth);

  /// Whether text is waiting to be read; decorations should then be skipped.
  bool is_behind() const;

 private:
  class Queue;

  const std::atomic<bool>& interrupted_;
  /// Shared with the thread, which may outlive this: a write can block for ever
  std::shared_ptr<Queue> queue_;
  std::thread thread_;
};

}  // namespace hg::apps
