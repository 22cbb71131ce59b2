#include "hg/scenario/run/plan_options.h"

#include <gtest/gtest.h>

#include "hg/core/test/message_of.h"

namespace hg::scenario {
namespace {

std::string refusal(const std::string& json) {
  return message_of([&] { plan_of_request(json); });
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' without '" << part << "'";
}

TEST(PlanOfRequest, ValuesComeToTheirParts) {
  const RunPlan plan = plan_of_request(R"({"scenario": "walk", "set": ["twin.mass_scale=2"],
    "seed": 7, "device_address": "host:1", "despite": ["lateness"], "duration": 2.5, "cpu": 1,
    "recordings": "r", "recording": false, "viewer": true, "embedded_in": ["http://a:1"]})");
  EXPECT_EQ(plan.world.scenario, "walk");
  EXPECT_EQ(plan.world.changes, std::vector<std::string>{"twin.mass_scale=2"});
  EXPECT_EQ(plan.world.seed, 7U);
  EXPECT_EQ(plan.machine.address, "host:1");
  EXPECT_EQ(plan.machine.despite, std::vector<std::string>{"lateness"});
  EXPECT_EQ(plan.timing.duration_s, 2.5);
  EXPECT_EQ(plan.timing.cpu, 1);
  EXPECT_EQ(plan.records.folder, "r");
  EXPECT_FALSE(plan.records.has_recording);
  EXPECT_TRUE(plan.page.is_trial());
}

TEST(PlanOfRequest, WhatIsMissingHasItsDefault) {
  const RunPlan plan = plan_of_request("{}"), defaults;
  EXPECT_EQ(plan.world.scenario, defaults.world.scenario);
  EXPECT_EQ(plan.timing.priority, defaults.timing.priority);
  EXPECT_EQ(plan.timing.duration_s, std::nullopt);
  EXPECT_TRUE(plan.records.has_recording);
}

TEST(PlanOfRequest, AnUnknownKeyIsRefusedWithTheNearest) {
  EXPECT_EQ(refusal(R"({"slow_solv": 3})"),
            "request: no option is called 'slow_solv', did you mean 'slow_solve'?");
}

TEST(PlanOfRequest, AKeyThatIsGivenTwiceIsRefused) {
  EXPECT_EQ(refusal(R"({"seed": 1, "fast": true, "seed": 2})"), "request: \"seed\" is given twice");
  expect_part(refusal(R"({"seed": {"a": 1, "a": 2}})"), "--seed: expected a whole number");
}

TEST(PlanOfRequest, OneObjectIsExpected) {
  for (const char* text : {"", "{", "[]", "3", "{} {}"})
    expect_part(refusal(text), "one JSON object");
}

TEST(PlanOfRequest, ValuesOfAnotherTypeAreRefused) {
  EXPECT_EQ(refusal(R"({"fast": 1})"), "--fast: expected true or false, got 1");
  EXPECT_EQ(refusal(R"({"duration": "3"})"), "--duration: expected a number, got \"3\"");
  EXPECT_EQ(refusal(R"({"seed": 1.5})"), "--seed: expected a whole number, got 1.5");
  EXPECT_EQ(refusal(R"({"set": "a=1"})"), "--set: expected a list of texts, got \"a=1\"");
  EXPECT_EQ(refusal(R"({"scenario": ""})"),
            "--scenario: expected a text that is not empty, got \"\"");
  EXPECT_EQ(refusal(R"({"port": 70000})"),
            "--port: expected a whole number in its range, got 70000");
  EXPECT_EQ(refusal(R"({"seed": -1})"), "--seed: expected a whole number in its range, got -1");
}

TEST(PlanOfRequest, ValuesOutOfRangeAreRefusedAsOnTheCommandLine) {
  EXPECT_EQ(refusal(R"({"duration": 0})"), "--duration: must be more than 0, got 0");
  EXPECT_EQ(refusal(R"({"slow_solve": 0})"), "--slow-solve: must be at least 1, got 0");
  EXPECT_EQ(refusal(R"({"priority": 100})"), "--priority: must be from 0 to 99, got 100");
  EXPECT_EQ(refusal(R"({"cpu": -2})"), "--cpu: must be at least 0, got -2");
  EXPECT_EQ(refusal(R"({"law": "gaus"})"),
            "--law: expected one of together, gauss, gantry, paper, paper_bounds, got 'gaus', did "
            "you mean 'gauss'?");
  expect_part(refusal(R"({"embedded_in": ["x"]})"), "--embedded-in: expected the origin of a page");
}

TEST(PlanOfRequest, WhatIsOfAMachineNeedsItsAddress) {
  EXPECT_EQ(refusal(R"({"move_to_start": true})"), "--move-to-start: needs --device-address");
  EXPECT_EQ(refusal(R"({"key_file": "k"})"), "--key-file: needs --device-address");
}

TEST(PlanOfRequest, WithoutAPageNothingIsSaidOfIt) {
  EXPECT_EQ(refusal(R"({"fast": true, "port": 1})"), "request: fast excludes port");
  EXPECT_EQ(refusal(R"({"viewer": false, "bind": "::1"})"), "request: viewer: false excludes bind");
  EXPECT_EQ(refusal(R"({"fast": true, "lsl": true})"), "request: fast excludes lsl");
}

}  // namespace
}  // namespace hg::scenario
