#include "hg/model/urdf_parts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

constexpr double kRounding = 1e-12;

std::string message_of(const std::string& text, const ChainOptions& options) {
  try {
    ChainModel::from_urdf_text(text, "tree.urdf", options);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

std::string body(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/><inertia ixx='0.1' iyy='0.1' "
         "izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>";
}

// torso on a base; left arm of two links with a finger, right arm of one
const std::string kTree =
    "<robot name='tree'>" + body("base") + body("torso") + body("upper") + body("lower") +
    body("finger") + body("right") +
    joint("waist", "continuous", "base", "torso", "<axis xyz='0 0 1'/><origin xyz='0 0 1'/>") +
    joint("shoulder", "continuous", "torso", "upper", "<axis xyz='0 1 0'/><origin xyz='0 1 0'/>") +
    joint("elbow", "continuous", "upper", "lower", "<axis xyz='0 1 0'/><origin xyz='1 0 0'/>") +
    joint("grip", "prismatic", "lower", "finger",
          "<axis xyz='1 0 0'/><limit lower='0' upper='0.1'/><mimic joint='elbow'/>") +
    joint("other", "continuous", "torso", "right", "<origin xyz='0 -1 0'/>") + "</robot>";

ChainModel part_of_tree(const std::string& root, const std::string& tip) {
  return ChainModel::from_urdf_text(kTree, "tree.urdf",
                                    {.gravity = false, .root_link = root, .tip_link = tip});
}

std::vector<std::string> joint_names(const ChainModel& chain) {
  std::vector<std::string> names;
  for (const Joint& each : chain.joints()) names.push_back(each.name);
  return names;
}

TEST(SerialPart, ABranchedRobotIsReadUpToATip) {
  EXPECT_NE(message_of(kTree, {}), "accepted");
  ChainData chain(part_of_tree("", "lower"));
  EXPECT_EQ(joint_names(chain.model()), (std::vector<std::string>{"waist", "shoulder", "elbow"}));
  EXPECT_EQ(chain.model().frame_names().size(), 6u);

  // the frozen finger hangs on the forearm, the right arm on the torso: all masses turn with it
  chain.update(chain.model().neutral(), VectorA::Zero(3));
  const double mass = 2.0, I = 0.1;
  const auto about_z = [&](double x, double y) { return I + mass * (x * x + y * y); };
  const double expected =
      about_z(0.1, 0.2) + about_z(0.1, 1.2) + 2 * about_z(1.1, 1.2) + about_z(0.1, -0.8);
  EXPECT_NEAR(chain.M()(0, 0), expected, kRounding);
}

TEST(SerialPart, WhatIsNotTakenMayHaveAnyFault) {
  const auto with = [](const std::string& more) {
    std::string text = kTree;
    return text.insert(text.rfind("</robot>"), more);
  };
  const ChainOptions arm = {.root_link = "base", .tip_link = "lower"};
  const std::string ball = "<link name='ball'/>";
  for (const auto& [text, fault] :
       {std::pair{ball + joint("j", "spherical", "base", "ball", ""), "type is unknown"},
        std::pair{ball + joint("j", "continuous", "base", "ball", "<axis xyz='0 0 0'/>"), "axis"},
        std::pair{ball + joint("j", "revolute", "base", "ball", ""), "limit"},
        std::pair{ball + joint("j", "revolute", "base", "ball", "<limit lower='-1e9' upper='1'/>"),
                  "lower must be"}}) {
    EXPECT_EQ(message_of(with(text), arm), "accepted") << text;
    EXPECT_NE(message_of(with(text), {}).find(fault), std::string::npos)
        << message_of(with(text), {});
  }
  std::string follower = kTree;  // the finger moves with the elbow, whatever is wrong with it
  follower.replace(follower.find("prismatic"), 9, "Prismatic");
  EXPECT_NE(message_of(follower, arm).find("type is unknown"), std::string::npos);
  const std::string bare = "<link name='ball'><inertial><mass value='1'/></inertial></link>";
  EXPECT_EQ(message_of(with(bare + joint("j", "fixed", "base", "ball", "")), arm), "accepted");
}

TEST(SerialPart, BelowARootTheRestOfTheRobotIsLeftOut) {
  ChainData chain(part_of_tree("upper", "lower"));
  EXPECT_EQ(joint_names(chain.model()), (std::vector<std::string>{"elbow"}));
  EXPECT_EQ(chain.model().frame_names(), (std::vector<std::string>{"upper", "lower", "finger"}));
  chain.update_kinematics(chain.model().neutral(), VectorA::Zero(1));
  EXPECT_LT((chain.pose(chain.model().frame("lower")).p - Eigen::Vector3d(1, 0, 0)).norm(),
            kRounding);
}

TEST(SerialPart, ARootAloneTakesWhatHangsOnIt) {
  EXPECT_EQ(message_of(kTree, {.root_link = "lower"}),
            "tree.urdf:1: joint grip: must follow a joint that moves on its own between root and "
            "tip, got 'elbow'");
  EXPECT_EQ(joint_names(part_of_tree("torso", "right")), (std::vector<std::string>{"other"}));
}

TEST(SerialPart, WrongNamesAreAnsweredWithTheNearest) {
  EXPECT_EQ(message_of(kTree, {.tip_link = "lowr"}),
            "tree.urdf: tip_link must be a link of the URDF, got 'lowr', nearest is 'lower'");
  EXPECT_EQ(message_of(kTree, {.root_link = "uper", .tip_link = "lower"}),
            "tree.urdf: root_link must be a link of the URDF, got 'uper', nearest is 'upper'");
  EXPECT_EQ(message_of(kTree, {.root_link = "right", .tip_link = "lower"}),
            "tree.urdf: root_link 'right' does not carry tip_link 'lower'; a chain goes from the "
            "root of the URDF outwards");
}

std::string planar_robot(const std::string& axis) {
  return "<robot name='puck'><link name='table'/>" + body("puck") +
         joint("glide", "planar", "table", "puck",
               "<origin xyz='0.3 0.2 0.1' rpy='0.4 0.3 -0.2'/>" + axis) +
         "</robot>";
}

TEST(PlanarParts, AreTwoSlidesAndATurnAboutTheNormal) {
  const char* axes[] = {"", "<axis xyz='0 0 1'/>", "<axis xyz='0 0 -2'/>", "<axis xyz='1 2 -3'/>",
                        "<axis xyz='-3 1 1'/>"};
  for (const char* axis : axes) {
    SCOPED_TRACE(axis);
    const std::string text = planar_robot(axis);
    const UrdfJoint planar = read_urdf_text(text, "").joints[0];
    ChainData chain(ChainModel::from_urdf_text(text, "puck.urdf"));
    ASSERT_EQ(joint_names(chain.model()),
              (std::vector<std::string>{"glide x", "glide y", "glide turn"}));
    EXPECT_EQ(chain.model().joints()[1].planar, "glide");
    EXPECT_EQ(chain.model().joints()[0].type, JointType::kPrismatic);
    EXPECT_EQ(chain.model().joints()[2].type, JointType::kContinuous);

    const Eigen::Vector3d q(0.7, -0.4, 2.5);
    chain.update(q, VectorA::Zero(3));
    const Pose moved = inverse(planar.T_parent_joint) * chain.pose(chain.model().frame("puck"));
    EXPECT_NEAR(moved.p.dot(planar.axis), 0.0, kRounding);
    EXPECT_NEAR(moved.p.norm(), q.head<2>().norm(), kRounding);
    const Eigen::AngleAxisd turn(q[2], planar.axis);
    EXPECT_LT((moved.R - turn.toRotationMatrix()).norm(), kRounding);

    // x, y and the normal are right-handed, and the puck has its mass in both directions
    chain.update(Eigen::Vector3d(1, 0, 0), VectorA::Zero(3));
    const Eigen::Vector3d x = (inverse(planar.T_parent_joint) * chain.pose(1)).p;
    chain.update(Eigen::Vector3d(0, 1, 0), VectorA::Zero(3));
    const Eigen::Vector3d y = (inverse(planar.T_parent_joint) * chain.pose(1)).p;
    EXPECT_LT((x.cross(y) - planar.axis).norm(), kRounding);
    EXPECT_NEAR(chain.M()(0, 0), 2.0, kRounding);
    EXPECT_NEAR(chain.M()(0, 1), 0.0, kRounding);
  }
}

TEST(PlanarParts, SpanThePlaneOfAVerticalNormalWithXAndYOfTheJoint) {
  const auto parts =
      planar_parts(read_urdf_text(planar_robot("<axis xyz='0 0 1'/>"), "").joints[0]);
  EXPECT_LT((parts[0].axis - Eigen::Vector3d::UnitX()).norm(), kRounding);
  EXPECT_LT((parts[1].axis - Eigen::Vector3d::UnitY()).norm(), kRounding);
}

TEST(PlanarParts, HaveNoLimits) {
  for (const UrdfJoint& part : planar_parts(
           read_urdf_text(planar_robot("<limit lower='0' upper='1' velocity='0' effort='1'/>"), "")
               .joints[0])) {
    EXPECT_FALSE(part.position.bounded());
    EXPECT_EQ(part.velocity_max, kInfinity);
  }
}

TEST(InsertBehind, CarriesWhatTheJointCarried) {
  const std::string text =
      "<robot name='r'><link name='base'/><link name='arm'/><link name='hand'/>"
      "<joint name='turn' type='revolute'><parent link='base'/><child link='arm'/><origin "
      "xyz='1 2 3'/><axis xyz='0 0 1'/><limit lower='-1' upper='1'/></joint>"
      "<joint name='grip' type='fixed'><parent link='arm'/><child link='hand'/></joint></robot>";
  Urdf urdf = read_urdf_text(text, "r.urdf");
  insert_behind("turn", "bend", Eigen::Vector3d(0.0, 2.0, 0.0), urdf);
  ASSERT_EQ(urdf.joints.size(), 3u);
  const UrdfJoint &turn = urdf.joints[0], &bend = urdf.joints[2];
  EXPECT_EQ(turn.child, bend.parent);
  EXPECT_EQ(urdf.links[bend.child].name, "arm");
  EXPECT_EQ(bend.type, UrdfJointType::kContinuous);
  EXPECT_EQ(bend.axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(bend.T_parent_joint.p, Eigen::Vector3d::Zero());
  EXPECT_EQ(turn.T_parent_joint.p, Eigen::Vector3d(1.0, 2.0, 3.0));
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"grip", "x"}, {"turn", "hand"}, {"none", "x"}};
  for (const auto& [behind, name] : wrong) {
    EXPECT_THROW(insert_behind(behind, name, {}, urdf), SetupError);
  }
}

}  // namespace
}  // namespace hg::model
