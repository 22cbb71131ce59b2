/// Runs a cycle on a device: clock, thread, priority, and the rings to everybody else.
///
/// The control thread never waits for an observer: what the ring cannot take is dropped and
/// counted. Only in fast mode, where there is no real time to keep, does it wait.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "hg/core/histogram.h"
#include "hg/core/nonblocking.h"
#include "hg/core/spsc_ring.h"
#include "hg/core/stage_probe.h"
#include "hg/cycle/cycle.h"
#include "hg/device/device.h"
#include "hg/runtime/control_thread.h"
#include "hg/runtime/pace.h"
#include "hg/runtime/schedule.h"
#include "hg/signals/operator_desk.h"
#include "hg/signals/state.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_panel.h"

namespace hg::runtime {

/// Set-up data.
struct Options {
  double rate_Hz = 1000.0;
  bool is_fast = false;     ///< as fast as it can instead of in real time
  double duration_s = 0.0;  ///< then the device is stopped; 0 = until request_stop()
  /// After which a device that still moves is left to its brakes, s: a little longer than a
  /// controlled stop may take.
  double longest_stop_s = 1.1;
  std::size_t ring = 4096;           ///< samples that an observer may fall behind
  std::vector<TimedChange> changes;  ///< of the twin, in the order of their times
  std::vector<TimedPanel> panel;     ///< of the operator, likewise
  /// A fault does not end the run: somebody is there who can reset it. From then on nothing is
  /// asked for by itself any more.
  bool stays_in_fault = false;
  /// A cycle that takes longer is slow: its problem is kept. In real time only with a priority for
  /// it; otherwise the time says more about other programs.
  double slow_cycle_us = kInfinity;
  ThreadOptions thread;  ///< of the control thread, in real time
  /// Once true, the same as request_stop(), without anybody in between; for a signal handler.
  /// nullptr: there is none.
  const std::atomic<bool>* stop = nullptr;
  /// What pages do: looked at in every cycle, and open while there are any. nullptr: no page.
  OperatorDesk* desk = nullptr;
  /// For a machine that does not wait for its controller: the cycle is told how many cycles were
  /// late, so that too many of them stop the device, and none is made up for. Only where the
  /// thread is real time; of an ordinary one, and with a device that waits, they are counted.
  bool tells_late_cycles = false;
};

/// Throws SetupError naming the option that is out of range.
void check(const Options& options);

/// Known after join().
struct Report {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;  ///< cycles that ended after the next one was due, or were left out
  std::uint64_t most_overruns_in_a_row = 0;
  std::uint64_t dropped = 0;      ///< samples that no observer saw
  std::uint64_t allocations = 0;  ///< heap allocations inside the loop
  long page_faults = 0;           ///< inside the loop
  ThreadReport thread;            ///< in real time
  bool told_late_cycles = false;  ///< the cycle was told about them: too many were a fault
  bool stop_timed_out = false;    ///< the device was still moving when it was left to its brakes
  Histogram wake_up_us;           ///< after a cycle was due, in real time
  std::array<Histogram, kStageCount> stage_us;  ///< of the cycle, in real time
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
  /// The same thread: presses the reset button of a simulated safety controller, for one cycle.
  void press_reset() noexcept { is_reset_pressed_.store(true); }
  /// The same thread: asks for a mode, in one of the next cycles. From the first one on nothing is
  /// asked for by itself, except to stop at the end. `stops` is what the desk counted when it was
  /// wanted: one that has been stopped since is left out. False when too many are waiting.
  [[nodiscard]] bool request(ModeRequest request, std::uint32_t stops = 0) noexcept {
    return requests_.push({request, stops});
  }
  /// The same thread: slow motion and pause. Not for a device that is a clock of its own, nor for
  /// a real one: it does not wait.
  Pace& pace() noexcept { return pace_; }

 private:
  struct Request {
    ModeRequest request = ModeRequest::kNone;
    std::uint32_t stops = 0;  ///< that the desk had counted
  };

  void loop() noexcept;
  bool stop_is_requested() const noexcept;
  void run_cycle(Sample& sample) noexcept HG_NONBLOCKING;
  void hand_out(const Sample& sample) noexcept;
  void release(CommandFrame& command) noexcept;
  ParameterChange next_change() noexcept;
  void operate(const Sample& sample, bool is_stopping, OperatorFrame& input) noexcept;
  void play_script(const TimedPanel& due) noexcept;
  void look_at_desk(OperatorFrame& input) noexcept;
  void prepare_thread() noexcept;
  Schedule new_schedule() const noexcept;
  void wait_for_turn(Schedule& schedule) noexcept;
  std::uint32_t late_for_device() const noexcept;
  void count_late(std::uint32_t cycles, OperatorFrame& input) noexcept;
  static void stage_ended(void* runtime, Stage stage) noexcept;
  void count_stages() noexcept;

  Options options_;
  cycle::Cycle& cycle_;
  device::Device& device_;
  SpscRing<Sample> samples_;
  SpscRing<HandTarget> hand_targets_;
  SpscRing<ParameterChange> parameter_changes_;
  SpscRing<Request> requests_;
  std::atomic<bool> is_reset_pressed_{false};
  TimedChanges changes_;
  TimedPanels timed_panels_;
  SafetyPanel timed_panel_;   ///< the last one that was due
  SafetyPanel script_panel_;  ///< what the script holds, without what pages do
  std::uint32_t stops_ = 0, holds_ = 0, script_releases_ = 0;  ///< of the desk, that were seen
  std::optional<std::uint32_t> request_stops_;  ///< of the page's request for the next cycle
  bool is_operated_ = false;                    ///< somebody else asks for modes
  Pace pace_;
  double speed_ = 1.0;                       ///< that the schedule was made for
  std::int64_t read_ns_ = 0, stage_ns_ = 0;  ///< end of the last read() and of the last stage
  std::array<std::int64_t, kStageCount> stage_time_ns_{};  ///< in this cycle
  std::uint64_t overruns_in_a_row_ = 0;
  std::atomic<bool> stop_requested_{false};
  std::atomic<bool> finished_{false};
  Report report_;
  std::thread thread_;
};

}  // namespace hg::runtime
