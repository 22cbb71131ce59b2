#include "hg/model/tool.h"

#include <gtest/gtest.h>

#include <random>

#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/model/chain_data.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

constexpr double kRounding = 1e-12;  // kg m^2 and m

// an arm of one joint; with `extra` its URDF says itself what is screwed on
std::string arm(const std::string& extra) {
  return R"(<robot name="arm"><link name="base"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="flange"/>
    <origin rpy="0.3 0.2 0.1"/><axis xyz="0 1 0"/><limit lower="-2" upper="2"/></joint>
  <link name="flange"><inertial><origin xyz="0.1 0 0.2"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.02" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>)" +
         extra + "</robot>";
}

Tool handle() {
  return {.link = "flange",
          .T_link_handle = slanted(),
          .mass = 0.8,
          .p_com = {0.0, 0.03, 0.1},
          .inertia = Eigen::Vector3d(0.002, 0.003, 0.004).asDiagonal()};
}

std::string said(const Tool& tool, const std::string& extra = "") {
  try {
    ChainModel::from_urdf_text(arm(extra), "arm.urdf", {.tool = tool});
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(Tool, WeighsAndTurnsLikeALinkOfTheUrdf) {
  ChainData with_tool(ChainModel::from_urdf_text(arm(""), "arm.urdf", {.tool = handle()}));
  ChainData as_link(ChainModel::from_urdf_text(arm(R"(
  <joint name="weld" type="fixed"><parent link="flange"/><child link="mass"/></joint>
  <link name="mass"><inertial><origin xyz="0 0.03 0.1"/><mass value="0.8"/>
    <inertia ixx="0.002" iyy="0.003" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>)"),
                                               "arm.urdf"));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 0.7), dq = Eigen::VectorXd::Ones(1);
  with_tool.update(q, dq);
  as_link.update(q, dq);
  EXPECT_NEAR(with_tool.M()(0, 0), as_link.M()(0, 0), kRounding);
  EXPECT_NEAR(with_tool.c()[0], as_link.c()[0], 1e-10);
}

TEST(Tool, AddsItsFrame) {
  ChainData chain(ChainModel::from_urdf_text(arm(""), "arm.urdf", {.tool = handle()}));
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, -0.4), dq = Eigen::VectorXd::Zero(1);
  chain.update_kinematics(q, dq);
  const Pose expected = chain.pose(chain.model().frame("flange")) * slanted();
  const Pose actual = chain.pose(chain.model().frame("handle"));
  EXPECT_LT((actual.p - expected.p).norm(), kRounding);
  EXPECT_LT(rotation_between(actual.R, expected.R).norm(), kRounding);
}

TEST(Tool, MayBeWithoutMass) { EXPECT_EQ(said({.link = "flange"}), ""); }

TEST(Tool, ReportsWhatIsWrong) {
  Tool tool = handle();
  tool.link = "flansch";
  EXPECT_EQ(said(tool),
            "arm.urdf: tool: the flange must be a link of the chain, got 'flansch', nearest is "
            "'flange'");
  tool = handle();
  tool.handle = "base";
  EXPECT_NE(said(tool).find("has a link 'base' already"), std::string::npos) << said(tool);
  tool = handle();
  tool.inertia =
      Eigen::Vector3d(0.1, 0.001, 0.001).asDiagonal();  // larger than the sum of the rest
  EXPECT_EQ(said(tool).find("tool"), 0u) << said(tool);
}

}  // namespace
}  // namespace hg::model
