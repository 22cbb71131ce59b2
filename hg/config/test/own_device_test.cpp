/// What is wrong with devices other than the HapticGiant: tools, gantries, postures.

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

// eight joints j0..j7; the first two of the given types
std::string arm_urdf(const std::string& first, const std::string& second = "revolute") {
  std::ostringstream text;
  text << "<robot name='arm'><link name='base'/>";
  for (int i = 0; i < 8; ++i) {
    text << "<joint name='j" << i << "' type='"
         << (i == 0   ? first
             : i == 1 ? second
                      : "revolute")
         << "'><parent link='" << (i == 0 ? "base" : "l") << (i == 0 ? "" : std::to_string(i - 1))
         << "'/><child link='l" << i << "'/><origin xyz='0 0 0.1'/><axis xyz='"
         << (i % 2 == 0 ? "0 0 1" : "0 1 0")
         << "'/><limit lower='-2' upper='2' velocity='2' effort='9'/></joint><link name='l" << i
         << "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
            "iyz='0'/></inertial></link>";
  }
  text << "</robot>";
  return text.str();
}

constexpr const char* kTool = "name: bar\nmass_kg: 0.5\ninertia_kg_m2: [0.002, 0.002, 0.001]\n";

constexpr const char* kJoints =
    "joints: {j2: {ddq_max_rad_per_s2: 9}, j3: {ddq_max_rad_per_s2: 9}, j4: {ddq_max_rad_per_s2: "
    "9}, "
    "j5: {ddq_max_rad_per_s2: 9}, j6: {ddq_max_rad_per_s2: 9}, j7: {ddq_max_rad_per_s2: 9}}\n";

// A device with joints j0, j1 as gantry; `rest` starts in line 4.
std::string text_of(const std::string& rest) {
  return "name: test\nurdf: arm.urdf\nmanipulator: [j2, j3, j4, j5, j6, j7]\n" + rest + kJoints;
}

SourceReader reader_of(const std::string& rest, const std::string& urdf, const std::string& tool) {
  return SourceReader({{"arm.urdf", urdf}, {"tool.yaml", tool}, {"device.yaml", text_of(rest)}});
}

std::string message(const std::string& rest, const std::string& urdf = arm_urdf("revolute"),
                    const std::string& tool = kTool) {
  SourceReader reader = reader_of(rest, urdf, tool);
  return message_of([&] { load_device("device.yaml", reader); });
}

const std::string kGantry = "gantry: [j0, j1]\nposture: {j2: 0.5}\n";

TEST(OwnDevice, AToolBringsHandleSensorMassAndItsSwitch) {
  SourceReader reader =
      reader_of(kGantry + "tool: tool.yaml\nflange: l7\n", arm_urdf("revolute"),
                std::string(kTool) + "handle: {z_m: 0.2}\nsensor: {x_m: 0.01}\ndead_man: false\n");
  const DeviceConfig device = load_device("device.yaml", reader);
  EXPECT_EQ(device.model.chain.frame_names()[device.model.handle], "handle");
  EXPECT_EQ(device.model.T_H_S.p.x(), 0.01);
  EXPECT_FALSE(device.monitor.has_dead_man);
  EXPECT_EQ(device.sources.size(), 3u);  // a recording must hold the tool
}

TEST(OwnDevice, FarTooManyEntriesAreOneFault) {
  std::string tool = "mass_kg: 1\n";
  for (int i = 0; i < 1000; ++i) tool += "key_" + std::to_string(i) + ": 1\n";
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l7\n", arm_urdf("revolute"), tool),
            "tool.yaml:1:1: has 1001 entries, expected at most 1000");
  std::string limits = "handle: l7\nvirtual_joints:\n";
  for (int i = 0; i < 10001; ++i) limits += "  - {}\n";
  const std::string said = message(kGantry + limits, arm_urdf("revolute"));
  EXPECT_NE(said.find("virtual_joints: has 10001 entries, expected at most 10000"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

TEST(OwnDevice, AToolIsCheckedInItsOwnFile) {
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l7\n", arm_urdf("revolute"),
                    "name: bar\nmas_kg: 1\n"),
            "tool.yaml:2:1: mas_kg: unknown key, did you mean 'mass_kg'?");
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l7\n", arm_urdf("revolute"),
                    "name: bar\nmass_kg: 1\ninertia_kg_m2: [1, 2]\n"),
            "tool.yaml:3:16: inertia_kg_m2: must be a list of numbers [xx, yy, zz] or [xx, yy, zz, "
            "xy, xz, yz], got 2 of them");
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l7\n", arm_urdf("revolute"),
                    "name: bar\nmass_kg: 1\ninertia_kg_m2: [9, 1, 1]\n")
                .find("tool.yaml:3:16: inertia_kg_m2: "),
            0u);
}

