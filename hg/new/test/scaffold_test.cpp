#include "hg/new/scaffold.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hg/check/scenario_inspection.h"
#include "hg/config/actuator_library.h"
#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/scenario/start_posture.h"
#include "hg/workspace/postures.h"

namespace hg::new_files {
namespace {

namespace fs = std::filesystem;

const ChainPart kGiant = {"models/haptic_giant/haptic_giant.urdf", "", ""};
const ChainPart kArm = {"models/examples/arm.urdf", "", ""};
const ChainPart kGate = {"models/examples/gate.urdf", "", ""};

TEST(Scaffold, DeviceOfAnArmLoadsAndLeavesItsSingularities) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("arm.yaml", draft_device(kArm, folder.path(), Drives::kIdeal, "").device);
  const config::DeviceConfig device = config::load_device(file);
  EXPECT_EQ(device.model.n_p, 0);
  EXPECT_EQ(device.model.n_m, 6);
  EXPECT_EQ(device.floor_z, -0.75);  // a person stands beside its table
  for (int i : {2, 4}) {             // elbow and wrist_bend are singular at 0
    const limits::JointLimits& range = device.model.joint_limits[i];
    EXPECT_FALSE(Interval({range.q_min, range.q_max}).contains(0.0)) << i;
    EXPECT_TRUE(Interval({range.q_min, range.q_max}).contains(device.model.posture[i])) << i;
  }
  model::ChainData chain(device.model.chain);
  EXPECT_GT(workspace::dexterity(chain, device.model.handle, 0, device.model.posture), 0.05);
}

// The example arm, its wrist beside the line of the forearm.
ChainPart arm_with_offset(const TemporaryFolder& folder, double offset) {
  std::string urdf = read_file(kArm.urdf);
  const std::string wrist = "<origin xyz=\"0 0 0.45\"/>";
  urdf.replace(urdf.find(wrist), wrist.size(), fmt::format("<origin xyz=\"{} 0 0.45\"/>", offset));
  return {folder.write("arm.urdf", urdf), "", ""};
}

// Its elbow is singular where shoulder, elbow and wrist are in line: at no quarter of a turn.
TEST(Scaffold, TheElbowOfAForearmWithAnOffsetIsFoundAndLeft) {
  for (const double offset : {0.05, 0.1, -0.08, 0.3}) {
    const TemporaryFolder folder;
    const ChainPart part = arm_with_offset(folder, offset);
    const model::ChainModel chain = read_part(part);
    const double stretched = -std::atan2(offset, 0.45);
    const auto found =
        workspace::singular_values(chain, chain.frame("handle"), 0, workspace::joint_ranges(chain));
    const auto elbow = std::ranges::find_if(found, [&](const workspace::SingularValue& s) {
      return s.joint == 2 && s.other < 0 && std::abs(s.value - stretched) < 1e-6;
    });
    EXPECT_NE(elbow, found.end()) << offset;
    const config::DeviceConfig device = config::load_device(
        folder.write("arm.yaml", draft_device(part, folder.path(), Drives::kIdeal, "").device));
    const limits::JointLimits& range = device.model.joint_limits[2];
    EXPECT_FALSE(Interval({range.q_min - 0.15, range.q_max + 0.15}).contains(stretched)) << offset;
    EXPECT_TRUE(Interval({range.q_min, range.q_max}).contains(device.model.posture[2])) << offset;
  }
}

// The shapes may be meshes or stand in the URDF: runs begin where no parts are near.
TEST(Scaffold, APostureIsClearOfTheDeviceAndOfItsTable) {
  for (const char* urdf :
       {"models/arms/ur5e/ur5e.urdf", "models/arms/gen3/gen3.urdf", "models/arms/fr3/fr3.urdf",
        "models/arms/xarm7/xarm7.urdf", "models/haptic_giant/haptic_giant.urdf"}) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "arm.yaml", draft_device({urdf, "", ""}, folder.path(), Drives::kIdeal, "").device);
    const config::DeviceConfig device = config::load_device(file);
    ASSERT_FALSE(device.collision.pairs.watched.empty()) << urdf;
    Eigen::VectorXd q(device.model.chain.nq());
    for (int i = 0; i < device.model.n_p; ++i) {
      q[i] = 0.5 * (device.model.gantry_range[i].lb + device.model.gantry_range[i].ub);
    }
    q.tail(device.model.n_m) = device.model.posture;
    model::ChainData now(device.model.chain), other(device.model.chain);
    now.update_poses(q);
    for (const collision::Pair& pair : device.collision.pairs.watched) {
      const collision::Nearest nearest(device.collision.shapes, {pair});
      double most = 0.0;
      for (const double angle : {-2.0, -1.0, 0.5, 1.5, 2.5}) {
        q.tail(device.model.n_m).setConstant(angle);
        other.update_poses(q);
        most = std::max(most, nearest.distance(other));
      }
      EXPECT_GE(nearest.distance(now), std::min(0.05, 0.4 * most)) << urdf;
    }
  }
}

