#include "hg/simulator/plant/motor_heat.h"

#include <gtest/gtest.h>

namespace hg::simulator {
namespace {

constexpr MotorHeatConfig kExact = {.time_constant = 100.0, .resolution = 0.0};

double after(double seconds, double tau, const MotorHeatConfig& config) {
  constexpr double kPeriod = 1e-2;
  MotorHeat heat(config, 30.0, kPeriod);
  double value = config.start;
  for (int i = 0; i < static_cast<int>(seconds / kPeriod); ++i) value = heat.next(tau);
  return value;
}

TEST(MotorHeat, EndsAtTheRatedTemperatureUnderTheRatedTorque) {
  EXPECT_NEAR(after(2000.0, 30.0, kExact), 72.0, 1e-3);
  EXPECT_NEAR(after(2000.0, -30.0, kExact), 72.0, 1e-3);
  EXPECT_NEAR(after(2000.0, 60.0, kExact), 222.0, 1e-3);  // four times the loss
  EXPECT_NEAR(after(2000.0, 0.0, kExact), 22.0, 1e-3);
}

TEST(MotorHeat, ComesNearerByTheTimeConstant) {
  EXPECT_NEAR(after(100.0, 30.0, kExact), 72.0 - 32.0 * std::exp(-1.0), 1e-2);
}

TEST(MotorHeat, IsReportedInSteps) {
  EXPECT_EQ(after(100.0, 30.0, {.time_constant = 100.0}), 60.0);
  MotorHeat unknown(kExact, 0.0, 1e-2);
  EXPECT_EQ(unknown.next(1000.0), kExact.start);
}

}  // namespace
}  // namespace hg::simulator
