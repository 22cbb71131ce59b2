/// The arms of models/arms: each opens its cupboard and its drawer and moves its tool, on a machine
/// in which nothing is ideal.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/open_file.h"
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

// A hand throws a light tool about, and a stop is asked for in the middle of it: it ends with the
// device armed and within its limits, not in a fault.
class StoppedArm : public testing::TestWithParam<const char*> {
 protected:
  static std::string thrown_until(double time) {
    std::string text =
        "frame: base\nhand: {tremor_N: 0.035}\nsegments:\n"
        "  - {start_s: 0, duration_s: 0.001, grip: 0}\n";
    for (int k = 0; 0.3 + 0.23 * k < time; ++k) {
      const auto wave = [k](double size, double rate, double start) {
        return size * std::sin(rate * k + start);
      };
      text += fmt::format(
          "  - {{start_s: {}, duration_s: 0.05, fx_N: {:.3f}, fy_N: {:.3f}, fz_N: {:.3f}, "
          "nx_Nm: {:.3f}, ny_Nm: {:.3f}, nz_Nm: {:.3f}}}\n",
          0.3 + 0.23 * k, wave(10, 2.1, 0.7), wave(10, 1.3, 2 + 10 * time), wave(8, 2.9, 10 * time),
          wave(0.4, 1.7, 0), wave(0.4, 2.3, 10 * time), wave(0.4, 1, 0));
    }
    return text + "duration_s: 5\n";
  }
  static std::string light_tool(const std::string& tool) {
    const std::size_t start = tool.find("start: {");
    return "name: tool\nfree_body: {mass_kg: 1.5, inertia_kg_m2: [0.03, 0.03, 0.03]}\n"
           "end_effector: handle\njoints:\n  root:\n    damping_Ns_per_m: 3\n"
           "    angular_damping_Nms_per_rad: 0.03\n    " +
           tool.substr(start, tool.find('}', start) + 1 - start) + "\n";
  }
  config::Scenario thrown(double time) const {
    const TemporaryFolder folder;
    const std::string arm = std::filesystem::absolute("models/arms").string() + "/" + GetParam();
    folder.write("throw.yaml", thrown_until(time));
    folder.write("tool.yaml", light_tool(read_file(arm + "/tool.yaml")));
    return config::load_scenario(folder.write(
        "thrown.yaml",
        fmt::format("title: Throw\ndescription: A stop amid motion.\ndevice: {}/device.yaml\n"
                    "twin: tool.yaml\nperson: throw.yaml\nduration_s: {}\n",
                    arm, time + 1.5)));
  }
};

TEST_P(StoppedArm, IsAtRestWithoutAFault) {
  for (const double time : {1.0, 1.2, 1.4, 1.6, 1.8, 2.0}) {
    SCOPED_TRACE(time);
    constexpr double kBeforeTheHand = 0.7;  // s
    ScenarioRun run(thrown(time));
    Mode mode = Mode::kOff;
    run.play([&](const Sample& sample) {
      mode = sample.record.mode;
      if (sample.record.time_s > kBeforeTheHand + time) run.request(ModeRequest::kStop);
    });
    EXPECT_EQ(mode, Mode::kArmed);
    EXPECT_EQ(run.summary().fault().code, FaultCode::kNone);
    for (const double excess : run.summary().truth().worst_excess()) EXPECT_LE(excess, 2e-3);
  }
}

