#include "hg/simulator/sensors/temperature.h"

#include <gtest/gtest.h>

#include "hg/simulator/test/statistics.h"

namespace hg::simulator {
namespace {

RandomStream stream(std::uint64_t seed) { return RandomStream(seed, RandomEffect::kTemperature); }

TEST(Temperature, CoversSixtyThreePercentOfTheWayInOneTimeConstant) {
  const TemperatureConfig config = {.environment = 2.0, .fluctuation = 0.0, .time_on = 0.0};
  Temperature temperature(config, 0.5, stream(1));
  double now = 0.0;
  for (int k = 0; k < 1200; ++k) now = temperature.next();
  EXPECT_NEAR(now, 2.0 + 8.0 * 0.63212, 1e-4);
  for (int k = 0; k < 24000; ++k) now = temperature.next();
  EXPECT_NEAR(now, 10.0, 1e-6);
}

TEST(Temperature, WhatHasBeenOnForAWhileStartsWarm) {
  const TemperatureConfig config = {.fluctuation = 0.0, .time_on = 600.0};
  EXPECT_NEAR(Temperature(config, 1e-3, stream(1)).next(), 8.0 * 0.63212, 1e-3);
}

TEST(Temperature, FluctuatesWithItsOwnDeviation) {
  const TemperatureConfig config = {
      .self_heating = 0.0, .time_constant = 600.0, .fluctuation = 2e-3, .time_on = 0.0};
  std::vector<double> early, late;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Temperature temperature(config, 10.0, stream(seed));
    early.push_back(temperature.next());
    for (int k = 0; k < 240; ++k) temperature.next();
    late.push_back(temperature.next());
  }
  EXPECT_NEAR(deviation(early), 2e-3 * std::sqrt(10.0), 4e-4);
  EXPECT_NEAR(deviation(late), 2e-3 * std::sqrt(600.0 / 2.0), 3e-3);
}

}  // namespace
}  // namespace hg::simulator
