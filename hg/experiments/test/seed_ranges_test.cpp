// Many seeds of a scenario: each one is itself, and the table names the worst.

#include "hg/experiments/seed_ranges.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hg::experiments {
namespace {

Trial short_walk() {
  Trial trial = {
      .name = "walk", .hand = "", .scenario = config::load_scenario("models/scenarios/walk.yaml")};
  trial.scenario.duration_s = 2.0;
  return trial;
}

TEST(PlaySeeds, EverySeedIsPlayedOnceInOrderAndIsTheSameAgain) {
  const std::vector<Trial> trials = {short_walk(), short_walk()};
  const std::vector<SeededRun> runs = play_seeds(trials, 5, 3, {});
  ASSERT_EQ(runs.size(), 6U);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].trial, i / 3);
    EXPECT_EQ(runs[i].seed, 5 + i % 3);
    EXPECT_TRUE(runs[i].has_held);
    EXPECT_GT(runs[i].joint_error, 0.0);
    EXPECT_EQ(runs[i].missing, 3U) << "too short for its events";
  }
  EXPECT_NE(runs[0].joint_error, runs[1].joint_error) << "another seed";
  EXPECT_EQ(runs[0].joint_error, runs[3].joint_error) << "the same seed";
}

TEST(PlaySeeds, AFaultAndALimitThatIsLeftHaveNotHeld) {
  Trial trial = short_walk();
  trial.scenario.faults = {{.kind = faults::find_kind("torque_sensor_nan"), .from_s = 1.5}};
  const std::vector<SeededRun> runs = play_seeds({trial}, 1, 1, {});
  EXPECT_EQ(runs[0].fault.code, FaultCode::kSensorNotFinite);
  EXPECT_NEAR(runs[0].ended_s, 1.5, 0.01);
  EXPECT_FALSE(have_all_held(runs));
  EXPECT_EQ(to_json({trial}, runs)["runs"][0]["fault_text"], "measured value is not finite");

  Trial tight = short_walk();
  for (LimitInfo& limit : tight.scenario.limits) {
    if (limit.name == "hand x") limit.range = {-0.1, 0.1};
  }
  const std::vector<SeededRun> outside = play_seeds({tight}, 1, 1, {});
  EXPECT_EQ(outside[0].length.name, "hand x");
  EXPECT_GT(outside[0].length.excess, 0.3);
  EXPECT_FALSE(have_all_held(outside));
}

// Joints that are fast when the forces are out: stopped at once, what one of them adds to the
// motion falls to m1, whose motor cannot take it; stopped slowly, m3 moves too far.
TEST(PlaySeeds, AStopOfFastJointsIsNoFault) {
  for (const char* file : {"stop_m1", "stop_m3"}) {
    SCOPED_TRACE(file);
    const std::string path = std::string("tests/scenarios/fast/") + file + ".yaml";
    const Trial trial = {.name = file, .hand = "", .scenario = config::load_scenario(path)};
    const std::vector<SeededRun> runs = play_seeds({trial}, 1, 1, {});
    EXPECT_EQ(runs[0].fault.code, FaultCode::kNone) << to_string(runs[0].fault.code);
    EXPECT_TRUE(have_all_held(runs));
    EXPECT_GT(runs[0].ended_s, trial.scenario.duration_s + 0.5) << "the stop was played";
  }
}

// Where a wall lets go of the elbow, m1 would change its torque by 150 Nm at once; the law asks for
// no more than its motor can twist its spring for.
TEST(PlaySeeds, AFastStrokeLeavesNoMotorBehind) {
  const Trial trial = {.name = "stroke",
                       .hand = "",
                       .scenario = config::load_scenario("tests/scenarios/fast/stroke.yaml")};
  const std::vector<SeededRun> runs = play_seeds({trial}, 1, 2, {});
  EXPECT_TRUE(have_all_held(runs)) << to_json({trial}, runs).dump(2);
}

// In the middle of a throw, m3 and m6 are at 2.6 and 3.3 rad/s: no axis moves farther than stated.
TEST(PlaySeeds, ARunEndsWithAnOrdinaryStop) {
  const Trial thrown = {
      .name = "throw", .hand = "", .scenario = config::load_scenario("models/stress/throw.yaml")};
  const std::vector<Trial> trials = {thrown};
  for (const std::uint64_t seed : {4, 9}) {
    const std::vector<SeededRun> runs = play_seeds(trials, seed, 1, {});
    EXPECT_TRUE(have_all_held(runs)) << to_json(trials, runs).dump(2);
    EXPECT_GT(runs[0].ended_s, thrown.scenario.duration_s + 0.2);
  }
}

TEST(PlaySeeds, TheScenariosOfStressBeginWell) {
  std::vector<Trial> trials;
  for (const auto& entry : std::filesystem::directory_iterator("models/stress")) {
    if (entry.path().extension() != ".yaml") continue;
    trials.push_back({.name = entry.path().stem().string(),
                      .hand = "",
                      .scenario = config::load_scenario(entry.path().string())});
    trials.back().scenario.duration_s = 1.5;
  }
  EXPECT_EQ(trials.size(), 11U);
  const std::vector<SeededRun> runs = play_seeds(trials, 1, 1, {});
  EXPECT_TRUE(have_all_held(runs)) << to_json(trials, runs).dump(2);
}

}  // namespace
}  // namespace hg::experiments
