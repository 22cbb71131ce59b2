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

// A hand moves the tool, and again and again the drives get no commands for some milliseconds:
// their joints stay within their ratings, as without that, or a fault that says so stops them.
class ArmWithGaps : public testing::TestWithParam<const char*> {
 protected:
  struct Played {
    double acceleration = 0.0;  ///< largest of any joint in motion, as a share of its rating
    FaultCode fault = FaultCode::kNone;
  };
  Played played(int gap_ms) const {
    const TemporaryFolder folder;
    const std::string arm = std::filesystem::absolute("models/arms").string() + "/" + GetParam();
    folder.write("move.yaml",
                 "frame: base\nhand: {preset: normal, force_max_N: 60}\nsegments:\n"
                 "  - {start_s: 1, duration_s: 0.6, by: {x_m: 0.1, y_m: 0.2}}\n"
                 "  - {start_s: 1.6, duration_s: 0.6, by: {y_m: -0.3, z_m: 0.1}}\n"
                 "  - {start_s: 2.2, duration_s: 0.6, by: {x_m: -0.1, y_m: 0.2}}\nduration_s: 3\n");
    std::string text = "title: Gaps\ndescription: Lost commands.\ndevice: " + arm +
                       "/device.yaml\ntwin: " + arm +
                       "/tool.yaml\nperson: move.yaml\nduration_s: 3\nfaults:\n";
    for (int k = 0; k < 5 && gap_ms > 0; ++k) {
      text += "  - {fault: commands_lost, at_s: " + std::to_string(1.9 + 0.23 * k) +
              ", for_s: " + std::to_string(1e-3 * gap_ms) + "}\n";
    }
    if (gap_ms == 0) text += "  []\n";
    ScenarioRun run(config::load_scenario(folder.write("gaps.yaml", text)));
    const DeviceModel& device = run.scenario().device.model;
    Played result;
    VectorM before;
    run.play([&](const Sample& sample) {
      const VectorM& dq = sample.truth.dq_m;
      for (Eigen::Index i = 0; i < before.size() && sample.record.time_s > 1.8; ++i) {
        const double ddq = std::abs(dq[i] - before[i]) / device.dt();
        result.acceleration = std::max(result.acceleration, ddq / device.joint_limits[i].ddq_max);
      }
      before = dq;
    });
    result.fault = run.summary().fault().code;
    return result;
  }
};

TEST_P(ArmWithGaps, MovesWithinItsRatingsOrStops) {
  const Played whole = played(0);
  EXPECT_EQ(whole.fault, FaultCode::kNone);
  for (const int gap_ms : {2, 5, 8}) {
    const Played gaps = played(gap_ms);
    EXPECT_EQ(gaps.fault, FaultCode::kNone) << gap_ms;
    EXPECT_LT(gaps.acceleration, std::max(1.0, 1.5 * whole.acceleration)) << gap_ms;
  }
  for (const int gap_ms : {20, 60}) {
    const Played gaps = played(gap_ms);
    EXPECT_EQ(gaps.fault, FaultCode::kCommandsLost) << gap_ms;
  }
}

INSTANTIATE_TEST_SUITE_P(Arms, ArmWithGaps,
                         testing::Values("fr3", "iiwa14", "ur5e", "ur10e", "xarm7", "gen3"),
                         [](const auto& arm) { return std::string(arm.param); });
INSTANTIATE_TEST_SUITE_P(Arms, PushedArm,
                         testing::Values("fr3", "iiwa14", "ur5e", "ur10e", "xarm7", "gen3"),
                         [](const auto& arm) { return std::string(arm.param); });
INSTANTIATE_TEST_SUITE_P(Arms, ShippedArm,
                         testing::Values("fr3", "ur5e", "ur10e", "xarm7", "gen3", "iiwa14"),
                         [](const auto& arm) { return std::string(arm.param); });

}  // namespace
}  // namespace hg
