/// Load on the computer that runs the cycle, at given times: late cycles and a solver cut short.
/// For tests and studies of the controller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hg {

/// Load during one interval of a run.
struct TimedLoad {
  double from_s = 0.0;                 ///< Time of the first cycle, s
  double for_s = 0.0;                  ///< Duration, s; 0 = until the end of the run
  std::uint32_t late_cycles = 0;       ///< Number of first cycles that begin one period late
  std::uint32_t most_active_sets = 0;  ///< Cap on active sets of the solver; 0 = none
};

/// Returns the load of each cycle. No allocation after construction.
class TimedLoads {
 public:
  TimedLoads() = default;
  explicit TimedLoads(std::vector<TimedLoad> loads)
      : loads_(std::move(loads)), passed_(loads_.size(), 0) {}

  /// Number of late cycles before the cycle that begins at `time_s`, 0 or 1. Once per cycle.
  std::uint32_t late_cycles(double time_s) noexcept {
    std::uint32_t late = 0;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      if (is_active(loads_[i], time_s) && passed_[i]++ < loads_[i].late_cycles) late = 1;
    }
    return late;
  }

  /// Cap on active sets in the cycle that begins at `time_s`; 0 = none.
  std::uint32_t most_active_sets(double time_s) const noexcept {
    std::uint32_t most = 0;
    for (const TimedLoad& load : loads_) {
      if (is_active(load, time_s) && load.most_active_sets > 0) most = load.most_active_sets;
    }
    return most;
  }

 private:
  static bool is_active(const TimedLoad& load, double time_s) noexcept {
    const double since_s = time_s - load.from_s;
    return since_s >= 0.0 && (load.for_s == 0.0 || since_s < load.for_s);
  }

  std::vector<TimedLoad> loads_;
  std::vector<std::uint32_t> passed_;  ///< Cycles since the begin of each load
};

}  // namespace hg
