/// Runs a cycle on a device: clock, thread, priority, and the rings to everybody else.
///
/// The control thread never waits for an observer: what the ring cannot take is dropped and
/// counted. Only in fast mode, where there is no real time to keep, does it wait.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "hg/core/spsc_ring.h"
#include "hg/cycle/cycle.h"
#include "hg/device/device.h"
#include "hg/runtime/pace.h"
#include "hg/runtime/schedule.h"
#include "hg/signals/state.h"
#include "hg/signals/timed_changes.h"

namespace hg::runtime {

/// Set-up data.
struct Options {
  double rate_Hz = 1000.0;
  bool is_fast = false;              ///< as fast as it can instead of in real time
  double duration_s = 0.0;           ///< then the device is stopped; 0 = until request_stop()
  std::size_t ring = 4096;           ///< samples that an observer may fall behind
  std::vector<TimedChange> changes;  ///< of the twin, in the order of their times
  /// A cycle that takes longer is slow: its problem is kept. In real time only with a priority for
  /// it; otherwise the time says more about other programs.
  double slow_cycle_us = kInfinity;
};

/// Throws SetupError naming the option that is out of range.
void check(const Options& options);

/// Known after join().
struct Report {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;     ///< cycles that ended after the next one was due, or were skipped
  std::uint64_t dropped = 0;      ///< samples that no observer saw
  std::uint64_t allocations = 0;  ///< heap allocations inside the loop
  bool is_real_time = false;      ///< the thread ran with SCHED_FIFO
  bool is_memory_locked = false;  ///< and could not be paged out
  bool stop_timed_out = false;    ///< the device was still moving when it was left to its brakes
};

class Runtime {
 public:
  /// `cycle` and `device` must outlive the runtime and belong to it from start() to join().
  Runtime(const Options& options, cycle::Cycle& cycle, device::Device& device);
  ~Runtime();

  /// Starts the control thread: arms the device, runs while the dead-man is closed, and stops it at
  /// the end. Whatever ends the loop, the last command disables the drives.
  void start();
  /// Asks for a controlled stop; the device comes to rest first. May be called from any thread.
  void request_stop() noexcept { stop_requested_.store(true); }
  bool is_finished() const noexcept { return finished_.load(); }
  Report join();

  /// One observer thread: the next sample, false if there is none yet.
  bool pop(Sample& sample) noexcept { return samples_.pop(sample); }
  /// One observer thread: problems of the solver that failed or were slow.
  const hqp::KeptProblems& kept_problems() const noexcept { return cycle_.kept_problems(); }
  /// One operator thread: where a simulated hand should go; from the next cycle on.
  void set_hand_target(const HandTarget& target) noexcept { hand_targets_.push(target); }
  /// The same thread: a value of the twin, taken by one of the next cycles; those of Options come
  /// first. False when too many are waiting.
  [[nodiscard]] bool change(const ParameterChange& change) noexcept {
    return parameter_changes_.push(change);
  }
  /// The same thread: slow motion and pause. Not for a device that is a clock of its own, nor for
  /// a real one: it does not wait.
  Pace& pace() noexcept { return pace_; }

 private:
  void loop() noexcept;
  void run_cycle(Sample& sample) noexcept;
  void hand_out(const Sample& sample) noexcept;
  void release(CommandFrame& command) noexcept;
  ParameterChange next_change() noexcept;
  void wait_for_turn(Schedule& schedule) noexcept;

  Options options_;
  cycle::Cycle& cycle_;
  device::Device& device_;
  SpscRing<Sample> samples_;
  SpscRing<HandTarget> hand_targets_;
  SpscRing<ParameterChange> parameter_changes_;
  TimedChanges changes_;
  Pace pace_;
  double speed_ = 1.0;  ///< that the schedule was made for
  std::atomic<bool> stop_requested_{false};
  std::atomic<bool> finished_{false};
  Report report_;
  std::thread thread_;
};

}  // namespace hg::runtime
