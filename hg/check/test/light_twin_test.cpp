#include "hg/check/light_twin.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"

namespace hg::check {
namespace {

config::Scenario tool(const std::string& arm, double mass) {
  config::Scenario scenario = config::load_scenario("models/arms/" + arm + "/move_tool.yaml");
  constexpr double kFile = 3.0;  // kg
  scenario.twin.model.mass_scale *= mass / kFile;
  return scenario;
}

TEST(LightTwin, IsWarnedOfInTheHandOfTheScript) {
  for (const char* arm : {"iiwa14", "ur5e"}) {
    config::Scenario light = tool(arm, 1.0);
    light.script.hand = person::hand(person::HandPreset::kStiff);
    const Findings findings = inspect_light_twin(light);
    ASSERT_EQ(findings.size(), 1u) << arm;
    EXPECT_EQ(findings[0].severity, Severity::kWarning);
    EXPECT_TRUE(findings[0].what.starts_with("1 kg at the handle shake")) << findings[0].what;
    EXPECT_NE(findings[0].fix.find("more mass"), std::string::npos);

    light.person = person::PersonKind::kMouse;  // whose hand is unknown
    EXPECT_EQ(inspect_light_twin(light).at(0).severity, Severity::kNote);
    EXPECT_EQ(inspect_light_twin(tool(arm, 3.0)).at(0).severity, Severity::kNote);
  }
}

TEST(LightTwin, IsNotAskedOfTwinsThatAreNoFreeBodies) {
  for (const char* twin : {"open_cupboard", "open_drawer"}) {
    const std::string file = std::string("models/arms/iiwa14/") + twin + ".yaml";
    EXPECT_TRUE(inspect_light_twin(config::load_scenario(file)).empty()) << twin;
  }
}

// The payload's inertia turns the handle, too.
TEST(LightTwin, CountsTurning) {
  const std::vector<person::HandImpedance> hand = {person::hand(person::HandPreset::kNormal)};
  config::Scenario scenario = tool("fr3", 3.0);
  const double before = lightest_bodies(scenario.device, scenario.twin, hand).at(0);
  EXPECT_LT(before, 3.0);
  scenario.device.estimation.wrench.payload.inertia = 0.02 * Eigen::Matrix3d::Identity();
  EXPECT_GT(lightest_bodies(scenario.device, scenario.twin, hand).at(0), 2.0 * before);
}

TEST(LightTwin, IsNotForeseenWithAnAccelerometerInTheHandle) {
  EXPECT_TRUE(inspect_light_twin(config::load_scenario("models/scenarios/walk.yaml")).empty());
  config::Scenario arm = tool("fr3", 1.0);
  arm.device.estimation.wrench.has_imu = true;
  EXPECT_TRUE(inspect_light_twin(arm).empty());
}

}  // namespace
}  // namespace hg::check
