/// What the program says on standard output and standard error.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

namespace hg::apps {

/// To standard output. Nothing happens when nobody reads it any more: the run goes on.
void print_out(const std::string& text);
/// To standard error.
void print_error(const std::string& text);

/// While it lives, print_out() and print_error() never wait for who reads them: a thread of its own
/// writes. Of more than 64 KiB that wait, for example while a terminal is stopped with Ctrl-S, the
/// rest is left out and counted.
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

  /// Whether something waits to be read: no time for what is only nice to know.
  bool is_behind() const;
  /// Texts that were left out until now.
  std::uint64_t left_out() const;

 private:
  friend void print_out(const std::string& text);
  friend void print_error(const std::string& text);
  class Queue;

  const std::atomic<bool>& interrupted_;
  std::shared_ptr<Queue> queue_;  ///< its thread may outlive this: a write can be stuck for ever
  std::thread thread_;
};

}  // namespace hg::apps