TEST(OwnDevice, AHandleIsALinkOrATool) {
  EXPECT_EQ(message(kGantry),
            "device.yaml:1:1: a device needs 'handle' (a link of the URDF) or "
            "'tool' with 'flange'");
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l9\n"),
            "device.yaml:7:9: flange: must be a link of the URDF, got 'l9', did you mean 'l0'?");
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\nflange: l7\nhandle: l7\n"),
            "device.yaml:8:9: handle: the tool brings the handle: give either 'handle' or 'tool'");
  EXPECT_EQ(message(kGantry + "tool: tool.yaml\n"),
            "device.yaml:6:7: tool: a tool needs 'flange', and a flange needs 'tool'");
}

TEST(OwnDevice, TheGantryIsOfOneKindAndItsKeysFollow) {
  const std::string handle = "handle: l7\n";
  EXPECT_EQ(message(kGantry + handle + "drive: {dq_max_rad_per_s: 2}\n"), "no error");
  EXPECT_EQ(message(kGantry + handle + "drive: {dq_max_m_per_s: 2}\n"),
            "device.yaml:7:9: drive.dq_max_m_per_s: unknown key, did you mean 'dq_max_rad_per_s'?");
  EXPECT_EQ(message(kGantry + handle + "drive: {dq_max_m_per_s: 2}\n",
                    arm_urdf("prismatic", "prismatic")),
            "no error");
  EXPECT_EQ(message(kGantry + handle, arm_urdf("prismatic")),
            "device.yaml:4:9: gantry: gantry joints must be all prismatic or all revolute, got "
            "'j1'");
}

TEST(OwnDevice, AGantryNeedsSomewhereToGo) {
  EXPECT_EQ(message("gantry: [j0, j1]\nhandle: l7\n"),
            "device.yaml:4:9: gantry: a gantry needs 'posture': without goals of the joints it has "
            "nowhere to go");
  EXPECT_EQ(message("gantry: [j0, j1]\nhandle: l7\nposture: {j2: 2.5}\n"),
            "device.yaml:6:10: posture: j2 must be within the limits of the joint, got 2.5");
  EXPECT_EQ(message("gantry: [j0, j1]\nhandle: l7\nposture: {j1: 0}\n"),
            "device.yaml:6:11: posture.j1: must be a manipulator joint, got 'j1', did you mean "
            "'j2'?");
}

TEST(OwnDevice, WithoutAGantryNothingOfItIsGiven) {
  const std::string text =
      message("handle: l7\nroot_link: l1\nprepositioning: {k_ppu_1_per_s: 4}\n");
  EXPECT_EQ(text, "device.yaml:6:17: prepositioning: concerns the gantry, and there is none");
  EXPECT_EQ(message("handle: l7\nroot_link: l1\n"), "no error");
}

TEST(OwnDevice, ReportsHowSensorsAreReadAndWhatHangsBeyondThem) {
  SourceReader reader = reader_of(
      "handle: l7\nroot_link: l1\n"
      "estimation: {link_pole_Hz: 80, motor_low_pass_Hz: 150, wrench_low_pass_Hz: 50, has_imu: "
      "false, angular_low_pass_Hz: 40, needs_tare: true, noise_N: 0.1, noise_Nm: 0.003}\n"
      "payload: {mass_kg: 1.2, centre_of_mass_m: [0.01, 0, 0.02], inertia_kg_m2: [3e-3, 3e-3, "
      "1e-3]}\n",
      arm_urdf("revolute"), kTool);
  const estimation::EstimationConfig estimation = load_device("device.yaml", reader).estimation;
  EXPECT_EQ(estimation.link_pole_Hz, 80.0);
  EXPECT_EQ(estimation.motor_low_pass_Hz, 150.0);
  EXPECT_EQ(estimation.wrench.low_pass_Hz, 50.0);
  EXPECT_FALSE(estimation.wrench.has_imu);
  EXPECT_EQ(estimation.wrench.alpha_low_pass_Hz, 40.0);
  EXPECT_TRUE(estimation.wrench.tare.is_needed);
  EXPECT_EQ(estimation.wrench.tare.noise_force, 0.1);
  EXPECT_EQ(estimation.wrench.tare.noise_torque, 0.003);
  EXPECT_EQ(estimation.wrench.payload.mass, 1.2);
  EXPECT_EQ(estimation.wrench.payload.com, Eigen::Vector3d(0.01, 0.0, 0.02));
  EXPECT_EQ(estimation.wrench.payload.inertia.diagonal(), Eigen::Vector3d(3e-3, 3e-3, 1e-3));
  EXPECT_EQ(message("handle: l7\nroot_link: l1\nestimation: {observer_pole_Hz: 8}\n"),
            "device.yaml:6:32: estimation.observer_pole_Hz: concerns the gantry, and there is "
            "none");
}

