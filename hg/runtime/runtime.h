/// Runs a cycle on a device: clock, thread, priority, and rings to observers and operator.
///
/// The control thread never waits for an observer: samples that do not fit the ring are dropped and
/// counted. It waits only in fast mode, which is not real time.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

#include "hg/core/nonblocking.h"
#include "hg/core/schedule.h"
#include "hg/core/spsc_ring.h"
#include "hg/core/stage_probe.h"
#include "hg/device/connected_device.h"
#include "hg/runtime/control_thread.h"
#include "hg/runtime/pace.h"
#include "hg/runtime/runtime_options.h"
#include "hg/runtime/session.h"
#include "hg/signals/operator_desk.h"
#include "hg/signals/state.h"
#include "hg/signals/timed_panel.h"

namespace hg::controller {
class Cycle;
}
namespace hg::hqp {
class ProblemCapture;
}

namespace hg::runtime {

/// Control loop in its own thread.
class Runtime {
 public:
  /// `cycle` and `device` must outlive the runtime and belong to it from start() to join().
  Runtime(const RuntimeOptions& options, controller::Cycle& cycle, device::Device& device);
  ~Runtime();

  /// Starts the control thread: arms the device, runs while the dead-man switch is closed, stops it
  /// at the end. The last command always disables the drives.
  void start();
  /// Requests a controlled stop and the end of the run after standstill. Callable from any thread.
  void request_stop() noexcept { stop_requested_.store(true); }
  bool is_finished() const noexcept { return finished_.load(); }
  /// Waits for the end of the run and returns its statistics.
  RuntimeReport join();

  /// Takes the next sample; false if there is none yet. One observer thread only.
  bool pop(Sample& sample) noexcept { return samples_.pop(sample); }
  /// Problems of failed or slow solves. One observer thread only.
  const hqp::ProblemCapture& kept_problems() const noexcept;
  /// Sets the target of a simulated hand from the next cycle on. False if it has no place, as in a
  /// long pause: to be repeated. One operator thread only.
  [[nodiscard]] bool set_hand_target(const HandTarget& target) noexcept {
    return hand_targets_.push(target);
  }
  /// Queues a parameter change of the twin for one of the next cycles, after due changes of
  /// RuntimeOptions. False if the queue is full. Operator thread only.
  [[nodiscard]] bool change(const ParameterChange& change) noexcept {
    return parameter_changes_.push(change);
  }
  /// Presses the reset button of a simulated safety controller for one cycle. Operator thread only.
  void press_reset() noexcept { is_reset_pressed_.store(true); }
  /// Queues a mode request for one of the next cycles. From the first one that takes over
  /// (takes_over()) no request is made automatically, except the stop at the end. `stops` is the
  /// desk's stop count at the time of the request: a request older than the last stop is dropped.
  /// False if the queue is full. Operator thread only.
  [[nodiscard]] bool request(ModeRequest request, std::uint32_t stops = 0) noexcept {
    return requests_.push({request, stops});
  }
  /// Slow motion and pause. Not for a device that is the clock, nor for a real one, which does not
  /// wait. Operator thread only.
  Pace& pace() noexcept { return pace_; }

 private:
  struct Request {
    ModeRequest request = ModeRequest::kNone;
    std::uint32_t stops = 0;  ///< Stop count of the desk at the time of the request
  };

  void loop() noexcept;
  bool stop_is_requested() const noexcept;
  void run_cycle() noexcept HG_NONBLOCKING;
  void note(const CycleRecord& record) noexcept;
  void hand_out(const Sample& sample) noexcept;
  void release(CommandFrame& command) noexcept;
  void operate(bool is_stopping) noexcept;
  void play_script(const TimedPanel& due) noexcept;
  void read_desk(OperatorFrame& input) noexcept;
  void prepare_thread() noexcept;
  Schedule new_schedule() const noexcept;
  void wait_for_turn(Schedule& schedule) noexcept;
  std::uint32_t late_for_device() noexcept;
  void count_late(std::uint32_t cycles) noexcept;
  static void stage_ended(void* runtime, Stage stage) noexcept;
  void count_stages() noexcept;

  RuntimeOptions options_;
  controller::Cycle& cycle_;
  device::Device& device_;
  const device::ConnectedDevice* connection_;  ///< the same; null: it is none
  Session session_;
  SpscRing<Sample> samples_;
  SpscRing<HandTarget> hand_targets_;
  SpscRing<ParameterChange> parameter_changes_;
  SpscRing<Request> requests_;
  std::atomic<bool> is_reset_pressed_{false};
  TimedPanels timed_panels_;
  SafetyPanel timed_panel_;   ///< Last due panel of the script
  SafetyPanel script_panel_;  ///< Panel by the script alone, without pages
  std::uint32_t stops_ = 0, holds_ = 0, script_releases_ = 0;  ///< Last counts read from the desk
  std::optional<std::uint32_t> request_stops_;  ///< Stop count of the next page request
  bool is_operated_ = false;                    ///< Modes are requested by operator or script
  Pace pace_;
  double speed_ = 1.0;                       ///< Speed of the present schedule
  std::int64_t read_ns_ = 0, stage_ns_ = 0;  ///< End of the last read() and of the last stage
  std::array<std::int64_t, kStageCount> stage_time_ns_{};  ///< Durations of stages in this cycle
  std::uint64_t overruns_in_a_row_ = 0;
  std::atomic<bool> stop_requested_{false};
  std::atomic<bool> finished_{false};
  RuntimeReport report_;
  std::thread thread_;
};

}  // namespace hg::runtime
