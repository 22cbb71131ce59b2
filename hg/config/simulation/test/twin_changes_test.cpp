// Twins that change, closers, conditional limits and chains of branched URDFs, as they are read.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/config/twin.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

// a door with a knocker beside its bolt: it branches at the leaf
constexpr const char* kDoorUrdf = R"(<robot name="door">
<link name="base"/>
<joint name="hinge" type="revolute"><parent link="base"/><child link="leaf"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1.75"/></joint>
<link name="leaf"><inertial><mass value="5"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="bolt" type="prismatic"><parent link="leaf"/><child link="handle"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.1"/></joint>
<link name="handle"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="knock" type="continuous"><parent link="leaf"/><child link="knocker"/></joint>
<link name="knocker"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>
)";

Twin load(const std::string& yaml) {
  SourceReader reader({{"door.urdf", kDoorUrdf}, {"door.yaml", yaml}});
  return load_twin("door.yaml", reader);
}

// `rest` starts in line 5
std::string head(const std::string& rest) {
  return "name: door\nurdf: door.urdf\ntip_link: handle\nend_effector: handle\n" + rest;
}
std::string door_message(const std::string& rest) {
  return message_of([&] { load(head(rest)); });
}

TEST(Chains, OfBranchedUrdfsAreChosenByTheirLastLink) {
  EXPECT_EQ(message_of([] { load("name: door\nurdf: door.urdf\nend_effector: handle\n"); }),
            "door.urdf:11: link leaf: branches into the joints bolt and knock; name the last link "
            "of the chain with tip_link (and its first with root_link): the other joints then "
            "stand still");
  EXPECT_EQ(load(head("")).model.dofs.size(), 2u);
  EXPECT_EQ(load("name: door\nurdf: door.urdf\nroot_link: leaf\ntip_link: knocker\n"
                 "end_effector: knocker\n")
                .model.dofs[0]
                .name,
            "knock");
}

TEST(Chains, ThatCannotBeReadLeaveTheRestOfTheFileToBeRead) {
  EXPECT_EQ(message_of([] {
              load(
                  "name: door\nurdf: door.urdf\ntip_link: handl\nend_effector: handle\n"
                  "mass_scale: -1\njoints: {hinge: {q_min_rad: 0}}\n"
                  "locks: [{name: bolt, joint: bolt, position_m: left}]\n"
                  "conditional_limits: [{name: c, joint: hinge, dq_max_rad_per_s: 1, "
                  "while: {bolt: {above_m: 0}}}]\n");
            }),
            "door.yaml:3:11: tip_link: must be a link of the URDF, got 'handl', did you mean "
            "'handle'?\n"
            "door.yaml:5:13: mass_scale: must be 0.1 .. 10, got -1\n"
            "door.yaml:7:47: locks[0].position_m: must be a number in m, got 'left'");
}

TEST(Closer, IsReadWithTheUnitsOfItsJoint) {
  const Twin twin = load(head(
      "joints:\n  hinge: {closer: {torque_Nm: 3, stiffness_Nm_per_rad: 4, speed_rad_per_s: 1.2}}\n"
      "  bolt: {closer: {force_N: 5, speed_m_per_s: 0.1}, quadratic_damping_Ns2_per_m2: 7}\n"));
  const auto& dofs = twin.model.dofs;
  EXPECT_EQ(dofs[0].closer.torque, 3.0);
  EXPECT_EQ(dofs[0].closer.stiffness, 4.0);
  EXPECT_EQ(dofs[0].closer.speed, 1.2);
  EXPECT_EQ(dofs[1].closer.torque, 5.0);
  EXPECT_EQ(dofs[1].closer.speed, 0.1);
  EXPECT_EQ(dofs[1].quadratic_damping, 7.0);
  EXPECT_EQ(door_message("joints:\n  hinge: {q_min_rad: -.inf, closer: {torque_Nm: 3}}\n"),
            "door.yaml:6:37: joints.hinge.closer: a closer needs a joint with a lower limit");
}

TEST(ConditionalLimits, AreReadWithTheirConditions) {
  const Twin twin =
      load(head("conditional_limits:\n  - name: slow\n    joint: hinge\n    dq_max_rad_per_s: 1.2\n"
                "    moving: lower\n    while: {bolt: {above_m: 0.05}}\n"));
  const rendering::ConditionalLimit& limit = twin.model.conditional_limits.at(0);
  EXPECT_EQ(limit.dof, 0);
  EXPECT_EQ(limit.limits.dq_max, 1.2);
  EXPECT_EQ(limit.limits.q_max, kInfinity);
  EXPECT_EQ(limit.moving, rendering::Moving::kLower);
  ASSERT_EQ(limit.conditions.size(), 1u);
  EXPECT_EQ(limit.conditions[0].dof, 1);
  EXPECT_EQ(limit.conditions[0].range.lb, 0.05);
}

TEST(ConditionalLimits, AreRefusedWhenEmptyOrContradictory) {
  const auto message = [](const std::string& keys) {
    return door_message("conditional_limits:\n  - {name: a, joint: hinge" + keys + "}\n");
  };
  EXPECT_EQ(message(", q_max_rad: 1"), "no error");
  EXPECT_EQ(message(""),
            "door.yaml:6:5: conditional_limits[0]: a conditional limit needs a position, a speed "
            "or an acceleration");
  EXPECT_EQ(message(", q_max_rad: 1, moving: upper"),
            "door.yaml:6:51: conditional_limits[0].moving: is about the largest speed, which is "
            "not given");
  EXPECT_EQ(message(", q_min_rad: 2"),
            "door.yaml:6:5: conditional_limits[0]: the positions must have something in common "
            "with the limits of the joint");
}

