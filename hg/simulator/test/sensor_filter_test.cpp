#include "hg/simulator/sensors/sensor_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "hg/core/error.h"

namespace hg::simulator {
namespace {

using Value = Eigen::Vector3d;

// Outputs after each value when 1 follows zeros.
std::vector<double> answer(const SensorFilterConfig& config, double step) {
  SensorFilter<Value> filter(config, step);
  filter.push(Value::Zero());
  std::vector<double> outputs;
  for (int k = 0; k < 12; ++k) {
    filter.push(Value::Ones());
    outputs.push_back(filter.output().x());
  }
  return outputs;
}

TEST(SensorFilter, AnswersAfterTheDelayWithTheMeanOfTheWindow) {
  // 1.5 ms are 6 steps, then 4 steps of rising
  EXPECT_EQ(answer({.average = 1e-3, .delay = 1.5e-3}, 0.25e-3),
            (std::vector<double>{0, 0, 0, 0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1}));
  EXPECT_EQ(answer({.average = 1e-3, .delay = 1.5e-3}, 0.5e-3),
            (std::vector<double>{0, 0, 0, 0.5, 1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(SensorFilter, WithoutWindowAndDelayTheNewestValueComesOut) {
  EXPECT_EQ(answer({.average = 0.0, .delay = 0.0}, 0.25e-3), std::vector<double>(12, 1.0));
}

TEST(SensorFilter, TheFirstValueHasBeenThereForEver) {
  SensorFilter<Value> filter({.average = 1e-3, .delay = 1.5e-3}, 0.25e-3);
  filter.push(Value(1.0, 2.0, 3.0));
  EXPECT_EQ(filter.output(), Value(1.0, 2.0, 3.0));
}

TEST(SensorFilter, RefusesMoreThanItCanHold) {
  EXPECT_NO_THROW(SensorFilter<Value>({.average = 28e-3, .delay = 100e-3}, 1e-3));
  EXPECT_THROW(SensorFilter<Value>({.average = 29e-3, .delay = 100e-3}, 1e-3), SetupError);
}

}  // namespace
}  // namespace hg::simulator
