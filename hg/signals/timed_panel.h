/// Actions of a simulated operator at given times, as part of a scenario.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hg/signals/due.h"
#include "hg/signals/frames.h"

namespace hg {

/// State of the panel from a given time on, with one request.
struct TimedPanel {
  double at_s = 0.0;  ///< Nominal time of the run, s; acts from the first cycle at or after it
  SafetyPanel panel;  ///< Panel from that time on
  ModeRequest request = ModeRequest::kNone;  ///< Request made once; kNone: no request
};

/// Returns due panels, each once. No allocation after construction.
class TimedPanels {
 public:
  /// Takes panels in the order of their times.
  explicit TimedPanels(std::vector<TimedPanel> panels) : panels_(std::move(panels)) {}

  /// Panel due in the cycle that begins at `time_s`, one per call; nullptr = none.
  const TimedPanel* due(double time_s) noexcept {
    if (next_ == panels_.size() || !is_due(panels_[next_].at_s, time_s)) return nullptr;
    return &panels_[next_++];
  }

 private:
  std::vector<TimedPanel> panels_;
  std::size_t next_ = 0;
};

}  // namespace hg
