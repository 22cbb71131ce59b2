#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>

#include "hg/check/device_inspection.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/twin_inspection.h"
#include "hg/check/unit_comparison.h"
#include "hg/check/unit_inspection.h"
#include "hg/config/twin.h"
#include "hg/core/open_file.h"
#include "hg/workspace/survey.h"

namespace hg::check {
namespace {

// "item: what -> fix" of each warning, with the line of those in `file`.
std::string text_of(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.severity, Severity::kWarning);
    text += std::to_string(finding.place.line) + ": " + finding.item + ": " + finding.what +
            " -> " + finding.fix + "\n";
  }
  return text;
}

std::string doubts_of(const std::string& file, const std::string& content,
                      const std::vector<std::string>& joints = {}) {
  const std::vector<config::SourceText> sources = {{file, content}};
  const config::Places places;
  Collector out(sources, places);
  inspect_units(sources, joints, out);
  return text_of(out.findings);
}

std::string urdf(const std::string& joint) {
  return "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n" + joint + "\n</robot>";
}

std::string revolute(const std::string& limit) {
  return urdf("<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><limit " +
              limit + "/></joint>");
}

TEST(Units, RangesOfAUrdfInDegrees) {
  EXPECT_EQ(doubts_of("r.urdf", revolute("lower=\"-2.9\" upper=\"6.28\" velocity=\"3\"")), "");
  EXPECT_EQ(doubts_of("r.urdf", revolute("lower=\"-1000\" upper=\"1000\"")), "") << "no stops";
  EXPECT_EQ(
      doubts_of("r.urdf", revolute("lower=\"-170\" upper=\"120\" velocity=\"3\"")),
      "2: joint j: <limit> -170 .. 120: -170 rad are 27.06 turns; suspected degrees: -2.967 "
      "rad -> if so, give lower=\"-2.967\" upper=\"2.094\"; a joint without stops has the type "
      "continuous\n");
}

TEST(Units, SpeedsOfAUrdfInDegrees) {
  EXPECT_EQ(doubts_of("r.urdf", revolute("upper=\"3\" velocity=\"180\"")),
            "2: joint j: <limit> velocity: 180 rad/s are 28.65 turns per second; suspected degrees "
            "per second: 3.142 rad/s, or revolutions per minute: 18.85 rad/s -> if so, give "
            "velocity in rad/s\n");
}

// Wheels and propellers are faster than arms.
TEST(Units, SpeedsOfWhatTurnsWithoutEnd) {
  const auto with = [](const std::string& limit) {
    return doubts_of("r.urdf", urdf("<joint name=\"j\" type=\"continuous\"><parent "
                                    "link=\"a\"/><child link=\"b\"/><limit " +
                                    limit + "/></joint>"));
  };
  EXPECT_EQ(with("effort=\"2000\" velocity=\"838\""), "");
  EXPECT_EQ(with("velocity=\"180\""), "");
  EXPECT_EQ(doubts_of("r.urdf", revolute("lower=\"-1e16\" upper=\"1e16\" velocity=\"838\"")), "");
  EXPECT_NE(with("effort=\"40\" velocity=\"180\"").find("suspected degrees per second"),
            std::string::npos);
}

TEST(Units, SlidesInMillimetres) {
  const std::string slide =
      "<joint name=\"j\" type=\"prismatic\"><parent link=\"a\"/><child link=\"b\"/><limit "
      "upper=\"800\"/></joint>";
  EXPECT_EQ(doubts_of("r.urdf", urdf(slide)),
            "2: joint j: <limit> 0 .. 800: 800 m are more than a hall is long; suspected "
            "millimetres: 0.8 m -> if so, give lower=\"0\" upper=\"0.8\"\n");
  EXPECT_EQ(doubts_of("r.urdf", urdf(std::regex_replace(slide, std::regex("800"), "40"))), "")
      << "the rail of a crane";
}

