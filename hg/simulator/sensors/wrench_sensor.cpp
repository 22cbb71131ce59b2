#include "hg/simulator/sensors/wrench_sensor.h"

#include <cmath>

namespace hg::simulator {

WrenchSensor::WrenchSensor(const WrenchSensorConfig& config, double step, double period,
                           std::uint64_t seed)
    : gain_(Eigen::Matrix<double, 6, 6>::Identity()),
      walk_sigma_(config.bias_walk * std::sqrt(period) * config.full_scale),
      range_(config.range * config.full_scale),
      lsb_(config.resolution * config.full_scale),
      filter_(config.filter, step) {
  sigma_.head<3>().setConstant(config.force_noise / std::sqrt(step));
  sigma_.tail<3>().setConstant(config.torque_noise / std::sqrt(step));
  Eigen::Matrix<double, 6, 6> cross_talk = Eigen::Matrix<double, 6, 6>::Identity();
  for (int i = 0; i < 6; ++i) {
    noise_[i] = RandomStream(seed, RandomEffect::kWrenchNoise, i);
    walks_[i] = RandomStream(seed, RandomEffect::kWrenchWalk, i);
    RandomStream errors(seed, RandomEffect::kWrenchErrors, i);
    const double full_scale = config.full_scale[i];
    bias_[i] = config.bias * full_scale * errors.gaussian();
    per_kelvin_[i] = config.temperature_drift * full_scale * errors.gaussian();
    gain_(i, i) += config.gain_error * errors.gaussian();
    for (int j = 0; j < 6; ++j)
      if (j != i)
        cross_talk(i, j) =
            config.cross_talk * full_scale / config.full_scale[j] * errors.gaussian();
  }
  gain_ = (1.0 - config.shunt) * cross_talk * gain_;
}

void WrenchSensor::observe(const Vector6& w_S) noexcept {
  Vector6 raw = gain_ * w_S;
  for (int i = 0; i < 6; ++i)
    if (sigma_[i] > 0.0) raw[i] += sigma_[i] * noise_[i].gaussian();
  filter_.push(raw);
}

Vector6 WrenchSensor::sample(double warmer) noexcept {
  Vector6 y = filter_.output() + bias_ + warmer * per_kelvin_;
  for (int i = 0; i < 6; ++i) {
    if (walk_sigma_[i] > 0.0) walk_[i] += walk_sigma_[i] * walks_[i].gaussian();
    y[i] = std::clamp(y[i] + walk_[i], -range_[i], range_[i]);
    if (lsb_[i] > 0.0) y[i] = lsb_[i] * std::round(y[i] / lsb_[i]);
  }
  return y;
}

}  // namespace hg::simulator
