// Free space and impedance with parts of the machine changed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/haptify/free_space_variants.h"
#include "hg/experiments/haptify/impedance.h"

namespace hg::haptify {
namespace {

config::Scenario walk_scenario() { return config::load_scenario("models/scenarios/walk.yaml"); }

TEST(MeasureVariant, OfTheShippedDeviceNeedsLittleMoreThanTheTwin) {
  const config::Scenario scenario = walk_scenario();
  const FreeSpaceConfig config = {.duration_s = 10.0};
  const std::vector<FreeSpaceVariant> variants = free_space_variants();
  const FreeSpace run = measure_variant(scenario, variants.front(), config, 1);
  EXPECT_EQ(run.failure, "");
  EXPECT_GT(run.own_share, 0.9);  // 6 kg, 4 Ns/m at 0.25 m/s on 0.7 m: 1.13 N
  EXPECT_LT(run.own_share, 1.5);
  EXPECT_LT(run.extra, 0.6);
  EXPECT_GT(run.extra, 0.02);
  EXPECT_LT(run.joint_error, 4e-3);
  EXPECT_GT(run.torque_share, 0.05);
}

TEST(MeasureVariant, AVibratingGantryIsFelt) {
  const config::Scenario scenario = walk_scenario();
  const FreeSpaceConfig config = {.duration_s = 5.0};
  const std::vector<FreeSpaceVariant> variants = free_space_variants();
  const FreeSpace run = measure_variant(scenario, variants.back(), config, 1);
  EXPECT_GT(run.acceleration_5Hz, 0.2);
  EXPECT_GT(run.extra, 1.0);
}

TEST(Shake, GivesDrivesOfThatLagTheWantedAcceleration) {
  constexpr GantryVibration kVibration = {.acceleration = 0.24, .frequency_Hz = 12.0};
  constexpr double kLag = 0.08, kStep = 1e-5;
  Eigen::Vector2d dq = Eigen::Vector2d::Zero(), a = dq;
  double smallest = 1.0, largest = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    VectorP command = VectorP::Zero(2);
    shake(kVibration, kLag, i * kStep, command);
    a = (command - dq) / kLag;
    dq += kStep * a;
    if (i * kStep < 0.6) continue;
    smallest = std::min(smallest, a.norm());  // the axes are 90 degrees apart
    largest = std::max(largest, a.norm());
  }
  EXPECT_NEAR(smallest, 0.24, 0.002);
  EXPECT_NEAR(largest, 0.24, 0.002);
}

TEST(MeasureCase, RendersTheTwinAndHoldsWhatDoesNotMove) {
  config::Scenario scenario = walk_scenario();
  scenario.device.simulation.factors = {};
  scenario.device.simulation.sensors = simulator::ideal_sensors();
  ImpedanceConfig config;
  config.response.frequency_Hz = {2.0};
  config.response.periods = 3;
  config.held = 0.4;
  constexpr int kZ = 2;
  const auto mobility = [](const ImpedanceRun& run) {
    return 1.0 / run.response.answers.at(0).impedance;
  };
  const ImpedanceRun free = measure_case(
      scenario, config, {.name = "free", .has_friction = false, .is_rigid = false}, kZ, 1);
  ASSERT_EQ(free.response.answers.size(), 1u);
  const std::complex<double> wanted = {4.0, 2.0 * 3.14159265 * 2.0 * 6.0};  // 6 kg, 4 Ns/m
  EXPECT_NEAR(std::abs(mobility(free) * wanted - 1.0), 0.0, 0.1);
  EXPECT_EQ(free.give.peak, 0.0);

  const ImpedanceRun held =
      measure_case(scenario, config, {.name = "held", .has_friction = false}, kZ, 1);
  const ImpedanceRun blind = measure_case(
      scenario, config, {.name = "blind", .has_friction = false, .is_blind = true}, kZ, 1);
  EXPECT_LT(std::abs(mobility(held)), 0.02 * std::abs(mobility(free)));
  EXPECT_GT(std::abs(mobility(blind)), 3.0 * std::abs(mobility(held)));
  EXPECT_GT(blind.give.peak, held.give.peak);
  EXPECT_GT(blind.give.peak, 5e-4);
  EXPECT_LT(blind.give.peak, 2e-2);
}

// The same seed and the same pushes: the same number, whoever asks.
TEST(MeasureCase, OfTheShippedControlIsTheResponse) {
  const config::Scenario scenario = walk_scenario();
  ImpedanceConfig config;
  config.response.frequency_Hz = {3.0};
  const ImpedanceRun run = measure_case(scenario, config, {.name = "", .is_rigid = false}, 0, 1);
  const Response response = measure_response(scenario, config.response, 0, 1);
  EXPECT_EQ(run.response.answers.at(0).impedance, response.answers.at(0).impedance);
}

}  // namespace
}  // namespace hg::haptify