// YAML files may speak of <robot>; a URDF may have any name.
TEST(Units, AUrdfIsWhatBeginsAsXml) {
  EXPECT_EQ(doubts_of("tool.yaml", "mass_kg: 1  # held by the <robot> of the URDF\n"), "");
  EXPECT_NE(doubts_of("tool.yaml", "mass_kg: 1200  # <robot\n").find("suspected grams"),
            std::string::npos);
  const std::string wrong = revolute("upper=\"170\"");
  for (const std::string before : {"", " \r\n", "\xEF\xBB\xBF", "<?xml version=\"1.0\"?>\n"}) {
    EXPECT_NE(doubts_of("robot", before + wrong).find("suspected degrees"), std::string::npos)
        << before;
  }
  EXPECT_TRUE(is_urdf({"r.urdf", ""}));
  EXPECT_FALSE(is_urdf({"r.yaml", ""}));
  EXPECT_EQ(urdfs_among({{"f.yaml", "# <robot>\n"}, {"robot", wrong}}).size(), 1u);
}

TEST(Units, AUrdfIsParsedOnceForAllFindings) {
  std::vector<config::SourceText> sources = {{"r.urdf", revolute("upper=\"170\"")}};
  const config::Places places;
  Collector out(sources, places);
  for (int i = 0; i < 2; ++i) {
    out.add_at_urdf(Severity::kWarning, "joint", "j", "odd", "");
    EXPECT_EQ(out.findings.back().place.line, 2);
    sources.front().content = "<robot name=\"r\"/>";
  }
}

TEST(Units, OnlyJointsOfTheChainCount) {
  const std::string wrong = revolute("upper=\"170\"");
  EXPECT_EQ(doubts_of("r.urdf", wrong, {"other"}), "");
  EXPECT_NE(doubts_of("r.urdf", wrong, {"j"}), "");
}

TEST(Units, OrientationsOfAUrdfInDegrees) {
  const auto with = [](const std::string& rpy) {
    return doubts_of("r.urdf", urdf("<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child "
                                    "link=\"b\"/>\n<origin rpy=\"" +
                                    rpy + "\"/></joint>"));
  };
  EXPECT_EQ(with("1.57 -3.14159 4.712"), "");
  EXPECT_EQ(with("0 90 -180"),
            "3: joint j: <origin> rpy \"0 90 -180\": -180 rad are more than a turn; suspected "
            "degrees: -3.142 rad -> if so, give rpy=\"0 1.571 -3.142\"\n");
}

TEST(Units, ScalesThatAreNotThreeNumbers) {
  const auto with = [](const std::string& scale) {
    return doubts_of("r.urdf",
                     "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh "
                     "filename=\"m.stl\" scale=\"" +
                         scale + "\"/></geometry></visual></link></robot>");
  };
  EXPECT_EQ(with("0.001 -0.001 0.001"), "");
  for (const char* wrong : {"0.001 0.001", "a b c", "", "nan 1 1", "1 0 1"}) {
    EXPECT_EQ(with(wrong), "1: link a: <mesh> scale must be three numbers other than 0, got '" +
                               std::string(wrong) +
                               "' -> give scale=\"1 1 1\", or \"0.001 0.001 0.001\" for a mesh in "
                               "millimetres\n");
  }
}

struct YamlCase {
  const char* yaml;
  const char* doubt;  ///< part of it; empty: none
};

class UnitsOfYaml : public testing::TestWithParam<YamlCase> {};

