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

}  // namespace
}  // namespace hg::config
