/// Options and report of a run.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hg/core/histogram.h"
#include "hg/core/interval.h"
#include "hg/core/stage_probe.h"
#include "hg/runtime/control_thread.h"
#include "hg/signals/fault.h"
#include "hg/signals/operator_desk.h"
#include "hg/signals/state.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_load.h"
#include "hg/signals/timed_panel.h"
#include "hg/signals/twin_force_source.h"

namespace hg::runtime {

/// Options of a run; set-up data.
struct RuntimeOptions {
  bool is_fast = false;     ///< As fast as possible instead of in real time
  double duration_s = 0.0;  ///< Duration until the stop, s; 0 = until request_stop()
  /// Longest wait for standstill before only the brakes stop the device, s: slightly longer than a
  /// controlled stop may take.
  double longest_stop_s = 1.1;
  std::size_t ring = 4096;           ///< Capacity of the ring to the observer, samples
  std::vector<TimedChange> changes;  ///< Changes of the twin, in the order of their times
  std::vector<TimedPanel> panel;     ///< Panels of the operator, in the order of their times
  std::vector<TimedLoad> load;       ///< Late cycles, for tests
  /// What pushes the twin, and outlives the runtime; nullptr = nothing.
  TwinForceSource* twin_force = nullptr;
  TwinBaseSource* twin_base = nullptr;  ///< The same of what moves the twin's root link
  /// true: a fault does not end the run, because an operator can reset it. After a fault no request
  /// is made automatically.
  bool stays_in_fault = false;
  /// Duration above which a cycle is slow and its problem kept, us. In real time only with a
  /// real-time priority; otherwise the duration depends on other programs.
  double slow_cycle_us = kInfinity;
  ThreadOptions thread;  ///< Options of the control thread, in real time
  /// Flag with the effect of request_stop() once true, for a signal handler; nullptr: none.
  const std::atomic<bool>* stop = nullptr;
  /// Inputs of operator pages, read in every cycle and open during the run; nullptr: no pages.
  OperatorDesk* desk = nullptr;
  /// true: late cycles are reported to the cycle, so that too many stop the device, and none is
  /// made up for; for a device that does not wait for its controller. Only with a real-time thread;
  /// otherwise late cycles are only counted.
  bool reports_late_cycles = false;
};

/// Throws SetupError naming the option that is out of range.
void check_runtime_options(const RuntimeOptions& options);

/// Statistics of a run, available after join().
struct RuntimeReport {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;  ///< Cycles that ended after the next one was due, or were left out
  std::uint64_t most_overruns_in_a_row = 0;
  std::uint64_t dropped = 0;          ///< Samples dropped because the ring was full
  std::uint64_t allocations = 0;      ///< Heap allocations inside the loop
  long page_faults = 0;               ///< Page faults inside the loop
  ThreadReport thread;                ///< Real-time properties of the thread, in real time
  bool reported_late_cycles = false;  ///< Late cycles were reported to the cycle
  bool stop_timed_out = false;        ///< Still moving when only the brakes were left to stop it
  bool has_run = false;               ///< The law moved the device in some cycle
  Refusal refusal = Refusal::kNone;   ///< Last refused request
  Fault fault;                        ///< First fault
  Histogram wake_up_us;               ///< Wake-up delay after a cycle was due, in real time
  std::array<Histogram, kStageCount> stage_us;  ///< Durations of the cycle's stages, in real time
};

}  // namespace hg::runtime
