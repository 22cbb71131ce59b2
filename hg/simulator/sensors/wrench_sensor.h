/// A six-axis force/torque sensor. Source: [HANDBOOK] 1.6, 4.5.
///   raw = (I + X) G w + n, averaged and delayed;  y = sat(raw + b0 + walk + k_T (T - T0)), rounded
/// with G = (1 - shunt) diag(1 + g_i) and X_ij scaled by FS_i / FS_j, X_ii = 0. All constant errors
/// of a sensor are drawn from the seed. Differs from the source: saturates per axis, not per strain
/// gauge.
///
/// Noise N is a random-walk coefficient (Allan): sigma = N / sqrt(averaging time).
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/simulator/random_stream.h"
#include "hg/simulator/sensors/sensor_filter.h"

namespace hg::simulator {

/// Set-up data of a wrench sensor; shares are of the full scale of each axis. 0 disables an effect,
/// as does an infinite range.
struct WrenchSensorConfig {
  Vector6 full_scale{500.0, 500.0, 1200.0, 15.0, 15.0, 12.0};  ///< N and Nm, > 0; [K] 1.6
  double force_noise = 2.5e-3;      ///< N/sqrt(Hz), >= 0; [K] 1.6: 0.08 N after 1 ms
  double torque_noise = 8e-5;       ///< Nm/sqrt(Hz), >= 0; [K] 1.6: 2.5 mNm after 1 ms
  double gain_error = 5e-3;         ///< standard deviation, >= 0; [A] 4.5
  double shunt = 0.0;               ///< share of w that bypasses the sensor, 0..1
  double cross_talk = 1e-2;         ///< standard deviation, >= 0; [A] 4.5
  double bias = 4e-3;               ///< turn-on bias: standard deviation, share; [A] 2 N, 60 mNm
  double bias_walk = 4e-6;          ///< share/sqrt(s); [A] 15 mN in a minute
  double temperature_drift = 1e-4;  ///< standard deviation, share/K; [A] 0.05 N/K
  double range = 1.0;               ///< saturation of an axis, share, > 0; [K] 1.6
  double resolution = 3.05e-5;      ///< LSB, share, >= 0; [A] 16 bit from -1 to 1
  SensorFilterConfig filter;
};

class WrenchSensor {
 public:
  /// Throws SetupError when the filter is too long.
  WrenchSensor(const WrenchSensorConfig& config, double step, double period, std::uint64_t seed);

  /// Takes the true wrench `w_S` at S, resolved in S, once per step of the plant.
  void observe(const Vector6& w_S) noexcept;
  /// Reading, once per period; `warmer`: temperature above that of calibration, K.
  Vector6 sample(double warmer) noexcept;

 private:
  Eigen::Matrix<double, 6, 6> gain_;
  Vector6 sigma_, walk_sigma_, bias_, per_kelvin_, range_, lsb_;
  Vector6 walk_ = Vector6::Zero();
  std::array<RandomStream, 6> noise_, walks_;
  SensorFilter<Vector6> filter_;
};

}  // namespace hg::simulator
