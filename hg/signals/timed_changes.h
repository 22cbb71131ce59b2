/// Changes of a twin's parameters at given times: what a scenario brings along.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hg/signals/frames.h"

namespace hg {

struct TimedChange {
  double at_s = 0.0;  ///< nominal time of the run; the first cycle from then on takes it
  ParameterChange change;
};

/// Hands out one change per cycle, each once. No allocation after construction.
class TimedChanges {
 public:
  /// In the order of their times.
  explicit TimedChanges(std::vector<TimedChange> changes) : changes_(std::move(changes)) {}

  /// For the operator frame of the cycle that begins at `time_s`: what is due, or nothing.
  ParameterChange due(double time_s) noexcept {
    if (next_ == changes_.size() || changes_[next_].at_s > time_s) return {};
    return changes_[next_++].change;
  }

 private:
  std::vector<TimedChange> changes_;
  std::size_t next_ = 0;
};

}  // namespace hg
