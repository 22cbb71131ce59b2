/// A gyroscope or accelerometer with three axes. Source: [HANDBOOK] 1.6, 4.5.
///   raw = (I + S) C x + n, averaged and delayed;  y = sat(raw + b0 + f + walk + k_T (T - T0))
/// S: scale errors, C: a small rotation (mounting), f: flicker noise, walk: rate random walk.
/// Differs from the source: no sensitivity of the gyroscope to acceleration.
///
/// Convention, all as Allan deviations: sigma(tau)^2 = N^2/tau + (0.664 B)^2 + K^2 tau/3. Flicker
/// is a sum of four Gauss-Markov processes with time constants of 1, 10, 100 and 1000 s, so the
/// floor stands from about 2 to 1000 s.
#pragma once

#include <array>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/simulator/random_stream.h"
#include "hg/simulator/sensors/sensor_filter.h"

namespace hg::simulator {

/// Set-up data in units U of the sensor, rad/s or m/s^2. 0 disables an effect, as does an infinite
/// range.
struct InertialSensorConfig {
  double noise = 0.0;              ///< N: angle or velocity random walk, U/sqrt(Hz), >= 0
  double bias_instability = 0.0;   ///< B, U, >= 0
  double random_walk = 0.0;        ///< K: rate random walk, U/s/sqrt(Hz), >= 0
  double bias = 0.0;               ///< turn-on bias: standard deviation, U, >= 0
  double temperature_drift = 0.0;  ///< standard deviation, U/K, >= 0
  double scale_error = 0.0;        ///< standard deviation, >= 0
  double misalignment = 0.0;       ///< standard deviation of the rotation about each axis, rad
  double range = kInfinity;        ///< saturation of each axis, U, > 0
  double resolution = 0.0;         ///< LSB, U, >= 0
};

/// Default parameters of consumer MEMS sensors, handbook 1.6.
InertialSensorConfig mems_accelerometer();
InertialSensorConfig mems_gyroscope();

/// Random streams of an inertial sensor.
struct InertialEffects {
  RandomEffect noise, errors, drift;
  int first_channel = 0;  ///< first channel of its three axes
};

class InertialSensor {
 public:
  /// Throws SetupError when the filter is too long.
  InertialSensor(const InertialSensorConfig& config, const SensorFilterConfig& filter, double step,
                 double period, std::uint64_t seed, const InertialEffects& effects);

  /// Takes the true value in the axes of S, once per step of the plant.
  void observe(const Eigen::Vector3d& x) noexcept;
  /// Reading, once per period; `warmer`: temperature above that of calibration, K.
  Eigen::Vector3d sample(double warmer) noexcept;

 private:
  static constexpr std::size_t kFlickers = 4;
  static constexpr std::size_t kDrifts = kFlickers + 1;  // the last one is the random walk
  /// x+ = decay x + sigma xi, every kDrifts periods.
  struct SlowProcess {
    double decay = 0.0, sigma = 0.0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };
  void drift() noexcept;

  double noise_sigma_, range_, lsb_;
  Eigen::Matrix3d gain_;
  Eigen::Vector3d bias_, per_kelvin_;
  std::array<SlowProcess, kDrifts> drifts_;
  std::size_t turn_ = 0;
  std::array<RandomStream, 3> noise_, drift_;
  SensorFilter<Eigen::Vector3d> filter_;
};

}  // namespace hg::simulator
