// Devices, scripts and scenarios that are refused, with the whole message.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/script.h"
#include "hg/config/twin.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A good device in 12 lines; the posture stands behind all of them.
const std::vector<std::string> kDevice = {
    "name: test",
    "urdf: arm.urdf",
    "gantry: [ppu1, ppu2]",
    "manipulator: [m1, m2, m3, m4, m5, m6]",
    "handle: handle",
    "joints:",
    "  m1: {ddq_max_rad_per_s2: 12}",
    "  m2: {ddq_max_rad_per_s2: 12}",
    "  m3: {ddq_max_rad_per_s2: 25}",
    "  m4: {ddq_max_rad_per_s2: 20}",
    "  m5: {ddq_max_rad_per_s2: 40}",
    "  m6: {ddq_max_rad_per_s2: 40}",
};

// The good device with one line replaced (counted from 1), or appended.
std::string device_text(std::size_t line, const std::string& text) {
  std::vector<std::string> lines = kDevice;
  lines.resize(std::max(lines.size(), line));
  lines[line - 1] = text;
  std::string yaml;
  for (const std::string& each : lines) yaml += each + "\n";
  return yaml + "posture: {m2: 1.57, m3: -0.67}\n";
}

std::string device_message(std::size_t line, const std::string& text) {
  SourceReader reader({{"arm.urdf", text_of("models/haptic_giant/haptic_giant.urdf")},
                       {"device.yaml", device_text(line, text)}});
  return message_of([&] { load_device("device.yaml", reader); });
}

TEST(BadDevice, AGoodOneIsTaken) { EXPECT_EQ(device_message(1, "name: good"), "no error"); }

TEST(BadDevice, UnknownJointsAndFramesAreNamed) {
  EXPECT_EQ(device_message(4, "manipulator: [m1, m2, m3, m4, m5, m7]"),
            "device.yaml:4:35: manipulator[5]: must be a joint of the URDF, got 'm7', did you mean "
            "'m1'?");
  EXPECT_EQ(device_message(5, "handle: handel"),
            "device.yaml:5:9: handle: must be a link of the URDF, got 'handel', did you mean "
            "'handle'?");
  EXPECT_EQ(
      device_message(7, "  n1: {ddq_max_rad_per_s2: 12}"),
      "device.yaml:6:1: joints.m1: needs dq_max_rad_per_s and ddq_max_rad_per_s2\n"
      "device.yaml:7:3: joints.n1: must be a joint of the URDF, got 'n1', did you mean 'm1'?");
  EXPECT_EQ(device_message(9, "  m3: {dq_max_rad_per_s: 1}"),
            "device.yaml:9:3: joints.m3: needs dq_max_rad_per_s and ddq_max_rad_per_s2");
}

TEST(BadDevice, JointsMustBeThoseOfTheUrdfInItsOrder) {
  const std::string order =
      "gantry and manipulator together must be the joints of the URDF in its order, ppu1, ppu2, "
      "m1, "
      "m2, m3, m4, m5, m6";
  EXPECT_EQ(device_message(4, "manipulator: [m2, m1, m3, m4, m5, m6]"),
            "device.yaml:4:14: manipulator: " + order);
  EXPECT_EQ(device_message(3, "gantry: [ppu1, ppu1]"),
            "device.yaml:3:16: gantry[1]: named twice, got 'ppu1'");
  EXPECT_EQ(device_message(3, "gantry: ppu1"),
            "device.yaml:3:9: gantry: must be a list of names, got 'ppu1'");
  EXPECT_EQ(device_message(3, "gantry: []"), "device.yaml:4:14: manipulator: " + order);
}

