// The list of elements that checks and trials iterate.
#include "hg/controller/rendering/twin_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hg/controller/rendering/test/playing.h"

namespace hg::rendering {
namespace {

// A door with every element.
TwinModel full_door() {
  TwinModel twin = door_with_closer();
  TwinDof& hinge = twin.dofs[0];
  hinge.rest = 0.2;
  hinge.friction = 0.5;
  hinge.quadratic_damping = 0.3;
  hinge.closer = {.torque = 2.0, .stiffness = 5.0, .speed = 0.4};
  hinge.profile = Profile({{0.0, 0.0}, {0.5, 30.0}});
  twin.locks = {door_lock()};
  twin.conditional_limits = {{.name = "slow", .dof = 0, .limits = {.dq_max = 0.1}}};
  twin.w_ref.setOnes();
  return twin;
}

TEST(TwinElements, WithoutForcesADoorIsWhatItsUrdfAndItsLimitsSay) {
  TwinModel twin = full_door();
  leave_out_forces(twin);
  for (const TwinDof& dof : twin.dofs) {
    EXPECT_EQ(dof.stiffness, 0.0);
    EXPECT_EQ(dof.rest, 0.0);
    EXPECT_EQ(dof.preload, 0.0);
    EXPECT_EQ(dof.damping, 0.0);
    EXPECT_EQ(dof.quadratic_damping, 0.0);
    EXPECT_EQ(dof.friction, 0.0);
    EXPECT_EQ(dof.closer.torque, 0.0);
    EXPECT_EQ(dof.closer.stiffness, 0.0);
    EXPECT_EQ(dof.closer.speed, kInfinity);
    EXPECT_TRUE(dof.profile.empty());
  }
  EXPECT_TRUE(twin.locks.empty() && twin.conditional_limits.empty() && twin.w_ref.isZero(0.0));
  EXPECT_EQ(twin.dofs[0].limits.q_max, full_door().dofs[0].limits.q_max);
  EXPECT_EQ(twin.dofs[0].name, full_door().dofs[0].name);
}

TEST(TwinElements, StiffnessIsTheSumAndNamesTheStiffest) {
  const TwinDof hinge = full_door().dofs[0];
  const Total all = total_of(&Element::stiffness, hinge);
  EXPECT_NEAR(all.value, 4.0 + 5.0 + hinge.profile.steepest(), 1e-12);
  EXPECT_EQ(item_of(*all.most, hinge), "joints.hinge.profile");
  const Total held = total_of(&Element::stiffness, hinge, TorqueAt::kBegin);
  EXPECT_EQ(held.value, 9.0);
  EXPECT_EQ(item_of(*held.most, hinge), "joints.hinge.closer");
  EXPECT_EQ(item_of(*total_of(&Element::damping, TwinDof{}).most, hinge),
            "joints.hinge.damping_Nms_per_rad");
}

TEST(TwinElements, KeysAreThoseOfTheJoint) {
  const Element& damping = *total_of(&Element::damping, TwinDof{}).most;
  EXPECT_EQ(item_of(damping, {.name = "slide", .q_index = 0, .is_angle = false}),
            "joints.slide.damping_Ns_per_m");
  EXPECT_EQ(item_of(damping, {.name = "root ry", .q_index = -1, .is_angle = true}),
            "joints.root.angular_damping_Nms_per_rad");
  EXPECT_EQ(item_of(damping, {.name = "root y", .q_index = -1, .is_angle = false}),
            "joints.root.damping_Ns_per_m");
}

// a magnet that holds the joint at its rest, as a later version may add it
TEST(TwinElements, OneThatIsAddedIsLeftOutAndCountsInAllSums) {
  std::vector<Element> elements(kElements.begin(), kElements.end());
  elements.push_back({.key = "magnet",
                      .leave_out = reset_dofs<&TwinDof::rest>,
                      .torque_at = TorqueAt::kMiddle,
                      .stiffness = [](const TwinDof&) { return 1000.0; },
                      .damping = [](const TwinDof&) { return 7.0; }});
  TwinModel twin = full_door();
  const TwinDof hinge = twin.dofs[0];
  const Total stiffness = total_of(&Element::stiffness, hinge, {}, elements);
  EXPECT_EQ(stiffness.value, 1000.0 + total_of(&Element::stiffness, hinge).value);
  EXPECT_EQ(item_of(*stiffness.most, hinge), "joints.hinge.magnet");
  EXPECT_EQ(total_of(&Element::damping, hinge, {}, elements).value, 9.0);
  EXPECT_EQ(total_of(&Element::stiffness, hinge, TorqueAt::kBegin, elements).value, 9.0);
  leave_out_forces(twin, std::vector<Element>{elements.back()});
  EXPECT_EQ(twin.dofs[0].rest, 0.0);
  EXPECT_EQ(twin.dofs[0].stiffness, hinge.stiffness);
}

}  // namespace
}  // namespace hg::rendering
