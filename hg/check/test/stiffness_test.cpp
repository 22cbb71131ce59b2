#include "hg/check/stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace hg::check {
namespace {

config::Scenario walk() { return config::load_scenario("models/scenarios/walk.yaml"); }

Findings found(const config::Scenario& scenario) {
  Collector out(scenario.twin.sources, scenario.twin.places);
  inspect_stiffness(scenario.device, scenario.twin, {}, out);
  return out.findings;
}

TEST(Stiffness, FollowsFromMassDampingDelayAndAcceleration) {
  config::Scenario scenario = walk();
  const StiffnessLimits limits = stiffness_limits(scenario.device, scenario.twin);
  EXPECT_NEAR(limits.mass, 6.0, 1e-9);
  EXPECT_NEAR(limits.damping, 4.0, 1e-9);
  EXPECT_EQ(limits.period, 1e-3);
  EXPECT_NEAR(limits.acceleration, 6.7, 0.3);  // upwards; the handle's rating is 3 m/s^2
  // low-pass of 100 Hz, torque loop, sensor: haptify measures 3.5 to 4.4 ms
  EXPECT_NEAR(limits.delay, 4e-3, 1e-3);
  EXPECT_NEAR(limits.frequency_Hz() * limits.delay, 16.5 / 360.0, 1e-12);
  EXPECT_NEAR(std::sqrt(limits.by_frequency() / 6.0) / (2.0 * std::numbers::pi),
              limits.frequency_Hz(), 1e-9);
  EXPECT_NEAR(limits.by_passivity(20.0), 24.0 / (0.5e-3 + limits.delay), 1e-6);
  const double by_acceleration = limits.by_acceleration(0.1);
  EXPECT_NEAR(by_acceleration, 6.0 * std::pow(limits.acceleration / 0.1, 2), 1e-6);
  EXPECT_NEAR(limits.meeting_speed(by_acceleration), 0.1, 1e-9);

  scenario.device.control.method = tracking::Method::kDrives;
  config::settle_law(scenario);
  EXPECT_EQ(stiffness_limits(scenario.device, scenario.twin).acceleration, 3.0);
  scenario = walk();

  scenario.device.estimation.wrench.low_pass_Hz = 0.0;
  const StiffnessLimits prompt = stiffness_limits(scenario.device, scenario.twin);
  EXPECT_NEAR(limits.delay - prompt.delay, 1.0 / (320.0 * std::numbers::pi), 1e-12);
  EXPECT_GT(prompt.by_frequency(), limits.by_frequency());
}

TEST(Stiffness, OfATwinWithAScaleIsThatOfTheBodyThatIsFelt) {
  config::Scenario scenario = walk();
  const StiffnessLimits one = stiffness_limits(scenario.device, scenario.twin);
  scenario.twin.model.felt_scale.head<3>() << 2.0, 0.5, 1.0;
  const StiffnessLimits scaled = stiffness_limits(scenario.device, scenario.twin);
  EXPECT_NEAR(scaled.mass, 0.5 * one.mass, 1e-9);
  EXPECT_NEAR(scaled.damping, 0.5 * one.damping, 1e-9);

  // along an axis the scale cancels: what a file may say does not change
  scenario.twin.model.felt_scale.head<3>().setConstant(2.0);
  scenario.surfaces.resize(1);
  scenario.surfaces[0].contact = surfaces::Contact::kSpring;
  scenario.surfaces[0].damping = 20.0;
  scenario.surfaces[0].stiffness = 0.9 * one.by_passivity(20.0);
  EXPECT_TRUE(inspect_surfaces(scenario).empty());
  scenario.surfaces[0].stiffness = 1.1 * one.by_passivity(20.0);
  EXPECT_EQ(inspect_surfaces(scenario).size(), 1u);

  // light bodies shake on drives that follow positions: twice the scale is half the body
  const auto calm = [](double scale, double share) {
    config::Scenario arm = config::load_scenario("models/arms/ur5e/move_tool.yaml");
    arm.twin.model.felt_scale.head<3>().setConstant(scale);
    arm.twin.model.mass_scale *= share;
    for (rendering::TwinDof& dof : arm.twin.model.dofs) dof.damping *= share;
    return stiffness_limits(arm.device, arm.twin).by_frequency();
  };
  EXPECT_NEAR(calm(2.0, 1.0), calm(1.0, 0.5), 1e-6 * calm(1.0, 0.5));
}

// What was measured (docs/concepts/environment.md): 6 kg are stable on 16 and not on 32 kN/m, 3 kg
// on 8 and not on 16.
TEST(Stiffness, FitsTheSurfacesThatWereStable) {
  const config::Scenario scenario = walk();
  StiffnessLimits limits = stiffness_limits(scenario.device, scenario.twin);
  EXPECT_GT(limits.by_frequency(), 16e3);
  EXPECT_LT(limits.by_frequency(), 32e3);
  limits.mass = 3.0;
  EXPECT_GT(limits.by_frequency(), 8e3);
  EXPECT_LT(limits.by_frequency(), 16e3);
}

TEST(Stiffness, ReportsTheLimitsAndTheirOrigin) {
  const Findings findings = found(walk());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::kNote);
  for (const char* part : {"6 kg and 4 Ns/m as felt", "T_d = ", "m (2 pi f)^2", "m (a / v)^2",
                           "a = 6.7", "b / (T / 2 + T_d)"}) {
    EXPECT_NE(findings[0].what.find(part), std::string::npos) << part << findings[0].what;
  }
  config::Scenario unlimited = walk();
  unlimited.device.model.cartesian_limits.clear();
  unlimited.device.model.has_torque_limits = false;
  EXPECT_NE(found(unlimited)[0].what.find("neither motors nor"), std::string::npos);
}

