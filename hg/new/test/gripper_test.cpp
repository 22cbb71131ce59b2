#include "hg/new/gripper.h"

#include <gtest/gtest.h>

namespace hg::new_files {
namespace {

using Names = std::vector<std::string>;

// shoulder, elbow and what `hand` says of the link "hand"
model::Urdf robot(const std::string& hand, const std::string& more = "") {
  std::string text = "<robot name='robot'>";
  for (const char* link : {"base", "upper", "hand", "left", "right", "other"}) {
    text += std::string("<link name='") + link + "'/>";
  }
  text +=
      "<joint name='shoulder' type='continuous'><parent link='base'/><child link='upper'/></joint>"
      "<joint name='elbow' type='continuous'><parent link='upper'/><child link='hand'/></joint>";
  return model::read_urdf_text(text + hand + more + "</robot>", "robot.urdf");
}

std::string turns(const std::string& name, const std::string& parent, const std::string& child) {
  return "<joint name='" + name + "' type='continuous'><parent link='" + parent +
         "'/><child link='" + child + "'/></joint>";
}

std::string slides(const std::string& name, const std::string& child, const std::string& upper,
                   const std::string& more = "") {
  return "<joint name='" + name + "' type='prismatic'><parent link='hand'/><child link='" + child +
         "'/><limit lower='0' upper='" + upper + "'/>" + more + "</joint>";
}

TEST(Gripper, FingersThatSlideAreOne) {
  const auto found =
      find_gripper(robot(slides("a", "left", "0.04") + slides("b", "right", "0.04")));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->link, "hand");
  EXPECT_EQ(found->joints, (Names{"a", "b"}));
}

TEST(Gripper, JointsThatFollowAFingerBelongToIt) {
  const auto found = find_gripper(
      robot(turns("Finger_drive", "hand", "left") +
            "<joint name='b' type='continuous'><parent link='hand'/><child link='right'/>"
            "<mimic joint='Finger_drive'/></joint>"));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->joints, (Names{"Finger_drive", "b"}));
}

TEST(Gripper, AWristALongSlideOrASecondArmIsNone) {
  EXPECT_FALSE(find_gripper(robot("")));
  EXPECT_FALSE(find_gripper(robot(turns("wrist", "hand", "left"))));
  EXPECT_FALSE(find_gripper(robot(slides("lift", "left", "0.5"))));
  EXPECT_FALSE(find_gripper(robot(turns("finger", "hand", "left"), turns("arm", "base", "other"))));
}

}  // namespace
}  // namespace hg::new_files