TEST_P(UnitsOfYaml, AreDoubtedWhereOnlyAnotherIsPlausible) {
  const auto [yaml, doubt] = GetParam();
  const std::string found = doubts_of("f.yaml", yaml);
  EXPECT_EQ(found.empty(), std::string(doubt).empty()) << found;
  EXPECT_NE(found.find(doubt), std::string::npos) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Units, UnitsOfYaml,
    testing::Values(
        YamlCase{"joints: {m1: {q_max_rad: 90}}",
                 "1: joints.m1.q_max_rad: 90 rad are 14.32 turns; suspected degrees: 1.571 rad -> "
                 "if so, give q_max_rad in rad"},
        YamlCase{"joints: {m1: {q_min_rad: -1000, q_max_rad: 1000}}", ""},
        YamlCase{"joints: {m1: {q_min_rad: -360, q_max_rad: 360}}", "q_min_rad: -360 rad"},
        YamlCase{"joints: {rail: {q_min_m: -1000, q_max_m: 1000}}", ""},
        YamlCase{"joints: {rail: {q_min_m: 0, q_max_m: 1000}}", "suspected millimetres: 1 m"},
        YamlCase{"joints: {hinge: {dq_max_rad_per_s: 50}}", ""},
        YamlCase{"control: {rotor_pole_rad_per_s: 175, link_pole_rad_per_s: 57, "
                 "motor_pole_rad_per_s: 90}",
                 ""},
        YamlCase{"joints: {m1: {closer: {speed_rad_per_s: 90}}}", "suspected degrees per second"},
        YamlCase{"actuators: {m1: {full_torque_to_rad_per_s: 180}}", "180 rad/s are"},
        YamlCase{"joints: {m1: {q_max_rad: 2.9, dq_max_rad_per_s: 3}}", ""},
        YamlCase{"joints: {m1: {dq_max_rad_per_s: 120}}", "suspected degrees per second: 2.094"},
        YamlCase{"posture:\n  elbow: -45", "2: posture.elbow: -45 rad are 7.162 turns"},
        YamlCase{"placement: {x_m: 1, yaw_rad: 90}", "placement.yaw_rad: 90 rad are more than a"},
        YamlCase{"locks: [{position_rad: 30}]", "locks[0].position_rad: 30 rad"},
        YamlCase{"sensors: {gyroscope: {range_rad_per_s: 35}}", ""},
        YamlCase{"placement: {x_m: 450}", "suspected millimetres: 0.45 m"},
        YamlCase{"mass_kg: 1200", "1200 kg are more than a person moves; suspected grams: 1.2 kg"},
        YamlCase{"free_body: {mass_kg: 200}", ""},
        YamlCase{"free_body: {mass_kg: 800, inertia_kg_m2: [150, 900, 1000]}",
                 "1: free_body.mass_kg: 800 kg are more than a person moves; suspected grams: 0.8 "
                 "kg -> if so, give mass_kg in kg\n"},
        YamlCase{"free_body: {mass_kg: 6000}", "suspected grams: 6 kg"},
        YamlCase{"payload: {mass_kg: 1.2, centre_of_mass_m: [0, 0, -3]}",
                 "payload.centre_of_mass_m[2]: -3 m are farther than the end of what is held; "
                 "suspected millimetres: -0.003 m"},
        YamlCase{"payload: {mass_kg: 1.2, inertia_kg_m2: [0.0034, 0.0034, 0.001]}", ""},
        YamlCase{"payload: {mass_kg: 1.2, inertia_kg_m2: [3400, 3400, 1070]}",
                 "payload.inertia_kg_m2[0]: this inertia is that of a body of about 57 m, with 1.2 "
                 "kg; suspected kg mm^2: 0.002623 kg m^2 ->"},
        YamlCase{"monitor: {force_max_N: 150, torque_max_Nm: 14}", ""},
        YamlCase{
            "monitor: {force_max_N: 150, torque_max_Nm: 14000}",
            "monitor.torque_max_Nm: 1.4e+04 Nm beside 150 N are a lever of 93 m; suspected Ncm: "
            "140 Nm, or Nmm: 14 Nm"},
        YamlCase{
            "estimation: {noise_N: 80, noise_Nm: 0.0026}",
            "estimation.noise_N: 0.0026 Nm beside 80 N are a lever of 3.2e-05 m; suspected mN: "
            "0.08 N"},
        YamlCase{"sensors: {wrench_sensor: {force_N: [500, 5, 5], torque_Nm: [15000, 1, 1]}}",
                 "sensors.wrench_sensor.torque_Nm[0]: 1.5e+04 Nm beside 500 N"},
        YamlCase{"push: {force_N: 1, torque_Nm: 5}", ""}));

