// Shaking that safety/passivity does not look for, on the whole elastic simulation.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"

namespace hg::haptify {
namespace {

struct Report {
  double at_s = kInfinity;
  Shaking what = Shaking::kNone;
  Fault fault;
};

Report watched(const config::Scenario& scenario) {
  Report report;
  experiments::Player player(scenario);
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    const CycleRecord& record = player.record();
    if (record.warning.code != FaultCode::kOscillation || report.what != Shaking::kNone) continue;
    report.at_s = record.time_s;
    report.what = static_cast<Shaking>(record.warning.index);
  }
  report.fault = player.record().fault;
  return report;
}

// 74 Hz: a rotation too light for this device, twisted for 10 ms.
config::Scenario light_rotation(double inertia) {
  person::Script script;
  script.segments = {
      {.start_s = 1.0, .duration_s = 1e-4, .channel = person::kWrenchChannel + 4, .value = 0.5},
      {.start_s = 1.01, .duration_s = 1e-4, .channel = person::kWrenchChannel + 4, .value = 0.0}};
  script.duration_s = 7.0;
  config::Scenario scenario =
      with_script(config::load_scenario("models/scenarios/walk.yaml"), script);
  experiments::set_free_inertia(scenario, inertia);
  return scenario;
}

// The hand runs from `run_up` in front of a wall; its goal stops `inside` it.
config::Scenario wall(double stiffness, double run_up, double inside) {
  person::Script script;
  script.segments = {{.start_s = 1.0,
                      .duration_s = 0.5,
                      .channel = 1,
                      .blend = person::Blend::kBy,
                      .value = run_up + inside}};
  script.duration_s = 16.0;
  config::Scenario scenario =
      with_script(config::load_scenario("models/scenarios/walk.yaml"), script);
  const Eigen::Vector3d place(0.0, 0.3, -0.775);
  scenario.twin.model.q_start.head<3>() = place - run_up * Eigen::Vector3d::UnitY();
  const Eigen::AngleAxisd upright(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX());
  scenario.surfaces = {surfaces::Surface{.name = "wall",
                                         .shape = surfaces::Plane{},
                                         .pose = {.p = place, .R = upright.toRotationMatrix()},
                                         .stiffness = stiffness}};
  // a device that can brake less than it must, whatever becomes of this one
  for (CartesianLimit& limit : scenario.device.model.cartesian_limits) {
    for (limits::JointLimits& axis : limit.axes) axis.ddq_max = 2.0;
  }
  return scenario;
}

TEST(ShakingRun, OfALightRotationIsReportedAndStopped) {
  EXPECT_EQ(watched(light_rotation(0.08)).what, Shaking::kNone);
  config::Scenario light = light_rotation(0.001);
  const Report report = watched(light);
  EXPECT_TRUE(report.what == Shaking::kFastForce || report.what == Shaking::kFastTorque)
      << to_string(report.what);
  EXPECT_LT(report.at_s, 3.0);
  EXPECT_EQ(report.fault.code, FaultCode::kNone);

  light.device.passivity.reaction = passivity::Reaction::kAct;
  EXPECT_EQ(watched(light).fault.code, FaultCode::kOscillation);
  light.device.passivity.reaction = passivity::Reaction::kOff;
  EXPECT_EQ(watched(light).what, Shaking::kNone);
}

TEST(ShakingRun, OfABodyThatMeetsAWallIsNone) {
  EXPECT_EQ(watched(wall(1000.0, 0.05, 0.0)).what, Shaking::kNone);
  EXPECT_EQ(watched(wall(20'000.0, 0.17, 0.08)).what, Shaking::kNone);
}

}  // namespace
}  // namespace hg::haptify