// the device that is drafted for the example arm
config::SimulatedDeviceConfig drafted_arm(Drives drives) {
  const TemporaryFolder folder;
  const DeviceFiles files = draft_device(kArm, folder.path(), drives, "simulation.yaml");
  if (!files.simulation.empty()) folder.write("simulation.yaml", files.simulation);
  return config::load_simulated_device(folder.write("arm.yaml", files.device));
}

TEST(Scaffold, ADraftedArmIsSimulatedWithTheDrivesThatAreAskedFor) {
  EXPECT_EQ(plant_of(drafted_arm(Drives::kIdeal)), config::PlantKind::kIdeal);
  EXPECT_EQ(plant_of(drafted_arm(Drives::kTorque)), config::PlantKind::kTorqueDrives);
  const config::SimulatedDeviceConfig arm = drafted_arm(Drives::kPosition);
  EXPECT_EQ(plant_of(arm), config::PlantKind::kPositionDrives);
  const auto& actuators = arm.simulation.drives.actuators;
  ASSERT_EQ(actuators.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const model::Joint& joint = arm.model.chain.joints()[i];
    EXPECT_NEAR(actuators[i].torque_max, joint.effort_max, 0.05 * joint.effort_max) << joint.name;
    EXPECT_GT(actuators[i].coulomb_friction, 0.0) << joint.name;
  }
}

TEST(Scaffold, TheNearestJointOfTheLibraryIsScaledToTheRating) {
  const auto library = config::load_actuator_library("models/actuators.yaml");
  const config::ActuatorType type = config::actuator_for(library, 72.0, 2.0);
  EXPECT_EQ(type.name, "strain wave 17");
  EXPECT_EQ(type.model.torque_max, 72.0);
  EXPECT_NEAR(type.model.stiffness, 10000.0 * 72.0 / 70.0, 1e-6);
  EXPECT_EQ(type.model.speed_full_torque, 2.0);
  EXPECT_GT(type.model.speed_no_load, 2.0);
}

TEST(Scaffold, LeadingPrismaticJointsAreTheGantry) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("giant.yaml", draft_device(kGiant, folder.path(), Drives::kIdeal, "").device);
  const config::DeviceConfig device = config::load_device(file);
  EXPECT_EQ(device.model.n_p, 2);
  ASSERT_EQ(device.model.virtual_joints.size(), 1u);  // q4 + q5, as [HG] VI-C3
  const VectorM& weights = device.model.virtual_joints[0].weights;
  EXPECT_EQ(weights[3], 1.0);
  EXPECT_EQ(weights[4], 1.0);
  EXPECT_EQ(weights.sum(), 2.0);
  EXPECT_GT(device.model.virtual_joints[0].limits.q_min, 0.0);
  EXPECT_LT(device.model.virtual_joints[0].limits.q_max, M_PI);
}

TEST(Scaffold, SingularValuesOfTheGiantAreThoseOfItsDeterminant) {
  // [HANDBOOK] 2.4: det J = -L1 L2 L4 sin q2 sin q4 sin(q4 + q5)
  const model::ChainModel chain = read_part(kGiant);
  const std::vector<Interval> turns(8, Interval{-3.0, 3.0});
  const auto found = workspace::singular_values(chain, chain.frame("handle"), 2, turns);
  const auto contains = [&](int joint, int other, double value) {
    return std::ranges::any_of(found, [&](const workspace::SingularValue& s) {
      return s.joint == joint && s.other == other && std::abs(s.value - value) < 1e-9;
    });
  };
  EXPECT_TRUE(contains(3, -1, 0.0));  // q2
  EXPECT_TRUE(contains(5, -1, 0.0));  // q4
  EXPECT_TRUE(contains(5, 6, 0.0));   // q4 + q5
  EXPECT_TRUE(contains(5, 6, M_PI));
  EXPECT_TRUE(contains(5, 6, -M_PI));
  EXPECT_FALSE(contains(7, -1, 0.0));
  EXPECT_EQ(found.size(), 5u);
}