TEST(Units, SlidesOfAPostureAreLengths) {
  const std::string robot = urdf(
      "<joint name=\"rail\" type=\"prismatic\"><parent link=\"a\"/><child link=\"b\"/><limit "
      "upper=\"50\"/></joint>");
  const auto with = [&](const std::string& at) {
    const std::vector<config::SourceText> sources = {{"f.yaml", "posture: {rail: " + at + "}"},
                                                     {"r.urdf", robot}};
    const config::Places places;
    Collector out(sources, places);
    inspect_units(sources, {}, out);
    return text_of(out.findings);
  };
  EXPECT_EQ(with("45"), "");
  EXPECT_EQ(with("650"),
            "1: posture.rail: 650 m are more than a hall is long; suspected millimetres: 0.65 m -> "
            "if so, give rail in m\n");
}

// "a.list[].NAME.key" with its value, as YAML.
std::string nested(const std::string& path, const std::string& value) {
  const std::size_t dot = path.find('.');
  std::string name = path.substr(0, dot);
  const bool is_list = name.ends_with("[]");
  if (is_list) name.resize(name.size() - 2);
  if (dot == std::string::npos) return "{" + name + ": " + value + "}";
  const std::string inner = nested(path.substr(dot + 1), value);
  return "{" + name + ": " + (is_list ? "[" + inner + "]" : inner) + "}";
}