TEST(ReferenceWrench, AndScalesAreRead) {
  const Twin twin =
      load(head("reference_wrench: {force_N: [1, 2, 3], torque_Nm: [4, 5, 6]}\nmass_scale: 0.5\n"
                "felt_scale: {force: [2, 1, 0.5], torque: [3, 4, 5]}\n"));
  Vector6 w_ref, felt_scale;
  w_ref << 1, 2, 3, 4, 5, 6;
  felt_scale << 2, 1, 0.5, 3, 4, 5;
  EXPECT_EQ(twin.model.w_ref, w_ref);
  EXPECT_EQ(twin.model.mass_scale, 0.5);
  EXPECT_EQ(twin.model.felt_scale, felt_scale);
  EXPECT_EQ(load(head("felt_scale: {force: [2, 1, 1]}\n")).model.felt_scale[3], 1.0);
  EXPECT_NE(door_message("felt_scale: {force: [2, 1, 11]}\n").find("must be 0.1 .. 10"),
            std::string::npos);
  EXPECT_EQ(door_message("mass_scale: 20\n"),
            "door.yaml:5:13: mass_scale: must be 0.1 .. 10, got 20");
}

Scenario load_changes(const std::string& changes) {
  SourceReader shipped;
  const auto text = [&](const char* file) { return shipped.read(file); };
  return load_scenario(
      {{"run.yaml",
        "title: a\ndescription: b\ndevice: models/haptic_giant/device.yaml\n"
        "twin: door.yaml\nperson: mouse\nduration_s: 3\nchanges:\n" +
            changes},
       {"models/haptic_giant/device.yaml", text("models/haptic_giant/device.yaml")},
       {"models/haptic_giant/simulation.yaml", text("models/haptic_giant/simulation.yaml")},
       {"models/haptic_giant/haptic_giant.urdf", text("models/haptic_giant/haptic_giant.urdf")},
       {"door.urdf", kDoorUrdf},
       {"door.yaml", head("")}});
}
std::string changes_message(const std::string& changes) {
  return message_of([&] { load_changes(changes); });
}

TEST(Changes, BecomeOneChangePerValue) {
  const std::vector<TimedChange> changes =
      load_changes(
          "  - {at_s: 1, joint: bolt, stiffness_N_per_m: 40, q_max_m: 0.2, friction_N: 2}\n"
          "  - {at_s: 2, joint: hinge, q_min_rad: 2, q_max_rad: 3}\n"
          "  - {at_s: 2.5, gravity: true, mass_scale: 2, reference_wrench: {force_N: [0, 0, 5]}}\n"
          "  - {at_s: 3, felt_scale: {torque: [1, 2, 3]}}\n")
          .changes;
  struct Expected {
    double at_s;
    Parameter parameter;
    int index;
    double value;
  };
  const std::vector<Expected> expected = {{1, Parameter::kStiffness, 1, 40},
                                          {1, Parameter::kFriction, 1, 2},
                                          {1, Parameter::kUpperLimit, 1, 0.2},
                                          // beyond the old upper end: that one first
                                          {2, Parameter::kUpperLimit, 0, 3},
                                          {2, Parameter::kLowerLimit, 0, 2},
                                          {2.5, Parameter::kReferenceWrench, 0, 0},
                                          {2.5, Parameter::kReferenceWrench, 1, 0},
                                          {2.5, Parameter::kReferenceWrench, 2, 5},
                                          {2.5, Parameter::kGravity, -1, 1},
                                          {2.5, Parameter::kMassScale, -1, 2},
                                          {3, Parameter::kFeltScale, 3, 1},
                                          {3, Parameter::kFeltScale, 4, 2},
                                          {3, Parameter::kFeltScale, 5, 3}};
  ASSERT_EQ(changes.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(changes[i].at_s, expected[i].at_s);
    EXPECT_EQ(changes[i].change.parameter, expected[i].parameter);
    EXPECT_EQ(changes[i].change.index, expected[i].index);
    EXPECT_EQ(changes[i].change.value, expected[i].value);
  }
}

TEST(Changes, AreRefusedWithTheirPlace) {
  EXPECT_EQ(changes_message("  - {at_s: 1}\n"),
            "run.yaml:8:5: changes[0]: a change needs at least one value");
  EXPECT_EQ(changes_message("  - {at_s: 1, joint: hinge, stiffness_N_per_m: 2}\n"),
            "run.yaml:8:29: changes[0].stiffness_N_per_m: unknown key, did you mean "
            "'stiffness_Nm_per_rad'?");
  EXPECT_EQ(changes_message("  - {at_s: 1, joint: hing, rest_rad: 2}\n"),
            std::string("run.yaml:8:22: changes[0].joint: must be a joint of the twin, got 'hing', "
                        "did you mean 'hinge'?"));
  EXPECT_EQ(changes_message("  - {at_s: 1, joint: hinge, q_max_rad: -1}\n"),
            "run.yaml:8:40: changes[0].q_max_rad: q_max must not be below q_min, got -1 with "
            "q_min 0");
  EXPECT_EQ(changes_message("  - {at_s: 2, gravity: true}\n  - {at_s: 1, gravity: false}\n"),
            "run.yaml:9:12: changes[1].at_s: changes must be in the order of their times");
}

}  // namespace
}  // namespace hg::config
