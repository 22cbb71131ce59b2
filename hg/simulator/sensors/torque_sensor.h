/// The torque sensor of one joint. Source: [HANDBOOK] 1.2.
///   y = sat((1 + g) tau + b + r sin(2 N theta + p) + n), rounded to the LSB
/// with N theta the angle of the motor. Gain error g, offset b and phase p are drawn from the seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/interval.h"
#include "hg/simulator/random_stream.h"

namespace hg::simulator {

/// Set-up data of a torque sensor, as shares of the full scale. 0 disables an effect, as does an
/// infinite range.
struct TorqueSensorConfig {
  double noise = 3e-4;  ///< standard deviation of each sample, >= 0; [A] 1.2
  double gain_error =
      3e-3;              ///< standard deviation, >= 0; [A] with the offset 0.5 % accuracy of 1.2
  double offset = 2e-3;  ///< standard deviation, >= 0; [A]
  double ripple = 2e-3;  ///< amplitude of the gear's ripple, twice per motor turn; [A] 1.2
  double range = 1.5;    ///< saturation of the reading, > 0; [A] strain gauges have a reserve
  double resolution = 3.05e-5;  ///< LSB, >= 0; [A] 16 bit from -1 to 1
};

class TorqueSensor {
 public:
  TorqueSensor() = default;
  /// `full_scale` in Nm, > 0; constant errors are drawn from `errors`, the noise of each sample
  /// from `noise`.
  TorqueSensor(const TorqueSensorConfig& config, double full_scale, double gear_ratio,
               RandomStream errors, RandomStream noise) noexcept
      : noise_(noise),
        sigma_(config.noise * full_scale),
        ripple_(config.ripple * full_scale),
        range_(config.range * full_scale),
        lsb_(config.resolution * full_scale),
        wave_number_(2.0 * gear_ratio) {
    gain_ = 1.0 + config.gain_error * errors.gaussian();
    offset_ = config.offset * full_scale * errors.gaussian();
    phase_ = 2.0 * std::numbers::pi * errors.uniform();
  }

  /// Reading at the transmitted torque `tau_J` and the motor angle `theta` (at the output).
  double sample(double tau_J, double theta) noexcept {
    double y = gain_ * tau_J + offset_;
    if (ripple_ > 0.0) y += ripple_ * std::sin(wave_number_ * theta + phase_);
    if (sigma_ > 0.0) y += sigma_ * noise_.gaussian();
    y = std::clamp(y, -range_, range_);
    return lsb_ > 0.0 ? lsb_ * std::round(y / lsb_) : y;
  }

 private:
  RandomStream noise_;
  double sigma_ = 0.0, ripple_ = 0.0, range_ = kInfinity, lsb_ = 0.0, wave_number_ = 0.0;
  double gain_ = 1.0, offset_ = 0.0, phase_ = 0.0;
};

}  // namespace hg::simulator