TEST(Units, DefaultsAreNotDoubted) {
  int count = 0;
  const std::regex row("`([^`]+)`(?: or `([^`]+)`)?,\"?(\\[[^\\]]+\\]|-?[0-9][0-9.e+-]*)\"?,.*");
  for (const char* kind : {"device", "scenario", "script", "simulation", "tool", "twin"}) {
    std::istringstream table(
        read_file(std::string("docs/reference/configuration_") + kind + ".csv"));
    std::smatch cells;
    for (std::string line; std::getline(table, line);) {
      if (!std::regex_match(line, cells, row)) continue;
      const std::string path = cells.str(1);
      const std::string parent = path.substr(0, path.rfind('.') + 1);
      for (const std::string& key : {path, parent + cells.str(2)}) {
        if (key == parent) continue;
        EXPECT_EQ(doubts_of("f.yaml", nested(key, cells.str(3))), "") << key;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 200);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is no longer in the shipped file";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Of the shipped device with a piece of its YAML file and of its URDF replaced.
std::string doubts_of_device(const std::string& from, const std::string& to,
                             const std::string& urdf_from = "", const std::string& urdf_to = "") {
  const std::string folder = "models/haptic_giant/";
  const std::string yaml = replaced(read_file(folder + "device.yaml"), "simulation: ", "# ");
  const std::string robot = read_file(folder + "haptic_giant.urdf");
  config::SourceReader reader({{"f.yaml", replaced(yaml, from, to)},
                               {"haptic_giant.urdf", replaced(robot, urdf_from, urdf_to)}});
  const config::DeviceConfig device = config::load_device("f.yaml", reader);
  Collector out(device.sources, device.places);
  compare_units(device, workspace::survey(device, {.postures = 500, .positions = 500}), out);
  return text_of(out.findings);
}

TEST(Units, TheShippedDeviceFitsItself) { EXPECT_EQ(doubts_of_device("", ""), ""); }

TEST(Units, AccelerationsOfADeviceInDegrees) {
  EXPECT_NE(doubts_of_device("m1: {ddq_max_rad_per_s2: 6.5}", "m1: {ddq_max_rad_per_s2: 372}")
                .find("joints.m1.ddq_max_rad_per_s2: with 372 rad/s^2 the full speed of"),
            std::string::npos);
  EXPECT_NE(doubts_of_device("ddq_max_rad_per_s2: 40  # [A] below",
                             "ddq_max_rad_per_s2: 2300  # [A] below")
                .find("virtual_joints[0].ddq_max_rad_per_s2: with 2300 rad/s^2"),
            std::string::npos);
}

TEST(Units, SpeedsFarBeyondThoseOfTheUrdf) {
  EXPECT_NE(doubts_of_device("m1: {ddq_max", "m1: {dq_max_rad_per_s: 21, ddq_max")
                .find("joints.m1.dq_max_rad_per_s: 21 rad/s are"),
            std::string::npos);
}

TEST(Units, ActuatorsOfAnotherScale) {
  EXPECT_NE(doubts_of_device("stiffness_Nm_per_rad: 12000", "stiffness_Nm_per_rad: 209")
                .find("actuators.m1.stiffness_Nm_per_rad: 209 Nm/rad twist by 0.84 rad under the "
                      "largest torque, 176 Nm; suspected Nm/deg: 1.197e+04 Nm/rad"),
            std::string::npos);
  EXPECT_NE(doubts_of_device("rotor_inertia_kg_m2: 1.46", "rotor_inertia_kg_m2: 14600")
                .find("suspected kg cm^2: 1.46 kg m^2"),
            std::string::npos);
  EXPECT_NE(doubts_of_device("torque_max_Nm: 40", "torque_max_Nm: 40000")
                .find("4e+04 Nm beside the effort of the URDF, 40 Nm; suspected Ncm: 400 Nm, or "
                      "Nmm: 40 Nm"),
            std::string::npos)
      << doubts_of_device("torque_max_Nm: 40", "torque_max_Nm: 40000");
}

// Of the arm of the examples with more lines in its YAML file and another URDF.
std::string doubts_of_arm(const std::string& lines, const std::string& robot) {
  config::SourceReader reader(
      {{"f.yaml", read_file("models/examples/arm.yaml") + "\n" + lines}, {"arm.urdf", robot}});
  const config::DeviceConfig device = config::load_device("f.yaml", reader);
  Collector out(device.sources, device.places);
  compare_units(device, workspace::survey(device, {.postures = 200, .positions = 200}), out);
  return text_of(out.findings);
}

TEST(Units, OneEffortOfAllJointsIsAnUnknownOne) {
  const std::string arm = read_file("models/examples/arm.urdf");
  const auto with = [&](const char* effort) {
    return doubts_of_arm("", std::regex_replace(arm, std::regex("effort=\"[0-9]+"), effort));
  };
  EXPECT_EQ(with("effort=\"30000"), "");
  EXPECT_NE(with("$&000").find("suspected Ncm: 1200 Nm, or Nmm: 120 Nm"), std::string::npos);
}

TEST(Units, WallsInMillimetres) {
  const auto doubts_with = [](const std::string& z_min) {
    return doubts_of_arm("cartesian_limits: [{name: hand, frame: handle, z: {q_min_m: " + z_min +
                             ", q_max_m: .inf}}]\n",
                         read_file("models/examples/arm.urdf"));
  };
  EXPECT_EQ(doubts_with("0.025"), "");
  EXPECT_NE(doubts_with("25").find("cartesian_limits[0].z.q_min_m: 25 m are far beyond the"),
            std::string::npos);
  EXPECT_NE(doubts_with("25").find("suspected millimetres: 0.025 m"), std::string::npos);
}

TEST(Units, EffortsOfAnotherScale) {
  EXPECT_NE(doubts_of_device("", "", "effort=\"176\"", "effort=\"176001\"")
                .find("joint m1: <limit> effort: 1.76e+05 Nm are"),
            std::string::npos);
  EXPECT_EQ(doubt_of_weight(60.0, 50.0), "");
  EXPECT_EQ(doubt_of_weight(60000.0, 150.0),
            "; suspected grams: masses of the URDF or tool 1000 times smaller");
  EXPECT_EQ(doubt_of_weight(60.0, 15.3), "; suspected kgf m: 150 Nm");
}

TEST(Units, ASpringThatNeverOvercomesItsFriction) {
  const auto doubts_with = [](const std::string& stiffness) {
    const std::string folder = "models/twins/door/";
    config::SourceReader reader(
        {{"f.yaml", replaced(read_file(folder + "twin.yaml"),
                             "preload_Nm: 0.6  # [A] 10.3: spring, 0.6 + 1.2 q\n    "
                             "stiffness_Nm_per_rad: 1.2",
                             "friction_Nm: 0.1\n    stiffness_Nm_per_rad: " + stiffness)},
         {"door.urdf", read_file(folder + "door.urdf")}});
    const config::Twin twin = config::load_twin("f.yaml", reader);
    Collector out(twin.sources, twin.places);
    compare_units(twin, 3.0, out);
    return text_of(out.findings);
  };
  EXPECT_EQ(doubts_with("1.2"), "");
  EXPECT_NE(doubts_with("0.021").find(
                "joints.lever.stiffness_Nm_per_rad: the spring pulls with 0.0168 Nm at most, the "
                "friction of the joint is 0.1 Nm; suspected Nm/deg: 1.203 Nm/rad"),
            std::string::npos);
}

TEST(Units, ATwinTooHeavyForAHand) {
  const config::Twin twin = config::load_twin("models/twins/door/twin.yaml");
  Collector out(twin.sources, twin.places);
  for (const double mass : {3.0, 400.0, kInfinity}) compare_units(twin, mass, out);
  EXPECT_TRUE(out.findings.empty());
  compare_units(twin, 8000.0, out);
  EXPECT_NE(text_of(out.findings)
                .find("end_effector: the hand moves 8000 kg at least, more than a person can; "
                      "suspected grams: 8 kg"),
            std::string::npos);
}

TEST(Units, AHeavyBodyIsDoubtedOnce) {
  for (const char* inertia : {"[0.08, 0.08, 0.08]", "[150, 900, 1000]"}) {
    config::SourceReader reader(
        {{"f.yaml",
          std::string(
              "name: car\nend_effector: handle\nfree_body: {mass_kg: 800, inertia_kg_m2: ") +
              inertia + "}\nplacement: {x_m: 0}\n"}});
    const Findings found = inspect(config::load_twin("f.yaml", reader), 1e-3);
    EXPECT_EQ(std::ranges::count(found, Severity::kWarning, &Finding::severity), 1);
  }
}

std::string doubts_of_link(const std::string& mass, const std::string& moment) {
  std::string body = "<link name=\"c\"><inertial><mass value=\"" + mass +
                     "\"/><inertia ixy=\"0\" "
                     "ixz=\"0\" iyz=\"0\"";
  for (const char* axis : {"ixx", "iyy", "izz"})
    body += std::string(" ") + axis + "=\"" + moment + "\"";
  const std::vector<config::SourceText> sources = {
      {"r.urdf", "<robot name=\"r\"><link name=\"a\"/>" + body +
                     "/></inertial></link><joint name=\"j\" type=\"fixed\"><parent link=\"a\"/>"
                     "<child link=\"c\"/></joint></robot>"}};
  const config::Places places;
  Collector out(sources, places);
  inspect_bodies(sources, {}, out);
  return text_of(out.findings);
}

TEST(Units, MassesAndInertiasOfLinks) {
  EXPECT_EQ(doubts_of_link("3.5", "0.02"), "");
  EXPECT_EQ(doubts_of_link("220", "12"), "");
  EXPECT_NE(doubts_of_link("3500", "0.02")
                .find("3500 kg with this inertia are denser than any "
                      "metal; suspected grams: 3.5 kg"),
            std::string::npos);
  EXPECT_NE(doubts_of_link("3.5", "20000")
                .find("kg; suspected kg cm^2: 2 kg m^2, or kg mm^2: 0.02 "
                      "kg m^2"),
            std::string::npos)
      << doubts_of_link("3.5", "20000");
}

TEST(Units, ShapesOfMovingLinksInMillimetres) {
  const std::vector<config::SourceText> sources = {
      {"r.urdf",
       "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"b\"><collision><geometry><box "
       "size=\"40 300 20\"/></geometry></collision></link><joint name=\"j\" "
       "type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>"}};
  const config::Places places;
  Collector out(sources, places);
  inspect_bodies(sources, {}, out);
  EXPECT_EQ(
      text_of(out.findings),
      "2: link b: <collision>: 300 m are more than a hall is long; suspected millimetres: 0.3 "
      "m -> give sizes and <origin xyz> in metres\n");
}

}  // namespace
}  // namespace hg::check
