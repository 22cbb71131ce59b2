// A hand that presses a twin onto a virtual surface, on the whole elastic simulation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/player.h"
#include "hg/scenario/start_posture.h"
#include "hg/simulator/person/hand.h"

namespace hg::experiments {
namespace {

struct Pressed {
  double stiffness = 0.0;  // true force of the hand over true depth of the handle, N/m
  double force = 0.0;      // largest, N
  double shaking = 0.0;    // rms of the true speed of the handle in the last half second, m/s
  double depth = 0.0;      // largest, of the true handle, m
  FaultCode fault = FaultCode::kNone;
};

// A plane 20 mm below the start, onto which a hand goes down until it presses with `force`, and
// holds for 2 s.
Pressed press(double stiffness, double damping, person::HandPreset preset, double force = 20.0,
              surfaces::Contact contact = surfaces::Contact::kSpring) {
  config::Scenario scenario = config::load_scenario("models/scenarios/free_space.yaml");
  const Eigen::Vector3d start = scenario::handle_start(scenario.twin.model).p;
  surfaces::Surface table = {
      .name = "table", .shape = surfaces::Plane{}, .stiffness = stiffness, .damping = damping};
  table.pose.p.z() = start.z() - 0.02;
  table.contact = contact;
  scenario.surfaces = {table};
  person::HandImpedance& hand = scenario.script.hand;
  hand = person::hand(preset);
  person::Script& script = scenario.script.script;
  const double below = 0.02 + force / stiffness + force / hand.stiffness.z();
  script.segments = {{.start_s = 1.0, .duration_s = 3.0, .channel = 2, .value = start.z() - below}};
  script.duration_s = scenario.duration_s = 6.0;

  Player player(scenario);
  Pressed pressed;
  double sum_fd = 0.0, sum_dd = 0.0, square = 0.0;
  int late = 0;
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    const CycleRecord& record = player.record();
    const Truth& truth = player.truth();
    const double f = -truth.w_H.z(), depth = table.pose.p.z() - truth.T_B_H.p.z();
    if (record.contact.surface >= 0) pressed.force = std::max(pressed.force, f);
    pressed.depth = std::max(pressed.depth, depth);
    if (record.time_s < 5.5) continue;
    sum_fd += f * depth;
    sum_dd += depth * depth;
    square += truth.twist.head<3>().squaredNorm();
    ++late;
  }
  pressed.stiffness = sum_fd / sum_dd;
  pressed.shaking = std::sqrt(square / std::max(1, late));
  pressed.fault = player.record().fault.code;
  return pressed;
}

TEST(SurfaceRun, TableFeelsAsStiffAsItIs) {
  for (const double stiffness : {500.0, 1000.0, 2000.0, 4000.0}) {
    const Pressed pressed = press(stiffness, 40.0, person::HandPreset::kNormal);
    EXPECT_EQ(pressed.fault, FaultCode::kNone) << stiffness;
    EXPECT_NEAR(pressed.stiffness / stiffness, 1.0, 0.03) << stiffness;
    EXPECT_LT(pressed.shaking, 2e-3) << stiffness;
    EXPECT_GT(pressed.force, 15.0) << stiffness;
  }
}

TEST(SurfaceRun, AStopCarriesAHandCalmly) {
  const Pressed pressed =
      press(5e4, 0.0, person::HandPreset::kNormal, 50.0, surfaces::Contact::kStop);
  EXPECT_EQ(pressed.fault, FaultCode::kNone);
  EXPECT_GT(pressed.force, 40.0);
  EXPECT_LT(pressed.shaking, 2e-3);
  EXPECT_LT(pressed.depth, 1.5e-3);  // what the joints give under 50 N; the twin is not inside
}

}  // namespace
}  // namespace hg::experiments
