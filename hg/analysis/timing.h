/// Timing quality of the control thread of a run, for people and scripts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/core/histogram.h"

namespace hg::analysis {

using hg::Distribution;
using hg::Histogram;

struct StageTime {
  std::string name;
  Distribution us;
};

/// Timing facts of a run that only the runtime has.
struct Timing {
  bool is_fast = false;  ///< run without waiting: only overruns, priority 0
  int priority = 0;      ///< SCHED_FIFO priority; 0 = an ordinary thread
  /// Reason why the system refused the priority; empty = not requested
  std::string priority_refusal;
  int cpu = -1;                   ///< CPU of the thread; -1 = any
  std::string cpu_refusal;        ///< reason why the system refused the CPU; empty = not requested
  bool is_memory_locked = false;  ///< memory locked by mlockall
  long page_faults = 0;           ///< page faults in the loop
  std::uint64_t overruns = 0;     ///< number of cycles that ended too late or were left out
  std::uint64_t most_overruns_in_a_row = 0;
  bool overruns_stop = false;     ///< too many overruns would have been a fault
  Histogram wake_up_us;           ///< delay of the begin of a cycle after it was due
  std::vector<StageTime> stages;  ///< times of the stages of the cycle; empty = not measured
};

/// Scheduling as text: "real time, priority 80, memory locked", or the reasons why not.
std::string priority_text(const Timing& timing);
/// Lines "  label        text\n" on wake-ups, late cycles and stages, as far as there are any.
std::string timing_lines(const Timing& timing);
/// Adds the timing keys to the top level of a summary.
void add_to(nlohmann::ordered_json& json, const Timing& timing);

nlohmann::ordered_json to_json(const Distribution& distribution);
/// Median, 99.9th percentile, maximum and how many values were below 1, 2, 5, 10, ... 1e6.
nlohmann::ordered_json to_json(const Histogram& histogram);

}  // namespace hg::analysis
