#include "hg/walking/path_planner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/random.h"

namespace hg::walking {
namespace {

const Rectangle kRoom = centered(2.3, 2.9);

// Cost of the planned controls, each changed by what `change` gives.
template <typename Change>
double changed_cost(const PathPlanner& planner, const PlannerConfig& config, PathState x,
                    const PathPlanner::Turns& turns, const Change& change) {
  double sum = 0.0;
  for (int k = 0; k < PathPlanner::kSteps; ++k) {
    const double j = planner.control((k + 0.5) * PathPlanner::kStep) + change(k);
    sum += path_cost(config, x, j);
    x = moved(x, j, turns[k], PathPlanner::kStep);
  }
  return sum + path_cost(config, x, 0.0);
}

// No change of the controls nearby makes a plan cheaper by more than 1 %.
TEST(PathPlanner, FindsTheLeastCostNearby) {
  const PlannerConfig config = {.room = kRoom};
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    PathPlanner planner(config);
    const PathState state(random.between(-0.8, 0.8), random.between(-1.0, 1.0),
                          random.between(-3.0, 3.0), random.between(-1.0, 1.0), 0.0);
    PathPlanner::Turns turns{};
    turns[10] = random.between(-1.5, 1.5);
    planner.plan(state, turns, 0);
    const double planned = changed_cost(planner, config, state, turns, [](int) { return 0.0; });
    EXPECT_NEAR(planned, planner.cost(), 1e-9 * planned);
    for (int k = 0; k < 40; ++k) {
      const double size = random.between(-3.0, 3.0), phase = random.between(0.0, 6.0);
      const double rate = random.between(0.0, 1.0);
      const double other = changed_cost(planner, config, state, turns, [&](int step) {
        return size * std::sin(phase + rate * step);
      });
      EXPECT_GT(other, 0.99 * planned) << trial << " " << k;
    }
  }
}

TEST(PathPlanner, GoesStraightWhereThereIsRoom) {
  PathPlanner planner({.room = centered(100.0, 100.0)});
  planner.plan(PathState(0.0, 0.0, 0.3, 0.0, 0.0), {}, 0);
  EXPECT_NEAR(planner.cost(), 0.0, 1e-6);
  const PathState end = planner.state(PathPlanner::kSteps);
  EXPECT_NEAR(end[0], 4.0 * std::cos(0.3), 1e-2);
  EXPECT_NEAR(end[1], 4.0 * std::sin(0.3), 1e-2);
}

TEST(PathPlanner, StaysInTheRoomAlsoWhereThePathTurnsToItsWall) {
  PathPlanner planner({.room = kRoom});
  PathPlanner::Turns turns{};
  turns[5] = 1.5;
  planner.plan(PathState(0.6, -0.5, 0.0, 0.0, 0.0), turns, 0);
  for (int k = 0; k <= PathPlanner::kSteps; ++k)
    EXPECT_GT(kRoom.clearance(planner.state(k).head<2>()), -0.02) << k;
}

// The least bending from the middle of a strip of +-0.5 m, at an angle, to be parallel at its side:
// for small angles a cubic, as of a beam, with u(0) = -2 angle / s and the way s = 3 y / angle.
TEST(PathPlanner, BendsAsABeamTowardsASide) {
  constexpr double kAngle = 0.4, kWay = 3.0 * 0.5 / kAngle;
  PathPlanner planner({.room = {{-100.0, -0.5}, {100.0, 0.5}}, .margin = 0.0});
  const double u = -2.0 * kAngle / kWay;
  planner.plan(PathState(0.0, 0.0, kAngle, u, -u / kWay), {}, 0);
  EXPECT_NEAR(2.0 * planner.cost(), 4.0 * kAngle * kAngle / (3.0 * kWay), 0.008);
  EXPECT_NEAR(planner.state(18)[3], 0.5 * u, 0.02);
  EXPECT_NEAR(planner.state(PathPlanner::kSteps)[1], 0.5, 0.02);
}

TEST(PathPlanner, MovesAlongASmoothPath) {
  const PathState start(0.1, -0.2, 0.3, 0.8, -0.5);
  const PathState once = moved(start, 2.0, 0.02, 0.01);
  const PathState twice = moved(moved(start, 2.0, 0.01, 0.005), 2.0, 0.01, 0.005);
  EXPECT_LT((once - twice).norm(), 1e-6);
  EXPECT_NEAR((moved(start, 2.0, 0.0, 1e-6) - start)[3] / 1e-6, start[4], 1e-4);
}

}  // namespace
}  // namespace hg::walking
