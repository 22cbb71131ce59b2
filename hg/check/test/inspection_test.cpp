#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>

#include "hg/check/cartesian_rule.h"
#include "hg/check/device_inspection.h"
#include "hg/check/ignored_urdf.h"
#include "hg/check/scenario_inspection.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/twin_inspection.h"
#include "hg/config/file_kind.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "hg/workspace/survey.h"

namespace hg::check {
namespace {

constexpr workspace::SurveyOptions kFew = {.seed = 1, .postures = 1'000, .positions = 2'000};
constexpr double kDt = 1e-3;

// Without the name of the simulation file, which is not beside the text; lines stay where they are.
std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string name = "simulation: simulation.yaml";
  if (const std::size_t at = text.find(name); at != std::string::npos) {
    text.replace(at, name.size(), "# without a simulation file");
  }
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is no longer in the shipped file";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The shipped device or twin with one piece of its YAML file or URDF replaced.
struct Changed {
  std::string yaml_from, yaml_to, urdf_from, urdf_to;
};

config::SourceReader reader_of(const std::string& yaml, const std::string& urdf_file,
                               const Changed& change) {
  return config::SourceReader(
      {{"f.yaml", replaced(text_of(yaml), change.yaml_from, change.yaml_to)},
       {urdf_file.substr(urdf_file.find_last_of('/') + 1),
        replaced(text_of(urdf_file), change.urdf_from, change.urdf_to)}});
}

Findings device_findings(const Changed& change) {
  config::SourceReader reader =
      reader_of("models/haptic_giant/device.yaml", "models/haptic_giant/haptic_giant.urdf", change);
  const config::DeviceConfig device = config::load_device("f.yaml", reader);
  return inspect(device, workspace::survey(device, kFew));
}

config::Twin door(const Changed& change) {
  config::SourceReader reader =
      reader_of("models/twins/door/twin.yaml", "models/twins/door/door.urdf", change);
  return config::load_twin("f.yaml", reader);
}

const Finding* find(const Findings& findings, const std::string& item, const std::string& what) {
  const auto found = std::ranges::find_if(findings, [&](const Finding& finding) {
    return finding.item == item && finding.what.find(what) != std::string::npos;
  });
  return found == findings.end() ? nullptr : &*found;
}

std::string all_of(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text +=
        std::string(to_string(finding.severity)) + " " + finding.item + ": " + finding.what + "\n";
  }
  return text;
}

struct Case {
  const char* name;
  Changed change;
  Severity severity;
  const char* item;
  const char* what;   ///< part of it
  const char* place;  ///< what stands there in the changed file, first line that has it
};

void PrintTo(const Case& tried, std::ostream* out) { *out << tried.name; }

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

// The example arm with other lines for its joints, and a wrist beside the line of its forearm.
Findings findings_of_arm(const std::string& joints) {
  config::SourceReader reader =
      reader_of("models/examples/arm.yaml", "models/examples/arm.urdf",
                {"  shoulder: {ddq_max_rad_per_s2: 20}\n  elbow: {ddq_max_rad_per_s2: 20}\n"
                 "  wrist_roll: {ddq_max_rad_per_s2: 20}\n  wrist_bend: {ddq_max_rad_per_s2: 20}\n",
                 joints, "<origin xyz=\"0 0 0.45\"/>", "<origin xyz=\"0.1 0 0.45\"/>"});
  const config::DeviceConfig device = config::load_device("f.yaml", reader);
  return inspect(device, workspace::survey(device, kFew));
}

// An elbow is singular where shoulder, elbow and wrist are in line: here at no quarter of a turn.
TEST(Singularity, IsNamedAfterTheJointThatMakesIt) {
  // within the range of the elbow, or just before the limit at its lower or upper end
  for (const char* limits : {"q_min_rad: -0.6, q_max_rad: 0.6", "q_min_rad: -0.22, q_max_rad: 0.6",
                             "q_min_rad: -0.6, q_max_rad: -0.218"}) {
    const Findings findings =
        findings_of_arm(fmt::format("  shoulder: {{q_min_rad: 0.5, ddq_max_rad_per_s2: 20}}\n"
                                    "  elbow: {{{}, ddq_max_rad_per_s2: 20}}\n"
                                    "  wrist_roll: {{ddq_max_rad_per_s2: 20}}\n"
                                    "  wrist_bend: {{q_min_rad: 0.3, ddq_max_rad_per_s2: 20}}\n",
                                    limits));
    EXPECT_NE(find(findings, "joints.elbow", "singular wherever elbow is at -0.22"), nullptr)
        << limits << "\n"
        << all_of(findings);
  }
}

TEST(Singularity, ThatTakesSeveralJointsIsNamedAfterNone) {
  const Findings findings = findings_of_arm(
      "  shoulder: {ddq_max_rad_per_s2: 20}\n"
      "  elbow: {q_min_rad: 0.3, q_max_rad: 2.2, ddq_max_rad_per_s2: 20}\n"
      "  wrist_roll: {ddq_max_rad_per_s2: 20}\n"
      "  wrist_bend: {q_min_rad: 0.3, ddq_max_rad_per_s2: 20}\n");
  const Finding* finding = find(findings, "manipulator", "a singular posture");
  ASSERT_NE(finding, nullptr) << all_of(findings);
  EXPECT_NE(finding->fix.find("the handle cannot move along"), std::string::npos) << finding->fix;
  EXPECT_NE(finding->fix.find("turn, "), std::string::npos) << finding->fix;
}

TEST(LastLink, OfMoreThanAPersonMovesIsDoubted) {
  const auto findings_with = [](const char* mass) {
    config::SourceReader reader = reader_of(
        "models/examples/arm.yaml", "models/examples/arm.urdf",
        {"", "",
         "<mass value=\"0.4\"/>\n      <inertia ixx=\"0.0005\" iyy=\"0.0005\" izz=\"0.0005\"",
         std::string("<mass value=\"") + mass +
             "\"/>\n      <inertia ixx=\"0.75\" iyy=\"0.75\" izz=\"0.75\""});
    const config::DeviceConfig device = config::load_device("f.yaml", reader);
    return inspect(device, workspace::survey(device, kFew));
  };
  const Findings heavy = findings_with("600");
  const Finding* finding = find(heavy, "link flange", "600 kg beyond the last joint");
  ASSERT_NE(finding, nullptr) << all_of(heavy);
  EXPECT_NE(finding->what.find("suspected grams: 0.6 kg"), std::string::npos) << finding->what;
  EXPECT_EQ(find(findings_with("40"), "link flange", "beyond the last joint"), nullptr);
}

class BadDevice : public testing::TestWithParam<Case> {};
class BadTwin : public testing::TestWithParam<Case> {};

void check_case(const Case& expected, const Findings& findings, const std::string& yaml,
                const std::string& urdf) {
  const Finding* finding = find(findings, expected.item, expected.what);
  ASSERT_NE(finding, nullptr) << all_of(findings);
  EXPECT_EQ(finding->severity, expected.severity);
  EXPECT_FALSE(finding->fix.empty());
  const bool is_urdf = finding->file.ends_with(".urdf");
  const std::string text =
      is_urdf ? replaced(text_of(urdf), expected.change.urdf_from, expected.change.urdf_to)
              : replaced(text_of(yaml), expected.change.yaml_from, expected.change.yaml_to);
  const std::size_t at = text.find(expected.place);
  ASSERT_NE(at, std::string::npos);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
  EXPECT_EQ(finding->place.line, 1 + std::count(text.begin(), end, '\n'));
}

TEST_P(BadDevice, IsFoundAtItsLineAndTheShippedOneIsNot) {
  const Case& expected = GetParam();
  check_case(expected, device_findings(expected.change), "models/haptic_giant/device.yaml",
             "models/haptic_giant/haptic_giant.urdf");
  static const Findings kShipped = device_findings({});
  EXPECT_EQ(find(kShipped, expected.item, expected.what), nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Inspection, BadDevice,
    testing::Values(
        Case{"DampingBeyondTheRate",
             {"kD_rot_1_per_s: 40", "kD_rot_1_per_s: 2500", "", ""},
             Severity::kFault,
             "synchronisation.kD_rot_1_per_s",
             "2.5",
             "kD_rot_1_per_s"},
        Case{"PolesOutside",
             {"kP_tran_1_per_s2: 400", "kP_tran_1_per_s2: 90000", "", ""},
             Severity::kFault,
             "synchronisation.kP_tran_1_per_s2",
             "slowest pole",
             "kP_tran"},
        Case{"Swinging",
             {"kD_tran_1_per_s: 40", "kD_tran_1_per_s: 10", "", ""},
             Severity::kWarning,
             "synchronisation.kD_tran_1_per_s",
             "damping ratio",
             "kD_tran"},
        Case{"GantryTooFast",
             {"k_ppu_1_per_s: 4", "k_ppu_1_per_s: 8", "", ""},
             Severity::kWarning,
             "prepositioning.k_ppu_1_per_s",
             "overshoots",
             "k_ppu_1_per_s"},
        Case{"FloorAboveTheHandle",
             {"floor_z_m: -2.15", "floor_z_m: 0.9", "", ""},
             Severity::kFault,
             "floor_z_m",
             "above every place",
             "floor_z_m"},
        Case{"FloorAroundTheArm",
             {"floor_z_m: -2.15", "floor_z_m: -0.4", "", ""},
             Severity::kWarning,
             "floor_z_m",
             "in every posture in the floor",
             "floor_z_m"},
        Case{"GantryOscillates",
             {"k_ppu_1_per_s: 4", "k_ppu_1_per_s: 30", "", ""},
             Severity::kFault,
             "prepositioning.k_ppu_1_per_s",
             "oscillates",
             "k_ppu_1_per_s"},
        Case{"ElbowHeightOutside",
             {"    y: {q_min_m: -1.95, q_max_m: 1.95}  # [P]",
              "    z: {q_min_m: -0.5, q_max_m: 0}\n    y: {q_min_m: -1.95, q_max_m: 1.95}  # [P]",
              "", ""},
             Severity::kFault,
             "cartesian_limits[1].z",
             "always is",
             "    z: {q_min_m: -0.5"},
        Case{"ElbowHeightInside",
             {"    y: {q_min_m: -1.95, q_max_m: 1.95}  # [P]",
              "    z: {q_min_m: -0.9, q_max_m: 0}\n    y: {q_min_m: -1.95, q_max_m: 1.95}  # [P]",
              "", ""},
             Severity::kNote,
             "cartesian_limits[1].z",
             "never acts",
             "    z: {q_min_m: -0.9"},
        Case{"BoxOutOfReach",
             {"z: {q_min_m: -1.25, q_max_m: -0.30}", "z: {q_min_m: 0.3, q_max_m: 1}", "", ""},
             Severity::kFault,
             "cartesian_limits[0].z",
             "no posture brings",
             "    z: {q_min_m: 0.3"},
        Case{"BoxesThatLeaveNoRoomBesideAWarning",
             {"x: {q_min_m: -1.65, q_max_m: 1.65}  # [A]", "x: {q_min_m: 2.4, q_max_m: 3}  # [A]",
              "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\" effort=\"110\"",
              "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\""},
             Severity::kFault,
             "cartesian_limits",
             "satisfies all limits",
             "cartesian_limits:"},
        Case{"SumsThatLeaveNoRoom",
             {"virtual_joints:\n",
              "virtual_joints:\n  - {name: other, weights: {m4: 1, m5: 1}, q_min_rad: 2.9, "
              "q_max_rad: 4, dq_max_rad_per_s: 2, ddq_max_rad_per_s2: 9}\n",
              "", ""},
             Severity::kFault,
             "virtual_joints",
             "no posture within the joint limits",
             "virtual_joints:"},
        Case{"JointWithoutRange",
             {"m3: {", "m3: {q_min_rad: 1, q_max_rad: 1, ", "", ""},
             Severity::kFault,
             "joints.m3.q_max_rad",
             "no range",
             "m3: {q_min_rad"},
        Case{"SumOutOfReach",
             {"q_min_rad: 0.26  # [V] 1.3: 15 degrees from the singularity, cond(J) = 9.7\n"
              "    q_max_rad: 2.88",
              "q_min_rad: 5\n    q_max_rad: 6", "", ""},
             Severity::kFault,
             "virtual_joints[0]",
             "only reach",
             "  - name: q4+q5"},
        Case{"SumThatNeverActs",
             {"q_min_rad: 0.26  # [V] 1.3: 15 degrees from the singularity, cond(J) = 9.7\n"
              "    q_max_rad: 2.88",
              "q_min_rad: -2\n    q_max_rad: 5", "", ""},
             Severity::kNote,
             "virtual_joints[0]",
             "never acts",
             "  - name: q4+q5"},
        Case{"SumThatCannotBrake",
             {"ddq_max_rad_per_s2: 40  # [A] below", "ddq_max_rad_per_s2: 70  # [A] below", "", ""},
             Severity::kWarning,
             "virtual_joints[0].ddq_max_rad_per_s2",
             "cannot brake",
             "ddq_max_rad_per_s2: 70"},
        Case{"SingularPosture",
             {"q_min_rad: 0.26", "q_min_rad: -0.3", "", ""},
             Severity::kWarning,
             "joints.m5",
             "singular wherever m4 + m5 is 0.00",
             "  m5:"},
        Case{"DistanceThatAnOrdinaryStopExceeds",
             {"stop_distance_rad: 0.8", "stop_distance_rad: 0.5", "", ""},
             Severity::kFault,
             "monitor.stop_distance_rad",
             "its brakes would close in ordinary stops",
             "  stop_distance_rad: 0.5"},
        Case{"DistanceThatBoundsNothing",
             {"stop_distance_rad: 0.8", "stop_distance_rad: 1000", "", ""},
             Severity::kWarning,
             "monitor.stop_distance_rad",
             "so far one may run before its brakes close",
             "  stop_distance_rad: 1000"},
        Case{"TimeThatAnOrdinaryStopExceeds",
             {"  stop_distance_rad: 0.8", "  stop_time_s: 0.1\n  stop_distance_rad: 0.8", "", ""},
             Severity::kWarning,
             "monitor.stop_time_s",
             "to stop from full speed",
             "  stop_time_s: 0.1"},
        Case{"NoRating",
             {"", "", "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\" effort=\"110\"",
              "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\""},
             Severity::kWarning,
             "joint m4",
             "no torque rating",
             "<joint name=\"m4\""},
        Case{"RatingBelowGravity",
             {"", "", "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\" effort=\"110\"",
              "lower=\"0.20\" upper=\"2.45\" velocity=\"2.6\" effort=\"11\""},
             Severity::kFault,
             "joint m4",
             "to hold the device",
             "<joint name=\"m4\""}),
    name_of);

// The lever that drives a wheel by -5, which may turn at 8 rad/s.
Findings flywheel_findings(const std::string& dq_max_rad_per_s) {
  const std::string axis = "<origin xyz=\"0 0 -0.2\"/><axis xyz=\"0 0 1\"/>";
  config::SourceReader reader(
      {{"f.yaml",
        "name: f\nurdf: f.urdf\ntip_link: handle\nend_effector: handle\njoints:\n  lever_joint: "
        "{ddq_max_rad_per_s2: 6, dq_max_rad_per_s: " +
            dq_max_rad_per_s + "}\n"},
       {"f.urdf", replaced(text_of("models/examples/flywheel.urdf"), axis,
                           axis + "<limit velocity=\"8\" effort=\"9\"/>")}});
  return inspect(config::load_twin("f.yaml", reader), kDt);
}

TEST(Inspection, APostureInWhichPartsTouchIsNamed) {
  config::DeviceConfig device = config::load_device("models/arms/xarm7/device.yaml");
  const auto touching = [&] {
    const Findings findings = inspect(device, workspace::survey(device, kFew));
    return find(findings, "posture", "inside each other") != nullptr;
  };
  EXPECT_FALSE(touching());
  device.model.posture[1] = 1.8;  // the arm bends into its table
  EXPECT_TRUE(touching());
}

TEST(Inspection, ALeaderThatIsTooFastForAJointThatFollowsIsFoundAtItsSpeed) {
  const std::string item = "joints.lever_joint.dq_max_rad_per_s";
  EXPECT_EQ(find(flywheel_findings("1.6"), item, "wheel_joint"), nullptr);
  const Findings findings = flywheel_findings("1.7");
  const Finding* finding = find(findings, item, "8.5, more than its 8");
  ASSERT_NE(finding, nullptr) << all_of(findings);
  EXPECT_EQ(finding->fix, "lower it to 1.6");
  EXPECT_EQ(finding->place.line, 6);
}

TEST_P(BadTwin, IsFoundAtItsLineAndTheShippedOneIsNot) {
  const Case& expected = GetParam();
  check_case(expected, inspect(door(expected.change), kDt), "models/twins/door/twin.yaml",
             "models/twins/door/door.urdf");
  static const Findings kShipped = inspect(door({}), kDt);
  EXPECT_EQ(find(kShipped, expected.item, expected.what), nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Inspection, BadTwin,
    testing::Values(
        Case{"DampingBeyondTheRate",
             {"damping_Nms_per_rad: 2.0", "damping_Nms_per_rad: 9000", "", ""},
             Severity::kWarning,
             "joints.hinge.damping_Nms_per_rad",
             "cannot show so much",
             "    damping_Nms_per_rad: 9000"},
        Case{"SpringFeedsEnergy",
             {"damping_Nms_per_rad: 0.05  # [A] 10.3\n", "damping_Nms_per_rad: 0\n", "", ""},
             Severity::kWarning,
             "joints.lever.damping_Nms_per_rad",
             "gains energy",
             "    damping_Nms_per_rad: 0\n"},
        Case{"ProfileTooSteep",
             {"stiffness_Nm_per_rad: 1.2",
              "profile: {points: [{at_rad: 0}, {at_rad: 0.001, torque_Nm: 20}]}", "", ""},
             Severity::kWarning,
             "joints.lever.profile",
             "too steep for the rate",
             "    profile: {"},
        Case{"SpringTooStiff",
             {"stiffness_Nm_per_rad: 1.2", "stiffness_Nm_per_rad: 30000", "", ""},
             Severity::kWarning,
             "joints.lever.stiffness_Nm_per_rad",
             "too stiff for the rate",
             "    stiffness_Nm_per_rad: 30000"},
        Case{"SpringFarTooStiff",
             {"stiffness_Nm_per_rad: 1.2", "stiffness_Nm_per_rad: 300000", "", ""},
             Severity::kFault,
             "joints.lever.stiffness_Nm_per_rad",
             "too stiff for the rate",
             "    stiffness_Nm_per_rad: 300000"},
        Case{"SpeedThatTheRangeCannotBrake",
             {"dq_max_rad_per_s: 3", "dq_max_rad_per_s: 9", "", ""},
             Severity::kWarning,
             "joints.lever.dq_max_rad_per_s",
             "more than the whole range",
             "    dq_max_rad_per_s: 9"},
        Case{"NoAccelerationRating",
             {"    ddq_max_rad_per_s2: 20\n", "", "", ""},
             Severity::kWarning,
             "joints.lever.ddq_max_rad_per_s2",
             "not given",
             "  lever:\n"},
        Case{"LightLever",
             {"", "", "iyy=\"0.02\" izz=\"0.0125\"", "iyy=\"0.002\" izz=\"0.0125\""},
             Severity::kWarning,
             "end_effector",
             "kg m^2",
             "end_effector"},
        Case{"CondemnedMassMatrix",
             {"", "",
              "<mass value=\"0.6\"/>\n      <inertia ixx=\"0.0125\" iyy=\"0.02\" izz=\"0.0125\"",
              "<mass value=\"1e-9\"/>\n      <inertia ixx=\"1e-11\" iyy=\"1e-11\" izz=\"1e-11\""},
             Severity::kFault,
             "urdf",
             "condition number",
             "urdf: "},
        Case{"PoorMassMatrix",
             {"", "",
              "<mass value=\"0.6\"/>\n      <inertia ixx=\"0.0125\" iyy=\"0.02\" izz=\"0.0125\"",
              "<mass value=\"1e-5\"/>\n      <inertia ixx=\"1e-6\" iyy=\"1e-6\" izz=\"1e-6\""},
             Severity::kWarning,
             "urdf",
             "condition number",
             "urdf: "},
        Case{"CentreOfMassInMillimetres",
             {"", "", "<origin xyz=\"0.47 0 -0.05\"/>", "<origin xyz=\"470 0 -50\"/>"},
             Severity::kWarning,
             "link leaf",
             "centre of mass",
             "<link name=\"leaf\""},
        Case{"InertiaInAnotherUnit",
             {"", "", "ixx=\"2.335\" iyy=\"2.806\" izz=\"0.49744\"",
              "ixx=\"2335\" iyy=\"2806\" izz=\"497.44\""},
             Severity::kWarning,
             "link leaf",
             "body of about",
             "<link name=\"leaf\""}),
    name_of);

config::SimulatedDeviceConfig shipped_device() {
  return config::load_simulated_device("models/haptic_giant/device.yaml");
}

TEST(Pair, TwinOutOfReachIsAFaultAtItsPlacement) {
  const Findings findings =
      inspect(shipped_device(), door({"x_m: -0.30, y_m: -0.20", "x_m: 5, y_m: -0.20", "", ""}));
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings.front().severity, Severity::kFault);
  EXPECT_EQ(findings.front().item, "placement");
  EXPECT_EQ(findings.front().place.line, 8);
}

TEST(Pair, StartInTheFloorIsAFault) {
  config::SourceReader reader =
      reader_of("models/haptic_giant/device.yaml", "models/haptic_giant/haptic_giant.urdf",
                {"floor_z_m: -2.15", "floor_z_m: 0.9", "", ""});
  const config::SimulatedDeviceConfig device = config::load_simulated_device("f.yaml", reader);
  const Findings findings = inspect(device, door({}));
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings.front().severity, Severity::kFault);
  EXPECT_NE(findings.front().what.find("would be in the floor"), std::string::npos);
}

TEST(Pair, AccelerationThatTheHandCannotBrakeIsNamedWithTheOneItCan) {
  const config::SimulatedDeviceConfig device = shipped_device();
  const Findings bad =
      inspect(device, door({"ddq_max_rad_per_s2: 3 ", "ddq_max_rad_per_s2: 25 ", "", ""}));
  const Finding* finding = find(bad, "joints.hinge.ddq_max_rad_per_s2", "Cartesian limits");
  ASSERT_NE(finding, nullptr) << all_of(bad);
  // 3 m/s^2 at 0.75 m and what m1 and m2 can do
  EXPECT_EQ(finding->fix.substr(0, 14), "lower it to 3.");
  EXPECT_EQ(find(inspect(device, door({})), "joints.hinge.ddq_max_rad_per_s2", "Cartesian limits"),
            nullptr);
}

TEST(Pair, SpeedThatTheHandCannotFollowIsFound) {
  const Findings findings = inspect(
      shipped_device(), door({"    ddq_max_rad_per_s2: 3 ",
                              "    dq_max_rad_per_s: 4\n    ddq_max_rad_per_s2: 3 ", "", ""}));
  EXPECT_NE(find(findings, "joints.hinge.dq_max_rad_per_s", "speed"), nullptr) << all_of(findings);
}

TEST(Pair, LeverThatTheWristCannotStopIsFound) {
  const config::SimulatedDeviceConfig device = shipped_device();
  const Findings findings =
      inspect(device, door({"ddq_max_rad_per_s2: 20", "ddq_max_rad_per_s2: 44", "", ""}));
  EXPECT_NE(find(findings, "joints.lever.ddq_max_rad_per_s2", "joint m"), nullptr)
      << all_of(findings);
}

TEST(Pair, PosturesOutOfReachAreCountedAndOneIsExplained) {
  const config::SimulatedDeviceConfig device = shipped_device();
  const config::Twin excavator = config::load_twin("models/twins/excavator/twin.yaml");
  const Findings findings = inspect(device, excavator);
  const Finding* finding = find(findings, "placement", "% of the twin's postures");
  ASSERT_NE(finding, nullptr) << all_of(findings);
  EXPECT_EQ(finding->severity, Severity::kNote);
  EXPECT_NE(finding->what.find("out of reach"), std::string::npos) << finding->what;
  EXPECT_NE(finding->what.find("boom"), std::string::npos) << finding->what;
}

TEST(Spheres, ThatMeetNoSurfaceAreNoted) {
  config::Scenario scenario = config::load_scenario("models/scenarios/door.yaml");
  EXPECT_TRUE(inspect_spheres(scenario).empty());
  scenario.twin.model.spheres = {{.frame = 0}};
  scenario.surfaces = {{.name = "table"}};
  const Findings findings = inspect_spheres(scenario);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::kNote);
  EXPECT_EQ(findings[0].file, "models/scenarios/door.yaml");
  EXPECT_EQ(findings[0].place.line, 6);  // twin: ...
  EXPECT_NE(findings[0].what.find("collision_spheres meet nothing"), std::string::npos);
  scenario.surfaces.push_back({.name = "chair", .contact = surfaces::Contact::kStop});
  const rendering::TwinModel& twin = scenario.twin.model;
  scenario.twin.model.spheres = {{.frame = twin.end_effector}};
  EXPECT_TRUE(inspect_spheres(scenario).empty());
  scenario.twin.model.spheres.push_back({.frame = twin.chain.frame("base")});
  const Findings fixed = inspect_spheres(scenario);
  ASSERT_EQ(fixed.size(), 1u);
  EXPECT_EQ(fixed[0].severity, Severity::kWarning);
  EXPECT_EQ(fixed[0].what, "its collision_spheres[1] is on 'base', which no joint moves");
}

