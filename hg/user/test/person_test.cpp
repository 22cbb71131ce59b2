#include "hg/user/person.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"

namespace hg::user {
namespace {

model::Chain free_body() { return model::Chain::free_body({}, {.gravity = false}); }

Person make(const Config& config) {
  const model::Chain chain = free_body();
  return Person(config, chain, chain.frame("handle"), {});
}

Config scripted() {
  Config config;
  config.script.start[4] = 1.4;
  config.script.start[kGripChannel] = 1.0;
  config.script.duration_s = 5.0;
  return config;
}

// R_B_H of azimuth 0, pitch 1.4, roll 0
Pose start_pose() {
  const double pi = 3.14159265358979323846;
  return {Eigen::Vector3d::Zero(), (Eigen::AngleAxisd(pi - 1.4, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(pi, Eigen::Vector3d::UnitZ()))
                                       .toRotationMatrix()};
}

TEST(Person, PullsTheHandleToItsGoalLikeASpring) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  EXPECT_LT(person.wrench(0.0, handle, {}).norm(), 1e-9);
  handle.T_B_H.p.x() = -0.1;
  EXPECT_NEAR(person.wrench(0.0, handle, {})[0], 20.0, 1e-9);
  handle.twist[0] = 0.5;
  EXPECT_NEAR(person.wrench(0.0, handle, {})[0], 20.0 - 10.0, 1e-9);
}

TEST(Person, TurnsTheHandleBackAboutTheAxisOfTheError) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  handle.T_B_H.R =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix() * handle.T_B_H.R;
  const Vector6 w = person.wrench(0.0, handle, {});
  EXPECT_NEAR(w[5], -0.4, 1e-9);
  EXPECT_LT(w.head<5>().norm(), 1e-9);
}

TEST(Person, PullsNoHarderThanAPerson) {
  Person person = make(scripted());
  HandleMotion handle{start_pose()};
  handle.T_B_H.p = {-3, 4, 0};
  EXPECT_NEAR(person.wrench(0.0, handle, {}).head<3>().norm(), 60.0, 1e-9);
}

TEST(Person, ReleasedItOnlyPushesAsTheScriptSays) {
  Config config = scripted();
  config.script.start[kGripChannel] = 0.0;
  config.script.start[kWrenchChannel + 2] = 5.0;  // along z of H
  Person person = make(config);
  HandleMotion handle{start_pose()};
  handle.T_B_H.p.x() = 1.0;
  const Vector6 w = person.wrench(0.0, handle, {});
  EXPECT_LT((w.head<3>() - 5.0 * handle.T_B_H.R.col(2)).norm(), 1e-9);
}

TEST(Person, TheMouseOverrulesTheScriptAndPressesTheLever) {
  Person person = make(scripted());
  HandTarget target;
  target.active = true;
  target.p_B = {0.1, 0.0, 0.0};
  target.press = 0.5;
  const Vector6 w = person.wrench(0.0, {start_pose()}, target);
  EXPECT_NEAR(w[0], 20.0, 1e-9);
  EXPECT_NEAR(w[2], -7.0, 1e-9);
  EXPECT_LT(w.tail<3>().norm(), 1e-9);  // the mouse holds no orientation
}

TEST(Person, AHandThatPressesDoesNotHoldTheHeight) {
  Person person = make(scripted());
  HandTarget target;
  target.active = true;
  target.p_B = {0.0, 0.0, 0.3};
  EXPECT_NEAR(person.wrench(0.0, {start_pose()}, target)[2], 60.0, 1e-9);
  target.press = 1.0;
  EXPECT_NEAR(person.wrench(0.0, {start_pose()}, target)[2], -14.0, 1e-9);
}

TEST(Person, NobodyPushesNothing) {
  Config config = scripted();
  config.kind = PersonKind::kNone;
  Person person = make(config);
  HandleMotion handle;
  handle.T_B_H.p.x() = 1.0;
  EXPECT_EQ(person.wrench(0.0, handle, {}), Vector6(Vector6::Zero()));
}

TEST(Person, RefusesANegativeStiffness) {
  Config config = scripted();
  config.hand.stiffness.x() = -1.0;
  EXPECT_THROW(make(config), SetupError);
}

}  // namespace
}  // namespace hg::user