TEST(OwnDevice, InertialUnitsAreLinksOfTheChainFromRootToTip) {
  const auto said = [](const std::string& estimation) {
    return message("handle: l7\nroot_link: l1\nestimation: {" + estimation + "}\n");
  };
  EXPECT_EQ(said("inertial_units: [l3, l5], inertial_delay_s: 0.002"), "no error");
  EXPECT_EQ(said("inertial_units: [l5, l3]"),
            "device.yaml:6:30: estimation.inertial_units: must be in the order from root to tip");
  EXPECT_EQ(
      said("inertial_units: [l3, l55]"),
      "device.yaml:6:35: estimation.inertial_units[1]: must be a link of the chain, got 'l55', "
      "did you mean 'l5'?");
  EXPECT_EQ(said("inertial_delay_s: 0.002"),
            "device.yaml:6:32: estimation.inertial_delay_s: concerns inertial_units, and there are "
            "none");
  EXPECT_EQ(
      said("inertial_units: [l3], inertial_delay_s: 0.05"),
      "device.yaml:6:54: estimation.inertial_delay_s: must be at most 14 periods, here 0.014 s, "
      "got 0.05");
}

TEST(OwnDevice, WithoutPrepositioningTheGantryKeepsWithinItsDrive) {
  const auto load = [](const std::string& rest) {
    SourceReader reader = reader_of(kGantry + "handle: l7\n" + rest, arm_urdf("revolute"), kTool);
    return load_device("device.yaml", reader);
  };
  const DeviceConfig slow = load("drive: {dq_max_rad_per_s: 0.3, ddq_max_rad_per_s2: 0.5}\n");
  EXPECT_EQ(slow.prepositioning.dq_max, 0.3);
  EXPECT_EQ(slow.prepositioning.ddq_max, 0.5);
  EXPECT_EQ(load("drive: {dq_max_rad_per_s: 9}\n").prepositioning.dq_max,
            prepositioning::PrepositioningConfig().dq_max);
  EXPECT_EQ(message(kGantry + "handle: l7\ndrive: {dq_max_rad_per_s: 0.3}\nprepositioning: "
                              "{dq_max_rad_per_s: 0.4}\n"),
            "device.yaml:8:36: prepositioning.dq_max_rad_per_s: must not exceed the speed of the "
            "drive, 0.3, got 0.4");
}

TEST(OwnDevice, WithoutAChainTheRestOfTheFileIsReadAllTheSame) {
  const std::string faults = "rate_Hz: -5\nsynchronisation: {kD_tran_1_per_s: -10}\n";
  const std::string expected =
      "device.yaml:9:10: rate_Hz: must be 100 .. 20000, got -5\n"
      "device.yaml:10:36: synchronisation.kD_tran_1_per_s: must be 1e-06 .. 1e+05, got -10";
  const auto names = [&](const std::string& gantry) {
    return gantry + "tool: tool.yaml\nflange: l7\ndrive: {dq_max_rad_per_s: 1}\n" + faults +
           "virtual_joints:\n  - {name: sum, weights: {j2: 1}, dq_max_rad_per_s: 1, "
           "ddq_max_rad_per_s2: 1}\n";
  };
  const std::string broken = message(names(kGantry), "<robot name='arm'><link");
  EXPECT_EQ(broken.substr(0, expected.size()), expected) << broken;
  const std::string rest = broken.substr(expected.size());
  EXPECT_EQ(rest.find("\narm.urdf:1: "), 0u) << broken;
  EXPECT_EQ(rest.find('\n', 1), std::string::npos) << broken;

  // the link can still be checked where it is the shape that is wrong
  std::string branched = arm_urdf("revolute");
  const std::string parent = "<parent link='l6'/>";
  branched.replace(branched.find(parent), parent.size(), "<parent link='l5'/>");
  const std::string shape = message(names(kGantry), branched);
  EXPECT_EQ(shape.substr(0, expected.size()), expected) << shape;
  EXPECT_NE(shape.find("branches into"), std::string::npos) << shape;
  EXPECT_EQ(std::count(shape.begin(), shape.end(), '\n'), 2) << shape;
}

