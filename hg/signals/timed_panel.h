/// What a simulated operator does at given times: what a scenario brings along.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hg/signals/frames.h"

namespace hg {

struct TimedPanel {
  double at_s = 0.0;  ///< nominal time of the run; from the first cycle from then on
  SafetyPanel panel;  ///< as it is then
  ModeRequest request = ModeRequest::kNone;  ///< made once; kNone: nothing is asked for
};

/// Hands out each once. No allocation after construction.
class TimedPanels {
 public:
  /// In the order of their times.
  explicit TimedPanels(std::vector<TimedPanel> panels) : panels_(std::move(panels)) {}

  /// For the cycle that begins at `time_s`: what is due, one at a time, or nullptr.
  const TimedPanel* due(double time_s) noexcept {
    if (next_ == panels_.size() || panels_[next_].at_s > time_s) return nullptr;
    return &panels_[next_++];
  }

 private:
  std::vector<TimedPanel> panels_;
  std::size_t next_ = 0;
};

}  // namespace hg