TEST(Pair, TwinThatIsTooMuchWorkForTheRateIsFound) {
  const auto finding_of = [](int dofs, rendering::Law law, double rate_Hz) {
    std::string urdf = "<robot name='snake'><link name='l0'/>";
    for (int i = 1; i <= dofs; ++i) {
      const std::string n = std::to_string(i);
      urdf += "<joint name='j" + n + "' type='continuous'><parent link='l" + std::to_string(i - 1) +
              "'/><child link='l" + n + "'/><axis xyz='0 0 1'/></joint><link name='l" + n +
              "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
              "iyz='0'/></inertial></link>";
    }
    config::SourceReader reader({{"snake.urdf", urdf + "</robot>"},
                                 {"f.yaml", "name: snake\nurdf: snake.urdf\nend_effector: l" +
                                                std::to_string(dofs) + "\n"}});
    config::SimulatedDeviceConfig device = shipped_device();
    device.rendering.law = law;
    device.model.rate_Hz = rate_Hz;
    const Findings findings = inspect(device, config::load_twin("f.yaml", reader));
    const Finding* finding = find(findings, "urdf", "degrees of freedom");
    return finding == nullptr ? "" : finding->what;
  };
  using rendering::Law;
  EXPECT_EQ(finding_of(30, Law::kGauss, 1000.0), "");
  EXPECT_EQ(finding_of(20, Law::kGauss, 8000.0), "");
  EXPECT_EQ(
      finding_of(21, Law::kGauss, 8000.0),
      "the twin has 21 degrees of freedom, expected at most 20 with the law gauss at 8000 Hz: "
      "the cycle may take longer than its period");
  EXPECT_EQ(finding_of(20, Law::kPaper, 1000.0), "");
  EXPECT_NE(finding_of(21, Law::kPaper, 1000.0), "");
  EXPECT_EQ(finding_of(25, Law::kPaper, 500.0), "");
}