// A hand pulls a drawer onto its stop and pushes it back at once, faster than the torque of the
// wrist may build up: the device gives way, or stands, but does not push against the hand.
TEST(PushedDrawer, NeverMovesAgainstTheHand) {
  const TemporaryFolder folder;
  folder.write("to_and_fro.yaml",
               "frame: twin_joints\nhand: {stiffness_N_per_m: [400, 400, 400], damping_Ns_per_m: "
               "[40, 40, 40], force_max_N: 30, angular_stiffness_Nm_per_rad: [0, 0, 0]}\n"
               "segments:\n  - {start_s: 0.5, duration_s: 0.556, slide: 0.73}\n"
               "  - {start_s: 1.486, duration_s: 0.774, slide: -0.3}\nduration_s: 2.6\n");
  const std::string arm = std::filesystem::absolute("models/arms/fr3").string();
  ScenarioRun run(config::load_scenario(
      folder.write("drawer.yaml", "title: Drawer\ndescription: To and fro.\ndevice: " + arm +
                                      "/device.yaml\ntwin: " + arm +
                                      "/drawer.yaml\nperson: to_and_fro.yaml\nduration_s: 2.6\n")));
  constexpr double kPush = 10.0;  // N
  double fastest = 0.0, largest_push = 0.0;
  bool is_at_its_end = false;
  run.play([&](const Sample& sample) {
    const CycleRecord& record = sample.record;
    if (record.twin.q_a.size() == 0) return;
    if (record.twin.q_a[0] > 0.2999) is_at_its_end = true;
    const double push = -sample.truth.w_H[0];
    if (is_at_its_end) largest_push = std::max(largest_push, push);
    if (is_at_its_end && push > kPush) fastest = std::max(fastest, record.twin.dq_a[0]);
  });
  EXPECT_GT(largest_push, 3.0 * kPush);
  EXPECT_LT(fastest, 1e-3);  // m/s
}

// A stroke of 1.5 m along one slide ends at walls of hand and elbow, and every 0.2 s or so the
// other slide meets its own end, 50 mm from its middle: walls and ends brake with the same motors.
TEST(PushedSlides, KeepTheirEndsWhereTheDeviceMeetsItsWalls) {
  const TemporaryFolder folder;
  const std::string device = std::filesystem::absolute("models/haptic_giant/device.yaml").string();
  const std::string body =
      "<inertial><mass value='3'/><inertia ixx='0.05' iyy='0.05' izz='0.05' ixy='0' ixz='0' "
      "iyz='0'/></inertial></link>";
  folder.write("slides.urdf",
               "<robot name='slides'><link name='base'/><link name='rail'>" + body +
                   "<link name='handle'>" + body +
                   "<joint name='long' type='prismatic'><parent link='base'/><child link='rail'/>"
                   "<axis xyz='1 0 0'/><limit lower='-2.5' upper='2.5' effort='0' velocity='1.5'/>"
                   "</joint><joint name='short' type='prismatic'><parent link='rail'/>"
                   "<child link='handle'/><axis xyz='0 1 0'/>"
                   "<limit lower='-0.05' upper='0.05' effort='0' velocity='1.5'/></joint></robot>");
  folder.write("twin.yaml",
               "name: slides\nurdf: slides.urdf\nend_effector: handle\n"
               "placement: {x_m: 0.6, y_m: 0.2, z_m: -0.8, roll_rad: 1.5708}\njoints:\n"
               "  long: {ddq_max_m_per_s2: 5, damping_Ns_per_m: 2}\n"
               "  short: {ddq_max_m_per_s2: 5, damping_Ns_per_m: 2}\n");
  folder.write("throw.yaml",
               "frame: base\nhand:\n  stiffness_N_per_m: [600, 600, 600]\n"
               "  damping_Ns_per_m: [40, 40, 40]\n  grip_stiffness_N_per_m: 3000\n"
               "  grip_damping_Ns_per_m: 40\n  force_max_N: 100\n"
               "segments:\n  - {start_s: 1, duration_s: 1.2, x_m: 2.2, y_m: 0.6}\n"
               "  - {start_s: 3, duration_s: 1.5, x_m: -2.2, y_m: -0.4}\nduration_s: 6\n");
  ScenarioRun run(config::load_scenario(folder.write(
      "slides.yaml", "title: Slides\ndescription: A stroke into walls.\ndevice: " + device +
                         "\ntwin: twin.yaml\nperson: throw.yaml\nduration_s: 6\n")));
  double farthest = 0.0;
  run.play([&](const Sample& sample) {
    if (sample.record.twin.q_a.size() == 0) return;
    farthest = std::max(farthest, std::abs(sample.record.twin.q_a[1]));
  });
  EXPECT_EQ(run.summary().fault().code, FaultCode::kNone);
  EXPECT_LT(farthest, 0.051);  // m
  for (const double excess : run.summary().truth().worst_excess()) EXPECT_LE(excess, 1e-3);
}

