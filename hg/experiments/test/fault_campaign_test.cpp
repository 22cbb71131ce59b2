// Faults on purpose in closed loop: what is noticed, what is harmless, and that the campaign
// reports it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/fault_campaign.h"
#include "hg/experiments/runs.h"

namespace hg::experiments {
namespace {

config::Scenario walk_scenario() { return config::load_scenario("models/scenarios/walk.yaml"); }

FaultCase play_judged(const config::Scenario& scenario, const FaultCase& drawn,
                      const CampaignConfig& config, double clean_force) {
  FaultCase result = play_fault(scenario, drawn, config);
  judge(config, clean_force, result);
  return result;
}

FaultCase play(const char* kind, int index = 0, double magnitude = 0.0) {
  const faults::Injection injection = {
      .kind = faults::find_kind(kind), .index = index, .magnitude = magnitude, .from_s = 2.5};
  return play_judged(walk_scenario(), {.injection = injection}, {.watched_s = 1.0}, 10.0);
}

TEST(PlayFault, ASensorWithoutANumberIsNoticedInTheSameCycle) {
  const FaultCase result = play("torque_sensor_nan", 3);
  EXPECT_EQ(result.outcome, Outcome::kNoticed);
  EXPECT_EQ(result.fault, FaultCode::kSensorNotFinite);
  EXPECT_EQ(result.stop, Stop::kSto);
  EXPECT_LE(result.noticed_s, 0.0011);
  EXPECT_TRUE(result.is_complete);
}

TEST(PlayFault, AnOpenDeadManStopsWithoutAFault) {
  const FaultCase result = play("dead_man_open");
  EXPECT_EQ(result.outcome, Outcome::kNoticed);
  EXPECT_EQ(result.fault, FaultCode::kNone);
  EXPECT_LT(result.stopped_s, 0.5);
  EXPECT_LT(result.worst_excess, 1e-3);
}

FaultCase play_in_a_stop(const char* kind, int index, double magnitude, double after_s) {
  const faults::Injection injection = {
      .kind = faults::find_kind(kind), .index = index, .magnitude = magnitude, .from_s = 2.5};
  const faults::Injection stop = {.kind = faults::find_kind("emergency_stop"),
                                  .from_s = 2.5 - after_s};
  return play_judged(walk_scenario(),
                     {.phase = Phase::kStopping, .injection = injection, .other = stop},
                     {.watched_s = 2.0}, 10.0);
}

TEST(PlayFault, AGantryThatRunsAwayIsStoppedByItsBrakesSoonAndNear) {
  for (const int axis : {0, 1}) {
    for (const double speed : {1.0, -1.0}) {
      const FaultCase result = play("gantry_runaway", axis, speed);
      EXPECT_EQ(result.outcome, Outcome::kNoticed);
      EXPECT_EQ(result.stop, Stop::kSto);
      EXPECT_LT(result.noticed_s, 0.15);
      EXPECT_LT(result.travel_share, 0.3);
      EXPECT_LT(result.energy, 1.2);  // the arm makes up for the gantry with all its motors give
    }
  }
}

TEST(PlayFault, AGantryThatRunsAwayInAStopIsNotOnlyAskedToStop) {
  for (const int axis : {0, 1}) {
    const FaultCase result = play_in_a_stop("gantry_runaway", axis, 1.0, 0.02);
    EXPECT_EQ(result.stop, Stop::kSto);
    EXPECT_LT(result.travel_share, 0.3);
  }
}

TEST(PlayFault, BothEncodersOfAJointThatDriftAlikeAreSeenByTheGyroscope) {
  for (const int joint : {0, 2, 3, 5}) {
    const FaultCase result = play("joint_encoders_drift", joint, 0.1);
    EXPECT_EQ(result.fault, FaultCode::kTurnUnexplained) << joint;
    EXPECT_LT(result.worst_distance, 0.06) << joint;
  }
}

TEST(PlayFault, AGantryWhoseCouplingSlipsIsSeenByTheAccelerometer) {
  for (const int axis : {0, 1}) {
    for (const double speed : {0.3, -1.0}) {
      const FaultCase result = play("gantry_slips", axis, speed);
      EXPECT_EQ(result.fault, FaultCode::kMotionUnexplained);
      EXPECT_EQ(result.stop, Stop::kSto);
      EXPECT_LT(result.noticed_s, 0.3);
      EXPECT_LT(result.travel_share, 0.5);
    }
  }
}

TEST(PlayFault, AGantryEncoderThatDriftsSlowlyIsSeenInTime) {
  for (const double speed : {0.005, -0.02}) {
    const faults::Injection injection = {
        .kind = faults::find_kind("gantry_encoder_drift"), .magnitude = speed, .from_s = 2.5};
    const FaultCase result =
        play_judged(walk_scenario(), {.injection = injection}, {.watched_s = 40.0}, 10.0);
    EXPECT_EQ(result.fault, FaultCode::kGantryDeviates);
    EXPECT_LT(result.travel_share, 0.5);
  }
}

TEST(PlayFault, AFallingArmIsWatchedToTheEndAndReported) {
  const faults::Injection weak = {
      .kind = faults::find_kind("brake_weak"), .index = 4, .from_s = 2.0};
  const faults::Injection stop = {.kind = faults::find_kind("emergency_stop"), .from_s = 4.0};
  const FaultCase result =
      play_judged(config::load_scenario("models/scenarios/excavator.yaml"),
                  {.phase = Phase::kPair, .injection = weak, .other = stop}, {}, 10.0);
  EXPECT_EQ(result.outcome, Outcome::kNoticed);
  EXPECT_GT(result.travel_share, 1.0);
  EXPECT_TRUE(result.has_reported_slip);
}

TEST(PlayFault, AnEncoderThatJumpsIsNamedAndNotTheCollisionThatItSeemsToBe) {
  for (const int joint : {0, 1, 2, 3, 4}) {
    EXPECT_EQ(play("link_encoder_zero", joint).fault, FaultCode::kSensorJump) << joint;
    EXPECT_EQ(play("link_encoder_jump", joint, 0.4).fault, FaultCode::kSensorJump) << joint;
  }
}

TEST(PlayFault, AMotorThatIsALittleWeakIsHarmless) {
  EXPECT_EQ(play("motor_weak", 2, 0.9).outcome, Outcome::kHarmless);
}

TEST(PlayFault, WhatBecomesWorseWithoutAReactionIsUnnoticed) {
  // no device notices a small offset of a force: it looks like a push
  const faults::Injection injection = {
      .kind = faults::find_kind("force_sensor_offset"), .magnitude = 5.0, .from_s = 2.5};
  const CampaignConfig strict = {.watched_s = 1.0, .harmless_force = -5.0};
  EXPECT_EQ(play_judged(walk_scenario(), {.injection = injection}, strict, 0.0).outcome,
            Outcome::kUnnoticed);
}

TEST(Campaign, IsTheSameForTheSameSeedAndReportsEveryCase) {
  config::Scenario scenario = walk_scenario();
  scenario.duration_s = 3.0;
  const auto cases_of = [&](std::uint64_t seed) {
    const CampaignConfig config = {.cases = 4, .seed = seed, .watched_s = 0.1};
    Runs runs;
    return to_json(run_campaign({scenario}, config, {}, runs))["cases"];
  };
  const auto cases = cases_of(3);
  EXPECT_EQ(cases.size(), 4U);
  EXPECT_EQ(cases_of(3), cases);
  EXPECT_NE(cases_of(4), cases);
}

TEST(Campaign, SaysWhatItsCaseShowed) {
  const FaultCase fallen = {.injection = {.kind = faults::find_kind("brake_weak"), .index = 4},
                            .other = faults::Injection{.kind = faults::find_kind("emergency_stop")},
                            .outcome = Outcome::kNoticed,
                            .has_reported_slip = true,
                            .is_complete = false};
  const auto said = to_json({.scenarios = {"walk"}, .cases = {fallen}})["cases"][0];
  EXPECT_EQ(said["fault"], "brake_weak");
  EXPECT_EQ(said["index"], 4);
  EXPECT_EQ(said["and"]["fault"], "emergency_stop");
  EXPECT_EQ(said["outcome"], "noticed");
  EXPECT_EQ(said["brake_slips"], true);
  EXPECT_EQ(said["recording_complete"], false);
}

}  // namespace
}  // namespace hg::experiments