TEST(TwinFigures, DrawTheHalfLimitedJointWithinItsLimit) {
  config::Twin twin = door({});
  twin.model.dofs[0].limits = {.q_min = 4.0, .q_max = kInfinity};
  const int index = twin.model.dofs[0].q_index;
  twin.model.q_start[index] = 4.0;
  for (const ConfigurationA& q : twin_postures(twin, 100, 1)) EXPECT_GE(q[index], 4.0);
  config::SimulatedDeviceConfig device = shipped_device();
  device.model.joint_limits[5] = {.q_min = 4.0, .q_max = kInfinity};
  const workspace::JointRanges ranges = workspace::joint_ranges(device);
  EXPECT_EQ(ranges.lower[7], 4.0);
  EXPECT_GT(ranges.upper[7], 4.0);
}

TEST(TwinFigures, AreThoseOfTheWorstPosture) {
  const config::Twin excavator = config::load_twin("models/twins/excavator/twin.yaml");
  const TwinFigures start = twin_figures(excavator, {excavator.model.q_start});
  const TwinFigures all = twin_figures(excavator, twin_postures(excavator, 300, 1));
  EXPECT_GT(all.condition, 1.1 * start.condition);
  EXPECT_LT(all.mass, start.mass);
}

TEST(SynchronisationPole, DividesWhatComesTogetherFromWhatRunsAway) {
  // double pole at 20 rad/s and 1 kHz
  // in continuous time; holding the acceleration splits it by 2e-3
  EXPECT_NEAR(synchronisation_pole(400.0, 40.0, 1e-3), std::exp(-0.02), 3e-3);
  EXPECT_LT(synchronisation_pole(400.0, 1999.0, 1e-3), 1.0);
  EXPECT_GT(synchronisation_pole(400.0, 2001.0, 1e-3), 1.0);
  // the recursion itself: e+ = e + dt v + dt^2 a / 2, v+ = v + dt a
  for (const double kP : {100.0, 5e4, 9e4, 3e5}) {
    double e = 1.0, v = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const double a = -kP * e - 40.0 * v;
      e += 1e-3 * v + 0.5e-6 * a;
      v += 1e-3 * a;
    }
    EXPECT_EQ(synchronisation_pole(kP, 40.0, 1e-3) < 1.0, std::abs(e) < 1.0) << kP;
  }
}

