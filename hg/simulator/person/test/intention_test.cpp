#include "hg/simulator/person/intention.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::person {
namespace {

constexpr double kDt = 0.25e-3;
const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();

/// Largest speed and acceleration of an intention, and where it ends.
struct Way {
  double speed = 0.0, acceleration = 0.0, overshoot = 0.0, end = 0.0;
};

// a target at rest that jumps by `jump` after 0.1 s, again every `period`, `times` in all
Way follow(double jump, double period, int times, double duration) {
  Approach approach(IntentionBounds{});
  approach.start();
  Way way;
  double target = 0.0, last_speed = 0.0;
  int jumps = 0;
  for (double t = 0.0; t < duration; t += kDt) {
    const bool is_now = jumps < times && t >= 0.1 + period * jumps;
    const double step = is_now ? jump : 0.0;
    jumps += is_now ? 1 : 0;
    target += step;
    const double speed = approach.step(step * kX, kDt).x();
    way.speed = std::max(way.speed, std::abs(speed));
    way.acceleration = std::max(way.acceleration, std::abs(speed - last_speed) / kDt);
    way.overshoot = std::max(way.overshoot, approach.rest().x());
    last_speed = speed;
  }
  way.end = target + approach.rest().x();
  return way;
}

TEST(Intention, AJumpIsTakenUpAtABoundedSpeed) {
  for (const double jump : {0.2, 1.0, 5.0}) {
    const Way way = follow(jump, 1.0, 1, 8.0);
    EXPECT_LE(way.speed, 1.0 + 1e-9);
    EXPECT_LE(way.acceleration, 5.0 + 1e-6);
    EXPECT_NEAR(way.overshoot, 0.0, 1e-3);
    EXPECT_EQ(way.end, jump);
  }
}

TEST(Intention, TargetsThatArriveOneByOneAreAMotionWithoutSteps) {
  const Way way = follow(5e-3, 1.0 / 30.0, 30, 3.0);  // 0.15 m/s
  EXPECT_LE(way.speed, 0.3);
  EXPECT_LE(way.acceleration, 5.0 + 1e-6);
  EXPECT_NEAR(way.end, 0.15, 1e-12);
}

TEST(Intention, ATargetThatMovesAsAHandCanIsTakenAsItIs) {
  Approach approach(IntentionBounds{});
  approach.start();
  const auto at = [](double t) { return 0.2 * std::sin(15.0 * t); };  // 3 m/s, 45 m/s^2
  for (double t = kDt; t < 1.0; t += kDt) {
    const Eigen::Vector3d way = (at(t) - at(t - kDt)) * kX;
    EXPECT_EQ(approach.step(way, kDt), Eigen::Vector3d(way / kDt));
    EXPECT_EQ(approach.rest(), Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
}

}  // namespace
}  // namespace hg::person
