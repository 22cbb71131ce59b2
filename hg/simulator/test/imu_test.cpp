#include "hg/simulator/sensors/imu.h"

#include <gtest/gtest.h>

#include "hg/simulator/test/statistics.h"

namespace hg::simulator {
namespace {

constexpr SensorFilterConfig kNoFilter = {.average = 0.0, .delay = 0.0};
constexpr InertialEffects kGyroscope = {
    RandomEffect::kGyroscopeNoise, RandomEffect::kGyroscopeErrors, RandomEffect::kGyroscopeDrift};

InertialSensor make(const InertialSensorConfig& config, double period = 1e-3,
                    std::uint64_t seed = 1) {
  return InertialSensor(config, kNoFilter, period, period, seed, kGyroscope);
}

Eigen::Vector3d reading(InertialSensor sensor, const Eigen::Vector3d& x, double warmer = 0.0) {
  sensor.observe(x);
  return sensor.sample(warmer);
}

// Allan deviations of a sensor at rest: root mean square over its axes.
std::vector<double> allan_deviations(const InertialSensorConfig& config, double period,
                                     std::size_t samples, const std::vector<double>& taus) {
  InertialSensor sensor = make(config, period);
  std::array<std::vector<double>, 3> y;
  for (std::size_t k = 0; k < samples; ++k) {
    sensor.observe(Eigen::Vector3d::Zero());
    const Eigen::Vector3d sample = sensor.sample(0.0);
    for (std::size_t i = 0; i < 3; ++i) y[i].push_back(sample[static_cast<int>(i)]);
  }
  std::vector<double> result;
  for (double tau : taus) {
    double sum = 0.0;
    for (const std::vector<double>& axis : y)
      sum += std::pow(allan_deviation(axis, std::lround(tau / period)), 2);
    result.push_back(std::sqrt(sum / 3.0));
  }
  return result;
}

TEST(InertialSensor, WhiteNoiseFallsWithSlopeMinusOneHalf) {
  const std::vector<double> taus = {0.01, 0.1, 1.0, 10.0};
  const auto sigma = allan_deviations({.noise = 1.2e-4}, 0.01, 300'000, taus);
  for (std::size_t k = 0; k < taus.size(); ++k)
    EXPECT_NEAR(sigma[k] / (1.2e-4 / std::sqrt(taus[k])), 1.0, 0.05) << taus[k];
}

TEST(InertialSensor, TheRateRandomWalkRisesWithSlopePlusOneHalf) {
  const std::vector<double> taus = {3.0, 30.0, 100.0};
  const auto sigma = allan_deviations({.random_walk = 1e-6}, 0.05, 300'000, taus);
  for (std::size_t k = 0; k < taus.size(); ++k)
    EXPECT_NEAR(sigma[k] / (1e-6 * std::sqrt(taus[k] / 3.0)), 1.0, 0.1) << taus[k];
}

TEST(InertialSensor, BiasInstabilityIsAFloor) {
  const std::vector<double> taus = {3.0, 10.0, 30.0, 100.0, 300.0};
  const auto sigma = allan_deviations({.bias_instability = 5e-5}, 0.1, 600'000, taus);
  for (std::size_t k = 0; k < taus.size(); ++k)
    EXPECT_NEAR(sigma[k] / (0.664 * 5e-5), 1.0, 0.12) << taus[k];
}

TEST(InertialSensor, TheThreeAddUpAsTheConventionSays) {
  const InertialSensorConfig config = {
      .noise = 1.2e-4, .bias_instability = 5e-5, .random_walk = 1e-5};
  const std::vector<double> taus = {0.1, 1.0, 10.0, 100.0};
  const auto sigma = allan_deviations(config, 0.05, 600'000, taus);
  for (std::size_t k = 0; k < taus.size(); ++k) {
    const double tau = taus[k];
    // below 2 s the floor is not built up, but there noise hides it
    const double expected = std::sqrt(1.44e-8 / tau + std::pow(0.664 * 5e-5, 2) + 1e-10 * tau / 3);
    EXPECT_NEAR(sigma[k] / expected, 1.0, 0.12) << tau;
  }
}

TEST(InertialSensor, AtTheStartTheFlickerIsAlreadyThere) {
  std::vector<double> first;
  for (std::uint64_t seed = 0; seed < 3000; ++seed)
    first.push_back(
        reading(make({.bias_instability = 5e-5}, 1e-3, seed), Eigen::Vector3d::Zero()).x());
  EXPECT_NEAR(deviation(first), 5e-5 * std::sqrt(4.0 * std::log(10.0) / std::numbers::pi), 4e-6);
}

TEST(InertialSensor, BiasScaleAndTemperatureDriftBelongToEachSensor) {
  const InertialSensorConfig config = {
      .bias = 0.01, .temperature_drift = 5e-4, .scale_error = 5e-3};
  std::vector<double> biases, scales, drifts;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const InertialSensor sensor = make(config, 1e-3, seed);
    const Eigen::Vector3d bias = reading(sensor, Eigen::Vector3d::Zero());
    for (int i = 0; i < 3; ++i) {
      biases.push_back(bias[i]);
      scales.push_back(reading(sensor, Eigen::Vector3d::Unit(i))[i] - bias[i]);
      drifts.push_back((reading(sensor, Eigen::Vector3d::Zero(), 4.0) - bias)[i] / 4.0);
    }
  }
  EXPECT_NEAR(mean(biases), 0.0, 1e-3);
  EXPECT_NEAR(deviation(biases), 0.01, 6e-4);
  EXPECT_NEAR(mean(scales), 1.0, 4e-4);
  EXPECT_NEAR(deviation(scales), 5e-3, 3e-4);
  EXPECT_NEAR(deviation(drifts), 5e-4, 3e-5);
}

TEST(InertialSensor, MisalignmentIsASmallRotation) {
  std::vector<double> angles;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const InertialSensor sensor = make({.misalignment = 5e-3}, 1e-3, seed);
    Eigen::Matrix3d R;
    for (int i = 0; i < 3; ++i) R.col(i) = reading(sensor, Eigen::Vector3d::Unit(i));
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    for (int i = 0; i < 3; ++i) angles.push_back(R((i + 2) % 3, (i + 1) % 3));
  }
  EXPECT_NEAR(deviation(angles), 5e-3, 3e-4);
}

TEST(InertialSensor, EachAxisEndsAtTheRangeAndComesInSteps) {
  const InertialSensor sensor = make({.range = 78.5, .resolution = 0.5});
  EXPECT_EQ(reading(sensor, {90.0, -90.0, 1.3}), Eigen::Vector3d(78.5, -78.5, 1.5));
}

TEST(InertialSensor, WithoutErrorsItIsExact) {
  const Eigen::Vector3d x(0.1, -2e3, 7.7);
  EXPECT_EQ(reading(make({}), x, 30.0), x);
}

}  // namespace
}  // namespace hg::simulator
