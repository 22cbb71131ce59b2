#include "hg/simulator/person/person.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"

namespace hg::person {
namespace {

constexpr double kDt = 1e-3;  // s
constexpr double kGrasp = 0.7;

model::ChainModel free_body() { return model::ChainModel::free_body({}, {.gravity = false}); }

Person make(const PersonConfig& config) {
  const model::ChainModel chain = free_body();
  return Person(config, chain, chain.frame("handle"), {});
}

// holds the origin at pitch 1.4, without tremor
PersonConfig scripted() {
  PersonConfig config;
  config.hand.tremor_rms = 0.0;
  config.script.start[4] = 1.4;
  config.script.start[kGripChannel] = 1.0;
  config.script.duration_s = 5.0;
  return config;
}

Pose start_pose() { return {{0, 0, 0}, model::haptic_giant::hand_orientation(0.0, 1.4, 0.0)}; }

// the wrench at the end of a spell with the handle at rest
Vector6 hold(Person& person, const HandleMotion& handle, double from, double to,
             const HandTarget& target = {}) {
  Vector6 wrench = Vector6::Zero();
  for (double t = from; t < to; t += kDt) wrench = person.wrench(t, handle, target);
  return wrench;
}

double in_series(double arm, double grip) { return arm * grip / (arm + grip); }

TEST(Person, UntilTheGraspTheHandleIsNotHeld) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.x() = 0.3;
  HandTarget target;
  target.active = true;
  for (double t = 0.0; t < kGrasp - 0.5 * kDt; t += kDt) {
    ASSERT_FALSE(person.is_holding(t));
    ASSERT_EQ(person.wrench(t, handle, {}), Vector6(Vector6::Zero()));
    ASSERT_EQ(person.wrench(t, handle, target), Vector6(Vector6::Zero()));
  }
  EXPECT_TRUE(person.is_holding(kGrasp));
  EXPECT_TRUE(person.is_holding(1e6));
}

TEST(Person, TakesAMovingHandleWithoutAJerk) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  handle.twist[0] = 0.5;
  handle.T_B_H.p.x() = 0.2;
  EXPECT_EQ(person.wrench(kGrasp, handle, {}), Vector6(Vector6::Zero()));
  handle.T_B_H.p.x() += kDt * 0.5;
  EXPECT_LT(person.wrench(kGrasp + kDt, handle, {}).head<3>().norm(), 2.0);
  EXPECT_LT(hold(person, handle, kGrasp + 2 * kDt, 3.0)[0], -35.0);
}

TEST(Person, PlaysTheScriptFromTheGraspOn) {
  PersonConfig config = scripted();
  config.script.grasp_s = 1.5;
  config.script.start[kGripChannel] = 0.0;
  config.script.segments = {{1.0, 1.0, kWrenchChannel, Blend::kTo, 8.0}};
  Person person = make(config);
  EXPECT_EQ(person.duration_s(), 1.5 + 5.0);
  const HandleMotion handle{start_pose()};
  EXPECT_EQ(hold(person, handle, 0.0, 2.5).norm(), 0.0);
  EXPECT_NEAR(person.wrench(3.0, handle, {}).norm(), 4.0, 1e-9);
  EXPECT_NEAR(person.wrench(3.5, handle, {}).norm(), 8.0, 1e-9);
}

TEST(Person, AJumpOfAClientsTargetIsTakenUpAtABoundedSpeed) {
  PersonConfig config = scripted();
  config.kind = PersonKind::kMouse;
  Person person = make(config);
  const HandleMotion handle{start_pose()};
  HandTarget target;
  target.active = target.turns = true;
  target.R_B = handle.T_B_H.R;
  EXPECT_LT(hold(person, handle, 0.0, 2.0, target).norm(), 1e-9);
  target.p_B.x() = 0.2;
  target.R_B = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()) * handle.T_B_H.R;
  const Vector6 soon = hold(person, handle, 2.0, 2.05, target);
  EXPECT_LT(soon.head<3>().norm(), 13.0);
  EXPECT_LT(soon.tail<3>().norm(), 0.2);
  const Vector6 late = hold(person, handle, 2.05, 8.0, target);
  EXPECT_NEAR(late[0], 0.2 * in_series(250, 1000), 1e-6);
  EXPECT_GT(late.tail<3>().norm(), 1.5);
}

TEST(Person, PullsTheHandleToItsGoalThroughArmAndGrip) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.x() = -0.1;
  EXPECT_NEAR(hold(person, handle, 0.0, 4.0)[0], 0.1 * in_series(250, 1000), 1e-6);
}

