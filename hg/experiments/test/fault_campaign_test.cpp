// Faults on purpose in closed loop: what is noticed, what is harmless, and that the campaign tells.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hg/config/scenario.h"
#include "hg/experiments/fault_campaign.h"

namespace hg::experiments {
namespace {

config::Scenario walk_scenario() { return config::load_scenario("models/scenarios/walk.yaml"); }

FaultCase play(const char* kind, int index = 0, double magnitude = 0.0) {
  const injection::Injection injection = {
      .kind = injection::find_kind(kind), .index = index, .magnitude = magnitude, .from_s = 2.5};
  return play_fault(walk_scenario(), injection, {.watched_s = 1.0}, 10.0);
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

TEST(PlayFault, AMotorThatIsALittleWeakIsHarmless) {
  EXPECT_EQ(play("motor_weak", 2, 0.9).outcome, Outcome::kHarmless);
}

TEST(PlayFault, WhatBecomesWorseWithoutAReactionIsUnnoticed) {
  // no device notices a small offset of a force: it looks like a push
  const injection::Injection injection = {
      .kind = injection::find_kind("force_sensor_offset"), .magnitude = 5.0, .from_s = 2.5};
  const CampaignConfig strict = {.watched_s = 1.0, .harmless_force = -5.0};
  EXPECT_EQ(play_fault(walk_scenario(), injection, strict, 0.0).outcome, Outcome::kUnnoticed);
}

TEST(Campaign, IsTheSameForTheSameSeedAndTellsEveryCase) {
  config::Scenario scenario = walk_scenario();
  scenario.duration_s = 3.0;
  const auto cases_of = [&](std::uint64_t seed) {
    const CampaignConfig config = {.cases = 4, .seed = seed, .watched_s = 0.1};
    return to_json(run_campaign({scenario}, config, {}, {}))["cases"];
  };
  const auto cases = cases_of(3);
  EXPECT_EQ(cases.size(), 4U);
  EXPECT_EQ(cases_of(3), cases);
  EXPECT_NE(cases_of(4), cases);
}

TEST(Campaign, FailsForAnUnnoticedFaultAndForAnExceededBound) {
  Campaign campaign;
  campaign.scenarios = {"walk"};
  FaultCase good = {.injection = {.kind = injection::find_kind("motor_dead")},
                    .outcome = Outcome::kNoticed,
                    .peak_force = 60.0,
                    .worst_excess = 0.01};
  campaign.cases = {good};
  EXPECT_TRUE(is_passed(campaign));
  FaultCase bad = good;
  bad.outcome = Outcome::kUnnoticed;
  campaign.cases = {good, bad};
  EXPECT_FALSE(is_passed(campaign));
  EXPECT_NE(to_text(campaign).find("case 1: motor_dead"), std::string::npos);
  for (const auto& spoil :
       {+[](FaultCase& c) { c.peak_force = 300.0; }, +[](FaultCase& c) { c.worst_excess = 0.2; },
        +[](FaultCase& c) { c.is_complete = false; }}) {
    bad = good;
    spoil(bad);
    campaign.cases = {bad};
    EXPECT_FALSE(is_passed(campaign));
  }
}

}  // namespace
}  // namespace hg::experiments
