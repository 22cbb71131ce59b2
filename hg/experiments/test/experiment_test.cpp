// The experiments on the device that ships: short ones, with ends that are known.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/player.h"
#include "hg/experiments/runs.h"
#include "hg/experiments/stability_map.h"
#include "hg/experiments/workers.h"
#include "hg/signals/drive_model.h"

namespace hg::experiments {
namespace {

config::Scenario walk_scenario() { return config::load_scenario("models/scenarios/walk.yaml"); }

TEST(DoAll, DoesEverythingOnceAndCounts) {
  std::vector<std::atomic<int>> done(50);
  std::vector<std::size_t> progress;
  do_all(
      done.size(), [&](std::size_t i) { ++done[i]; },
      [&](std::size_t now, std::size_t total) {
        EXPECT_EQ(total, 50u);
        progress.push_back(now);
      });
  for (const auto& times : done) EXPECT_EQ(times, 1);
  ASSERT_EQ(progress.size(), 50u);
  for (std::size_t i = 0; i < progress.size(); ++i) EXPECT_EQ(progress[i], i + 1);
}

TEST(DoAll, HandsAnExceptionOn) {
  const auto work = [](std::size_t i) {
    if (i == 3) throw SetupError("three");
  };
  EXPECT_THROW(do_all(20, work, {}), SetupError);
  EXPECT_NO_THROW(do_all(3, work, {}));
}

TEST(SetFreeTwin, ChangesMassAndDampingAndNothingElse) {
  config::Scenario scenario = walk_scenario();
  const FreeTwin shipped = free_twin_of(scenario);
  EXPECT_DOUBLE_EQ(shipped.mass, 6.0);
  EXPECT_DOUBLE_EQ(shipped.damping, 4.0);
  model::ChainData before(scenario.twin.model.chain);
  set_free_twin(scenario, {.mass = 2.5, .damping = 7.0});
  EXPECT_DOUBLE_EQ(free_twin_of(scenario).mass, 2.5);
  EXPECT_DOUBLE_EQ(free_twin_of(scenario).damping, 7.0);
  EXPECT_DOUBLE_EQ(scenario.twin.model.dofs[3].damping, 0.1);  // angular

  model::ChainData after(scenario.twin.model.chain);
  const VectorA at_rest = VectorA::Zero(6);
  before.update(scenario.twin.model.q_start, at_rest);
  after.update(scenario.twin.model.q_start, at_rest);
  EXPECT_TRUE(after.M().bottomRightCorner(3, 3).isApprox(before.M().bottomRightCorner(3, 3)));
  EXPECT_TRUE(after.gravity().isZero());
  EXPECT_TRUE(after.pose(scenario.twin.model.end_effector)
                  .p.isApprox(before.pose(before.model().frame("handle")).p));
}

TEST(SetFreeTwin, RefusesOtherTwins) {
  config::Scenario door = config::load_scenario("models/scenarios/door.yaml");
  EXPECT_THROW(set_free_twin(door, {}), SetupError);
}

TEST(Player, PlaysTheSameToTheEndEveryTime) {
  config::Scenario scenario = walk_scenario();
  scenario.duration_s = 0.6;
  std::uint64_t hash = 0;
  for (int play = 0; play < 2; ++play) {
    Player player(scenario);
    for (bool has_more = true; has_more; has_more = player.end()) {
      player.begin();
      player.run();
    }
    EXPECT_TRUE(player.is_running());
    EXPECT_NEAR(player.record().time_s, scenario.script.script.grasp_s + 0.6, 2e-3);
    if (play == 1) {
      EXPECT_EQ(player.record().state_hash, hash);
    }
    hash = player.record().state_hash;
  }
}

TEST(SpringHand, HasTheDampingRatiosItIsGiven) {
  const person::HandImpedance hand = spring_hand({}, 3000.0);
  EXPECT_DOUBLE_EQ(hand.stiffness.x(), 3000.0);
  EXPECT_DOUBLE_EQ(hand.mass.z(), 1.5);
  EXPECT_NEAR(hand.damping.y(), 0.2 * 2.0 * std::sqrt(3000.0 * 1.5), 1e-12);
  EXPECT_NEAR(hand.grip_damping, 0.2 * 2.0 * std::sqrt(1e4 * 1.5), 1e-12);
  EXPECT_EQ(hand.tremor_rms, 0.0);
}

TEST(Kick, AHeavyDampedBodyInANormalHandIsStable) {
  const KickOutcome outcome =
      kick(walk_scenario(), {}, person::hand(person::HandPreset::kNormal), 6.0, 20.0);
  EXPECT_EQ(outcome.verdict, DecayClass::kStable);
  EXPECT_EQ(outcome.fault, FaultCode::kNone);
  EXPECT_GT(outcome.last_speed, 0.0);
}

// [C] 3: without compensation of the handle nothing below 1.7 times its 1.18 kg is stable.
TEST(Kick, ALightBodyWithoutCompensationOfTheHandleIsNot) {
  config::Scenario scenario = walk_scenario();
  scenario.device.estimation.wrench.has_imu = false;
  const person::HandImpedance hand = spring_hand({}, 1000.0);
  const KickOutcome outcome = kick(scenario, {}, hand, 0.4, 4.0);
  EXPECT_FALSE(is_stable(outcome.verdict));
  const KickOutcome again = kick(scenario, {}, hand, 0.4, 4.0);
  EXPECT_EQ(again.verdict, outcome.verdict);
  EXPECT_EQ(again.last_speed, outcome.last_speed);
}

TEST(Kick, IsAPushAndTheHandHoldsOn) {
  StabilityConfig config;
  config.calm.window = 0.05;
  config.kick.watched = 0.15;  // the last window ends 0.15 s after the kick
  const auto speed = [&](double force) {
    config.kick.force = force;
    person::HandImpedance hand = person::hand(person::HandPreset::kNormal);
    hand.tremor_rms = 0.0;
    return kick(walk_scenario(), config, hand, 6.0, 4.0).last_speed;
  };
  EXPECT_GT(speed(15.0), 0.012);  // 0.15 Ns on 6 kg and some of the arm
  EXPECT_LT(speed(15.0), 0.030);
  EXPECT_LT(speed(0.0), 0.006);
}

TEST(StabilityMap, HasARowPerHandAndFindsTheSmallestMass) {
  StabilityConfig config;
  config.stiffness = {1000};
  config.mass = {0.05, 6};
  config.damping = {20};
  config.mass_tolerance = 3.0;
  Runs runs;
  const StabilityMap map = make_stability_map(walk_scenario(), config, runs);
  ASSERT_EQ(map.rows.size(), 4u);
  EXPECT_EQ(rows_of(config), 4u);
  EXPECT_EQ(map.rows[0].hand, "1000 N/m");
  EXPECT_EQ(map.rows[2].hand, "normal");
  for (const StabilityRow& row : map.rows) {
    ASSERT_EQ(row.outcomes.size(), 2u);
    EXPECT_FALSE(is_stable(row.outcomes[0].verdict)) << row.hand;
    EXPECT_TRUE(is_stable(row.outcomes[1].verdict)) << row.hand;
    EXPECT_GT(row.stable_from, 0.05) << row.hand;
    EXPECT_LT(row.stable_from, 6.0) << row.hand;
  }
}

TEST(StabilityMap, JsonHasEveryCell) {
  StabilityMap map;
  map.config.mass = {1, 2};
  map.rows = {{"300 N/m", 4.0, {{DecayClass::kDiverges}, {DecayClass::kHunts, 0.01}}, 1.25},
              {"stiff", 4.0, {{DecayClass::kSustained}, {DecayClass::kSustained}}, kInfinity}};
  const nlohmann::ordered_json json = to_json(map);
  EXPECT_EQ(json["rows"][0]["cells"][1]["verdict"], "hunts");
  EXPECT_EQ(json["rows"][0]["stable_from_kg"], 1.25);
  EXPECT_TRUE(json["rows"][1]["stable_from_kg"].is_null());
}

}  // namespace
}  // namespace hg::experiments