// The wrist of a UR is singular at 0, and a hand that has let go leaves the noise of the force
// sensor: it moves no joint by more than what a free tool drifts anywhere.
class SingularStart : public testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  config::Scenario singular() const {
    const auto& [name, start] = GetParam();
    const TemporaryFolder folder;
    const std::filesystem::path arms = std::filesystem::absolute("models/arms");
    std::string device = read_file(arms / name / "device.yaml");
    const auto replace = [&device](const std::string& from, const std::string& to) {
      const std::size_t at = device.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      device.replace(at, from.size(), to);
    };
    replace("\nurdf: ", "\nurdf: " + (arms / name).string() + "/");
    replace("\ntool: ../", "\ntool: " + arms.string() + "/");
    replace("\nsimulation: ", "\nsimulation: " + (arms / name).string() + "/");
    replace("wrist_2_joint: {q_min_rad: 0.3", "wrist_2_joint: {q_min_rad: -1");
    replace("wrist_2_joint: 1.571", "wrist_2_joint: 0");
    folder.write("device.yaml", device);
    folder.write(
        "twin.yaml",
        std::string("name: tool\nfree_body: {mass_kg: 3, inertia_kg_m2: [0.03, 0.03, 0.03]}\n"
                    "end_effector: handle\njoints:\n  root:\n    damping_Ns_per_m: 3\n"
                    "    angular_damping_Nms_per_rad: 0.03\n    start: ") +
            start + "\n");
    folder.write(
        "let_go.yaml",
        "frame: base\nsegments: [{start_s: 0.1, duration_s: 0.3, grip: 0}]\nduration_s: 4\n");
    return config::load_scenario(
        folder.write("start.yaml",
                     "title: Start\ndescription: In a singular posture.\ndevice: device.yaml\n"
                     "twin: twin.yaml\nperson: let_go.yaml\nduration_s: 4\n"));
  }
};

TEST_P(SingularStart, NoiseMovesNoJointFar) {
  ScenarioRun run(singular());
  VectorM least, most;
  run.play([&](const Sample& sample) {
    const VectorM& q = sample.truth.q_m;
    if (least.size() == 0) least = most = q;
    least = least.cwiseMin(q);
    most = most.cwiseMax(q);
  });
  EXPECT_EQ(run.summary().fault().code, FaultCode::kNone);
  EXPECT_LT((most - least).maxCoeff(), 0.15);
}

INSTANTIATE_TEST_SUITE_P(Arms, SingularStart,
                         testing::Values(std::pair("ur5e",
                                                   "{x_m: 0.550381, y_m: -0.182919, z_m: 0.489966, "
                                                   "azimuth_rad: -1.301204, pitch_rad: 1.570796, "
                                                   "roll_rad: -1.300611}"),
                                         std::pair("ur10e",
                                                   "{x_m: 0.705429, y_m: -0.198742, z_m: 0.556893, "
                                                   "azimuth_rad: -1.299204, pitch_rad: 1.570796, "
                                                   "roll_rad: -1.298611}")),
                         [](const auto& arm) { return std::string(arm.param.first); });
INSTANTIATE_TEST_SUITE_P(Arms, ArmWithGaps,
                         testing::Values("fr3", "iiwa14", "ur5e", "ur10e", "xarm7", "gen3"),
                         [](const auto& arm) { return std::string(arm.param); });
INSTANTIATE_TEST_SUITE_P(Arms, StoppedArm,
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