TEST(Fixes, ValuesAreRoundedToTheSafeSide) {
  EXPECT_EQ(rounded_down(5.57, 2), "5.5");
  EXPECT_EQ(rounded_down(5.52, 2), "5.5");
  EXPECT_EQ(rounded_down(9.96, 2), "9.9");
  EXPECT_EQ(rounded_down(1996.0, 2), "1.9e+03");
  EXPECT_EQ(rounded_down(0.5, 2), "0.5");
  EXPECT_EQ(rounded_down(kInfinity, 2), "inf");
  EXPECT_EQ(rounded_up(5.52, 2), "5.6");
  EXPECT_EQ(rounded_up(9.94, 2), "10");
  EXPECT_EQ(rounded_up(0.0, 2), "0");
}

TEST(CartesianRule, NoMoreIsProposedThanTheFileHas) {
  config::DeviceConfig device = shipped_device();
  const workspace::Survey survey = workspace::survey(device, kFew);
  const double low = cartesian_rules(device, survey).front().low_acceleration;
  int few = 0;
  for (double factor = 0.1; factor < 2.0; factor *= 1.01) {
    device.model.cartesian_limits[0].axes[0].ddq_max = factor * low;
    const CartesianRule rule = cartesian_rules(device, survey).front();
    if (rule.share_too_weak < 0.01) continue;
    if (rule.share_too_weak < 0.05) ++few;
    EXPECT_LT(rule.low_acceleration, factor * low) << rule.share_too_weak;
  }
  EXPECT_GT(few, 0);
}