TEST(BadDevice, RatesGainsAndChoicesHaveRanges) {
  EXPECT_EQ(device_message(13, "rate_Hz: 0"),
            "device.yaml:13:10: rate_Hz: must be 100 .. 20000, got 0");
  EXPECT_EQ(
      device_message(13, "kinematics: haptic_gaint"),
      "device.yaml:13:13: kinematics: must be one of haptic_giant, generic, got 'haptic_gaint', "
      "did you mean 'haptic_giant'?");
  EXPECT_EQ(device_message(13, "prepositioning: {k_ppu: 4}"),
            "device.yaml:13:18: prepositioning.k_ppu: unknown key, did you mean 'k_ppu_1_per_s'?");
  EXPECT_EQ(device_message(13, "monitor: {speed_tolerance: 0.9}"),
            "device.yaml:13:28: monitor.speed_tolerance: must be 1 .. 1e+06, got 0.9");
  EXPECT_EQ(device_message(13, "prepositioning: {dq_max_m_per_s: 1.6}"),
            "device.yaml:13:34: prepositioning.dq_max_m_per_s: must not exceed the speed of the "
            "drive, 1.5, got 1.6");
  EXPECT_EQ(device_message(13, "drive: {dead_time_s: 0.3}"),
            "device.yaml:13:22: drive.dead_time_s: must be shorter than 256 cycles, got 0.3");
  EXPECT_EQ(device_message(13, "rendering: {solver_budget: 1.5}"),
            "device.yaml:13:28: rendering.solver_budget: must be a whole number, got 1.5");
}

TEST(GoodDevice, ReportsWhetherLimitsBrakeTogether) {
  const auto braking = [](const std::string& text) {
    SourceReader reader({{"arm.urdf", text_of("models/haptic_giant/haptic_giant.urdf")},
                         {"device.yaml", device_text(13, text)}});
    return load_device("device.yaml", reader).rendering.braking;
  };
  EXPECT_EQ(braking("rendering: {braking: together}"), rendering::Braking::kTogether);
  EXPECT_EQ(braking("rendering: {braking: alone}"), rendering::Braking::kAlone);
  EXPECT_EQ(braking(""), rendering::Braking::kTogether);
  EXPECT_EQ(
      device_message(13, "rendering: {braking: all}"),
      "device.yaml:13:22: rendering.braking: must be one of alone, together, got 'all', did you "
      "mean 'alone'?");
}

TEST(BadDevice, GantryJointsHaveNoAccelerationOfTheirOwn) {
  EXPECT_EQ(
      device_message(13, "  ppu1: {q_max_m: 1.2, ddq_max_m_per_s2: 2}"),
      "device.yaml:13:24: joints.ppu1.ddq_max_m_per_s2: unknown key, did you mean 'q_max_m'?");
}

TEST(BadDevice, VirtualJointsAndBoxesAreComplete) {
  EXPECT_EQ(device_message(13,
                           "virtual_joints: [{name: sum, weights: {m4: 1, ppu1: 1}, "
                           "dq_max_rad_per_s: 4}]"),
            "device.yaml:13:18: virtual_joints[0]: key 'ddq_max_rad_per_s2' is missing\n"
            "device.yaml:13:47: virtual_joints[0].weights.ppu1: must be a manipulator joint, got "
            "'ppu1', did you mean 'm1'?");
  EXPECT_EQ(device_message(13,
                           "virtual_joints: [{name: sum, dq_max_rad_per_s: 4, "
                           "ddq_max_rad_per_s2: 4}]"),
            "device.yaml:13:18: virtual_joints[0]: at least one joint must have a weight");
  EXPECT_EQ(device_message(13,
                           "cartesian_limits: [{name: hand, frame: hand, x: {q_min_m: 1, "
                           "q_max_m: -1}}]"),
            "device.yaml:13:40: cartesian_limits[0].frame: must be a link of the URDF, got 'hand', "
            "did you mean 'handle'?\n"
            "device.yaml:13:71: cartesian_limits[0].x.q_max_m: q_max must not be below q_min, got "
            "-1 with q_min 1");
  EXPECT_EQ(device_message(13,
                           "cartesian_limits: [{name: hand, frame: handle, x: {q_min_m: 0, "
                           "q_max_m: 0.01}}]"),
            "device.yaml:13:51: cartesian_limits[0].x: the margin must leave some of the range");
}

constexpr const char* kLeverUrdf = R"(<robot name="lever"><link name="base"/>
<joint name="lever" type="revolute"><parent link="base"/><child link="handle"/>
<axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1" effort="1"/></joint>
<link name="handle"><inertial><mass value="5"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>
)";
constexpr const char* kLeverTwin = "name: lever\nurdf: lever.urdf\nend_effector: handle\n";

