/// The paper's three experiments (Figs. 6, 8 and 9) and two walks in closed loop as they ship, and
/// with other rates, gantries and hands ([HANDBOOK] 10.4).

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenarios/trace.h"

namespace hg {
namespace {

// With a lag that is half or twice of what the observer thinks, the estimated acceleration of the
// gantry is wrong by up to 1 m/s^2 for as long as it changes its speed: 1 m/s^2 / kP, kP = 400
// 1/s^2
constexpr double kSyncMaxUnknownLag = 3e-3;  // m

void set_plant_lag(config::Scenario& scenario, double lag_s) {
  scenario.device.simulation.factors.gantry_lag = lag_s / scenario.device.model.drive.lag;
}

// the observer and the braking distance include the lag, too
void set_known_lag(config::Scenario& scenario, double lag_s) {
  scenario.device.model.drive.lag = lag_s;
  set_plant_lag(scenario, lag_s);
}

// One thing varies at a time: a tremor decides which rows collide for a cycle, and so how hard.
config::Scenario undisturbed(const std::string& name) {
  config::Scenario scenario = law_alone(name, 500.0);
  scenario.script.hand.tremor_rms = 0.0;
  return scenario;
}

class EveryScenario : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Shipped, EveryScenario,
                         ::testing::Values("door", "excavator", "free_space", "path", "walk",
                                           "walk_through"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EveryScenario, RunsSmoothlyAndSoundlyAtItsOwnRate) {
  ScenarioRun run(law_alone(GetParam()));
  run.play();
  expect_sound(run);
  EXPECT_LT(run.quality().changes, kChangesPerCycleMax * run.quality().cycles);
  EXPECT_LT(run.quality().mean_acceleration_change(), kAccelerationChangeMax);
}

TEST_P(EveryScenario, ShowsTheSameEventsAtHalfAndTwiceTheRate) {
  for (const double rate_Hz : {500.0, 2000.0}) {
    SCOPED_TRACE(rate_Hz);
    ScenarioRun run(law_alone(GetParam(), rate_Hz));
    run.play();
    expect_sound(run);
  }
}

TEST_P(EveryScenario, ShowsItsEventsWithAGantryFasterOrSlowerThanThought) {
  for (const double lag_s : {0.02, 0.08}) {
    SCOPED_TRACE(lag_s);
    config::Scenario scenario = undisturbed(GetParam());
    set_plant_lag(scenario, lag_s);
    ScenarioRun run(scenario);
    run.play();
    expect_sound(run, kSyncMaxUnknownLag);
  }
}

TEST_P(EveryScenario, ShowsItsEventsWithAGantryConfiguredFasterOrSlower) {
  for (const double lag_s : {0.02, 0.08}) {
    SCOPED_TRACE(lag_s);
    config::Scenario scenario = undisturbed(GetParam());
    set_known_lag(scenario, lag_s);
    ScenarioRun run(scenario);
    run.play();
    expect_sound(run);
  }
}

TEST_P(EveryScenario, ShowsItsEventsWithASofterOrStifferHand) {
  for (const double factor : {0.9, 1.1}) {
    SCOPED_TRACE(factor);
    config::Scenario scenario = undisturbed(GetParam());
    scenario.script.hand.stiffness *= factor;
    scenario.script.hand.angular_stiffness *= factor;
    ScenarioRun run(scenario);
    run.play();
    expect_sound(run);
  }
}

// Twins of 20 and 30 joints, for benchmarks: many of their limits and their latch act at once.
class Chain : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Shipped, Chain, ::testing::Values("chain_20", "chain_30"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Chain, RunsSoundlyAtItsLimits) {
  for (const bool is_elastic : {false, true}) {
    SCOPED_TRACE(is_elastic);
    ScenarioRun run(is_elastic ? shipped(GetParam()) : law_alone(GetParam()));
    int most = 0, latched = 0;
    run.play([&](const Sample& sample) {
      int acting = 0;
      for (const LimitReport& limit : sample.record.limits) {
        acting += limit.state != LimitState::kInactive && limit.cause == LimitCause::kPosition;
        latched += limit.cause == LimitCause::kLock;
      }
      most = std::max(most, acting);
    });
    expect_sound(run);
    EXPECT_GE(most, 8);
    EXPECT_GT(latched, 1000);  // cycles
  }
}

TEST(Scenario, TheSameRunGivesTheSameBits) {
  std::vector<std::uint64_t> hashes;
  ScenarioRun first("door");
  first.play([&](const Sample& sample) { hashes.push_back(sample.record.state_hash); }, 3.0);
  ScenarioRun second("door");
  std::size_t i = 0;
  second.play(
      [&](const Sample& sample) {
        ASSERT_LT(i, hashes.size());
        ASSERT_EQ(sample.record.state_hash, hashes[i++]);
      },
      3.0);
  EXPECT_EQ(i, hashes.size());
}

}  // namespace
}  // namespace hg