TEST(Person, FollowsAMovingGoalWithoutDragging) {
  PersonConfig config = scripted();
  config.hand.stiffness.setZero();
  config.hand.damping = {20, 20, 20};
  config.script.segments = {{0.0, 2.0, 0, Blend::kTo, 1.0}};
  Person person = make(config);
  // half way the goal moves with 1.875 / 2 m/s; a handle at rest feels the damper
  const Vector6 w = hold(person, {start_pose()}, 0.0, kGrasp + 1.0);
  EXPECT_NEAR(w[0], 20.0 * 1.875 / 2.0, 0.5);
}

TEST(Person, ReleasedItOnlyPushesAsTheScriptSays) {
  PersonConfig config = scripted();
  config.hand.tremor_rms = 0.05;
  config.script.start[kGripChannel] = 0.0;
  config.script.start[kWrenchChannel + 2] = 5.0;  // along z of H
  Person person = make(config);
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.x() = 1.0;
  const Vector6 w = hold(person, handle, 0.0, 2.0);
  EXPECT_LT((w.head<3>() - 5.0 * handle.T_B_H.R.col(2)).norm(), 1e-12);
  EXPECT_EQ(w.tail<3>().norm(), 0.0);
}

TEST(Person, HalfAGripIsHalfAHand) {
  PersonConfig config = scripted();
  Person whole = make(config);
  config.script.start[kGripChannel] = 0.5;
  Person half = make(config);
  HandleMotion handle{start_pose()};
  for (double t = kGrasp; t < 2.0; t += kDt) {
    handle.T_B_H.p.y() = 0.05 * std::sin(20.0 * t);
    const Vector6 w = whole.wrench(t, handle, {});
    ASSERT_LT((0.5 * w - half.wrench(t, handle, {})).norm(), 1e-12);
  }
}

TEST(Person, TheMouseOverrulesTheScriptAndPressesTheLever) {
  Person person = make(scripted());
  HandTarget target;
  target.active = true;
  target.p_B = {0.1, 0.0, 0.3};
  EXPECT_NEAR(hold(person, {start_pose()}, 0.0, 4.0, target)[2], 0.3 * in_series(200, 1000), 1e-6);
  target.press = 1.0;  // holds no height
  const Vector6 w = hold(person, {start_pose()}, 4.0, 8.0, target);
  EXPECT_NEAR(w[0], 0.1 * in_series(250, 1000), 1e-6);
  // a pull along a lever that is down lifts it: the hand presses against that, too
  EXPECT_NEAR(w[2], -14.0 - w[0], 1e-6);
  EXPECT_LT(w.tail<3>().norm(), 1e-9);  // the mouse holds no orientation
  EXPECT_NEAR(hold(person, {start_pose()}, 8.0, 12.0).norm(), 0.0, 1e-6);  // back to the script
}

TEST(Person, AMouseThatTurnsHoldsTheOrientationToo) {
  Person person = make(scripted());
  HandTarget target;
  target.active = true;
  target.R_B = start_pose().R * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  EXPECT_LT(hold(person, {start_pose()}, 0.0, 4.0, target).tail<3>().norm(), 1e-9);
  target.turns = true;
  const Eigen::Vector3d torque = hold(person, {start_pose()}, 4.0, 8.0, target).tail<3>();
  EXPECT_GT(torque.dot(start_pose().R.col(2)), 0.1);
}

TEST(Person, BackFromTheMouseTheScriptDoesNotCatchUpAtOnce) {
  PersonConfig config = scripted();
  config.hand.stiffness.setZero();  // damper only
  config.script.segments = {{1.0, 1.0, 0, Blend::kTo, 1.0}};
  Person person = make(config);
  hold(person, {start_pose()}, 0.0, kGrasp + 0.5);
  HandTarget target;
  target.active = true;
  hold(person, {start_pose()}, kGrasp + 0.5, kGrasp + 3.0, target);
  const double back = kGrasp + 3.0 + 0.5 * kDt;
  EXPECT_LT(hold(person, {start_pose()}, back, back + 2 * kDt).norm(), 0.1);
}

TEST(Person, AMouseThatLetsGoLetsGoAtOnceAndTakesHoldGently) {
  PersonConfig config = scripted();
  config.kind = PersonKind::kMouse;
  Person person = make(config);
  HandTarget target;
  target.active = true;
  target.p_B = {0.1, 0.0, 0.0};
  EXPECT_GT(hold(person, {start_pose()}, 0.0, 2.0, target).norm(), 10.0);
  EXPECT_EQ(hold(person, {start_pose()}, 2.0, 2.0 + kDt), Vector6(Vector6::Zero()));
  EXPECT_TRUE(person.is_holding(2.0));
  HandleMotion elsewhere{start_pose()};
  elsewhere.T_B_H.p = {0.0, 0.5, 0.0};
  EXPECT_LT(hold(person, elsewhere, 3.0, 3.0 + 2 * kDt, target).norm(), 2.0);
  EXPECT_EQ(person.duration_s(), 0.0);
}

