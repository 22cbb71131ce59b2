#include "hg/simulator/person/walker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"

namespace hg::person {
namespace {

using Eigen::Vector2d;

constexpr double kDt = 1e-3;  // s
constexpr double kPi = 3.14159265358979323846;

Walk circle() {
  Walk walk;
  walk.kind = WalkKind::kCircle;
  walk.speed = 0.25;
  walk.circle_radius = 0.7;
  walk.vertical_bob = walk.lateral_bob = 0.0;
  return walk;
}

Walk path(std::vector<Checkpoint> checkpoints) {
  Walk walk;
  walk.kind = WalkKind::kCheckpoints;
  walk.speed = 0.8;
  walk.vertical_bob = walk.lateral_bob = 0.0;
  walk.checkpoints = std::move(checkpoints);
  return walk;
}

// a handle that is where the hand wants it
Pose follows(const Walker& walker) {
  const double azimuth = walker.heading() + walker.walk().azimuth_from_heading;
  return {walker.hand(), model::haptic_giant::hand_orientation(azimuth, 1.4, 0.0)};
}

double angle_between(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

TEST(Walker, StartsWithTheHandAtTheHandle) {
  Walk walk = circle();
  walk.azimuth_from_heading = -0.5 * kPi;
  Walker walker(walk);
  walker.start({0.9, 0.2, -0.75}, 0.5 * kPi);
  EXPECT_LT((walker.hand() - Eigen::Vector3d(0.9, 0.2, 0.0)).norm(), 1e-12);
  EXPECT_NEAR(walker.heading(), kPi, 1e-12);
  // looking along -x, the hand 0.35 before and 0.15 to the right
  EXPECT_LT((walker.body() - Vector2d(0.9 + 0.35, 0.2 - 0.15)).norm(), 1e-12);
  EXPECT_LT((walker.shoulder() - Eigen::Vector3d(1.25, 0.2, 0.0)).norm(), 1e-12);
}

TEST(Walker, OnACircleTheHandKeepsRadiusAndSpeed) {
  for (const double speed : {0.25, 0.6, 1.0}) {
    SCOPED_TRACE(speed);
    Walk walk = circle();
    walk.speed = speed;
    Walker walker(walk);
    walker.start({0.9, 0.0, 0.0}, 0.5 * kPi);
    for (double t = 0.0; t < 6.0; t += kDt) walker.step(kDt, {});
    // the centre from three points of the settled walk
    Vector2d mean = Vector2d::Zero();
    const int turn = static_cast<int>(std::lround(2.0 * kPi * 0.7 / speed / kDt));
    std::vector<Vector2d> points;
    double length = 0.0;
    for (int k = 0; k < turn; ++k) {
      walker.step(kDt, {});
      if (!points.empty()) length += (walker.hand().head<2>() - points.back()).norm();
      points.push_back(walker.hand().head<2>());
      mean += points.back() / turn;
    }
    for (const Vector2d& p : points) ASSERT_NEAR((p - mean).norm(), 0.7, 2e-3);
    EXPECT_NEAR(length / (turn * kDt), speed, 2e-3 * speed);
    const Vector2d outwards = points.back() - mean,
                   motion = points.back() - points[points.size() - 2];
    EXPECT_GT(outwards.x() * motion.y() - outwards.y() * motion.x(), 0.0);  // counterclockwise
  }
}

TEST(Walker, TheHeadingLagsBehindTheTangent) {
  Walker walker(circle());
  walker.start({0.9, 0.0, 0.0}, 0.5 * kPi);
  Vector2d before = walker.body();
  for (double t = 0.0; t < 5.0; t += kDt) {
    before = walker.body();
    walker.step(kDt, {});
  }
  const Vector2d motion = walker.body() - before;
  const double lag = std::remainder(std::atan2(motion.y(), motion.x()) - walker.heading(), 2 * kPi);
  EXPECT_NEAR(lag, 0.25 / 0.7 * 0.4, 1e-3);
}

TEST(Walker, TheBodyAcceleratesLikeAPersonAndStopsAtItsGoal) {
  Walker walker(path({{{-1.2, -1.5}, 0.0}}));
  walker.start({0.9, 0.0, 0.0}, 0.5 * kPi);
  Vector2d p = walker.body(), v = Vector2d::Zero();
  double fastest = 0.0;
  for (double t = 0.0; t < 8.0; t += kDt) {
    walker.step(kDt, {});  // the handle does not follow... and is never out of reach here
    const Vector2d v_now = (walker.body() - p) / kDt;
    ASSERT_LE((v_now - v).norm() / kDt, 1.0 + 1e-6) << t;
    fastest = std::max(fastest, v_now.norm());
    p = walker.body();
    v = v_now;
    if (walker.speed() == 0.0) break;
  }
  EXPECT_LE(fastest, 0.8 + 1e-9);
}

TEST(Walker, ReachesSixCheckpointsInTheirOrder) {
  const std::vector<Checkpoint> points = {{{-1.2, -1.5}, 0.0}, {{1.2, -1.5}, 0.5 * kPi},
                                          {{1.45, 0.3}, kPi},  {{0.0, 0.0}, 1.5 * kPi},
                                          {{-1.45, 1.2}, 0.0}, {{1.0, 1.85}, 0.5 * kPi}};
  Walk walk = path(points);
  walk.azimuth_from_heading = -0.5 * kPi;
  Walker walker(walk);
  walker.start({0.9, 0.0, 0.0}, 0.5 * kPi);
  for (double t = 0.0; t < 60.0 && walker.reached() < 6; t += kDt) {
    const int before = walker.reached();
    const Pose handle = follows(walker);
    const double heading = walker.heading();
    walker.step(kDt, handle);
    if (walker.reached() == before) continue;
    const Checkpoint& point = points[before];
    EXPECT_LT((handle.p.head<2>() - point.p).norm(), 0.10);
    EXPECT_LT(angle_between(heading, point.heading), 15.0 * kPi / 180.0);
  }
  EXPECT_EQ(walker.reached(), 6);
  for (double t = 0.0; t < 5.0; t += kDt) walker.step(kDt, follows(walker));
  EXPECT_LT((walker.hand().head<2>() - points.back().p).norm(), 1e-3);  // stays there
  EXPECT_LT(walker.speed(), 1e-3);
}

TEST(Walker, ACheckpointNeedsPlaceAndHeadingOfTheHandle) {
  const auto reached = [](double x, double azimuth) {
    Walker walker(path({{{0.0, 0.0}, 0.0}}));
    walker.start({0.3, 0.0, 0.0}, 0.0);
    walker.step(kDt, {{x, 0.0, 0.0}, model::haptic_giant::hand_orientation(azimuth, 1.4, 0.0)});
    return walker.reached();
  };
  EXPECT_EQ(reached(0.09, 0.25), 1);
  EXPECT_EQ(reached(0.11, 0.0), 0);
  EXPECT_EQ(reached(0.09, 0.27), 0);
  EXPECT_EQ(reached(0.09, -0.27), 0);
}

TEST(Walker, WaitsForAHandleOutOfReach) {
  Walker walker(path({{{3.0, 0.0}, 0.0}}));
  walker.start({0.0, 0.0, 0.0}, 0.0);
  const Pose stuck = follows(walker);
  for (double t = 0.0; t < 6.0; t += kDt) walker.step(kDt, stuck);
  EXPECT_LT(walker.speed(), 0.1);
  // it stops once the handle is 0.65 m behind the shoulder, or as soon after as a person can
  const double stretched = (stuck.p - walker.shoulder()).head<2>().norm();
  EXPECT_GT(stretched, 0.64);
  EXPECT_LT(stretched, 0.65 + 0.8 * 0.8 / 2.0 + 0.01);
}

TEST(Walker, TheGaitMovesTheHandUpAndSideways) {
  Walk walk = circle();
  walk.speed = 1.0;
  walk.circle_radius = 50.0;  // as good as straight
  walk.vertical_bob = 0.015;
  Walker bobbing(walk);
  walk.vertical_bob = 0.0;
  walk.lateral_bob = 0.02;
  Walker swaying(walk);
  walk.lateral_bob = 0.0;
  Walker gliding(walk);
  for (Walker* walker : {&bobbing, &swaying, &gliding}) walker->start({0, 0, 0}, 0.0);
  int rises = 0, turns = 0;
  double highest = 0.0, widest = 0.0, last_z = 0.0, last_y = 0.0;
  for (int k = 0; k < 11'000; ++k) {
    for (Walker* walker : {&bobbing, &swaying, &gliding}) walker->step(kDt, {});
    if (k < 1000) continue;  // still getting faster
    const double z = bobbing.hand().z(), h = gliding.heading();
    const double y =
        (swaying.hand() - gliding.hand()).head<2>().dot(Vector2d(-std::sin(h), std::cos(h)));
    rises += last_z <= 0.0 && z > 0.0;
    turns += last_y <= 0.0 && y > 0.0;
    highest = std::max(highest, z);
    widest = std::max(widest, y);
    last_z = z;
    last_y = y;
  }
  EXPECT_EQ(rises, 18);  // 1.8 Hz for 10 s
  EXPECT_EQ(turns, 9);
  EXPECT_NEAR(highest, 0.015, 1e-5);
  EXPECT_NEAR(widest, 0.02, 1e-5);
}

TEST(Walker, RefusesAWalkWithoutAPerson) {
  Walk walk = circle();
  walk.circle_radius = 0.3;
  EXPECT_FALSE(has_room(walk));
  EXPECT_THROW(Walker{walk}, SetupError);
  walk.circle_radius = 0.7;
  walk.speed = 1.2;  // turns faster than a body
  EXPECT_FALSE(has_room(walk));
  EXPECT_THROW(Walker{path({})}, SetupError);
  EXPECT_THROW(Walker{path(std::vector<Checkpoint>(17))}, SetupError);
  walk = circle();
  walk.speed = 0.0;
  EXPECT_THROW(Walker{walk}, SetupError);
}

}  // namespace
}  // namespace hg::person
