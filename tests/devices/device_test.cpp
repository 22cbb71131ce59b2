/// Other arms as the device: each opens a small door. Their URDFs come from the wheel
/// example-robot-data; nothing of them is in this repository.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"
#include "hg/model/test/models.h"
#include "hg/scenario/start_posture.h"
#include "tests/scenarios/trace.h"

namespace hg {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The URDF with its fixed joint at the base made to move.
std::string with_moving_base(std::string urdf, const std::string& type, const std::string& axis) {
  const std::string fixed = R"(<joint name="world_joint" type="fixed">)";
  const std::size_t at = urdf.find(fixed);
  if (at == std::string::npos) throw SetupError("ur5_robot.urdf: has no joint world_joint");
  return urdf.replace(at, fixed.size(),
                      R"(<joint name="world_joint" type=")" + type + R"("><axis xyz=")" + axis +
                          R"("/><limit lower="-0.5" upper="0.5" velocity="1" effort="100"/>)");
}

// Files of tests/devices, and the URDFs that are not in this repository beside them.
std::vector<config::SourceText> sources(const std::string& device,
                                        const std::map<std::string, std::string>& replaced) {
  const std::string scenario = "tests/devices/" + device + "/scenario.yaml";
  std::vector<config::SourceText> texts = {{scenario, text_of(scenario)}};
  for (const auto& entry : fs::recursive_directory_iterator("tests/devices")) {
    const std::string name = entry.path().generic_string();
    if (entry.is_regular_file() && name != scenario) texts.push_back({name, text_of(entry)});
  }
  const std::string ur5 = text_of(model::example_robot_file("ur_description/urdf/ur5_robot.urdf"));
  texts.push_back({"tests/devices/ur5/ur5_robot.urdf", ur5});
  texts.push_back(
      {"tests/devices/ur5_rail/ur5_rail.urdf", with_moving_base(ur5, "prismatic", "0 1 0")});
  texts.push_back({"tests/devices/ur5_turntable/ur5_turntable.urdf",
                   with_moving_base(ur5, "revolute", "0 0 1")});
  texts.push_back({"tests/devices/panda/panda.urdf",
                   text_of(model::example_robot_file("panda_description/urdf/panda.urdf"))});
  texts.push_back({"tests/devices/z1/z1.urdf",
                   text_of(model::example_robot_file("z1_description/urdf/z1.urdf"))});
  for (config::SourceText& text : texts) {
    for (const auto& [from, to] : replaced) {
      const std::size_t at = text.content.find(from);
      if (at != std::string::npos) text.content.replace(at, from.size(), to);
    }
  }
  return texts;
}

config::Scenario scenario_of(const std::string& device,
                             const std::map<std::string, std::string>& replaced = {}) {
  return config::load_scenario(sources(device, replaced));
}

class OtherDevice : public testing::TestWithParam<const char*> {};

TEST_P(OtherDevice, OpensTheDoor) {
  const Trace trace(scenario_of(GetParam()));
  expect_sound(trace.run());
  EXPECT_NEAR(trace.largest(0.0, 9.0, [](const auto& r) { return r.twin.q_a[0]; }), 0.8, 5e-3);
  EXPECT_LT(trace.run().quality().mean_acceleration_change(), kAccelerationChangeMax);
}

INSTANTIATE_TEST_SUITE_P(Devices, OtherDevice,
                         testing::Values("ur5", "panda", "z1", "ur5_rail", "ur5_turntable"),
                         [](const auto& device) { return std::string(device.param); });

// The arm is led so that its first joint stays at its goal.
TEST(OneGantryAxis, FollowsTheHandOnARail) {
  const Trace trace(scenario_of("ur5_rail"));
  const auto pan = [](const CycleRecord& r) { return std::abs(r.reference.q_m[0]); };
  const auto rail = [](const CycleRecord& r) { return r.robot.q_p[0]; };
  EXPECT_GT(trace.largest(0.0, 9.0, rail) - trace.smallest(0.0, 9.0, rail), 0.05);  // m
  EXPECT_LT(pan(trace.records().back()), 0.02);  // rad, shut and at rest
  // the same door without the rail: how far the joint turns
  const Trace fixed(scenario_of("ur5"));
  EXPECT_LT(trace.largest(3.0, 5.6, pan), fixed.largest(3.0, 5.6, pan));
}

