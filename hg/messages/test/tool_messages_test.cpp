#include "hg/messages/tool_messages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::messages {
namespace {

constexpr double kRounding = 1e-15;  // values are of order 1

RunNames info() {
  RunNames info;
  info.gantry_joints = {"p1"};
  info.manipulator_joints = {"m1", "m2"};
  info.twin_joints = {{"slide", false}, {"root", true}, {"hinge", false}};
  info.limits = {{LimitKind::kManipulatorJoint, "m1", true, {-1.0, 1.0}},
                 {LimitKind::kCartesian, "elbow x", false, {-1.0, 1.0}}};
  return info;
}

TEST(ToolMessages, JoinGantryAndManipulator) {
  Sample sample;
  sample.record.robot.q_p = VectorP::Constant(1, 1.0);
  sample.record.robot.dq_p = VectorP::Constant(1, 2.0);
  sample.record.robot.q_m = VectorM::LinSpaced(2, 3.0, 4.0);
  sample.record.robot.dq_m = VectorM::LinSpaced(2, 5.0, 6.0);
  sample.sensors.tau_m = VectorM::LinSpaced(2, 7.0, 8.0);
  ToolMessages messages(info());
  messages.update(sample, 0);
  const JointState& device = messages.device();
  EXPECT_EQ(device.name, (std::vector<std::string>{"p1", "m1", "m2"}));
  EXPECT_EQ(device.position, (std::vector<double>{1.0, 3.0, 4.0}));
  EXPECT_EQ(device.velocity, (std::vector<double>{2.0, 5.0, 6.0}));
  EXPECT_TRUE(std::isnan(device.effort[0]));
  EXPECT_EQ(device.effort[1], 7.0);
  EXPECT_EQ(device.effort[2], 8.0);
}

TEST(ToolMessages, LeaveFloatingJointsOut) {
  Sample sample;
  sample.record.twin.q_a = ConfigurationA::LinSpaced(9, 0.0, 8.0);
  sample.record.twin.dq_a = VectorA::LinSpaced(8, 10.0, 17.0);
  sample.record.tau_a = VectorA::LinSpaced(8, 20.0, 27.0);
  ToolMessages messages(info());
  messages.update(sample, 0);
  const JointState& twin = messages.twin();
  EXPECT_EQ(twin.name, (std::vector<std::string>{"slide", "hinge"}));
  EXPECT_EQ(twin.position, (std::vector<double>{0.0, 8.0}));
  EXPECT_EQ(twin.velocity, (std::vector<double>{10.0, 17.0}));
  EXPECT_EQ(twin.effort, (std::vector<double>{20.0, 27.0}));
}

TEST(ToolMessages, SayNanForWhatTheSampleDoesNotHave) {
  ToolMessages messages(info());
  messages.update(Sample{}, 0);
  for (const JointState& state : {messages.device(), messages.twin(), messages.limits()}) {
    ASSERT_EQ(state.position.size(), state.name.size());
    ASSERT_EQ(state.velocity.size(), state.name.size());
    ASSERT_EQ(state.effort.size(), state.name.size());
    for (const double position : state.position) EXPECT_TRUE(std::isnan(position));
  }
}

TEST(ToolMessages, TurnTheWrenchIntoTheHandle) {
  Sample sample;
  // the handle's x axis points along y of the base
  sample.record.T_B_H.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  sample.record.robot.w_H << 0.0, 2.0, 0.0, -3.0, 0.0, 0.0;
  ToolMessages messages(info());
  messages.update(sample, 0);
  const WrenchStamped& stamped = messages.user_wrench();
  EXPECT_EQ(stamped.header.frame_id, "handle");
  EXPECT_EQ(stamped.wrench.force.x, 2.0);
  EXPECT_EQ(stamped.wrench.force.y, 0.0);
  EXPECT_EQ(stamped.wrench.torque.y, 3.0);
}

TEST(ToolMessages, PlaceHandleAndElbowInTheBase) {
  Sample sample;
  sample.record.T_B_H.p = {1.0, 2.0, 3.0};
  sample.record.T_B_H.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  sample.record.T_B_E = sample.record.T_B_H;
  sample.record.T_B_E.p.x() = 1.5;
  sample.record.p_B_elbow = {4.0, 5.0, 6.0};
  ToolMessages messages(info());
  messages.update(sample, 1'800'000'000'250'000'000);
  const auto& [handle, elbow] =
      std::tie(messages.transforms().transforms[0], messages.transforms().transforms[1]);
  EXPECT_EQ(handle.header.frame_id, "base");
  EXPECT_EQ(handle.header.stamp.sec, 1'800'000'000);
  EXPECT_EQ(handle.header.stamp.nanosec, 250'000'000u);
  EXPECT_EQ(handle.child_frame_id, "handle");
  EXPECT_EQ(handle.transform.translation.y, 2.0);
  EXPECT_NEAR(handle.transform.rotation.z, std::sqrt(0.5), kRounding);
  EXPECT_NEAR(handle.transform.rotation.w, std::sqrt(0.5), kRounding);
  EXPECT_EQ(elbow.child_frame_id, "elbow");
  EXPECT_EQ(elbow.transform.translation.z, 6.0);
  EXPECT_EQ(elbow.transform.rotation.w, 1.0);
  const auto& twin_end = messages.transforms().transforms[2];
  EXPECT_EQ(twin_end.child_frame_id, "twin_end");
  EXPECT_EQ(twin_end.transform.translation.x, 1.5);
  EXPECT_NEAR(twin_end.transform.rotation.z, std::sqrt(0.5), kRounding);
}

TEST(ToolMessages, TurnTheTwistIntoTheHandle) {
  Sample sample;
  // the handle's x axis points along y of the base
  sample.record.T_B_H.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  sample.record.v_H = {0.0, 2.0, 0.0};
  ToolMessages messages(info());
  messages.update(sample, 0);
  EXPECT_EQ(messages.handle_twist().header.frame_id, "handle");
  EXPECT_EQ(messages.handle_twist().twist.linear.x, 2.0);
  EXPECT_EQ(messages.handle_twist().twist.angular.z, 0.0);
  // 10 ms later it has turned by 20 mrad about its own y axis
  sample.record.time_s = 0.01;
  sample.record.T_B_H.R *= Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  messages.update(sample, 0);
  EXPECT_NEAR(messages.handle_twist().twist.angular.y, 2.0, 1e-9);
  EXPECT_NEAR(messages.handle_twist().twist.angular.x, 0.0, 1e-9);
}

TEST(ToolMessages, SayHowFarTheLimitsAre) {
  Sample sample;
  sample.record.limit_count = 2;
  sample.record.limits[1] = {.to_lower = 0.3, .to_upper = 0.1, .reaction = -5.0};
  ToolMessages messages(info());
  messages.update(sample, 0);
  EXPECT_EQ(messages.limits().name, (std::vector<std::string>{"m1", "elbow x"}));
  EXPECT_EQ(messages.limits().position[1], 0.1);
  EXPECT_EQ(messages.limits().effort[1], -5.0);
  EXPECT_TRUE(std::isinf(messages.limits().position[0]));
}

TEST(ToolMessages, HaveTheLinksInTheTransforms) {
  LinkTree links;
  links.frames = {{"base", "m1"}, {"m1", "m2"}};
  links.poses = [](const Sample& sample, std::vector<Pose>& poses) {
    poses.at(1).p.x() = sample.record.time_s;
  };
  Sample sample;
  sample.record.time_s = 3.0;
  ToolMessages messages(info(), links);
  messages.update(sample, 0);
  const auto& transforms = messages.transforms().transforms;
  ASSERT_EQ(transforms.size(), 5u);
  EXPECT_EQ(transforms[4].header.frame_id, "m1");
  EXPECT_EQ(transforms[4].child_frame_id, "m2");
  EXPECT_EQ(transforms[4].transform.translation.x, 3.0);
}

}  // namespace
}  // namespace hg::messages
