/// An absolute encoder of one axis. Source: [HANDBOOK] 4.5.
///   y = LSB floor((q + b + e1 sin(s + p1) + e2 sin(2 s + p2)) / LSB + 0.5),  s = 2 pi ratio q / P
/// b and the phases p1, p2 of each encoder are drawn from the seed. Units of the axis: rad or m.
#pragma once

#include <cmath>
#include <numbers>

#include "hg/simulator/random_stream.h"

namespace hg::simulator {

/// Set-up data of an encoder, all seen at the axis itself, behind a gear if there is one. 0
/// disables an effect.
struct EncoderConfig {
  double resolution = 0.0;  ///< LSB on the encoder's own shaft, >= 0
  double offset = 0.0;      ///< standard deviation of the mounting offset, >= 0
  double error_1 = 0.0;     ///< amplitude of the error once per period, >= 0
  double error_2 = 0.0;     ///< amplitude of the error twice per period, >= 0
  /// Period of these errors, on the encoder's own shaft, > 0
  double period = 2.0 * std::numbers::pi;
};

class Encoder {
 public:
  Encoder() = default;
  /// `ratio`: turns of the encoder per turn of the axis, > 0. Its errors are drawn from `random`.
  Encoder(const EncoderConfig& config, double ratio, RandomStream random) noexcept
      : config_(config),
        lsb_(config.resolution / ratio),
        wave_number_(2.0 * std::numbers::pi * ratio / config.period) {
    offset_ = config.offset * random.gaussian();
    phase_1_ = 2.0 * std::numbers::pi * random.uniform();
    phase_2_ = 2.0 * std::numbers::pi * random.uniform();
  }

  /// Reported position for the true position `q`; continuous, not wrapped.
  double reading(double q) const noexcept {
    double y = q + offset_;
    const double s = wave_number_ * q;
    if (config_.error_1 > 0.0) y += config_.error_1 * std::sin(s + phase_1_);
    if (config_.error_2 > 0.0) y += config_.error_2 * std::sin(2.0 * s + phase_2_);
    return lsb_ > 0.0 ? lsb_ * std::floor(y / lsb_ + 0.5) : y;
  }

 private:
  EncoderConfig config_;
  double lsb_ = 0.0;
  double wave_number_ = 1.0;
  double offset_ = 0.0, phase_1_ = 0.0, phase_2_ = 0.0;
};

}  // namespace hg::simulator
