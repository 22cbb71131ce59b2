#include "hg/simulator/sensors/wrench_sensor.h"

#include <gtest/gtest.h>

#include "hg/simulator/sensors/sensors.h"
#include "hg/simulator/test/statistics.h"

namespace hg::simulator {
namespace {

constexpr double kStep = 0.25e-3, kPeriod = 1e-3;
const Vector6 kFullScale{500.0, 500.0, 1200.0, 15.0, 15.0, 12.0};

WrenchSensor make(const WrenchSensorConfig& config, std::uint64_t seed = 1) {
  return WrenchSensor(config, kStep, kPeriod, seed);
}

Vector6 reading(WrenchSensor sensor, const Vector6& w, double warmer = 0.0) {
  sensor.observe(w);
  return sensor.sample(warmer);
}

// Each axis at rest, sampled every `steps` of the plant.
std::array<std::vector<double>, 6> at_rest(const WrenchSensorConfig& config, int steps) {
  WrenchSensor sensor(config, kStep, steps * kStep, 1);
  std::array<std::vector<double>, 6> y;
  for (int k = 0; k < 50'000; ++k) {
    for (int s = 0; s < steps; ++s) sensor.observe(Vector6::Zero());
    const Vector6 sample = sensor.sample(0.0);
    for (std::size_t i = 0; i < 6; ++i) y[i].push_back(sample[static_cast<int>(i)]);
  }
  return y;
}

TEST(WrenchSensor, NoiseAfterTheMeanOfAMillisecondIsThatOfTheDataSheetAtAnyRate) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.force_noise = WrenchSensorConfig().force_noise;
  config.torque_noise = WrenchSensorConfig().torque_noise;
  config.filter = {};
  for (int steps : {4, 2}) {
    const auto y = at_rest(config, steps);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(deviation(y[i]), i < 3 ? 0.079 : 2.53e-3, i < 3 ? 0.0015 : 5e-5);
      EXPECT_NEAR(mean(y[i]), 0.0, i < 3 ? 0.003 : 1e-4);
      // at 2 kHz neighbours share half of the window
      EXPECT_NEAR(correlation(y[i], y[i], 1), steps == 4 ? 0.0 : 0.5, 0.025);
      EXPECT_NEAR(correlation(y[i], y[(i + 1) % 6]), 0.0, 0.025);
    }
  }
}

TEST(WrenchSensor, BiasAndTemperatureDriftBelongToEachSensor) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.bias = 4e-3;
  config.temperature_drift = 1e-4;
  std::vector<double> biases, drifts;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Vector6 cold = reading(make(config, seed), Vector6::Zero());
    const Vector6 warm = reading(make(config, seed), Vector6::Zero(), 5.0);
    const Vector6 warmer = reading(make(config, seed), Vector6::Zero(), 10.0);
    EXPECT_LT((warmer - 2.0 * warm + cold).norm(), 1e-12);
    for (int i = 0; i < 6; ++i) {
      biases.push_back(cold[i] / kFullScale[i]);
      drifts.push_back((warm[i] - cold[i]) / 5.0 / kFullScale[i]);
    }
  }
  EXPECT_NEAR(mean(biases), 0.0, 5.0 * 4e-3 / 60.0);
  EXPECT_NEAR(deviation(biases), 4e-3, 2.5e-4);
  EXPECT_NEAR(deviation(drifts), 1e-4, 6e-6);
  EXPECT_NEAR(correlation(biases, drifts), 0.0, 0.08);
}

TEST(WrenchSensor, TheBiasWalksWithTheSquareRootOfTime) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.bias_walk = 4e-6;
  const auto y = at_rest(config, 4);
  for (std::size_t lag : {1u, 100u}) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = lag; k < y[i].size(); k += lag, ++count)
        sum += std::pow((y[i][k] - y[i][k - lag]) / kFullScale[static_cast<int>(i)], 2);
    const double expected = 4e-6 * std::sqrt(static_cast<double>(lag) * kPeriod);
    EXPECT_NEAR(std::sqrt(sum / count) / expected, 1.0, 0.06);
  }
}

TEST(WrenchSensor, ALoadOnOneAxisShowsOnTheOthersByTheirFullScales) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.gain_error = 5e-3;
  config.cross_talk = 1e-2;
  std::vector<double> gains;
  std::array<std::vector<double>, 30> cross_talk;  // of axis j on axis i, without i = j
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    for (int j = 0; j < 6; ++j) {
      const Vector6 w = 0.4 * kFullScale[j] * Vector6::Unit(j);
      const Vector6 share = reading(make(config, seed), w).cwiseQuotient(kFullScale) / 0.4;
      for (int i = 0; i < 6; ++i) {
        if (i == j)
          gains.push_back(share[i]);
        else
          cross_talk[5 * i + (j < i ? j : j - 1)].push_back(share[i]);
      }
    }
  }
  EXPECT_NEAR(mean(gains), 1.0, 5.0 * 5e-3 / 60.0);
  EXPECT_NEAR(deviation(gains), 5e-3, 3e-4);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_NEAR(deviation(cross_talk[k]), 1e-2, 1.5e-3) << k;
    EXPECT_NEAR(correlation(cross_talk[k], cross_talk[(k + 1) % 30]), 0.0, 0.21) << k;
  }
}

TEST(WrenchSensor, EachAxisEndsAtItsFullScaleAndComesInSteps) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.range = 1.0;
  EXPECT_EQ(reading(make(config), 2.0 * kFullScale), kFullScale);
  EXPECT_EQ(reading(make(config), -2.0 * kFullScale), -kFullScale);
  config.resolution = 1e-3;
  Vector6 expected;
  expected << 0.5, 1.0, 1.2, 0.015, 0.03, 0.0;
  Vector6 load;
  load << 0.6, 0.8, 1.7, 0.02, 0.024, 0.005;
  EXPECT_LT((reading(make(config), load) - expected).norm(), 1e-12);
}

TEST(WrenchSensor, TheBiasCountsAgainstTheRange) {
  WrenchSensorConfig config = ideal_sensors().wrench;
  config.bias = 0.5;
  config.range = 1.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Vector6 share = reading(make(config, seed), 0.9 * kFullScale).cwiseQuotient(kFullScale);
    EXPECT_LE(share.maxCoeff(), 1.0 + 1e-12);
  }
}

}  // namespace
}  // namespace hg::simulator