TEST(Shipped, DeviceAndTwinsHaveNoFaultsAndNoWarningsButTheExplainedOnes) {
  const config::SimulatedDeviceConfig device = shipped_device();
  Findings all = inspect(device, workspace::survey(device));
  for (const char* name : {"door", "excavator", "free_space"}) {
    const config::Twin twin = config::load_twin(std::string("models/twins/") + name + "/twin.yaml");
    for (const Findings& findings : {inspect(twin, kDt), inspect(device, twin)}) {
      all.insert(all.end(), findings.begin(), findings.end());
    }
  }
  // docs/start/check.md explains them
  std::vector<std::string> warnings;
  for (const Finding& finding : all) {
    EXPECT_NE(finding.severity, Severity::kFault) << finding.item << ": " << finding.what;
    if (finding.severity == Severity::kWarning) {
      warnings.push_back(finding.item + " " + finding.what.substr(0, 13));
    }
  }
  EXPECT_EQ(warnings,
            (std::vector<std::string>{"cartesian_limits[0].ddq_max_m_per_s2 braking hand ",
                                      "cartesian_limits[1].ddq_max_m_per_s2 braking elbow",
                                      "cartesian_limits[1].ddq_max_m_per_s2 braking elbow",
                                      "placement led through i"}))
      << all_of(all);
}