TEST(Stiffness, WarnsOfSpringsThatAreTooStiff) {
  config::Scenario door = config::load_scenario("models/scenarios/door.yaml");
  EXPECT_EQ(found(door).size(), 1u);
  door.twin.model.dofs[0].stiffness = 20'000.0;
  door.twin.model.dofs[1].stiffness = 2'000.0;
  const Findings findings = found(door);
  ASSERT_EQ(findings.size(), 3u);
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(findings[i].severity, Severity::kWarning);
    EXPECT_NE(findings[i].what.find("so do 1 other joints"), std::string::npos);
    EXPECT_EQ(findings[i].fix.rfind("lower it to ", 0), 0u);
  }
  EXPECT_NE(findings[1].what.find("this device shows up to"), std::string::npos);
  EXPECT_NE(findings[2].what.find("their swings may grow"), std::string::npos);
}

TEST(Stiffness, WarnsOfProfilesThatAreTooSteep) {
  config::Scenario door = config::load_scenario("models/scenarios/door.yaml");
  door.twin.model.dofs[0].profile = rendering::Profile({{0.0, 0.0}, {0.01, 200.0}});
  const Findings findings = found(door);
  ASSERT_EQ(findings.size(), 3u);
  EXPECT_EQ(findings[1].item, "joints.hinge.profile");
  EXPECT_NE(findings[1].what.find("20004 Nm/rad"), std::string::npos);
}

TEST(Stiffness, WarnsOfSurfacesThatAreTooStiff) {
  EXPECT_TRUE(inspect_surfaces(config::load_scenario("models/scenarios/surfaces.yaml")).empty());
  config::Scenario wall = config::load_scenario("models/stress/wall.yaml");
  wall.surfaces[0].stiffness = 40'000.0;
  const Findings findings = inspect_surfaces(wall);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::kWarning);
  EXPECT_EQ(findings[0].item, "surfaces[0].stiffness_N_per_m");
  EXPECT_GT(findings[0].place.line, 8);
  EXPECT_NE(findings[0].fix.find("lower it to 2"), std::string::npos) << findings[0].fix;
}

TEST(Stiffness, ReportsTheDampingOfSurfacesAndAdvisesAllowedValues) {
  config::Scenario wall = config::load_scenario("models/stress/wall.yaml");
  surfaces::Surface& surface = wall.surfaces[0];
  surface.stiffness = 5e4;
  surface.damping.reset();
  const double latency = std::exchange(wall.device.control.loop.latency, 0.1);
  EXPECT_NE(inspect_surfaces(wall).at(0).what.find("critical, as none is given"),
            std::string::npos);
  wall.device.control.loop.latency = latency;
  surface.damping = 20.0;
  EXPECT_NE(inspect_surfaces(wall).at(0).what.find("with 20 Ns/m, as given"), std::string::npos);
  surface.damping = 0.0;
  for (rendering::TwinDof& dof : wall.twin.model.dofs) dof.damping = 0.0;
  const Findings without = inspect_surfaces(wall);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(without[0].fix,
            "raise its damping and the mass of the twin: a surface has at least 10 N/m");
  surface.damping = 1e4;
  const Findings heavy = inspect_surfaces(wall);
  ASSERT_FALSE(heavy.empty());
  EXPECT_EQ(heavy[0].item, "surfaces[0].damping_Ns_per_m");
  EXPECT_NE(heavy[0].what.find("m / T"), std::string::npos);
}

}  // namespace
}  // namespace hg::check