TEST(OwnDevice, WithoutAChainTheToolIsReadAllTheSame) {
  const std::string faults =
      message(kGantry + "tool: tool.yaml\nflange: l7\n", "<robot", "name: bar\nmas_kg: 1\n");
  EXPECT_NE(faults.find("tool.yaml:2:1: mas_kg: unknown key"), std::string::npos) << faults;
  EXPECT_NE(faults.find("arm.urdf:1: "), std::string::npos) << faults;
}

TEST(OwnDevice, TheEndsOfTheChainAreNamedAtTheirKeys) {
  EXPECT_EQ(message("handle: l7\nroot_link: m1\n"),
            "device.yaml:5:12: root_link: must be a link of the URDF, got 'm1', did you mean "
            "'l1'?");
  EXPECT_EQ(message("handle: l7\ntip_link: m7\nrate_Hz: 1\n"),
            "device.yaml:5:11: tip_link: must be a link of the URDF, got 'm7', did you mean 'l7'?\n"
            "device.yaml:6:10: rate_Hz: must be 100 .. 20000, got 1");
}

TEST(OwnDevice, JointsThatMimicOthersAreRefused) {
  std::string urdf = arm_urdf("revolute");
  const std::string child = "<child link='l4'/>";
  ASSERT_NE(urdf.find(child), std::string::npos);
  urdf.replace(urdf.find(child), child.size(), child + "<mimic joint='j2'/>");
  const std::string all = message("handle: l7\n", urdf);
  EXPECT_NE(all.find("urdf: a device has no joints that mimic others, got 'j4'"), std::string::npos)
      << all;
}

// Capsules on l2, l5 and l7, and what is left unwatched of them: all can touch.
std::string capsules(const std::string& unwatched) {
  std::string text = "handle: l7\nroot_link: l1\ncollision:\n  capsules:\n";
  for (const char* capsule :
       {"name: low, link: l2", "name: mid, link: l5", "name: end, link: l7"}) {
    text += std::string("    - {") + capsule + ", to_m: [0, 0, 0.08], radius_m: 0.04}\n";
  }
  return text + unwatched;
}

std::vector<std::string> watched(const std::string& unwatched) {
  SourceReader reader = reader_of(capsules(unwatched), arm_urdf("revolute"), kTool);
  return collision::pair_names(load_device("device.yaml", reader).collision);
}

TEST(OwnDevice, CapsulesAreWatchedButForNamedPairs) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(watched(""), (Names{"low - mid", "low - end", "mid - end"}));
  EXPECT_EQ(watched("  unwatched: [{links: [l7, l5]}]\n"), (Names{"low - mid", "low - end"}));
  EXPECT_EQ(watched("  unwatched: [{capsules: [end, low]}, {capsules: [low, mid]}]\n"),
            Names{"mid - end"});
  // a link before the root of the chain
  EXPECT_EQ(watched("  unwatched: [{links: [l0, l5]}]\n").size(), 3u);
}

TEST(OwnDevice, UnwatchedPairsAreTwoLinksOrTwoCapsules) {
  EXPECT_EQ(message(capsules("  unwatched: [{links: [l5]}]\n")),
            "device.yaml:11:23: collision.unwatched[0].links: must be two, got 1");
  EXPECT_EQ(message(capsules("  unwatched: [{capsules: [low, med]}]\n")),
            "device.yaml:11:32: collision.unwatched[0].capsules[1]: must be the name of a capsule, "
            "got 'med', did you mean 'mid'?");
  EXPECT_EQ(message(capsules("  unwatched: [{}]\n")),
            "device.yaml:11:15: collision.unwatched[0]: needs either links or capsules");
}

std::string message_of_list(const std::string& manipulator) {
  const std::string text = "name: test\nurdf: arm.urdf\nmanipulator: " + manipulator +
                           "\nhandle: l7\nposture: {j7: 0.1}\nvirtual_joints: [{name: sum, "
                           "weights: {j7: 1}, q_max_rad: 1, "
                           "dq_max_rad_per_s: 1, ddq_max_rad_per_s2: 9}]\n" +
                           kJoints;
  SourceReader reader({{"arm.urdf", arm_urdf("revolute")}, {"device.yaml", text}});
  return message_of([&] { load_device("device.yaml", reader); });
}

// Values of the joints are read all the same, so that all faults are reported.
TEST(OwnDevice, ListsOfMoreJointsThanADeviceMayHaveAreRefused) {
  const std::string all = message_of_list("[j0, j1, j2, j3, j4, j5, j6, j7]");
  EXPECT_NE(all.find("at most 7 joints are possible"), std::string::npos) << all;
  const std::string wrong = message_of_list("[j1, j2, j3, j4, j5, j6, jj]");
  EXPECT_NE(wrong.find("manipulator[6]: must be a joint"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace hg::config