TEST(IgnoredUrdf, IsNamedInOneNotePerFile) {
  const Changed extended = {.urdf_from = "</robot>",
                            .urdf_to = "<transmission/><gazebo/><transmission/></robot>"};
  const char* const expected = "not read: <transmission> (2 times), <gazebo>";
  const Findings device = device_findings(extended);
  const Finding* note = find(device, "urdf", expected);
  ASSERT_NE(note, nullptr) << all_of(device);
  EXPECT_EQ(note->severity, Severity::kNote);
  EXPECT_TRUE(note->file.ends_with(".urdf")) << note->file;
  const Findings twin = inspect(door(extended), kDt);
  EXPECT_NE(find(twin, "urdf", expected), nullptr) << all_of(twin);
  EXPECT_EQ(find(inspect(door({}), kDt), "urdf", "not read"), nullptr);
}

TEST(IgnoredUrdf, FaultsOfPartsThatAreNotUsedAreNamed) {
  const std::vector<config::SourceText> sources = {
      {"f.yaml", ""},
      {"my: r.urdf",
       R"(<robot name="r"><link name="a"><inertial><mass value="1"/></inertial></link><link name="b"/><joint name="socket" type="spherical">)"
       R"(<parent link="a"/><child link="b"/></joint></robot>)"}};
  const config::Places places;
  Collector out(sources, places);
  inspect_ignored(sources, UrdfUse::kTwin, out);
  EXPECT_NE(find(out.findings, "urdf", "not read: joint socket: type is unknown, got 'spherical'"),
            nullptr)
      << all_of(out.findings);
  EXPECT_NE(find(out.findings, "urdf", "link a: <inertial> needs an element <inertia>"), nullptr)
      << all_of(out.findings);
}