TEST(Scaffold, TwinIsPlacedWhereTheDeviceReachesIt) {
  const TemporaryFolder folder;
  const auto device_file =
      folder.write("arm.yaml", draft_device(kArm, folder.path(), Drives::kIdeal, "").device);
  for (const fs::path& device : {device_file, fs::path("models/haptic_giant/device.yaml")}) {
    config::Scenario scenario{
        .title = {},
        .description = {},
        .device = config::load_simulated_device(device),
        .twin = config::load_twin(folder.write(
            "gate.yaml",
            draft_twin(kGate, folder.path(), config::load_simulated_device(device)).yaml)),
        .script = {},
        .limits = {},
        .events = {},
        .changes = {},
        .sources = {},
        .places = {}};
    EXPECT_NO_THROW(scenario::find_start(scenario.device, scenario.twin)) << device;
    EXPECT_EQ(scenario.twin.model.dofs[0].limits.q_max, 1.2);
    EXPECT_GT(scenario.twin.model.dofs[0].damping, 0.0);

    // the tip, 0.45 m from the hinge, stays below what the hand may do
    EXPECT_LT(0.45 * scenario.twin.model.dofs[0].limits.ddq_max, 5.0);
    EXPECT_LT(0.45 * scenario.twin.model.dofs[0].limits.dq_max, 1.5);
  }
}

// The box of the hand promises more than the first joint of this arm can give.
TEST(Scaffold, TheTwinAsksNoMoreThanEveryJointCanGive) {
  const TemporaryFolder folder;
  auto device = config::load_simulated_device(
      folder.write("arm.yaml", draft_device(kArm, folder.path(), Drives::kIdeal, "").device));
  device.model.joint_limits[0].ddq_max = 1.0;
  const config::Twin twin =
      config::load_twin(folder.write("gate.yaml", draft_twin(kGate, folder.path(), device).yaml));
  const check::Match match = check::match(device, twin);
  ASSERT_EQ(match.demands.size(), 1u);
  EXPECT_LE(match.demands[0].acceleration, 1.0);
  EXPECT_LE(match.demands[0].speed, 1.0);
  EXPECT_LE(match.demands[0].joint_acceleration, 1.0);
  EXPECT_GT(match.demands[0].joint_acceleration, 0.8);  // and not much less
}

// A handle at the end of a light bar shakes in a hand on this arm, whose sensor and drives are
// late.
TEST(Scaffold, AMechanismThatShakesIsMadeHeavier) {
  const TemporaryFolder folder;
  const auto urdf = folder.write("lever.urdf", R"(<robot name="lever"><link name="frame"/>
    <link name="bar"><inertial><origin xyz="0 0 0.2"/><mass value="1.5"/>
      <inertia ixx="0.03" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="pivot" type="revolute"><parent link="frame"/><child link="bar"/>
      <axis xyz="1 0 0"/><limit lower="-0.5" upper="0.5" velocity="2" effort="100"/></joint>
    <link name="handle"/><joint name="grip" type="fixed"><parent link="bar"/><child link="handle"/>
      <origin xyz="0 0 0.35" rpy="1.5708 0 1.5708"/></joint></robot>)");
  const auto device = config::load_simulated_device("models/arms/ur5e/device.yaml");
  const TwinDraft draft = draft_twin({urdf, "", ""}, folder.path(), device);
  EXPECT_EQ(draft.problem, "");
  EXPECT_NE(draft.note.find("times as heavy as in its URDF"), std::string::npos) << draft.note;
  const config::Twin twin = config::load_twin(folder.write("lever.yaml", draft.yaml));
  EXPECT_GT(twin.model.mass_scale, 1.0);
}

TEST(Scaffold, AJointWithDynamicsKeepsThem) {
  const TemporaryFolder folder;
  std::string urdf = read_file("models/examples/gate.urdf", 1'000'000);
  const std::string end = "effort=\"100\"/>";
  urdf.insert(urdf.find(end) + end.size(), R"(<dynamics damping="0.7" friction="0.3"/>)");
  const ChainPart gate = {folder.write("gate.urdf", urdf), "", ""};
  const auto device = config::load_simulated_device("models/haptic_giant/device.yaml");
  const config::Twin twin =
      config::load_twin(folder.write("gate.yaml", draft_twin(gate, folder.path(), device).yaml));
  EXPECT_EQ(twin.model.dofs[0].damping, 0.7);
  EXPECT_EQ(twin.model.dofs[0].friction, 0.3);
}

TEST(Scaffold, LengthsThatCanOnlyBeOfAnotherUnitAreDoubted) {
  const TemporaryFolder folder;
  const auto device = config::load_simulated_device("models/haptic_giant/device.yaml");
  const std::string gate = read_file(kGate.urdf);
  const auto doubt_of = [&](const std::string& from, const std::string& to) {
    std::string urdf = gate;
    urdf.replace(urdf.find(from), from.size(), to);
    return draft_twin({folder.write("gate.urdf", urdf), "", ""}, folder.path(), device).doubt;
  };
  EXPECT_EQ(doubt_of("0.45 0.05 0", "0.45 0.05 0"), "");
  EXPECT_NE(doubt_of("0.45 0.05 0", "450 50 0").find("are the lengths of the URDF millimetres?"),
            std::string::npos);
  EXPECT_NE(doubt_of("0.45 0.05 0", "0 0 0.3").find("handle is on the axis of hinge"),
            std::string::npos);
}

