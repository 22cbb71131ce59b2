/// Winding temperature of a motor and the reading of its sensor. Copper losses heat the winding,
/// the frame cools it: first order, so that continuous rated torque ends at the rated temperature.
///   T' = (T_room + rise (tau / tau_rated)^2 - T) / time_constant
#pragma once

#include <cmath>

namespace hg::simulator {

/// Set-up data of a motor's heating. [A]: typical of frameless motors on a robot's joint,
/// datasheets give no more.
struct MotorHeatConfig {
  double room = 22.0;            ///< room temperature, degrees Celsius
  double rise = 50.0;            ///< temperature rise at continuous rated torque, K
  double time_constant = 900.0;  ///< s, > 0
  double start = 40.0;           ///< initial temperature of a motor in use, degrees Celsius
  double resolution = 1.0;       ///< sensor resolution, K; 0: not rounded
};

class MotorHeat {
 public:
  MotorHeat() = default;
  /// `torque_rated` in Nm, > 0; 0: the temperature stays constant.
  MotorHeat(const MotorHeatConfig& config, double torque_rated, double period) noexcept
      : room_(config.room),
        resolution_(config.resolution),
        value_(config.start),
        gain_(torque_rated > 0.0 ? config.rise / (torque_rated * torque_rated) : 0.0),
        share_(torque_rated > 0.0 ? -std::expm1(-period / config.time_constant) : 0.0) {}

  /// Sensor reading after one more period with the motor torque `tau` (Nm), degrees Celsius.
  double next(double tau) noexcept {
    value_ += share_ * (room_ + gain_ * tau * tau - value_);
    return resolution_ > 0.0 ? resolution_ * std::round(value_ / resolution_) : value_;
  }

 private:
  double room_ = 0.0, resolution_ = 0.0, value_ = 0.0, gain_ = 0.0, share_ = 0.0;
};

}  // namespace hg::simulator
