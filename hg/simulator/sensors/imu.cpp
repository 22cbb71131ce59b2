#include "hg/simulator/sensors/imu.h"

#include <cmath>
#include <numbers>

namespace hg::simulator {
namespace {

// flicker processes: ratio of successive time constants, the shortest time constant in s
constexpr double kSpread = 10.0;
constexpr double kShortest = 1.0;

}  // namespace

InertialSensorConfig mems_accelerometer() {
  return {.noise = 1e-3,                 // [A] 1.6: 100 ug/sqrt(Hz)
          .bias_instability = 3.92e-4,   // [A] 1.6: 40 ug
          .random_walk = 1e-5,           // [A]
          .bias = 0.196,                 // [A] 1.6: 20 mg
          .temperature_drift = 1.96e-3,  // [A] 1.6: 0.2 mg/K
          .scale_error = 5e-3,           // [A]
          .misalignment = 5e-3,          // [A]
          .range = 78.5,                 // [A] 1.6: 8 g
          .resolution = 2.4e-3};         // [A] 16 bit
}

InertialSensorConfig mems_gyroscope() {
  return {.noise = 1.2e-4,              // [A] 1.6: 0.007 deg/s/sqrt(Hz)
          .bias_instability = 5e-5,     // [A] 1.6: 10 deg/h
          .random_walk = 1e-6,          // [A] 1.6
          .bias = 8.7e-3,               // [A] 1.6: 0.5 deg/s
          .temperature_drift = 5.2e-4,  // [A] 1.6: 0.03 deg/s/K
          .scale_error = 5e-3,          // [A]
          .misalignment = 5e-3,         // [A]
          .range = 35.0,                // [A] 1.6: 2000 deg/s
          .resolution = 1.07e-3};       // [A] 16 bit
}

InertialSensor::InertialSensor(const InertialSensorConfig& config, const SensorFilterConfig& filter,
                               double step, double period, std::uint64_t seed,
                               const InertialEffects& effects)
    : noise_sigma_(config.noise / std::sqrt(step)),
      range_(config.range),
      lsb_(config.resolution),
      filter_(filter, step) {
  Eigen::Vector3d scale, turn;
  for (int i = 0; i < 3; ++i) {
    const int channel = effects.first_channel + i;
    noise_[i] = RandomStream(seed, effects.noise, channel);
    drift_[i] = RandomStream(seed, effects.drift, channel);
    RandomStream errors(seed, effects.errors, channel);
    bias_[i] = config.bias * errors.gaussian();
    per_kelvin_[i] = config.temperature_drift * errors.gaussian();
    scale[i] = 1.0 + config.scale_error * errors.gaussian();
    turn[i] = config.misalignment * errors.gaussian();
  }
  gain_ = scale.asDiagonal();
  if (turn.norm() > 0.0)
    gain_ = gain_ * Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();

  // flicker: the sum has the two-sided spectrum B^2 / (2 pi f) between the time constants
  const double sigma = config.bias_instability * std::sqrt(std::log(kSpread) / std::numbers::pi);
  const double step_of_each = static_cast<double>(kDrifts) * period;
  for (std::size_t k = 0; k < kFlickers; ++k) {
    const double exponent = -step_of_each / (kShortest * std::pow(kSpread, k));
    drifts_[k].decay = std::exp(exponent);
    drifts_[k].sigma = sigma * std::sqrt(-std::expm1(2.0 * exponent));
    for (int i = 0; i < 3; ++i) drifts_[k].value[i] = sigma * drift_[i].gaussian();
  }
  drifts_[kFlickers].decay = 1.0;
  drifts_[kFlickers].sigma = config.random_walk * std::sqrt(step_of_each);
}

void InertialSensor::observe(const Eigen::Vector3d& x) noexcept {
  Eigen::Vector3d raw = gain_ * x;
  if (noise_sigma_ > 0.0)
    for (int i = 0; i < 3; ++i) raw[i] += noise_sigma_ * noise_[i].gaussian();
  filter_.push(raw);
}

// One of the slow processes takes its step in each period, in turn.
void InertialSensor::drift() noexcept {
  SlowProcess& process = drifts_[turn_];
  turn_ = (turn_ + 1) % kDrifts;
  if (process.sigma == 0.0) return;
  for (int i = 0; i < 3; ++i)
    process.value[i] = process.decay * process.value[i] + process.sigma * drift_[i].gaussian();
}

Eigen::Vector3d InertialSensor::sample(double warmer) noexcept {
  drift();
  Eigen::Vector3d y = filter_.output() + bias_ + warmer * per_kelvin_;
  for (const SlowProcess& process : drifts_) y += process.value;
  y = y.cwiseMax(-range_).cwiseMin(range_);
  return lsb_ > 0.0 ? Eigen::Vector3d(lsb_ * (y / lsb_).array().round()) : y;
}

}  // namespace hg::simulator
