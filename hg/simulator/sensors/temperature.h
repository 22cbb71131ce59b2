/// Warm-up of a sensor. Source: [HANDBOOK] 4.5.
///   T' = (T_env + dT_self - T) / tau + sigma xi
#pragma once

#include <cmath>

#include "hg/simulator/random_stream.h"

namespace hg::simulator {

/// Set-up data of a sensor's temperature.
struct TemperatureConfig {
  double environment = 0.0;      ///< room minus calibration temperature, K; [A]
  double self_heating = 8.0;     ///< temperature rise by self-heating, K; [A] 4.5
  double time_constant = 600.0;  ///< s, > 0; [A] 4.5
  double fluctuation = 2e-3;     ///< sigma, K/sqrt(s), >= 0; [A] 4.5
  double time_on = 1800.0;       ///< time since power-on at the start, s, >= 0; [A]
};

class Temperature {
 public:
  Temperature(const TemperatureConfig& config, double period, RandomStream random) noexcept
      : end_(config.environment + config.self_heating),
        decay_(std::exp(-period / config.time_constant)),
        sigma_(config.fluctuation * std::sqrt(period)),
        value_(config.environment +
               config.self_heating * -std::expm1(-config.time_on / config.time_constant)),
        random_(random) {}

  /// Advances by one period; returns the temperature above that of calibration, K.
  double next() noexcept {
    value_ = end_ + decay_ * (value_ - end_);
    if (sigma_ > 0.0) value_ += sigma_ * random_.gaussian();
    return value_;
  }

 private:
  double end_, decay_, sigma_, value_;
  RandomStream random_;
};

}  // namespace hg::simulator