std::string script_message(const std::string& yaml) {
  SourceReader reader(
      {{"lever.urdf", kLeverUrdf}, {"lever.yaml", kLeverTwin}, {"script.yaml", yaml}});
  const Twin twin = load_twin("lever.yaml", reader);
  return message_of([&] { load_script("script.yaml", twin.model, reader); });
}

TEST(BadScript, ChannelsBelongToTheFrame) {
  EXPECT_EQ(script_message("frame: twin_joints\nsegments:\n"
                           "  - {start_s: 1, duration_s: 1, lever: 0.5}\n"),
            "no error");
  EXPECT_EQ(script_message("frame: twin_joint\n"),
            "script.yaml:1:8: frame: must be one of base, cylindrical, twin_joints, got "
            "'twin_joint', did you mean 'twin_joints'?");
  EXPECT_EQ(script_message("frame: twin_joints\nsegments:\n"
                           "  - {start_s: 1, duration_s: 1, levr: 0.5}\n"),
            "script.yaml:3:33: segments[0].levr: unknown key, did you mean 'lever'?");
  EXPECT_EQ(script_message("segments:\n  - {start_s: 1, duration_s: 1, by: {y_deg: 1}}\n"),
            "script.yaml:2:38: segments[0].by.y_deg: unknown key, did you mean 'y_m'?");
  EXPECT_EQ(script_message("frame: cylindrical\nsegments:\n"
                           "  - {start_s: 1, duration_s: 1, r_m: 1, circle_turns: 1}\n"),
            "script.yaml:3:41: segments[0].circle_turns: unknown key, did you mean 'duration_s'?");
}

TEST(BadScript, SegmentsMoveSomething) {
  EXPECT_EQ(script_message("segments:\n  - {start_s: 1, duration_s: 1}\n"),
            "script.yaml:2:5: segments[0]: a segment needs at least one channel");
}

TEST(BadScript, TimesAndValuesHaveRanges) {
  EXPECT_EQ(script_message("segments:\n  - {start_s: -1, duration_s: 0, grip: 2}\n"
                           "  - {duration_s: 1, x_m: 1}\n"),
            "script.yaml:2:15: segments[0].start_s: must be 0 .. 1e+05, got -1\n"
            "script.yaml:2:31: segments[0].duration_s: must be 1e-06 .. 1e+05, got 0\n"
            "script.yaml:2:40: segments[0].grip: must be 0 .. 1, got 2\n"
            "script.yaml:3:5: segments[1]: key 'start_s' is missing");
  EXPECT_EQ(script_message("hand: {stiffness_N_per_m: 200}\n"),
            "script.yaml:1:27: hand.stiffness_N_per_m: must be a list of three numbers [x, y, z], "
            "got '200'");
}

TEST(BadScript, AHandHasAPresetOrValuesOfAHand) {
  EXPECT_EQ(script_message("hand: {preset: stif}\n"),
            "script.yaml:1:16: hand.preset: must be one of relaxed, normal, stiff, got 'stif', did "
            "you mean 'stiff'?");
  EXPECT_EQ(script_message("hand: {mass_kg: [1, 0, 1], grip_stiffness_N_per_m: 0, tremor_N: -1}\n"
                           "grasp_s: -1\n"),
            "script.yaml:1:21: hand.mass_kg[1]: must be 1e-09 .. 1e+06, got 0\n"
            "script.yaml:1:52: hand.grip_stiffness_N_per_m: must be 1e-06 .. 1e+10, got 0\n"
            "script.yaml:1:65: hand.tremor_N: must be 0 .. 1e+07, got -1\n"
            "script.yaml:2:10: grasp_s: must be 0 .. 1e+05, got -1");
}

