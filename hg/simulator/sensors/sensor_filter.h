/// The filter of a digital sensor: mean of the newest samples, reported after a delay.
///
/// Window and delay are whole numbers of plant steps. The first value is taken as the entire past.
/// Copyable, no allocation after set-up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "hg/core/error.h"

namespace hg::simulator {

/// Maximum of window and delay together, in steps of the plant.
inline constexpr int kMaxFilterSteps = 128;

/// Set-up data of a sensor filter. [C] 2: mass compensation needs the same filter for wrench and
/// acceleration.
struct SensorFilterConfig {
  double average = 1e-3;  ///< window of the mean, s, >= 0; less than a step: no averaging; [A] 1.6
  double delay = 1.5e-3;  ///< further delay, s, >= 0; [A] 1.6
};

/// Filter of vectors; `Value` is a vector of fixed size.
template <class Value>
class SensorFilter {
 public:
  /// Throws SetupError when window and delay together exceed kMaxFilterSteps steps of `step`
  /// seconds.
  SensorFilter(const SensorFilterConfig& config, double step) {
    const double window = std::max(1.0, std::round(config.average / step));
    const double delay = std::round(config.delay / step);
    if (!(window + delay <= kMaxFilterSteps))
      throw SetupError("filter of a sensor: window and delay must not exceed " +
                       std::to_string(kMaxFilterSteps) + " steps of the plant, got " +
                       std::to_string(window + delay));
    window_ = static_cast<int>(window);
    length_ = window_ + static_cast<int>(delay);
  }

  void push(const Value& value) noexcept {
    if (!has_values_) {
      values_.fill(value);
      has_values_ = true;
    }
    values_[newest_ = (newest_ + 1) % length_] = value;
  }

  Value output() const noexcept {
    Value sum = Value::Zero();
    for (int k = 1; k <= window_; ++k)  // the oldest ones
      sum += values_[(newest_ + k) % length_];
    return sum / window_;
  }

 private:
  std::array<Value, kMaxFilterSteps> values_{};
  int window_ = 1, length_ = 1, newest_ = 0;
  bool has_values_ = false;
};

}  // namespace hg::simulator
