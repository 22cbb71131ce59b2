/// Changes of a twin's parameters at given times, as part of a scenario.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hg/signals/due.h"
#include "hg/signals/frames.h"

namespace hg {

/// One parameter change with its time.
struct TimedChange {
  double at_s = 0.0;  ///< Nominal time of the run, s; applied in the first cycle at or after it
  ParameterChange change;
};

/// Returns due changes, one per cycle and each once. No allocation after construction.
class TimedChanges {
 public:
  /// Takes changes in the order of their times.
  explicit TimedChanges(std::vector<TimedChange> changes) : changes_(std::move(changes)) {}

  /// Change due in the cycle that begins at `time_s`; Parameter::kNone if none is due.
  ParameterChange due(double time_s) noexcept {
    if (next_ == changes_.size() || !is_due(changes_[next_].at_s, time_s)) return {};
    return changes_[next_++].change;
  }

 private:
  std::vector<TimedChange> changes_;
  std::size_t next_ = 0;
};

}  // namespace hg
