#include "hg/walking/walk.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hg/walking/generated_paths.h"

namespace hg::walking {
namespace {

// The first 100 s of a path of each kind.
std::vector<WalkedPath> some_paths() {
  Random random(5);
  std::vector<WalkedPath> paths = {
      make_building(random), make_path(PathFamily::kRightAngles, random),
      make_path(PathFamily::kRandomTurns, random), make_path(PathFamily::kStraight, random)};
  for (WalkedPath& path : paths)
    path.samples.resize(std::min<std::size_t>(path.samples.size(), 6000));
  return paths;
}

WalkFigures walked(const WalkedPath& path, RedirectionKind kind, const WalkRoom& room = {}) {
  return walk(path, *make_redirector(kind, room), room);
}

TEST(Walk, WithoutAMethodIsThePathItself) {
  const WalkRoom wide = {.walls = centered(1e4, 1e4)};
  for (const WalkedPath& path : some_paths()) {
    PlanarPose last;
    walk(path, *make_redirector(RedirectionKind::kNone, wide), wide,
         [&](const WalkMoment&, const PlanarPose& pose) { last = pose; });
    const WalkSample& first = path.samples.front();
    const Eigen::Vector2d way =
        Eigen::Rotation2Dd(-first.heading) * (path.samples.back().p - first.p);
    EXPECT_LT((last.p - way).norm(), 1e-9) << path.name;
  }
}

TEST(Walk, WithMotionCompressionNeedsNoResets) {
  for (const WalkedPath& path : some_paths()) {
    const WalkFigures none = walked(path, RedirectionKind::kNone);
    EXPECT_GT(none.resets, 5) << path.name;
    for (const auto kind : {RedirectionKind::kMotionCompression, RedirectionKind::kKnownRoute}) {
      const WalkFigures figures = walked(path, kind);
      EXPECT_EQ(figures.resets, 0) << path.name;
      EXPECT_GT(figures.clearance, 0.5) << path.name;
      EXPECT_LE(figures.bend_quantile(1.0), 10.0) << path.name;
    }
  }
}

// Lengths and turns in place are those of the target environment; only the way is bent.
TEST(Walk, WithMotionCompressionKeepsLengthsAndTurns) {
  const WalkRoom room;
  for (const WalkedPath& path : some_paths()) {
    Eigen::Vector2d last = room.walls.middle();
    double turned = 0.0, longest = 0.0;
    walk(path, *make_redirector(RedirectionKind::kMotionCompression, room), room,
         [&](const WalkMoment& moment, const PlanarPose& pose) {
           longest = std::max(longest, std::abs((pose.p - last).norm() - moment.distance()));
           if (moment.sample().v.norm() < 1e-9) {
             turned = std::max(
                 turned, std::abs(std::remainder(pose.heading - moment.room.heading - moment.turn(),
                                                 2.0 * std::numbers::pi)));
           }
           last = pose.p;
         });
    EXPECT_LT(longest, 1e-12) << path.name;
    EXPECT_LT(turned, 1e-9) << path.name;
  }
}

// What a person sees turns without a jump of its speed: a bend of 8/m at 1 m/s that began at once
// would be 480 rad/s^2.
TEST(Walk, WithMotionCompressionTurnsTheEnvironmentSmoothly) {
  const WalkRoom room;
  for (const WalkedPath& path : some_paths()) {
    double last = 0.0, most = 0.0;
    walk(path, *make_redirector(RedirectionKind::kMotionCompression, room), room,
         [&](const WalkMoment& moment, const PlanarPose& pose) {
           const double rate = std::remainder(pose.heading - moment.room.heading - moment.turn(),
                                              2.0 * std::numbers::pi) /
                               kWalkPeriod;
           most = std::max(most, std::abs(rate - last) / kWalkPeriod);
           last = rate;
         });
    EXPECT_LT(most, 100.0) << path.name;
  }
}

TEST(Walk, SteersToTheCenterOfAWideRoom) {
  const WalkRoom wide = {.walls = centered(40.0, 40.0)};
  Random random(1);
  const WalkedPath path = make_path(PathFamily::kStraight, random);
  EXPECT_GT(walked(path, RedirectionKind::kNone, wide).resets, 3);
  EXPECT_EQ(walked(path, RedirectionKind::kSteerToCenter, wide).resets, 0);
  EXPECT_EQ(walked(path, RedirectionKind::kPotentialField, wide).resets, 0);
}

TEST(Walk, AlignmentDoesNothingWhereBothEnvironmentsAreAlike) {
  const WalkRoom room = {.walls = centered(20.0, 20.0)};
  Random random(1);
  WalkedPath path = make_path(PathFamily::kRightAngles, random);
  path.samples.resize(600);
  path.spaces = {room.walls};
  const WalkFigures figures = walked(path, RedirectionKind::kAlignment, room);
  EXPECT_EQ(figures.bend_quantile(1.0), 0.0);
  EXPECT_EQ(figures.way_gain_most, 1.0);
}

TEST(Walk, StopsWhoHeadsForAWall) {
  const WalkRoom room;
  EXPECT_TRUE(room.needs_reset({{1.2, 0.0}, 0.0}));
  EXPECT_FALSE(room.needs_reset({{1.2, 0.0}, std::numbers::pi}));
  EXPECT_FALSE(room.needs_reset({{1.1, 0.0}, 0.0}));
  EXPECT_TRUE(room.needs_reset({{0.0, -1.5}, -0.5 * std::numbers::pi}));
}

TEST(GeneratedPaths, LeadThroughTheRoomsOfABuilding) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const WalkedPath path = make_building(random);
    EXPECT_GT(path.spaces.size(), 4u);
    for (const WalkSample& sample : path.samples) {
      const bool is_inside = std::ranges::any_of(
          path.spaces, [&](const Rectangle& space) { return space.contains(sample.p); });
      ASSERT_TRUE(is_inside) << i;
    }
  }
}

TEST(Rectangles, HaveFreeWaysThroughDoors) {
  const std::vector<Rectangle> spaces = {
      {{0.0, 0.0}, {4.0, 4.0}}, {{4.0, 1.5}, {4.2, 2.5}}, {{4.2, 0.0}, {9.0, 4.0}}};
  EXPECT_NEAR(free_distance(spaces, {1.0, 2.0}, {1.0, 0.0}), 8.0, 1e-9);
  EXPECT_NEAR(free_distance(spaces, {1.0, 1.0}, {1.0, 0.0}), 3.0, 1e-9);
  EXPECT_NEAR(free_distance(spaces, {8.0, 2.0}, {-1.0, 0.0}), 8.0, 1e-9);
  EXPECT_EQ(free_distance(spaces, {-1.0, 2.0}, {1.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace hg::walking
