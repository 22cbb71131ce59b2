/// Faults of the computer, at given times: late cycles, a solver cut short. For tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "hg/signals/due.h"

namespace hg {

/// Late cycles in one interval of a run.
struct TimedLoad {
  double from_s = 0.0;            ///< Time of the first cycle, s
  double for_s = 0.0;             ///< Duration, s; 0 = until the end of the run
  std::uint32_t late_cycles = 0;  ///< Number of first cycles that begin one period late
};

/// Returns the late cycles before each cycle. No allocation after construction.
class TimedLoads {
 public:
  explicit TimedLoads(std::vector<TimedLoad> loads)
      : loads_(std::move(loads)), passed_(loads_.size(), 0) {}

  /// Number of late cycles before the cycle that begins at `time_s`, 0 or 1. Once per cycle.
  std::uint32_t late_cycles(double time_s) noexcept {
    std::uint32_t late = 0;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      const TimedLoad& load = loads_[i];
      if (is_within(load.from_s, load.for_s, time_s) && passed_[i]++ < load.late_cycles) late = 1;
    }
    return late;
  }

 private:
  std::vector<TimedLoad> loads_;
  std::vector<std::uint32_t> passed_;  ///< Cycles since the begin of each load
};

/// Cap on the solver in one interval of a run.
struct SolverCap {
  double from_s = 0.0;                 ///< Time of the first cycle, s
  double for_s = 0.0;                  ///< Duration, s; 0 = until the end of the run
  std::uint32_t most_active_sets = 0;  ///< Largest number of active sets of a solve; 0 = no cap
};

/// Cap on active sets in the cycle that begins at `time_s`, the last one of `caps`; 0 = none.
inline std::uint32_t most_active_sets(const std::vector<SolverCap>& caps, double time_s) noexcept {
  std::uint32_t most = 0;
  for (const SolverCap& cap : caps) {
    if (is_within(cap.from_s, cap.for_s, time_s)) most = cap.most_active_sets;
  }
  return most;
}

}  // namespace hg