TEST(OneGantryAxis, FollowsTheHandOnATurntable) {
  const Trace trace(scenario_of("ur5_turntable"));
  const auto table = [](const CycleRecord& r) { return r.robot.q_p[0]; };
  EXPECT_GT(trace.largest(0.0, 9.0, table) - trace.smallest(0.0, 9.0, table), 0.05);  // rad
  EXPECT_NEAR(trace.records().back().reference.q_m[0], -0.4, 0.02);
}

TEST(SevenJoints, TheElbowStaysWhereThePostureWantsIt) {
  const Trace trace(scenario_of("panda"));
  const VectorM start = trace.records().front().reference.q_m;
  double worst = 0.0;
  for (const CycleRecord& record : trace.records()) {
    worst = std::max(worst, std::abs(record.reference.q_m[2]));
  }
  EXPECT_LT(worst, 0.6);  // rad from the goal, 0; the joint could turn by 2.9
  // the hand is where it began, and so is the arm
  EXPECT_LT((trace.records().back().reference.q_m - start).lpNorm<Eigen::Infinity>(), 0.1);
}

TEST(Handle, WithoutADeadManRunsAllTheSame) {
  const config::Scenario scenario = scenario_of("panda");
  EXPECT_FALSE(scenario.device.monitor.has_dead_man);
  ScenarioRun run(scenario);
  Mode last = Mode::kOff;
  bool is_closed = false;
  run.play(
      [&](const Sample& sample) {
        last = sample.record.mode;
        is_closed |= sample.sensors.dead_man;
      },
      0.1);
  EXPECT_EQ(last, Mode::kRunning);
  EXPECT_FALSE(is_closed);
}

std::string start_message(const config::Scenario& scenario) {
  try {
    ScenarioRun run(scenario);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Start, OutOfReachReportsHowFarAndWhatToDo) {
  const std::string message =
      start_message(scenario_of("ur5", {{"{x_m: 0.56, y_m: 0.30", "{x_m: 2.0, y_m: 0.30"}}));
  EXPECT_NE(message.find("cannot hold its handle at (1.94, "), std::string::npos) << message;
  EXPECT_NE(message.find("move or turn the twin's placement, or change its start"),
            std::string::npos)
      << message;
}

TEST(Start, ChoosesAPostureThatTheSumsOfJointsPermit) {
  const config::Scenario scenario = scenario_of(
      "ur5", {{"posture: {shoulder_pan_joint: 0,", "#"},
              {"{q_min_rad: -3.1, q_max_rad: 0, ddq", "{ddq"},
              {"{q_min_rad: 0.2, q_max_rad: 2.9, ddq", "{ddq"},
              {"{q_min_rad: -2.9, q_max_rad: -0.25, ddq", "{ddq"},
              {"cartesian_limits:",
               "virtual_joints:\n  - {name: bend, weights: {elbow_joint: 1}, q_min_rad: -2.9, "
               "q_max_rad: -0.2, dq_max_rad_per_s: 3, ddq_max_rad_per_s2: 20}\n"
               "cartesian_limits:"}});
  const scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
  EXPECT_GE(start.q_m[2], -2.9);
  EXPECT_LE(start.q_m[2], -0.2);
}

TEST(Start, OutsideABoxReportsWhichAndHowFar) {
  const std::string message = start_message(
      scenario_of("ur5", {{"z: {q_min_m: 0.05, q_max_m: 0.8}", "z: {q_max_m: 0.3}"}}));
  EXPECT_NE(message.find("at its start hand z of the device would be at 0.350, outside -inf .. "
                         "0.300"),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace hg
