// A teleoperation, as a scenario describes it.

#include <gtest/gtest.h>

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

// A scenario of a shipped twin with these lines below `teleoperation`.
Scenario load_with(const std::string& twin, const std::string& lines) {
  std::vector<SourceText> texts = {
      {"models/scenarios/run.yaml",
       "title: a\ndescription: b\ndevice: ../haptic_giant/device.yaml\n"
       "twin: ../twins/" +
           twin + "/twin.yaml\nperson: mouse\nduration_s: 3\nteleoperation:\n" + lines}};
  for (const SourceText& source : load_scenario("models/scenarios/" + twin + ".yaml").sources) {
    if (source.name != "models/scenarios/" + twin + ".yaml") texts.push_back(source);
  }
  return load_scenario(texts);
}

std::string message(const std::string& twin, const std::string& lines) {
  return message_of([&] { load_with(twin, lines); });
}

TEST(Teleoperation, OfAToolHasItsDefaults) {
  const Scenario scenario = load_with("free_space", "  {method: wave_variables}\n");
  ASSERT_TRUE(scenario.teleoperation);
  const teleoperation::TeleoperationConfig& config = *scenario.teleoperation;
  EXPECT_EQ(config.mapping, teleoperation::Mapping::kTool);
  EXPECT_EQ(config.method.kind, teleoperation::MethodKind::kWaveVariables);
  EXPECT_EQ(config.machine.x_start.size(), 3);
  EXPECT_EQ(config.limiter.axes.size(), 3U);
  EXPECT_FALSE(load_scenario("models/scenarios/door.yaml").teleoperation);
}

TEST(Teleoperation, OfAPoseHasTurnsThatAreMeasuredOnALever) {
  const Scenario scenario = load_with(
      "free_space",
      "  mapping: pose\n  lever_m: 0.2\n"
      "  remote: {turn_max_rad: 1, walls: [{normal: [0, 0, 1], through_m: [0, 0, -1]}]}\n");
  const teleoperation::TeleoperationConfig& config = *scenario.teleoperation;
  ASSERT_EQ(config.machine.x_start.size(), 6);
  ASSERT_EQ(config.limiter.axes.size(), 6U);
  EXPECT_EQ(config.limiter.axes[2].range.ub, 0.5);
  EXPECT_EQ(config.limiter.axes[5].range.ub, 0.2);
  EXPECT_EQ(config.leader.ranges.size(), 6U);
  EXPECT_EQ(config.machine.walls[0].normal.size(), 6);
}

TEST(Teleoperation, ScalesThatChangeNeedAToolThatIsLed) {
  const std::string changes = "changes:\n  - {at_s: 1, motion_scale: [1, 0.5, 1]}\n";
  const Scenario scenario = load_with("free_space", "  mapping: pose\n" + changes);
  ASSERT_EQ(scenario.changes.size(), 3U);
  EXPECT_EQ(scenario.changes[1].change.parameter, Parameter::kMotionScale);
  EXPECT_EQ(scenario.changes[1].change.value, 0.5);
  EXPECT_NE(message("excavator", "  mapping: joints\n" + changes)
                .find("motion_scale and force_scale need a teleoperation that leads a tool"),
            std::string::npos);
}

TEST(Teleoperation, OfJointsHasTheRangesAndTheStartOfTheTwin) {
  const Scenario scenario =
      load_with("excavator",
                "  mapping: joints\n"
                "  remote: {walls: [{joint: stick, at_rad: 1.2, is_above: true}]}\n");
  const teleoperation::TeleoperationConfig& config = *scenario.teleoperation;
  ASSERT_EQ(config.limiter.axes.size(), 4U);
  EXPECT_EQ(config.machine.x_start[2], 0.9);
  EXPECT_EQ(config.limiter.axes[3].range.ub, scenario.twin.model.dofs[3].limits.q_max);
  EXPECT_EQ(config.machine.walls[0].normal[2], -1.0);
  EXPECT_EQ(config.machine.walls[0].offset, -1.2);
  EXPECT_EQ(config.leader.snapshot, 0.02);
}

TEST(Teleoperation, WhatMakesNoSenseIsRefusedWhereItStands) {
  EXPECT_EQ(message("free_space", "  method: model_mediate\n"),
            "models/scenarios/run.yaml:8:11: teleoperation.method: must be one of position_force, "
            "four_channel, wave_variables, passivity_control, model_mediated, got "
            "'model_mediate', did you mean 'model_mediated'?");
  EXPECT_EQ(message("free_space", "  link: {loss: 5}\n"),
            "models/scenarios/run.yaml:8:16: teleoperation.link.loss: must be 0 .. 1, got 5");
  EXPECT_EQ(message("free_space", "  mapping: joints\n"),
            "models/scenarios/run.yaml:8:12: teleoperation.mapping: joints needs a twin of one to "
            "seven joints, all of which turn");
  EXPECT_EQ(message("free_space", "  remote: {lowest_m: [1, 0, 0], highest_m: [0, 1, 1]}\n"),
            "models/scenarios/run.yaml:8:11: teleoperation.remote: the start must be within "
            "lowest_m and highest_m\nmodels/scenarios/run.yaml:8:44: "
            "teleoperation.remote.highest_m: must be above lowest_m");
  EXPECT_EQ(message("free_space",
                    "  remote: {walls: [{normal: [0, 0, 1], through_m: [0, 0, 0.1]}]}"
                    "\n"),
            "models/scenarios/run.yaml:8:51: teleoperation.remote.walls[0].through_m: the tool "
            "must not start inside of it");
  EXPECT_EQ(message("free_space", "  remote: {stiffness_N_per_m: 1e9}\n"),
            "models/scenarios/run.yaml:8:31: teleoperation.remote.stiffness_N_per_m: at most 1e6 "
            "1/s^2 times what moves, got 1e+09 for 3");
  EXPECT_EQ(message("excavator",
                    "  {mapping: joints, remote: {walls: [{joint: bom, at_rad: 0}]}}"
                    "\n"),
            "models/scenarios/run.yaml:8:46: teleoperation.remote.walls[0].joint: must be a joint "
            "of the twin, got 'bom', did you mean 'boom'?");
}

}  // namespace
}  // namespace hg::config
