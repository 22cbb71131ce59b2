// Hand and device that shake each other, on the whole elastic simulation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/player.h"
#include "hg/experiments/stability_map.h"

namespace hg::experiments {
namespace {

struct Shaking {
  double onset_s = kInfinity;  // the handle moves with 10 mm/s, and 50 ms later still does
  double detected_s = kInfinity;
  double calmed_speed = 0.0;  // largest from 1.2 s to 2 s after that, m/s
  double last_speed = 0.0;    // largest in the last second, m/s
  FaultCode fault = FaultCode::kNone;
};

Shaking play(const config::Scenario& scenario) {
  constexpr double kOnset = 0.03;  // noise alone moves half a kilogram with 0.013 m/s
  Shaking shaking;
  Player player(scenario);
  const double end_s = scenario.script.script.grasp_s + scenario.script.script.duration_s;
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    const CycleRecord& record = player.record();
    const double t = record.time_s;
    const double speed = player.truth().twist.head<3>().norm();
    if (speed > kOnset) shaking.onset_s = std::min(shaking.onset_s, t);
    if (record.passivity.oscillation >= 1.0) shaking.detected_s = std::min(shaking.detected_s, t);
    const double since = t - shaking.detected_s;
    if (since > 1.2 && since < 2.0) shaking.calmed_speed = std::max(shaking.calmed_speed, speed);
    if (t > end_s - 1.0) shaking.last_speed = std::max(shaking.last_speed, speed);
  }
  shaking.fault = player.record().fault.code;
  return shaking;
}

// Light twins in stiff hands at random places: without calming they shake on and on.
TEST(PassivityRun, CatchesStiffHandsOnLightTwins) {
  const config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  constexpr int kRuns = 4;
  const unsigned seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int run = 0; run < kRuns; ++run) {
    StabilityConfig config;
    config.position = {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-0.95, -0.6)};
    config::Scenario tried = scenario;
    tried.device.simulation.seed = static_cast<std::uint64_t>(run + 1);
    const double mass = run % 2 == 0 ? 0.5 : uniform(0.4, 0.9);
    const person::HandImpedance hand = spring_hand(config.hand, 3000.0);
    config.reaction = passivity::Reaction::kObserve;
    const Shaking alone = play(kicked(tried, config, hand, mass, 4.0));
    config.reaction = passivity::Reaction::kAct;
    const Shaking calmed = play(kicked(tried, config, hand, mass, 4.0));
    EXPECT_GT(alone.last_speed, 0.02) << "run " << run << ": stable on its own";
    EXPECT_LT(calmed.detected_s - calmed.onset_s, 0.4) << "run " << run;
    EXPECT_LT(calmed.calmed_speed, 0.015) << "run " << run;
    EXPECT_EQ(calmed.fault, FaultCode::kNone) << "run " << run;
  }
}

// Also where the hand shakes as hands do: 2 N along each axis.
TEST(PassivityRun, LeavesTheScenariosAlone) {
  struct Run {
    std::string name;
    double tremor = 0.0;
  };
  for (const Run& run : std::vector<Run>{{"scenarios/door"},
                                         {"scenarios/excavator"},
                                         {"scenarios/free_space"},
                                         {"scenarios/walk"},
                                         {"scenarios/path"},
                                         {"scenarios/surfaces"},
                                         {"stress/heavy"},
                                         {"scenarios/walk", 1.0},
                                         {"scenarios/walk", 2.0},
                                         {"scenarios/free_space", 2.0},
                                         {"scenarios/surfaces", 2.0}}) {
    SCOPED_TRACE(run.name);
    config::Scenario scenario = config::load_scenario("models/" + run.name + ".yaml");
    if (run.name == "scenarios/walk") scenario.duration_s = 20.0;
    if (run.tremor > 0.0) scenario.script.hand.tremor_rms = run.tremor;
    Player player(scenario);
    double index = 0.0;
    double at_s = 0.0;
    double tank = kInfinity;
    for (bool has_more = true; has_more; has_more = player.end()) {
      player.begin();
      player.run();
      const CycleRecord& record = player.record();
      if (!player.is_running()) continue;
      ASSERT_NE(record.warning.code, FaultCode::kOscillation)
          << record.warning.index << " at " << record.time_s << " s";
      if (record.passivity.oscillation > index) at_s = record.time_s;
      index = std::max(index, record.passivity.oscillation);
      tank = std::min(tank, record.passivity.tank);
    }
    EXPECT_LT(index, 1.0) << " at " << at_s << " s";
    EXPECT_GT(tank, 2.0);
    EXPECT_EQ(player.record().fault.code, FaultCode::kNone);
  }
}

}  // namespace
}  // namespace hg::experiments
