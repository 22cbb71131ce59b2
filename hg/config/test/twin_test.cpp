#include "hg/config/twin.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/core/error.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

Twin gate(const std::string& dynamics, const std::string& joint) {
  const std::string urdf = R"(<robot name="gate"><link name="post"/>
<joint name="hinge" type="revolute"><parent link="post"/><child link="panel"/>
<limit lower="0" upper="1"/>)" +
                           dynamics + R"(</joint>
<link name="panel"><inertial><mass value="8"/>
<inertia ixx="0.1" iyy="0.25" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  SourceReader reader({{"twin.yaml",
                        "name: gate\nurdf: gate.urdf\nend_effector: panel\n"
                        "joints: {hinge: {ddq_max_rad_per_s2: 5" +
                            joint + "}}\n"},
                       {"gate.urdf", urdf}});
  return load_twin("twin.yaml", reader);
}

TEST(Twin, DampingAndFrictionAreThoseOfTheUrdfUnlessTheFileHasItsOwn) {
  const std::string dynamics = R"(<dynamics damping="0.5" friction="2"/>)";
  const rendering::TwinDof by_urdf = gate(dynamics, "").model.dofs[0];
  EXPECT_EQ(by_urdf.damping, 0.5);
  EXPECT_EQ(by_urdf.friction, 2.0);
  const rendering::TwinDof own = gate(dynamics, ", damping_Nms_per_rad: 0").model.dofs[0];
  EXPECT_EQ(own.damping, 0.0);
  EXPECT_EQ(own.friction, 2.0);
  const rendering::TwinDof none = gate("", "").model.dofs[0];
  EXPECT_EQ(none.damping, 0.0);
  EXPECT_EQ(none.friction, 0.0);
}

TEST(Twin, AProfileIsReadWithItsRepeatAndItsFriction) {
  const rendering::TwinDof dof =
      gate("", R"(, profile: {repeat_rad: 0.4, points: [{at_rad: 0, torque_Nm: 0},
{at_rad: 0.1, torque_Nm: 2, friction_Nm: 0.5}, {at_rad: 0.3, torque_Nm: -2}]})")
          .model.dofs[0];
  EXPECT_NEAR(dof.profile.torque(0.1), 2.0, 1e-12);
  EXPECT_NEAR(dof.profile.torque(0.7), -2.0, 1e-12);
  EXPECT_NEAR(dof.profile.friction(0.5), 0.5, 1e-12);
  EXPECT_TRUE(gate("", "").model.dofs[0].profile.empty());
}

Twin example(const std::string& name, const std::string& more) {
  SourceReader disk;
  SourceReader reader(
      {{"twin.yaml", "name: f\nurdf: f.urdf\ntip_link: handle\nend_effector: handle\n" + more},
       {"f.urdf", disk.read("models/examples/" + name + ".urdf")}});
  return load_twin("twin.yaml", reader);
}

Twin flywheel(const std::string& more) { return example("flywheel", more); }

std::string fault_of(const std::string& more) {
  try {
    flywheel(more);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "none";
}

TEST(Twin, CouplingsAreThoseOfTheUrdfUnlessTheFileHasItsOwn) {
  const auto& by_urdf = flywheel("").model.chain.couplings();
  ASSERT_EQ(by_urdf.size(), 1u);
  EXPECT_EQ(by_urdf[0].ratio, -5.0);
  const auto own = flywheel("couplings: [{joint: wheel_joint, follows: lever_joint, ratio: 3}]\n")
                       .model.chain.couplings();
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own[0].joint, "wheel_joint");
  EXPECT_EQ(own[0].leader, "lever_joint");
  EXPECT_EQ(own[0].ratio, 3.0);
}

TEST(Twin, CouplingsThatCannotBeAreRefusedAtTheirPlace) {
  EXPECT_EQ(
      fault_of("couplings: [{joint: wheel_joint, follows: lever}]\n"),
      "twin.yaml:5:43: couplings[0].follows: must be a joint of the URDF, got 'lever', did you "
      "mean 'lever_joint'?");
  EXPECT_EQ(fault_of("couplings: [{joint: wheel_joint, follows: lever_joint, ratio: 0}]\n"),
            "twin.yaml:5:63: couplings[0].ratio: must not be 0");
  EXPECT_EQ(
      fault_of("joints: {wheel_joint: {damping_Nms_per_rad: 1}}\n"),
      "twin.yaml:5:10: joints.wheel_joint: must be a joint of the twin, got 'wheel_joint', did "
      "you mean 'lever_joint'?");
}

TEST(Twin, ALoopIsClosedByTheJointsThatFollow) {
  const auto door = [](const std::string& follow) {
    return example("lift_door",
                   "loops:\n  - {link: upper_arm_end, meets: hinge_on_door, leads: "
                   "lower_hinge, follow: [" +
                       follow + "]}\n");
  };
  const model::ChainModel chain = door("door_hinge, upper_hinge").model.chain;
  EXPECT_EQ(chain.nv(), 1);
  ASSERT_EQ(chain.couplings().size(), 2u);
  EXPECT_TRUE(chain.couplings()[0].curve && chain.couplings()[1].curve);
  EXPECT_EQ(
      message_of([&] { door(""); }),
      "twin.yaml:6:77: loops[0].follow: one to three joints must keep the loop closed, got 0");
}

