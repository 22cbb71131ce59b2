#include "hg/limits/moving_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/limits/acceleration_bounds.h"
#include "hg/limits/test/one_joint.h"

namespace hg::limits {
namespace {

constexpr double kDt = 1e-3;    // s
constexpr double kSpeed = 0.5;  // rad/s
constexpr double kStep = kSpeed * kDt;
constexpr double kRounding = 1e-12;  // of some thousand additions of order 1

TEST(MovingLimits, ANewTargetIsReachedAtTheGivenSpeedAndKept) {
  const Interval target = {-0.5, 1.2};
  MovingLimits limits = {.q = {-1.0, 1.0}};
  for (int k = 1; k <= 1100; ++k) {
    limits = advanced(limits, target, 0.0, kSpeed, kDt);
    ASSERT_NEAR(limits.q.lb, std::min(-1.0 + k * kStep, -0.5), kRounding);
    ASSERT_NEAR(limits.q.ub, std::min(1.0 + k * kStep, 1.2), kRounding);
  }
  EXPECT_EQ(limits.q.lb, -0.5);
  EXPECT_EQ(limits.q.ub, 1.2);
  EXPECT_FALSE(limits.is_crossed);
}

TEST(MovingLimits, ACrossedTargetIsReportedAndCountsAsItsMidpoint) {
  MovingLimits limits = {.q = {-1.0, 1.0}};
  for (int k = 0; k < 3000; ++k) {
    limits = advanced(limits, {0.6, 0.2}, 0.0, kSpeed, kDt);
    ASSERT_TRUE(limits.is_crossed);
    ASSERT_LE(limits.q.lb, limits.q.ub);
  }
  EXPECT_DOUBLE_EQ(limits.q.lb, 0.4);
  EXPECT_DOUBLE_EQ(limits.q.ub, 0.4);
  EXPECT_FALSE(advanced(limits, {0.2, 0.6}, 0.0, kSpeed, kDt).is_crossed);
}

TEST(MovingLimits, ACrossedTargetWithoutMidpointChangesNothing) {
  const MovingLimits limits = {.q = {-1.0, 1.0}};
  for (const Interval target :
       {Interval{0.5, -kInfinity}, Interval{kInfinity, 0.5}, Interval{kInfinity, -kInfinity}}) {
    const MovingLimits next = advanced(limits, target, 0.0, kSpeed, kDt);
    EXPECT_EQ(next.q.lb, -1.0);
    EXPECT_EQ(next.q.ub, 1.0);
    EXPECT_TRUE(next.is_crossed);
  }
}

TEST(MovingLimits, ALimitDisappearsAtOnce) {
  const MovingLimits next = advanced({.q = {-1.0, 1.0}}, {}, 0.0, kSpeed, kDt);
  EXPECT_EQ(next.q.lb, -kInfinity);
  EXPECT_EQ(next.q.ub, kInfinity);
}

TEST(MovingLimits, ALimitThatAppearsStartsAtItsTargetOrAtTheJoint) {
  const MovingLimits free;
  const MovingLimits inside = advanced(free, {-1.0, 1.0}, 0.3, kSpeed, kDt);
  EXPECT_EQ(inside.q.lb, -1.0);
  EXPECT_EQ(inside.q.ub, 1.0);
  const MovingLimits above = advanced(free, {-1.0, 1.0}, 1.4, kSpeed, kDt);
  EXPECT_EQ(above.q.lb, -1.0);
  EXPECT_EQ(above.q.ub, 1.4);
  EXPECT_DOUBLE_EQ(advanced(above, {-1.0, 1.0}, 1.4, kSpeed, kDt).q.ub, 1.4 - kStep);
  const MovingLimits below = advanced(free, {-1.0, 1.0}, -1.4, kSpeed, kDt);
  EXPECT_EQ(below.q.lb, -1.4);
  EXPECT_EQ(below.q.ub, 1.0);
}

TEST(MovingLimits, AnySequenceOfTargetsKeepsTheSpeedAndNeverCrosses) {
  for (int seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    MovingLimits limits;
    for (int k = 0; k < 50; ++k) {
      Interval target = {uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0)};
      if (uniform(random, 0.0, 1.0) < 0.2) target.lb = -kInfinity;
      if (uniform(random, 0.0, 1.0) < 0.2) target.ub = kInfinity;
      const double q = uniform(random, -2.0, 2.0);
      const MovingLimits next = advanced(limits, target, q, kSpeed, 1.0);
      ASSERT_LE(next.q.lb, next.q.ub);
      for (const auto& [before, after] :
           {std::pair{limits.q.lb, next.q.lb}, std::pair{limits.q.ub, next.q.ub}}) {
        if (std::isfinite(before) && std::isfinite(after)) {
          ASSERT_LE(std::abs(after - before), kSpeed + kRounding);
        }
      }
      limits = next;
    }
  }
}

// How far a joint gets outside a limit that closes in on it, as the header states it.
double largest_overrun(const JointLimits& limits, const RecoverableOptions& o, double dt) {
  const double braking = o.v_rec * o.v_rec / (2.0 * limits.ddq_max * (o.ddq_rec_factor - 1.0));
  return std::max(o.v_rec * o.tau_rec, braking) + o.v_rec * dt + kRounding;
}

TEST(MovingLimits, ALimitThatClosesInOverrunsTheJointNoFurtherThanStated) {
  constexpr double kTravel = 0.3;  // rad
  double closest = 0.0;            // largest overrun as a share of the stated one
  for (int seed = 0; seed < 800; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    limits.q_min = -kInfinity;
    const double dt = random_period(random);
    const RecoverableOptions options = recoverable_options(limits, dt, dt);
    const double stated = largest_overrun(limits, options, dt);
    const Policy policy = kPolicies[seed % kPolicies.size()];
    // the limit begins to move when the joint is anywhere on its way, and rests kTravel later
    const int first_sample = static_cast<int>(uniform(random, 0.0, 1.0) / dt);
    const double target = limits.q_max - kTravel;
    MovingLimits moving = {.q = {limits.q_min, limits.q_max}};
    Joint joint = {limits.q_max - log_uniform(random, 1e-3, 1.0), 0.0};
    const auto bounds = [&](Joint j) { return recoverable_bounds(limits, options, j.q, j.dq, dt); };
    const double duration = 1.0 + (kTravel + stated) / options.v_rec +
                            limits.dq_max / limits.ddq_max + 20.0 * options.tau_rec;
    for (int k = 0; k < static_cast<int>(duration / dt); ++k) {
      if (k >= first_sample) {
        moving = advanced(moving, {-kInfinity, target}, joint.q, options.v_rec, dt);
        limits.q_max = moving.q.ub;
      }
      Interval ddq = bounds(joint);
      ddq.lb = std::min(std::max(ddq.lb, -limits.ddq_max),
                        ddq.ub);  // a joint without a lower limit may flee
      const auto [end, path] = move(joint, choose(policy, ddq, k, joint, dt, bounds, random), dt);
      ASSERT_LE(path.ub - limits.q_max, stated);
      closest = std::max(closest, (path.ub - limits.q_max) / stated);
      joint = end;
    }
    ASSERT_LE(joint.q, target + 1e-6);  // back inside: exp(-20) of the way is left
  }
  EXPECT_GT(closest, 0.99);  // the statement is tight
}

}  // namespace
}  // namespace hg::limits