TEST(IgnoredUrdf, FrictionOfADeviceIsNotTakenFromItsUrdf) {
  const Changed rubbed = {.urdf_from = "</joint>",
                          .urdf_to = R"(<dynamics damping="1" friction="0"/></joint>)"};
  const Findings device = device_findings(rubbed);
  EXPECT_NE(find(device, "urdf", "not read: <dynamics> damping and friction"), nullptr)
      << all_of(device);
}

// A chain of links of 0.1, 0.2, ... m with these masses, kg, and moments, kg m^2.
Findings findings_of_links(const std::vector<std::pair<double, Eigen::Vector3d>>& links,
                           const std::vector<std::string>& joints = {}) {
  std::string urdf = "<robot name=\"r\"><link name=\"l0\"/>";
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& [mass, I] = links[i];
    urdf += fmt::format(
        "<link name=\"l{0}\"><inertial><mass value=\"{1}\"/><inertia ixx=\"{2}\" iyy=\"{3}\" "
        "izz=\"{4}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link><joint name=\"j{0}\" "
        "type=\"continuous\"><parent link=\"l{5}\"/><child link=\"l{0}\"/><origin xyz=\"0 0 "
        "{6}\"/></joint>",
        i + 1, mass, I.x(), I.y(), I.z(), i, 0.1 * static_cast<double>(i + 1));
  }
  const std::vector<config::SourceText> sources = {{"f.yaml", ""}, {"r.urdf", urdf + "</robot>"}};
  const config::Places places;
  Collector out(sources, places);
  inspect_bodies(sources, joints, out);
  return out.findings;
}

