// Torque over position: the curve on its own, and on a twin's joint over time.
#include "hg/controller/rendering/profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/controller/rendering/test/playing.h"
#include "hg/core/error.h"

namespace hg::rendering {
namespace {

constexpr double kPitch = 0.3;   // rad between two detents
constexpr double kTorque = 2.0;  // Nm, the most of a detent

Profile detents(double friction = 0.0) {
  return Profile({{0.0, 0.0, friction},
                  {0.25 * kPitch, kTorque, friction},
                  {0.75 * kPitch, -kTorque, friction}},
                 kPitch);
}

// The same on the hinge of a door without any other force on it.
TwinModel door_with(const Profile& profile, double start) {
  TwinModel twin = door();
  twin.dofs[0].limits = {};
  twin.dofs[0].profile = profile;
  twin.q_start[0] = start;
  return twin;
}

// Work against the torque from a to b, by the midpoints of many steps.
double work(const Profile& profile, double a, double b) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += profile.torque(a + (b - a) * (i + 0.5) / kSteps);
  return sum * (b - a) / kSteps;
}

TEST(Profile, MeetsItsPointsAndStaysBetweenNeighbours) {
  const Profile profile({{0.0, 1.0}, {0.1, 3.0}, {0.5, 3.0}, {0.6, -2.0, 4.0}});
  EXPECT_DOUBLE_EQ(profile.torque(0.0), 1.0);
  EXPECT_DOUBLE_EQ(profile.torque(0.1), 3.0);
  EXPECT_DOUBLE_EQ(profile.torque(0.6), -2.0);
  EXPECT_EQ(profile.torque(-7.0), 1.0);  // beyond the points that of the nearest one
  EXPECT_EQ(profile.torque(7.0), -2.0);
  for (double q = 0.1; q <= 0.5; q += 0.01) EXPECT_DOUBLE_EQ(profile.torque(q), 3.0);
  for (double q = -0.1; q <= 0.7; q += 0.001) {
    EXPECT_GE(profile.torque(q), -2.0);
    EXPECT_LE(profile.torque(q), 3.0);
    EXPECT_GE(profile.friction(q), 0.0);
  }
}

TEST(Profile, ALineThroughTwoPointsIsALine) {
  const Profile line({{0.0, 100.0}, {0.5, 150.0}});
  for (double q = 0.0; q <= 0.5; q += 0.05) EXPECT_NEAR(line.torque(q), 100.0 + 100.0 * q, 1e-9);
  EXPECT_NEAR(line.steepest(), 100.0, 1e-9);
}

TEST(Profile, ItsSlopeIsContinuousAndNowhereSteeperThanSaid) {
  const Profile profile = detents();
  constexpr double kStep = 1e-5;
  double before = (profile.torque(-kStep) - profile.torque(-2 * kStep)) / kStep, most = 0.0;
  for (double q = 0.0; q < 2.0 * kPitch; q += kStep) {
    const double slope = (profile.torque(q) - profile.torque(q - kStep)) / kStep;
    EXPECT_NEAR(slope, before, 0.3);
    most = std::max(most, std::abs(slope));
    before = slope;
  }
  EXPECT_NEAR(profile.steepest(), most, 0.3);
}

TEST(Profile, AClosedPathTakesNoWorkAndNorDoesAPeriod) {
  const Profile profile = detents();
  EXPECT_NEAR(work(profile, -0.4, 1.1) + work(profile, 1.1, -0.4), 0.0, 1e-9);
  EXPECT_NEAR(work(profile, 0.07, 0.07 + 3.0 * kPitch), 0.0, 1e-6);
}

TEST(Profile, SaysWhatIsWrong) {
  EXPECT_EQ(profile_fault({{0.0, 1.0}}, kInfinity), "a profile needs 2 .. 100 points, got 1");
  EXPECT_EQ(profile_fault({{0.0}, {0.2}, {0.2}}, kInfinity),
            "positions must grow from point to point, got 0.2 after 0.2");
  EXPECT_EQ(profile_fault({{0.1}, {0.5}}, 0.3),
            "points must end before the first one repeats, at 0.4, got 0.5");
  EXPECT_THROW(Profile({{0.0, 1.0}}), SetupError);
}

TEST(Profile, ASlowHandFeelsTheTable) {
  Playing door(door_with(detents(), 0.0));
  const VectorA still = VectorA::Zero(2);
  for (double q = -0.4; q < 0.4; q += 0.01) {
    door.state.twin.q_a[0] = q;
    door.state.twin.dq_a = still;
    const double expected = detents().torque(q);
    door.step(door.wrench_for(0, expected));
    EXPECT_NEAR(door.state.twin.ddq_a[0], 0.0, 1e-9) << "the hand does not hold it at " << q;
    EXPECT_NEAR(door.result.budget.spring[0], expected, 1e-12);
  }
}

// A stiff hand that moves slowly: what it gives, less what the curve says, at most.
double difference_on_a_slow_path(Playing& door, const Profile& profile, double from, double to,
                                 double friction) {
  constexpr double kSpeed = 0.05, kStiffness = 1000.0, kDamping = 100.0;  // rad/s, Nm/rad, Nms/rad
  const double side = to > from ? 1.0 : -1.0;
  double hand = from, worst = 0.0;
  while (side * (to - hand) > 0.0) {
    hand += side * kSpeed * kDt;
    const double torque = kStiffness * (hand - door.q(0)) + kDamping * (side * kSpeed - door.dq(0));
    door.step(door.wrench_for(0, torque));
    if (std::abs(hand - from) < 0.05) continue;  // it has yet to begin to move
    worst = std::max(worst, std::abs(torque - profile.torque(door.q(0)) - side * friction));
  }
  return worst;
}

TEST(Profile, AHandOnASlowPathFeelsTheTableAndTheFrictionAgainstItsWay) {
  for (const double friction : {0.0, 0.5}) {
    const Profile profile = detents(friction);
    Playing door(door_with(profile, 0.0));
    EXPECT_LT(difference_on_a_slow_path(door, profile, 0.0, 0.4, friction), 0.05);
    EXPECT_LT(difference_on_a_slow_path(door, profile, 0.4, 0.0, friction), 0.05);
  }
}

TEST(Profile, ASwingInADetentKeepsItsEnergyForAMinute) {
  const Profile profile = detents();
  Playing door(door_with(profile, 0.1));
  door.state.twin.q_a[1] = 0.4;
  const auto energy = [&] {
    const double q = door.q(0), dq = door.dq(0);
    return work(profile, 0.0, q) + 0.5 * door.rendering.twin_chain().M()(0, 0) * dq * dq;
  };
  door.run(0.002, 0, 0.0);
  const double first = energy();
  double least = first, most = first;
  for (int i = 0; i < 60; ++i) {
    door.run(1.0, 0, 0.0);
    least = std::min(least, energy());
    most = std::max(most, energy());
  }
  EXPECT_GT(first, 0.05);
  EXPECT_LT(most - least, 0.002 * first);
}

TEST(Profile, AnOverCentreLatchFallsToEitherSide) {
  // pulls to 0 below 0.2 and to 0.4 above
  const Profile over_centre({{0.0, 0.0}, {0.1, 3.0}, {0.3, -3.0}, {0.4, 0.0}});
  for (const double start : {0.19, 0.21}) {
    TwinModel twin = door_with(over_centre, start);
    twin.dofs[0].limits = {0.0, 0.4, 2.0, 20.0};
    twin.dofs[0].damping = 1.0;
    Playing door(twin);
    door.run(6.0, 0, 0.0);
    EXPECT_NEAR(door.q(0), start < 0.2 ? 0.0 : 0.4, 2e-3);
  }
}

// Where the hinge starts to move in a direction, by torques that grow slowly.
double breakaway(const Profile& profile, double q, double direction) {
  for (double extra = 0.0; extra < 10.0; extra += 0.05) {
    Playing door(door_with(profile, q));
    door.run(0.02, 0, profile.torque(q) + direction * extra);
    if (direction * (door.q(0) - q) > 1e-6) return extra;
  }
  return kInfinity;
}

TEST(Profile, AGasSpringIsHarderToPushInThanItPushesOut) {
  const Profile gas({{0.0, 20.0, 3.0}, {0.5, 14.0, 1.0}});
  EXPECT_NEAR(breakaway(gas, 0.0, 1.0), 3.0, 0.1);
  EXPECT_NEAR(breakaway(gas, 0.0, -1.0), 3.0, 0.1);
  EXPECT_NEAR(breakaway(gas, 0.25, 1.0), 2.0, 0.1);
  EXPECT_NEAR(breakaway(gas, 0.25, -1.0), 2.0, 0.1);
}

TEST(Profile, ItsFrictionDoesNotChatterAtRest) {
  Playing door(door_with(detents(1.5), 0.1));
  door.run(2.0, 0, 0.0);
  const double q = door.q(0);
  EXPECT_EQ(door.limit(0).cause, LimitCause::kFriction);
  door.changes = 0;
  door.run(1.0, 0, 0.0);
  EXPECT_NEAR(door.q(0), q, 1e-9);
  EXPECT_EQ(door.changes, 0);
}

}  // namespace
}  // namespace hg::rendering
