#include "hg/simulator/sensors/link_unit.h"

#include <Eigen/Geometry>

#include "hg/simulator/random_stream.h"

namespace hg::simulator {
namespace {

constexpr int kAxes = 3;

InertialEffects effects(RandomEffect noise, RandomEffect errors, RandomEffect drift, int unit) {
  return {.noise = noise, .errors = errors, .drift = drift, .first_channel = kAxes * unit};
}

}  // namespace

LinkUnit::LinkUnit(const LinkUnitConfig& config, double step, double period, std::uint64_t seed,
                   int unit)
    : accelerometer_(
          config.accelerometer, config.filter, step, period, seed,
          effects(RandomEffect::kLinkAccelerometerNoise, RandomEffect::kLinkAccelerometerErrors,
                  RandomEffect::kLinkAccelerometerDrift, unit)),
      gyroscope_(config.gyroscope, config.filter, step, period, seed,
                 effects(RandomEffect::kLinkGyroscopeNoise, RandomEffect::kLinkGyroscopeErrors,
                         RandomEffect::kLinkGyroscopeDrift, unit)) {
  RandomStream mounting(seed, RandomEffect::kLinkMounting, unit);
  for (double& coordinate : T_L_U_.p) coordinate = config.place * mounting.gaussian();
  Eigen::Vector4d turn;  // uniformly distributed random rotation
  for (double& part : turn) part = mounting.gaussian();
  if (config.is_turned)
    T_L_U_.R = Eigen::Quaterniond(turn.normalized()).conjugate().toRotationMatrix();
}

void LinkUnit::observe(const BodyMotion& link) noexcept {
  const InertialMotion felt = felt_at(T_L_U_, link);
  accelerometer_.observe(felt.a);
  gyroscope_.observe(felt.omega);
}

Vector6 LinkUnit::sample(double warmer) noexcept {
  Vector6 reading;
  reading << accelerometer_.sample(warmer), gyroscope_.sample(warmer);
  return reading;
}

}  // namespace hg::simulator
