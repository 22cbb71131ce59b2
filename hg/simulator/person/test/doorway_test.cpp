#include "hg/simulator/person/doorway.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::person {
namespace {

using Eigen::Vector2d;

constexpr double kPi = 3.14159265358979323846;

// a leaf with a handle 0.75 m from its hinge and 0.06 m before it, on the side of -y; turned by
// `yaw` at (1, 2); `axis` and `side` choose which way it opens and from where it is held
model::ChainModel door(double yaw, const std::string& axis = "0 0 1", double side = -1.0) {
  const std::string urdf =
      R"(<robot name="door"><link name="base"/><link name="leaf"><inertial><mass value="5"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="hinge" type="revolute"><parent link="base"/><child link="leaf"/>
      <axis xyz=")" +
      axis + R"("/><limit lower="0" upper="2" velocity="1" effort="1"/></joint>
      <joint name="fix" type="fixed"><parent link="leaf"/><child link="handle"/>
      <origin xyz="0.75 )" +
      std::to_string(0.06 * side) + R"( 0" rpy=")" + std::to_string(-side * kPi / 2.0) +
      R"( 0 0"/></joint><link name="handle"/></robot>)";
  model::ChainOptions options;
  options.T_B_root.p = {1.0, 2.0, -0.8};
  options.T_B_root.R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return model::ChainModel::from_urdf_text(urdf, "door.urdf", options);
}

TEST(Doorway, IsFoundFromTheTwin) {
  for (const double yaw : {0.0, 0.8, -2.0}) {
    SCOPED_TRACE(yaw);
    const model::ChainModel twin = door(yaw);
    Doorway doorway;
    place(doorway, twin, twin.frame("handle"));
    EXPECT_LT((doorway.hinge - Vector2d(1.0, 2.0)).norm(), 1e-6);
    EXPECT_LT((doorway.along - Vector2d(std::cos(yaw), std::sin(yaw))).norm(), 1e-5);
    EXPECT_LT((doorway.away - Vector2d(-std::sin(yaw), std::cos(yaw))).norm(), 1e-5);
    EXPECT_NEAR(doorway.handle_radius, 0.75, 1e-5);
    EXPECT_NEAR(doorway.handle_offset, 0.06, 1e-5);
    // the angle of the leaf follows from the place of the handle
    model::ChainData open(twin);
    open.update_poses(Eigen::VectorXd::Constant(1, 0.9));
    EXPECT_NEAR(leaf_angle(doorway, open.pose(twin.frame("handle")).p), 0.9, 1e-5);
  }
}

TEST(Doorway, WithTheHingeAtTheOtherSideIsMirrored) {
  const model::ChainModel twin = door(kPi, "0 0 -1", 1.0);  // held from -y of B, opens to +y
  Doorway doorway;
  place(doorway, twin, twin.frame("handle"));
  EXPECT_LT((doorway.along - Vector2d(-1.0, 0.0)).norm(), 1e-5);
  EXPECT_LT((doorway.away - Vector2d(0.0, 1.0)).norm(), 1e-5);
  model::ChainData open(twin);
  open.update_poses(Eigen::VectorXd::Constant(1, 0.9));
  EXPECT_NEAR(leaf_angle(doorway, open.pose(twin.frame("handle")).p), 0.9, 1e-5);
}

TEST(Doorway, ALeafThatOpensTowardsThePersonIsRefused) {
  const model::ChainModel twin = door(0.0, "0 0 -1");
  Doorway doorway;
  EXPECT_THROW(place(doorway, twin, twin.frame("handle")), SetupError);
}

// by turning the leaf until it leaves room
TEST(Doorway, TheAngleNeededIsTheFirstThatLeavesRoom) {
  const Doorway doorway;
  constexpr double kRoom = 0.28, kStep = 1e-3;
  for (double x = 0.3; x < 0.9; x += 0.1) {
    for (double y = -0.6; y < 1.4; y += 0.05) {
      const Vector2d p(x, y);
      double angle = kPi;  // turned back until the leaf would touch
      while (angle > 0.0 && leaf_distance(doorway, angle - kStep, p) >= kRoom) angle -= kStep;
      // a body that stands before the shut leaf needs none
      if (y < -kRoom) angle = 0.0;
      EXPECT_NEAR(angle_needed(doorway, p, kRoom), std::max(angle, 0.0), 2.0 * kStep)
          << x << ' ' << y;
    }
  }
}

TEST(Doorway, OnlyBeyondTheReachOfTheLeafTheBodyIsClearOfIt) {
  const Doorway doorway;
  EXPECT_FALSE(is_clear_of_leaf(doorway, {0.6, -1.5}, 0.28));  // before the door
  EXPECT_FALSE(is_clear_of_leaf(doorway, {0.6, 1.0}, 0.28));
  EXPECT_TRUE(is_clear_of_leaf(doorway, {0.6, 1.1}, 0.28));
}

TEST(Doorway, TheFrameIsBesideTheOpening) {
  const Doorway doorway;
  EXPECT_NEAR(frame_distance(doorway, {0.6, 0.0}), 0.33, 1e-12);
  EXPECT_NEAR(frame_distance(doorway, {0.2, 0.0}), 0.2, 1e-12);
  EXPECT_NEAR(frame_distance(doorway, {-0.5, 0.3}), 0.3, 1e-12);
}

}  // namespace
}  // namespace hg::person