TEST(Person, WithoutAPersonNothingPushesUntilATargetComes) {
  PersonConfig config = scripted();
  config.kind = PersonKind::kNone;
  Person person = make(config);
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.x() = 1.0;
  EXPECT_EQ(hold(person, handle, 0.0, 2.0), Vector6(Vector6::Zero()));
  EXPECT_TRUE(person.is_holding(2.0));
  HandTarget target;
  target.active = true;
  EXPECT_GT(hold(person, handle, 2.0, 4.0, target).norm(), 10.0);
}

PersonConfig walking() {
  PersonConfig config = scripted();
  config.script.walk.kind = WalkKind::kCheckpoints;
  config.script.walk.speed = 0.5;
  config.script.walk.vertical_bob = config.script.walk.lateral_bob = 0.0;
  config.script.walk.checkpoints = {{{1.0, 0.0}, 0.0}, {{1.0, 0.6}, 1.2}, {{40.0, 0.0}, 0.0}};
  config.script.duration_s = 20.0;
  return config;
}

// a handle of 6 kg in free space that turns with the walker
struct FreeHandle {
  HandleMotion motion{start_pose()};
  double path = 0.0, force = 0.0;

  void live(const Vector6& w, double heading) {
    motion.twist.head<3>() += kDt / 6.0 * (w.head<3>() - 4.0 * motion.twist.head<3>());
    motion.T_B_H.p += kDt * motion.twist.head<3>();
    motion.T_B_H.R = model::haptic_giant::hand_orientation(heading, 1.4, 0.0);
    path += kDt * motion.twist.head<2>().norm();
  }
};

TEST(Person, WalksFromCheckpointToCheckpointAndKeepsTheScore) {
  Person person = make(walking());
  FreeHandle handle;
  double sum = 0.0, path_at_second = 0.0, time_at_second = 0.0;
  int samples = 0;
  double heading = 0.0;
  for (double t = kGrasp; t < 20.0; t += kDt) {
    const int before = person.score().reached;
    const Vector6 w = person.wrench(t, handle.motion, {});
    sum += w.head<3>().norm();
    ++samples;
    if (before == 1 && person.score().reached == 2) {
      path_at_second = handle.path;
      time_at_second = t - kGrasp;
      EXPECT_NEAR(person.score().mean_force, sum / samples, 0.02 * sum / samples);
    }
    if (person.score().reached == 1) heading = std::min(1.2, heading + kDt);
    handle.live(w, heading);
  }
  const Score& score = person.score();
  ASSERT_EQ(score.reached, 2);  // 40 m in 20 s are out of reach
  EXPECT_NEAR(score.time_s[0] + score.time_s[1], time_at_second, 2e-3);
  EXPECT_GT(score.time_s[0], 1.0 / 0.5 - 0.5);
  EXPECT_NEAR(score.straight_length, 1.6, 1e-9);
  EXPECT_NEAR(score.path_length, path_at_second, 5e-3);
}

TEST(Person, WalkingItTurnsTheHandleAndKeepsItsHeight) {
  PersonConfig config = walking();
  config.script.start[2] = -0.75;
  config.script.walk.checkpoints = {{{0.0, 0.0}, 1.5}};  // turn on the spot
  Person person = make(config);
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.z() = -0.75;
  const Vector6 w = hold(person, handle, 0.0, 4.0);
  EXPECT_GT(w[5], 1.0);
  EXPECT_NEAR(w[2], 0.0, 1e-6);
}

TEST(Person, TheSameCallsGiveTheSameBitsWithoutAllocating) {
  PersonConfig config = walking();
  config.hand.tremor_rms = 0.05;
  Person person = make(config);
  Person copy = person;
  config.seed = 2;
  Person other = make(config);
  FreeHandle handle;
  double difference = 0.0;
  std::uint64_t allocations = 0;
  for (double t = 0.0; t < 3.0; t += kDt) {
    const AllocationCounter counter;
    const Vector6 w = person.wrench(t, handle.motion, {});
    allocations += counter.count();
    ASSERT_EQ(w, copy.wrench(t, handle.motion, {}));
    difference = std::max(difference, (w - other.wrench(t, handle.motion, {})).norm());
    handle.live(w, 0.0);
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(difference, 0.05);
  EXPECT_LT(difference, 2.0);
}

TEST(Person, RefusesANegativeStiffnessAndATimeBeforeTheStart) {
  PersonConfig config = scripted();
  config.hand.stiffness.x() = -1.0;
  EXPECT_THROW(make(config), SetupError);
  config = scripted();
  config.script.grasp_s = -0.1;
  EXPECT_THROW(make(config), SetupError);
}

}  // namespace
}  // namespace hg::person
