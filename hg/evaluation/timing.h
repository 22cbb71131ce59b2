/// How well the control thread of a run kept its times, for people and scripts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/core/histogram.h"

namespace hg::evaluation {

using hg::Distribution;
using hg::Histogram;

struct StageTime {
  std::string name;
  Distribution us;
};

/// What the runtime alone knows.
struct Timing {
  bool is_fast = false;           ///< nothing was waited for: only overruns, priority 0
  int priority = 0;               ///< of SCHED_FIFO; 0 = an ordinary thread
  std::string priority_refusal;   ///< why the system refused it; empty = it was not asked for
  int cpu = -1;                   ///< the only one it ran on; -1 = any
  std::string cpu_refusal;        ///< likewise
  bool is_memory_locked = false;  ///< mlockall
  long page_faults = 0;           ///< in the loop
  std::uint64_t overruns = 0;     ///< cycles that ended too late, or were left out
  std::uint64_t most_overruns_in_a_row = 0;
  bool overruns_stop = false;     ///< too many of them would have been a fault
  Histogram wake_up_us;           ///< how long after it was due a cycle began
  std::vector<StageTime> stages;  ///< of the cycle; empty = not measured
};

/// "real time, priority 80, memory locked" or why not.
std::string priority_text(const Timing& timing);
/// Lines "  label        text\n" on wake-ups, late cycles and stages, as far as there are any.
std::string timing_lines(const Timing& timing);
/// Keys for the top level of a summary.
void add_to(nlohmann::ordered_json& json, const Timing& timing);

nlohmann::ordered_json to_json(const Distribution& distribution);
/// Median, 99.9th percentile, maximum and how many values were below 1, 2, 5, 10, ... 1e6.
nlohmann::ordered_json to_json(const Histogram& histogram);

}  // namespace hg::evaluation