TEST(Scaffold, AUrdfBehindASymbolicLinkIsFound) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "v2");
  fs::copy_file("models/examples/gate.urdf", folder.path() / "v2" / "gate_v2.urdf");
  fs::create_symlink("v2/gate_v2.urdf", folder.path() / "gate.urdf");
  const auto device = config::load_simulated_device("models/haptic_giant/device.yaml");
  const TwinDraft draft = draft_twin({folder.path() / "gate.urdf", "", ""}, folder.path(), device);
  EXPECT_EQ(draft.problem, "");
  EXPECT_NO_THROW(config::load_twin(folder.write("gate.yaml", draft.yaml)));
}

TEST(Scaffold, ADraftThatCannotBeTriedIsWrittenWithTheReason) {
  const TemporaryFolder folder;
  auto device = config::load_simulated_device("models/haptic_giant/device.yaml");
  device.control.loop.latency = 0.5;  // no stable torque loop
  const TwinDraft draft = draft_twin(kGate, folder.path(), device);
  EXPECT_NE(draft.problem.find("latency"), std::string::npos) << draft.problem;
  EXPECT_NO_THROW(config::load_twin(folder.write("gate.yaml", draft.yaml)));
}

TEST(Scaffold, TooFewJointsAreRefusedWithAdvice) {
  const std::string message =
      message_of([] { draft_device(kGate, ".", Drives::kIdeal, "").device; });
  EXPECT_NE(message.find("six or seven manipulator joints"), std::string::npos) << message;
  EXPECT_NE(message.find("--tip-link"), std::string::npos) << message;
}

// A URDF of a whole robot: a screen ("ee") and a handle on links that the arm does not move.
TEST(Scaffold, TheHandleIsAFrameThatTheWholeArmMoves) {
  const TemporaryFolder folder;
  std::string urdf = read_file(kArm.urdf);
  const std::size_t end = urdf.rfind("</robot>");
  ASSERT_NE(end, std::string::npos);
  const std::string root = model::ChainModel::from_urdf_file(kArm.urdf, {}).frame_names()[0];
  for (const char* name : {"screen", "cart_handle"}) {
    urdf.insert(end, std::string("<link name='") + name + "'/><joint name='to_" + name +
                         "' type='fixed'><parent link='" + root + "'/><child link='" + name +
                         "'/></joint>");
  }
  const auto file = folder.write("robot.urdf", urdf);
  const auto device = config::load_device(folder.write(
      "robot.yaml", draft_device({file, "", ""}, folder.path(), Drives::kIdeal, "").device));
  const std::string handle = device.model.chain.frame_names()[device.model.handle];
  EXPECT_EQ(handle, "handle");
}

TEST(Scaffold, AnArmThatMovesInAPlaneIsRefused) {
  const TemporaryFolder folder;
  std::string urdf = "<robot name='flat'><link name='l0'/>";
  for (int i = 1; i <= 6; ++i) {
    urdf += fmt::format(
        "<link name='l{1}'><inertial><mass value='1'/><inertia ixx='0.01' iyy='0.01' izz='0.01' "
        "ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j{1}' type='revolute'>"
        "<parent link='l{0}'/><child link='l{1}'/><origin xyz='0.2 0 0'/><axis xyz='0 0 1'/>"
        "<limit lower='-2' upper='2' effort='9' velocity='2'/></joint>",
        i - 1, i);
  }
  const auto file = folder.write("flat.urdf", urdf + "</robot>");
  const std::string message = message_of([&] {
    draft_device({file, "", ""}, folder.path(), Drives::kIdeal, "");
  });
  EXPECT_NE(message.find("hardly move 'l6' along z"), std::string::npos) << message;
}

TEST(Scaffold, NamesAreQuotedWhereYamlNeedsIt) {
  EXPECT_EQ(quoted("joint_1"), "joint_1");
  EXPECT_EQ(quoted("../a b.urdf"), "'../a b.urdf'");
  EXPECT_EQ(quoted("on"), "'on'");
  EXPECT_EQ(quoted("1st"), "'1st'");
  EXPECT_EQ(quoted("it's"), "'it''s'");
  EXPECT_EQ(quoted(""), "''");
}

TEST(Scaffold, NumbersHaveTwoDigits) {
  EXPECT_EQ(rounded(0.0), "0");
  EXPECT_EQ(rounded(123.4), "120");
  EXPECT_EQ(rounded(-0.002345), "-0.0023");
  EXPECT_EQ(rounded(9.99), "10");
}

}  // namespace
}  // namespace hg::new_files