TEST(BadScript, AWalkIsACircleOrCheckpointsAndNothingElseMovesTheHandAlong) {
  EXPECT_EQ(script_message("walk: {speed_m_per_s: 1}\nduration_s: 9\n"),
            "script.yaml:1:7: walk: a walk needs one of circle_radius_m, checkpoints and doorway");
  EXPECT_EQ(script_message("walk: {circle_radius_m: 0.3}\nduration_s: 9\n"),
            "script.yaml:1:25: walk.circle_radius_m: so large that the body can walk inside the "
            "circle of its hand, at this speed");
  EXPECT_EQ(script_message("walk: {checkpoints: [{x_m: 1, y_m: 2, headin_rad: 0}]}\n"
                           "duration_s: 9\n"),
            "script.yaml:1:22: walk.checkpoints[0]: key 'heading_rad' is missing\n"
            "script.yaml:1:39: walk.checkpoints[0].headin_rad: unknown key, did you mean "
            "'heading_rad'?");
  EXPECT_EQ(script_message("walk: {circle_radius_m: 0.7}\n"),
            "script.yaml:1:7: walk: a walk needs duration_s");
  EXPECT_EQ(script_message("walk: {circle_radius_m: 0.7}\nduration_s: 9\nsegments:\n"
                           "  - {start_s: 1, duration_s: 1, z_m: -0.6}\n"),
            "no error");
  EXPECT_EQ(script_message("walk: {circle_radius_m: 0.7}\nduration_s: 9\nsegments:\n"
                           "  - {start_s: 1, duration_s: 1, y_m: 1}\n"),
            "script.yaml:4:3: segments: with a walk, no segment moves x_m, y_m or azimuth_rad, or "
            "has circle_turns");
  EXPECT_EQ(script_message("frame: cylindrical\nduration_s: 9\nwalk: {circle_radius_m: 0.7}\n"),
            "script.yaml:3:7: walk: a walk needs frame base");
}

std::string door_message(const std::string& yaml) {
  static const Twin door = load_twin("models/twins/door/twin.yaml");
  SourceReader reader(std::vector<SourceText>{{"script.yaml", yaml}});
  return message_of([&] { load_script("script.yaml", door.model, reader); });
}

TEST(BadScript, ADoorwayHasAHingeThatNothingElseMoves) {
  const std::string frame = "frame: twin_joints\nduration_s: 9\n";
  EXPECT_EQ(door_message(frame + "walk: {doorway: {hinge: hinge}}\nsegments:\n"
                                 "  - {start_s: 1, duration_s: 1, lever: 0.8}\n"),
            "no error");
  EXPECT_EQ(
      door_message(frame + "walk: {doorway: {hinge: hing}}\n"),
      "script.yaml:3:25: walk.doorway.hinge: must be a joint of the twin, got 'hing', did you "
      "mean 'hinge'?");
  EXPECT_EQ(door_message(frame + "walk: {doorway: {hinge: lever}}\n"),
            "script.yaml:3:7: walk: a doorway needs a vertical hinge beside the handle");
  EXPECT_EQ(door_message(frame + "walk: {doorway: {hinge: hinge, clear_width_m: 0.6}}\n"),
            "script.yaml:3:47: walk.doorway.clear_width_m: wide enough for a person");
  EXPECT_EQ(door_message("duration_s: 9\nwalk: {doorway: {hinge: hinge}}\n"),
            "script.yaml:2:7: walk: a doorway needs frame twin_joints");
  EXPECT_EQ(door_message(frame + "walk: {doorway: {hinge: hinge}}\nsegments:\n"
                                 "  - {start_s: 1, duration_s: 1, hinge: 0.8}\n"),
            "script.yaml:5:3: segments: at a doorway, no segment moves the hinge");
}

std::string scenario_message(const std::string& yaml) {
  return message_of([&] {
    load_scenario({{"run.yaml", yaml},
                   {"arm.urdf", text_of("models/haptic_giant/haptic_giant.urdf")},
                   {"device.yaml", device_text(1, "name: good")},
                   {"lever.urdf", kLeverUrdf},
                   {"lever.yaml", kLeverTwin},
                   {"script.yaml", "frame: twin_joints\n"},
                   {"bad_device.yaml", device_text(5, "handle: handel")},
                   {"bad_twin.yaml", std::string(kLeverTwin) + "gravity: 9.81\n"}});
  });
}

// `events` starts in line 7.
std::string event_message(const std::string& events) {
  return scenario_message(
      "title: a\ndescription: b\ndevice: device.yaml\ntwin: lever.yaml\nperson: script.yaml\n"
      "duration_s: 3\n" +
      events);
}

