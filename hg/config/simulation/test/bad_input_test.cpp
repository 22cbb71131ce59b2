#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/script.h"
#include "hg/config/twin.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

constexpr const char* kDoorUrdf = R"(<robot name="door">
<link name="base"/>
<joint name="hinge" type="revolute"><parent link="base"/><child link="leaf"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1.75" velocity="1.2" effort="1"/></joint>
<link name="leaf"><inertial><mass value="5"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="bolt" type="prismatic"><parent link="leaf"/><child link="handle"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.1" velocity="1" effort="1"/></joint>
<link name="handle"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>
)";

// What is wrong with door.yaml when it has this text.
std::string twin_message(const std::string& yaml) {
  SourceReader reader({{"door.urdf", kDoorUrdf}, {"door.yaml", yaml}});
  return message_of([&] { load_twin("door.yaml", reader); });
}

// The same with lines that make a good file as long as `rest` is good; `rest` starts in line 4.
std::string door_message(const std::string& rest) {
  return twin_message("name: door\nurdf: door.urdf\nend_effector: handle\n" + rest);
}

struct Case {
  const char* name;
  const char* yaml;
  const char* message;
};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

class BadTwin : public testing::TestWithParam<Case> {};

TEST_P(BadTwin, IsRefusedWithPlaceRuleValueAndNearestName) {
  EXPECT_EQ(door_message(GetParam().yaml), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Config, BadTwin,
    testing::Values(
        Case{"Good", "joints:\n  hinge: {damping_Nms_per_rad: 1}\n", "no error"},
        Case{"UnknownKey", "joint:\n  hinge: {}\n",
             "door.yaml:4:1: joint: unknown key, did you mean 'joints'?"},
        Case{"UnknownKeyInside", "joints:\n  hinge: {dampng_Nms_per_rad: 1}\n",
             "door.yaml:5:11: joints.hinge.dampng_Nms_per_rad: unknown key, did you mean "
             "'damping_Nms_per_rad'?"},
        Case{"WrongUnit", "joints:\n  hinge: {q_max_deg: 90}\n",
             "door.yaml:5:11: joints.hinge.q_max_deg: unknown key, did you mean 'q_max_rad'?"},
        Case{"UnitOfTheOtherJointType", "joints:\n  bolt: {q_max_rad: 0.05}\n",
             "door.yaml:5:10: joints.bolt.q_max_rad: unknown key, did you mean 'q_max_m'?"},
        Case{"LengthOfARevoluteJoint", "joints:\n  hinge: {damping_Ns_per_m: 1}\n",
             "door.yaml:5:11: joints.hinge.damping_Ns_per_m: unknown key, did you mean "
             "'damping_Nms_per_rad'?"},
        Case{"DuplicateKey", "gravity: true\njoints: {}\ngravity: false\n",
             "door.yaml:6:1: gravity: given twice, first in line 4"},
        Case{"DuplicateJoint", "joints:\n  hinge: {}\n  hinge: {}\n",
             "door.yaml:6:3: joints.hinge: given twice, first in line 5"},
        Case{"KeyThatIsNoWord", "[1, 2]: 3\n", "door.yaml:4:1: a key must be a word, got a list"},
        Case{"ValueWithUnit", "joints:\n  hinge: {start_rad: 15 deg}\n",
             "door.yaml:5:22: joints.hinge.start_rad: must be a number in rad, got '15 deg'"},
        Case{"WordForANumber", "placement: {x_m: left}\n",
             "door.yaml:4:18: placement.x_m: must be a number in m, got 'left'"},
        Case{"QuotedNumber", "placement: {x_m: \"1\"}\n",
             "door.yaml:4:18: placement.x_m: must be a number in m, got '1'"},
        Case{"CommaForPoint", "placement:\n  x_m: 1,5\n",
             "door.yaml:5:8: placement.x_m: must be a number in m, got '1,5'"},
        Case{"NumberThatIsMissing", "placement:\n  x_m:\n  y_m: 1\n",
             "door.yaml:6:3: placement.x_m: must be a number in m, got nothing"},
        Case{"ListForANumber", "placement: {x_m: [1]}\n",
             "door.yaml:4:18: placement.x_m: must be a number in m, got a list"},
        Case{"NumberForAMap", "placement: 3\n",
             "door.yaml:4:12: placement: must be a map of keys, got '3'"},
        Case{"NumberForAMapOfNames", "joints: 3\n",
             "door.yaml:4:9: joints: must be a map with names as keys, got '3'"},
        Case{"MapForAList", "locks: {name: x}\n",
             "door.yaml:4:8: locks: must be a list, got a map"},
        Case{"WordForAFlag", "gravity: yes\n",
             "door.yaml:4:10: gravity: must be true or false, got 'yes'"},
        Case{"NotANumber", "joints:\n  hinge: {rest_rad: .nan}\n",
             "door.yaml:5:21: joints.hinge.rest_rad: must be -1000 .. 1000, got .nan"},
        Case{"NotANumberForALimit", "joints:\n  hinge: {q_max_rad: .nan}\n",
             "door.yaml:5:22: joints.hinge.q_max_rad: must be -1000 .. 1000, .inf or -.inf, got "
             ".nan"},
        Case{"Infinite", "placement: {z_m: -.inf}\n",
             "door.yaml:4:18: placement.z_m: must be -1000 .. 1000, got -.inf"},
        Case{"InfiniteDamping", "joints:\n  hinge: {damping_Nms_per_rad: .inf}\n",
             "door.yaml:5:32: joints.hinge.damping_Nms_per_rad: must be 0 .. 1e+09, got .inf"},
        Case{"TooLargeForANumber", "placement: {z_m: 1e999}\n",
             "door.yaml:4:18: placement.z_m: must be a number in m, got '1e999'"},
        Case{"Negative", "joints:\n  hinge: {damping_Nms_per_rad: -1}\n",
             "door.yaml:5:32: joints.hinge.damping_Nms_per_rad: must be 0 .. 1e+09, got -1"},
        Case{
            "ZeroSpeed", "joints:\n  hinge: {dq_max_rad_per_s: 0}\n",
            "door.yaml:5:29: joints.hinge.dq_max_rad_per_s: must be 1e-06 .. 10000 or .inf, got 0"},
        Case{"ReversedLimits", "joints:\n  hinge: {q_min_rad: 1, q_max_rad: 0.5}\n",
             "door.yaml:5:36: joints.hinge.q_max_rad: q_max must not be below q_min, got 0.5 with "
             "q_min 1"},
        Case{"LimitBeyondThatOfTheUrdf", "joints:\n  hinge: {q_min_rad: 2}\n",
             "door.yaml:5:10: joints.hinge: q_max must not be below q_min, got 1.75 with q_min 2"},
        Case{"StartOutsideTheLimits", "joints:\n  hinge: {start_rad: 1.8}\n",
             "door.yaml:5:22: joints.hinge.start_rad: the start must be within the limits, got "
             "1.8"},
        Case{"NoStartAtAll", "joints:\n  hinge: {q_min_rad: 0.1}\n", "no error"},
        Case{"UnknownJoint", "joints:\n  hing: {}\n",
             "door.yaml:5:3: joints.hing: must be a joint of the twin, got 'hing', did you mean "
             "'hinge'?"},
        Case{"LockOnUnknownJoint", "locks:\n  - {name: lock, joint: henge}\n",
             "door.yaml:5:25: locks[0].joint: must be a joint of the twin, got 'henge', did you "
             "mean 'hinge'?"},
        Case{"LockWithoutJoint", "locks:\n  - {name: lock}\n",
             "door.yaml:5:5: locks[0]: key 'joint' is missing"},
        Case{"LockOutsideTheLimits", "locks:\n  - {name: lock, joint: hinge, position_rad: 2}\n",
             "door.yaml:5:46: locks[0].position_rad: must be within the limits of the joint, got "
             "2"},
        Case{"ConditionOnUnknownJoint",
             "locks:\n  - name: lock\n    joint: hinge\n    engaged_while:\n"
             "      bolts: {below_m: 1}\n",
             "door.yaml:8:7: locks[0].engaged_while.bolts: must be a joint of the twin, got "
             "'bolts', did you mean 'bolt'?"},
        Case{"ConditionWithoutRange",
             "locks:\n  - name: lock\n    joint: hinge\n    engaged_while:\n      bolt: {}\n",
             "door.yaml:8:13: locks[0].engaged_while.bolt: the condition needs 'above' or 'below', "
             "and something between them"},
        Case{"TooManyLocks",
             "locks:\n  - {name: a, joint: hinge}\n  - {name: b, joint: hinge}\n"
             "  - {name: c, joint: hinge}\n  - {name: d, joint: hinge}\n"
             "  - {name: e, joint: hinge}\n",
             "door.yaml:5:3: locks: at most 4 are possible"},
        Case{"RatchetWithoutTeeth", "locks:\n  - {name: pawl, joint: hinge, free: upper}\n",
             "door.yaml:5:38: locks[0].free: is about a ratchet, which needs 'teeth'"},
        Case{"ProfileWithoutPoints", "joints:\n  hinge: {profile: {repeat_rad: 0.2}}\n",
             "door.yaml:5:20: joints.hinge.profile: key 'points' is missing"},
        Case{"ProfileOfOnePoint",
             "joints:\n  hinge:\n    profile: {points: [{at_rad: 0, torque_Nm: 1}]}\n",
             "door.yaml:6:23: joints.hinge.profile.points: a profile needs 2 .. 100 points, got 1"},
        Case{"ProfileInTheUnitOfASlide",
             "joints:\n  hinge:\n    profile: {points: [{at_m: 0}, {at_rad: 1}]}\n",
             "door.yaml:6:24: joints.hinge.profile.points[0]: key 'at_rad' is missing\n"
             "door.yaml:6:25: joints.hinge.profile.points[0].at_m: unknown key, did you mean "
             "'at_rad'?"},
        Case{"FreeBodyWithoutMass", "free_body: {mass_kg: 0}\n",
             "door.yaml:4:22: free_body.mass_kg: must be 1e-09 .. 1e+06, got 0"},
        Case{"VectorTooShort", "free_body: {inertia_kg_m2: [1, 2]}\n",
             "door.yaml:4:28: free_body.inertia_kg_m2: must be a list of three numbers [x, y, z], "
             "got 2 of them"},
        Case{"VectorElement", "free_body:\n  inertia_kg_m2: [1, 0, one]\n",
             "door.yaml:5:22: free_body.inertia_kg_m2[1]: must be 1e-15 .. 1e+09, got 0\n"
             "door.yaml:5:25: free_body.inertia_kg_m2[2]: must be a number in kg m^2, got 'one'"},
        Case{"LongValueIsCut", "placement: {x_m: 0123456789012345678901234567890123456789-end}\n",
             "door.yaml:4:18: placement.x_m: must be a number in m, got "
             "'0123456789012345678901234567890123456789...'"},
        Case{"SeveralAtOnce",
             "joints:\n  hinge:\n    q_max_deg: 90\n    damping_Nms_per_rad: -1\n  lever: {}\n"
             "gravty: true\nplacement: {x_m: 1 m}\n",
             "door.yaml:6:5: joints.hinge.q_max_deg: unknown key, did you mean 'q_max_rad'?\n"
             "door.yaml:7:26: joints.hinge.damping_Nms_per_rad: must be 0 .. 1e+09, got -1\n"
             "door.yaml:8:3: joints.lever: must be a joint of the twin, got 'lever', did you mean "
             "'hinge'?\n"
             "door.yaml:9:1: gravty: unknown key, did you mean 'gravity'?\n"
             "door.yaml:10:18: placement.x_m: must be a number in m, got '1 m'"}),
    name_of);

TEST(BadFile, EveryKindOfUnreadableFileIsNamed) {
  SourceReader nothing{std::vector<SourceText>{}};
  EXPECT_EQ(message_of([&] { load_twin("missing.yaml", nothing); }), "missing.yaml: no such file");
  EXPECT_EQ(twin_message(""), "door.yaml:1:1: the file must be a map of keys, got nothing");
  EXPECT_EQ(twin_message("# nothing but a comment\n"),
            "door.yaml:1:1: the file must be a map of keys, got nothing");
  EXPECT_EQ(twin_message("just text\n"),
            "door.yaml:1:1: the file must be a map of keys, got 'just text'");
  EXPECT_EQ(twin_message("name: door\nurdf: [1, 2\n"),
            "door.yaml:3:1: not valid YAML: end of sequence flow not found");
  EXPECT_EQ(twin_message("name: door\n\turdf: x\n"),
            "door.yaml:2:1: not valid YAML: illegal tab when looking for indentation");
  EXPECT_EQ(twin_message("name: a\n---\nname: b\n"),
            "door.yaml:2:1: the file must be one map, but it has ended before this");
  EXPECT_EQ(twin_message("name: a\n}\nurdf: b\n"),
            "door.yaml:2:1: not valid YAML: illegal flow end");
  EXPECT_EQ(twin_message("{name: a}\nurdf: b\n"),
            "door.yaml:2:1: the file must be one map, but it has ended before this");
}

TEST(BadFile, TextOfAnotherEncodingIsNamed) {
  EXPECT_EQ(twin_message("name: T\xfcr\nurdf: door.urdf\nend_effector: handle\n"),
            "door.yaml:1:7: name: must be UTF-8, got 'T\\xfcr'");
  EXPECT_EQ(twin_message("name: T\u00fcr # \u009b\nurdf: door.urdf\nend_effector: handle\n"),
            "no error");
}

TEST(BadFile, MissingKeysAreNamedAtTheMapThatNeedsThem) {
  EXPECT_EQ(twin_message("urdf: door.urdf\n"),
            "door.yaml:1:1: key 'name' is missing\n"
            "door.yaml:1:1: key 'end_effector' is missing");
  EXPECT_EQ(twin_message("name: door\nend_effector: handle\n"),
            "door.yaml:1:1: a twin needs 'urdf' or 'free_body'");
}

TEST(BadFile, FilesThatItNamesMustExist) {
  EXPECT_EQ(twin_message("name: door\nurdf: dor.urdf\nend_effector: handle\n"),
            "door.yaml:2:7: urdf: no such file, got 'dor.urdf'");
  // beside files on disk the nearest name is known
  const std::string message = message_of([] { load_twin("hg/config/test/data/typo.yaml"); });
  EXPECT_EQ(message,
            "hg/config/test/data/typo.yaml:2:7: urdf: no such file, got "
            "'../../../../models/twins/door/dor.urdf', did you mean 'door.urdf'?");
}

TEST(BadFile, FaultsAreDataToo) {
  const std::string file = "my: door:7: .yaml";
  SourceReader reader(
      {{"door.urdf", kDoorUrdf},
       {file, "name: door\nurdf: dor.urdf\nend_effector: handle\n\"gra: vty\": 1\n"}});
  try {
    load_twin(file, reader);
    FAIL() << "must be refused";
  } catch (const SetupError& error) {
    const std::vector<InputFault> faults = faults_of(error);
    ASSERT_EQ(faults.size(), 2u) << error.what();
    EXPECT_EQ(faults[0].file, file);
    EXPECT_EQ(faults[0].line, 2);
    EXPECT_EQ(faults[0].column, 7);
    EXPECT_EQ(faults[0].item, "urdf");
    EXPECT_TRUE(faults[0].is_missing_file);
    EXPECT_EQ(faults[1].line, 4);
    EXPECT_EQ(faults[1].item, "gra: vty");
    EXPECT_EQ(faults[1].what, "unknown key, did you mean 'gravity'?");
    EXPECT_EQ(faults[1].meant, "gravity");
    EXPECT_FALSE(faults[1].is_missing_file);
  }
}

TEST(BadFile, FaultsOfAUrdfKeepTheirPlaceInTheFileThatNamesIt) {
  SourceReader reader(
      {{"door.urdf", "<robot name=\"door\">\n<link name=\"a: 1\"/><link name=\"a: 1\"/></robot>"},
       {"door.yaml", "name: door\nurdf: door.urdf\nend_effector: handle\n"}});
  try {
    load_twin("door.yaml", reader);
    FAIL() << "must be refused";
  } catch (const SetupError& error) {
    const InputFault fault = faults_of(error).back();
    EXPECT_EQ(fault.file, "door.urdf");
    EXPECT_EQ(fault.line, 2);
    EXPECT_EQ(fault.item, "link a: 1");
    EXPECT_EQ(fault.what, "name is taken already in line 2");
  }
}

TEST(BadFile, AUrdfSpeaksForItself) {
  SourceReader reader({{"door.urdf", "<robot name=\"door\"><link/></robot>"},
                       {"door.yaml", "name: door\nurdf: door.urdf\nend_effector: handle\n"}});
  const std::string message = message_of([&] { load_twin("door.yaml", reader); });
  EXPECT_EQ(message.substr(0, 12), "door.urdf:1:") << message;
}

}  // namespace
}  // namespace hg::config