TEST(Bodies, PlaceholdersAreNamed) {
  const Eigen::Vector3d slim(0.02, 0.02, 0.01), ball(0.02, 0.02, 0.02), own(0.03, 0.03, 0.01);
  const auto says = [](const Findings& findings, const char* what) {
    return find(findings, "link l1", what) != nullptr;
  };
  EXPECT_TRUE(says(findings_of_links({{1, slim}, {1, slim}, {1, slim}}),
                   "all 3 moving links have its inertia, 3 kg in all, but not its length"));
  EXPECT_TRUE(says(findings_of_links({{1, slim}, {1, slim}, {1, slim}, {2, own}}),
                   "3 of 4 moving links have its inertia"));
  EXPECT_TRUE(says(findings_of_links({{1, ball}, {2, ball}, {3, ball}}),
                   "all 3 moving links have its inertia, 6 kg in all"));
  for (const auto& fair :
       {findings_of_links({{1, slim}, {1, slim}, {1, slim}}, {"j1", "j2"}),
        findings_of_links({{1, slim}, {2, slim}, {3, slim}}),
        findings_of_links({{1, slim}, {1, slim}, {1, own}}),
        findings_of_links({{1, slim}, {1, slim}, {1, slim}, {2, own}, {3, own}, {4, own}})}) {
    EXPECT_FALSE(says(fair, "have its inertia")) << all_of(fair);
  }
}

TEST(Findings, AreWhereTheFaultsAre) {
  const Findings findings =
      findings_of(InputError({{.file = "a/b.yaml",
                               .line = 3,
                               .column = 7,
                               .item = "joints.m1",
                               .what = "must be > 0, got 0"},
                              {.file = "r.urdf", .line = 12, .item = "link x", .what = "too heavy"},
                              {.file = "f", .what = "no such file"}}),
                  "f");
  ASSERT_EQ(findings.size(), 3u);
  EXPECT_EQ(findings[0].file, "a/b.yaml");
  EXPECT_EQ(findings[0].place.line, 3);
  EXPECT_EQ(findings[0].place.column, 7);
  EXPECT_EQ(findings[0].item, "joints.m1");
  EXPECT_EQ(findings[0].what, "must be > 0, got 0");
  EXPECT_EQ(findings[1].file, "r.urdf");
  EXPECT_EQ(findings[1].place.line, 12);
  EXPECT_EQ(findings[1].place.column, 1);
  EXPECT_EQ(findings[1].item, "link x");
  EXPECT_EQ(findings[1].what, "too heavy");
  EXPECT_EQ(findings[2].file, "f");
  EXPECT_EQ(findings[2].place.line, 1);
  EXPECT_EQ(findings[2].item + findings[2].what, "no such file");
}

TEST(Findings, NamesThatLookLikePlacesDoNotMoveThem) {
  const Finding finding = finding_of({.file = "a:12: b.yaml",
                                      .line = 3,
                                      .column = 7,
                                      .item = "joints.door: 7",
                                      .what = "is: wrong"},
                                     "a:12: b.yaml");
  EXPECT_EQ(finding.file, "a:12: b.yaml");
  EXPECT_EQ(finding.place.line, 3);
  EXPECT_EQ(finding.place.column, 7);
  EXPECT_EQ(finding.item, "joints.door: 7");
  EXPECT_EQ(finding.what, "is: wrong");
}

TEST(Findings, AnotherFileAsAWholeIsTheItem) {
  const Finding finding = finding_of({.file = "r.urdf", .item = "tool", .what = "wrong"}, "f.yaml");
  EXPECT_EQ(finding.file, "f.yaml");
  EXPECT_EQ(finding.item, "r.urdf");
  EXPECT_EQ(finding.what, "tool: wrong");
}

TEST(Findings, AnErrorWithoutDataIsOneOfTheFile) {
  const Findings findings = findings_of(SetupError("a.yaml:3:7: x: no place"), "f");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].file, "f");
  EXPECT_EQ(findings[0].place.line, 1);
  EXPECT_EQ(findings[0].item, "");
  EXPECT_EQ(findings[0].what, "a.yaml:3:7: x: no place");
}

TEST(FileKind, FollowsFromTheKeysOfTheFile) {
  config::SourceReader disk;
  using config::FileKind;
  EXPECT_EQ(kind_of("models/haptic_giant/device.yaml", disk), FileKind::kDevice);
  for (const char* name : {"door", "excavator", "free_space"}) {
    const std::string models = "models/";
    EXPECT_EQ(kind_of(models + "twins/" + name + "/twin.yaml", disk), FileKind::kTwin);
    EXPECT_EQ(kind_of(models + "scenarios/" + name + ".yaml", disk), FileKind::kScenario);
    EXPECT_EQ(kind_of(models + "scripts/" + name + ".yaml", disk), FileKind::kScript);
  }
  EXPECT_EQ(kind_of("models/haptic_giant/simulation.yaml", disk), FileKind::kSimulation);
  config::SourceReader texts(
      {{"tool.yaml", "name: grip\nmass_kg: 1\n"}, {"x.yaml", "colour: red\n"}});
  EXPECT_EQ(kind_of("tool.yaml", texts), FileKind::kTool);
  try {
    (void)kind_of("x.yaml", texts);
    FAIL() << "must be refused";
  } catch (const SetupError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("x.yaml:1:1: ")) << message;
    EXPECT_NE(message.find("'manipulator'"), std::string::npos);
    EXPECT_NE(message.find("'colour'"), std::string::npos);
  }
}

}  // namespace
}  // namespace hg::check