TEST(Twin, ACamIsACouplingByACurve) {
  const auto couplings = example("flywheel",
                                 "cams: [{joint: wheel_joint, follows: lever_joint, "
                                 "repeats_per_turn: 4, points: [{at_rad: 0, "
                                 "position_rad: 0}, {at_rad: 0.5, position_rad: 0.3}, "
                                 "{at_rad: 1, position_rad: 0.1}]}]\n")
                             .model.chain.couplings();
  ASSERT_EQ(couplings.size(), 1u);
  EXPECT_EQ(couplings[0].joint, "wheel_joint");
  EXPECT_EQ(couplings[0].leader, "lever_joint");
  ASSERT_TRUE(couplings[0].curve);
  EXPECT_NEAR(couplings[0].curve->at(0.5).value, 0.3, 1e-9);
  EXPECT_NEAR(couplings[0].curve->at(0.5 + M_PI).value, 0.3, 1e-9);
}

TEST(Twin, TheLeaderOfACamThatDoesNotRepeatStaysWithinItsPoints) {
  const Twin twin = flywheel(
      "cams: [{joint: wheel_joint, follows: lever_joint, points: [{at_rad: 0.1, position_rad: 0}, "
      "{at_rad: 0.9, position_rad: 1}]}]\n");
  EXPECT_EQ(twin.model.dofs[0].limits.q_min, 0.1);
  EXPECT_EQ(twin.model.dofs[0].limits.q_max, 0.9);
}

std::string fault_of_cam(const std::string& keys) {
  return fault_of("cams:\n  - {joint: wheel_joint, " + keys + "}\n");
}

TEST(Twin, CamsThatCannotBeAreRefusedAtTheirPlace) {
  const std::string points = "points: [{at_rad: 0, position_rad: 0}, {at_rad: 1, position_rad: 2}]";
  EXPECT_EQ(fault_of_cam("follows: lever, " + points),
            "twin.yaml:6:35: cams[0].follows: must be a joint of the URDF, got 'lever', did you "
            "mean 'lever_joint'?");
  EXPECT_EQ(fault_of_cam("follows: wheel_joint, " + points),
            "twin.yaml:6:35: cams[0].follows: a joint cannot follow itself");
  EXPECT_EQ(fault_of_cam("follows: lever_joint, points: [{at_rad: 0, position_rad: 0}]"),
            "twin.yaml:6:56: cams[0].points: a cam needs 2 .. 200 points, got 1");
  EXPECT_EQ(fault_of_cam("follows: lever_joint, points: [{at_rad: 1, position_rad: 0}, {at_rad: 0, "
                         "position_rad: 2}]"),
            "twin.yaml:6:56: cams[0].points: positions of the leader must grow from point to "
            "point, got 0 after 1");
  EXPECT_EQ(fault_of_cam("follows: lever_joint, points: [{at_rad: 0, position_rad: 0}, {at_rad: 3, "
                         "position_rad: 1}, {at_rad: 6.283185307179586, position_rad: 2}], "
                         "repeats_per_turn: 1"),
            "twin.yaml:6:56: cams[0].points: a point where the first one repeats must be the same, "
            "expected 0, got 2");
  EXPECT_EQ(fault_of_cam("follows: lever_joint, points: [{at_rad: 0, position_rad: .nan}, "
                         "{at_rad: 1, position_rad: 2}]")
                .substr(0, 56),
            "twin.yaml:6:83: cams[0].points[0].position_rad: must be ");
  EXPECT_EQ(fault_of_cam("follows: lever_joint, points: [{at_rad: 0}, {at_rad: 1, "
                         "position_rad: 2}]")
                .substr(0, 32),
            "twin.yaml:6:57: cams[0].points[0");
  EXPECT_EQ(fault_of("couplings: [{joint: wheel_joint, follows: lever_joint}]\ncams:\n  - {joint: "
                     "wheel_joint, follows: lever_joint, " +
                     points + "}\n"),
            "twin.yaml:7:13: cams[0].joint: follows another joint already");
  EXPECT_EQ(message_of([] {
              example(
                  "lift_door",
                  "loops: [{link: upper_arm_end, meets: hinge_on_door, leads: lower_hinge, "
                  "follow: [door_hinge, upper_hinge]}]\ncams:\n  - {joint: upper_hinge, follows: "
                  "lower_hinge, points: [{at_rad: 0, position_rad: 0}, {at_rad: 1, "
                  "position_rad: 2}]}\n");
            }),
            "twin.yaml:7:13: cams[0].joint: follows another joint already");
}

TEST(Twin, ACamKeepsTheJointThatFollowsWithinItsLimits) {
  const auto press = [](const std::string& most) {
    SourceReader disk;
    SourceReader reader(
        {{"twin.yaml",
          "name: f\nurdf: f.urdf\ntip_link: handle\nend_effector: handle\ncams: [{joint: "
          "ram_guide, "
          "follows: crank, repeats_per_turn: 1, points: [{at_rad: 0, position_m: 0}, {at_rad: 2, "
          "position_m: " +
              most + "}, {at_rad: 4, position_m: 0.01}]}]\n"},
         {"f.urdf", disk.read("models/twins/cam_press/cam_press.urdf")}});
    return load_twin("twin.yaml", reader);
  };
  const model::Joint crank = press("0.03").model.chain.joints()[0];
  EXPECT_EQ(crank.type, model::JointType::kContinuous);
  EXPECT_FALSE(crank.position.bounded());
  EXPECT_LT(crank.velocity_max, 4.0 * 10.0);
  EXPECT_EQ(message_of([&] { press("0.07"); }).substr(0, 106),
            "twin.yaml:5:72: cams[0].points: the joint that follows must stay within its limits, "
            "-0.005 .. 0.06, got -0");
}

}  // namespace
}  // namespace hg::config
