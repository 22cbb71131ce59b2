/// The arms of models/arms: each opens its cupboard and its drawer and moves its tool, on a machine
/// in which nothing is ideal.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/scenario/names.h"
#include "tests/scenarios/trace.h"

namespace hg {
namespace {

class ShippedArm : public testing::TestWithParam<const char*> {};

void expect_whole(const std::string& file) {
  SCOPED_TRACE(file);
  const config::Scenario scenario = config::load_scenario(std::filesystem::path(file));
  EXPECT_EQ(scenario::idealisation(scenario.device), "");
  const Trace trace(scenario);
  const ScenarioRun& run = trace.run();
  EXPECT_EQ(run.missing(), std::vector<std::string>{});
  EXPECT_TRUE(run.summary().limits_held());         // in truth, too
  EXPECT_LT(run.summary().max_sync_error(), 2e-3);  // m, where a late arm meets a stop
  EXPECT_EQ(run.summary().fault().code, FaultCode::kNone);
  EXPECT_EQ(run.quality().unsolved, 0);
}

TEST_P(ShippedArm, OpensShutsAndMoves) {
  for (const char* name : {"open_cupboard", "open_drawer", "move_tool"}) {
    expect_whole(std::string("models/arms/") + GetParam() + "/" + name + ".yaml");
  }
}

TEST(ShippedCam, IsTurnedByTheReferenceDeviceAndByArms) {
  for (const char* file : {"models/scenarios/cam_press.yaml", "models/arms/fr3/turn_cam.yaml",
                           "models/arms/ur5e/turn_cam.yaml", "models/arms/iiwa14/turn_cam.yaml"}) {
    expect_whole(file);
  }
}

// A free tool that a hand of 60 N pushes to a place far outside of the room of the hand, which some
// of the arms cannot hold: no limit is passed by more than the tolerance.
class PushedArm : public testing::TestWithParam<const char*> {
 protected:
  config::Scenario pushed_to(const char* target) const {
    const TemporaryFolder folder;
    const std::string arm = std::filesystem::absolute("models/arms").string() + "/" + GetParam();
    folder.write("push.yaml", std::string("frame: base\n"
                                          "hand: {preset: normal, force_max_N: 60}\n"
                                          "segments:\n"
                                          "  - {start_s: 1, duration_s: 0.4, by: {") +
                                  target + "}}\nduration_s: 3\n");
    const std::string text = "title: Push\ndescription: A hand of 60 N.\ndevice: " + arm +
                             "/device.yaml\ntwin: " + arm +
                             "/tool.yaml\nperson: push.yaml\nduration_s: 3\n";
    return config::load_scenario(folder.write("pushed.yaml", text));
  }
};

TEST_P(PushedArm, StopsAtItsWalls) {
  for (const char* target : {"x_m: 2", "y_m: 2", "z_m: 2", "z_m: -2", "x_m: 2, z_m: -1"}) {
    SCOPED_TRACE(target);
    ScenarioRun run(pushed_to(target));
    run.play();
    for (const double excess : run.summary().truth().worst_excess()) EXPECT_LE(excess, 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, PushedArm,
                         testing::Values("fr3", "iiwa14", "ur5e", "ur10e", "xarm7", "gen3"),
                         [](const auto& arm) { return std::string(arm.param); });
INSTANTIATE_TEST_SUITE_P(Arms, ShippedArm,
                         testing::Values("fr3", "ur5e", "ur10e", "xarm7", "gen3", "iiwa14"),
                         [](const auto& arm) { return std::string(arm.param); });

}  // namespace
}  // namespace hg