std::string when_message(const std::string& when) {
  return event_message("events:\n  - name: t_a\n    what: it happens\n    when: {" + when + "}\n");
}

TEST(BadScenario, AGoodOneIsTaken) {
  EXPECT_EQ(when_message("limit: lever, side: upper"), "no error");
  EXPECT_EQ(scenario_message("title: a\ndescription: b\ndevice: device.yaml\ntwin: lever.yaml\n"
                             "person: mouse\nduration_s: 3\n"),
            "no error");
}

TEST(BadScenario, UnknownNamesInEventsAreNamed) {
  EXPECT_EQ(when_message("limit: levre"),
            "run.yaml:10:19: events[0].when.limit: must be a limit, got 'levre', did you mean "
            "'lever'?");
  EXPECT_EQ(when_message("limit: lever, side: top"),
            "run.yaml:10:32: events[0].when.side: must be one of lower, upper, got 'top', did you "
            "mean 'lower'?");
  EXPECT_EQ(when_message("locked: m1, elapsed_s: 1"),
            "run.yaml:10:20: events[0].when.locked: must be a joint of the twin, got 'm1', did you "
            "mean 'lever'?");
  EXPECT_EQ(when_message("twin_above: {m2: 1}, elapsed_s: 1"),
            "run.yaml:10:25: events[0].when.twin_above.m2: must be a joint of the twin, got 'm2', "
            "did you mean 'lever'?");
  EXPECT_EQ(when_message("turns: {m1: one}, elapsed_s: 1"),
            "run.yaml:10:24: events[0].when.turns.m1: must be a number, got 'one'");
  EXPECT_EQ(when_message("force_above: 10, elapsed_s: 1"),
            "run.yaml:10:12: events[0].when.force_above: unknown key, did you mean "
            "'force_above_N'?");
}

TEST(BadScenario, EventsNeedNameSentenceAndConditions) {
  EXPECT_EQ(when_message("side: upper"),
            "run.yaml:10:11: events[0].when: an event needs at least one condition");
  EXPECT_EQ(event_message("events: [{name: t_a}]\n"),
            "run.yaml:7:10: events[0]: key 'what' is missing\n"
            "run.yaml:7:10: events[0]: key 'when' is missing");
  EXPECT_EQ(event_message("events: [t_a]\n"),
            "run.yaml:7:10: events[0]: must be a map of keys, got 't_a'");
}

TEST(BadScenario, FaultsOfItsFilesAreReportedTogether) {
  EXPECT_EQ(scenario_message("title: a\ndescription: b\ndevice: bad_device.yaml\n"
                             "twin: bad_twin.yaml\nperson: missing.yaml\nduration_s: 0\n"),
            "run.yaml:5:9: person: no such file, got 'missing.yaml'\n"
            "run.yaml:6:13: duration_s: must be 1e-06 .. 1e+05, got 0\n"
            "bad_device.yaml:5:9: handle: must be a link of the URDF, got 'handel', did you mean "
            "'handle'?\n"
            "bad_twin.yaml:4:10: gravity: must be true or false, got '9.81'");
}

TEST(BadScenario, NamesOfLimitsAreUnique) {
  const std::string urdf = text_of("models/haptic_giant/haptic_giant.urdf");
  std::string twin_urdf = kLeverUrdf;
  twin_urdf.replace(twin_urdf.find("joint name=\"lever\""), 18, "joint name=\"m1\"");
  const std::string message = message_of([&] {
    load_scenario({{"run.yaml",
                    "title: a\ndescription: b\ndevice: device.yaml\ntwin: lever.yaml\n"
                    "person: none\nduration_s: 1\n"},
                   {"arm.urdf", urdf},
                   {"device.yaml", device_text(1, "name: good")},
                   {"lever.urdf", twin_urdf},
                   {"lever.yaml", kLeverTwin}});
  });
  EXPECT_EQ(message,
            "run.yaml:4:7: twin: device and twin together must not use a name twice, got 'm1'");
}

}  // namespace
}  // namespace hg::config
