// What `hapticgiant identify joints` and `identify inertia` find of simulated arms, whose truth is
// known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "hg/experiments/player.h"
#include "hg/identify/drive_delay.h"
#include "hg/identify/inertia.h"
#include "hg/identify/joint_elasticity.h"
#include "hg/identify/joint_recording.h"
#include "hg/scenario/options.h"

namespace hg {
namespace {

using identify::Figure;

// The motion of the joints in a scenario.
std::vector<identify::JointMotion> moved(const config::Scenario& scenario) {
  identify::JointRecording joints(scenario.device.model);
  experiments::Player player(scenario);
  for (bool is_running = true; is_running; is_running = player.end()) {
    player.begin();
    player.run();
    joints.add(player.sample());
  }
  EXPECT_EQ(player.record().fault.code, FaultCode::kNone);
  return joints.parts();
}

void expect_covered(const Figure& found, double truth, double share, const char* what) {
  EXPECT_TRUE(found.is_found) << what;
  EXPECT_LT(std::abs(found.value - truth), std::min(1.5 * found.interval(), share * truth))
      << what << " " << found.value << " +- " << found.interval();
}

TEST(IdentifyJoints, FindsStiffnessAndDampingOfAnArmWhoseFileIsWrong) {
  const config::Scenario scenario = scenario::load({.scenario = "models/arms/fr3/move_tool.yaml"});
  const auto parts = moved(scenario);
  const auto& [factors, device] = std::tie(scenario.device.simulation.factors, scenario.device);
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(device.model.manipulator_joint(i));
    const ActuatorModel& nominal = device.model.actuators[static_cast<std::size_t>(i)];
    const auto found = identify::identify_elasticity(parts, i, device.model.dt(), nominal,
                                                     device.simulation.gear_ratio[i]);
    expect_covered(found.stiffness, factors.stiffness * nominal.stiffness, 0.02, "stiffness");
    expect_covered(found.damping, factors.damping * nominal.damping, 0.08, "damping");
  }
}

TEST(IdentifyJoints, FindsTheDelayOfDrivesThatFollowPositions) {
  const config::Scenario scenario = scenario::load({.scenario = "models/arms/ur5e/move_tool.yaml"});
  const auto parts = moved(scenario);
  std::vector<identify::DriveDelay> delays;
  for (int i = 0; i < 6; ++i) {
    delays.push_back(identify::identify_delay(parts, i, scenario.device.model.dt()));
  }
  // 8 ms of latency and a period of 2 ms, less the step by which the drives look ahead
  expect_covered(identify::common_delay(delays), 9.75e-3, 0.01, "delay");
}

TEST(IdentifyInertia, FindsThatAnArmIsHeavierThanItsFilesSay) {
  const config::Scenario scenario = scenario::load({.scenario = "models/arms/fr3/excite.yaml"});
  const auto found = identify::identify_inertia(moved(scenario), scenario.device);
  EXPECT_EQ(found.missing, "");
  EXPECT_GE(found.shown, 30);
  int large = 0;
  for (const identify::BaseFigure& base : found.base) {
    if (std::abs(base.nominal) < 0.5) continue;
    ++large;
    const double factor = base.found.value / base.nominal;
    EXPECT_GT(factor, scenario.device.simulation.factors.mass - 0.01) << base.name;
    EXPECT_LT(factor, scenario.device.simulation.factors.mass + 0.03) << base.name << " and grip";
  }
  EXPECT_GE(large, 8);
}

}  // namespace
}  // namespace hg
