// Bounds A, B and C of [HG]; bounds R have a file of their own.
#include "hg/limits/acceleration_bounds.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <string>
#include <vector>

#include "hg/limits/test/one_joint.h"

namespace hg::limits {
namespace {

constexpr double kDt = 1e-3;                 // s
constexpr double kPositionRounding = 4e-15;  // positions are of order 1
// the viable speed two units in the last place away from a limit, sqrt(2 ddq_max 4e-16)
constexpr double kSpeedRounding = 5e-7;
constexpr double kAccelerationRounding = 1e-6;  // relative
constexpr JointLimits kElbow = {.q_min = -1.0, .q_max = 0.5, .dq_max = 2.0, .ddq_max = 10.0};

double viable_speed(double d, const JointLimits& limits) {
  return std::min(limits.dq_max, std::sqrt(2.0 * limits.ddq_max * std::max(0.0, d)));
}

Joint random_viable(Random& random, const JointLimits& limits) {
  const double q = uniform(random, limits.q_min, limits.q_max);
  const double share = std::clamp(uniform(random, -0.2, 1.2), 0.0, 1.0);
  return {q, std::lerp(-viable_speed(q - limits.q_min, limits),
                       viable_speed(limits.q_max - q, limits), share)};
}

Joint random_state(Random& random, const JointLimits& limits) {
  const double margin = log_uniform(random, 1e-6, 0.3);
  return {uniform(random, limits.q_min - margin, limits.q_max + margin),
          uniform(random, -1.5, 1.5) * limits.dq_max};
}

using PaperBounds = Interval (*)(const JointLimits&, double, double, double) noexcept;
constexpr PaperBounds kAll[] = {bounds_A, bounds_B, bounds_C};
constexpr PaperBounds kNeverEmpty[] = {bounds_A, bounds_B};

TEST(BoundsB, FromViableStatesEveryPolicyKeepsAllLimits) {
  for (int seed = 0; seed < 100; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    const double dt = random_period(random);
    limits.dq_max = std::max(limits.dq_max, limits.ddq_max * dt);  // B needs it
    const auto bounds = [&](Joint j) { return bounds_B(limits, j.q, j.dq, dt); };
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", policy " +
                   std::to_string(static_cast<int>(policy)));
      Joint joint = random_viable(random, limits);
      for (int k = 0; k < 3000; ++k) {
        const Interval ddq = bounds(joint);
        ASSERT_LE(ddq.lb, ddq.ub);
        const double chosen = choose(policy, ddq, k, joint, dt, bounds, random);
        ASSERT_LE(std::abs(chosen), limits.ddq_max * (1.0 + kAccelerationRounding));
        const auto [end, path] = move(joint, chosen, dt);
        const double drift = kPositionRounding + kSpeedRounding * k * dt;  // B does not bring back
        ASSERT_LE(path.ub - limits.q_max, drift);
        ASSERT_GE(path.lb - limits.q_min, -drift);
        ASSERT_LE(end.dq, viable_speed(limits.q_max - end.q, limits) + kSpeedRounding);
        ASSERT_GE(end.dq, -viable_speed(end.q - limits.q_min, limits) - kSpeedRounding);
        joint = end;
      }
    }
  }
}

TEST(BoundsA, OneSampleKeepsPositionAndSpeedAndTheUpperBoundIsTight) {
  for (int seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const Joint joint = random_viable(random, limits);
    const Interval ddq = bounds_A(limits, joint.q, joint.dq, kDt);
    const auto is_allowed = [&](double choice) {
      const auto [end, path] = move(joint, choice, kDt);
      return path.ub <= limits.q_max && path.lb >= limits.q_min &&
             std::abs(end.dq) <= limits.dq_max;
    };
    const double step = 1e-6 * (1.0 + std::abs(ddq.ub) + std::abs(ddq.lb));  // above rounding
    ASSERT_LT(ddq.lb, ddq.ub);
    ASSERT_TRUE(is_allowed(ddq.ub - step));
    ASSERT_FALSE(is_allowed(ddq.ub + step));
    ASSERT_TRUE(is_allowed(ddq.lb + step));
    ASSERT_FALSE(is_allowed(ddq.lb - step));
  }
}

TEST(BoundsB, TheUpperBoundIsTight) {
  for (int seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const Joint joint = random_viable(random, limits);
    const double ub = bounds_B(limits, joint.q, joint.dq, kDt).ub;
    const auto is_allowed = [&](double choice) {
      const auto [end, path] = move(joint, choice, kDt);
      return choice <= limits.ddq_max && path.ub <= limits.q_max &&
             end.dq <= viable_speed(limits.q_max - end.q, limits);
    };
    const double step = 1e-4 * limits.ddq_max;  // above the rounding of alg. 2 near the limit
    ASSERT_TRUE(is_allowed(ub - step));
    ASSERT_FALSE(is_allowed(ub + step));
  }
}

TEST(PaperBounds, MirroringTheJointMirrorsTheBounds) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    if (seed % 3 == 0) limits.q_min = limits.q_max - log_uniform(random, 1e-8, 1e-3);
    const JointLimits mirrored = {-limits.q_max, -limits.q_min, limits.dq_max, limits.ddq_max};
    const auto [q, dq] = random_state(random, limits);
    for (const PaperBounds bounds : kAll) {
      const Interval ddq = bounds(limits, q, dq, kDt);
      const Interval ddq_mirrored = bounds(mirrored, -q, -dq, kDt);
      ASSERT_EQ(ddq_mirrored.lb, -ddq.ub);
      ASSERT_EQ(ddq_mirrored.ub, -ddq.lb);
    }
  }
}

TEST(PaperBounds, MovingJointAndLimitsTogetherChangesNothing) {
  constexpr double kGrid = 1.0 / (1 << 20);  // positions and the shift are multiples: no rounding
  const auto on_grid = [](double x) { return std::round(x / kGrid) * kGrid; };
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    limits.q_min = on_grid(limits.q_min);
    limits.q_max = on_grid(limits.q_max);
    const auto [q_raw, dq] = random_state(random, limits);
    const double q = on_grid(q_raw);
    const double shift = on_grid(uniform(random, -50.0, 50.0));
    const JointLimits shifted = {limits.q_min + shift, limits.q_max + shift, limits.dq_max,
                                 limits.ddq_max};
    for (const PaperBounds bounds : kAll) {
      const Interval ddq = bounds(limits, q, dq, kDt);
      const Interval ddq_shifted = bounds(shifted, q + shift, dq, kDt);
      ASSERT_EQ(ddq_shifted.lb, ddq.lb);
      ASSERT_EQ(ddq_shifted.ub, ddq.ub);
    }
  }
}

TEST(PaperBounds, AWiderRangeNeverTightensTheBoundOfAViableState) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const auto [q, dq] = random_viable(random, limits);
    JointLimits wider = limits;
    wider.q_max += log_uniform(random, 1e-6, 1.0);
    const double rounding = kAccelerationRounding * limits.ddq_max;
    for (const PaperBounds bounds : kAll) {
      ASSERT_GE(bounds(wider, q, dq, kDt).ub, bounds(limits, q, dq, kDt).ub - rounding);
    }
  }
}

TEST(PaperBounds, WithoutPositionLimitsOnlySpeedAndAccelerationRemain) {
  const JointLimits unlimited = {.dq_max = 2.0, .ddq_max = 20.0};
  for (const double dq : {-2.0, -1.99, 0.0, 0.5, 1.999, 2.0}) {
    const Interval A = bounds_A(unlimited, 1e3, dq, kDt);
    EXPECT_EQ(A.ub, (2.0 - dq) / kDt);
    EXPECT_EQ(A.lb, (-2.0 - dq) / kDt);
    const Interval B = bounds_B(unlimited, 1e3, dq, kDt);
    EXPECT_EQ(B.ub, std::min(20.0, (2.0 - dq) / kDt));
    EXPECT_EQ(B.lb, std::max(-20.0, (-2.0 - dq) / kDt));
    EXPECT_FALSE(bounds_C(unlimited, 1e3, dq, kDt).bounded());
  }
}

TEST(PaperBounds, InfiniteLimitsLocksAndTinyRangesGiveNoNanAndNoEmptyInterval) {
  for (const double width : {kInfinity, 1.5, 1e-5, 1e-9, 0.0}) {
    for (int mask = 0; mask < 8; ++mask) {
      JointLimits limits = kElbow;
      limits.q_min = limits.q_max - width;
      if (mask & 1) limits.q_max = kInfinity;
      if (mask & 2) limits.dq_max = kInfinity;
      if (mask & 4) limits.ddq_max = kInfinity;
      for (const double q : {-2.0, -1.0, 0.0, 0.5 - 0.5e-9, 0.5 - 1e-12, 0.5, 0.5001, 2.0}) {
        for (const double dq : {-3.0, -1e-3, 0.0, 1e-3, 3.0}) {
          for (const PaperBounds bounds : kNeverEmpty) {
            std::feclearexcept(FE_ALL_EXCEPT);
            const Interval ddq = bounds(limits, q, dq, kDt);
            ASSERT_LE(ddq.lb, ddq.ub) << width << ", " << mask << ", " << q << ", " << dq;
#ifndef __clang__  // which may compute what a condition then throws away
            ASSERT_FALSE(std::fetestexcept(FE_INVALID));  // no NaN on the way either
#endif
          }
        }
      }
    }
  }
}

TEST(PaperBounds, ALockAtRestStaysAtRest) {
  const JointLimits lock = {.q_min = 0.3, .q_max = 0.3, .dq_max = 2.0, .ddq_max = 10.0};
  for (const PaperBounds bounds : kAll) {
    const Interval ddq = bounds(lock, 0.3, 0.0, kDt);
    EXPECT_EQ(ddq.lb, 0.0);
    EXPECT_EQ(ddq.ub, 0.0);
  }
}

TEST(BoundsA, AtALimitEvenUnlimitedAccelerationAllowsNoSpeedTowardsIt) {
  const JointLimits limits = {.q_max = 0.5, .dq_max = 2.0};
  EXPECT_EQ(bounds_A(limits, 0.5, 1.0, kDt).ub, 0.0);
}

TEST(PaperBounds, PositionIsStrongerThanSpeed) {
  // braking stops the joint in less than one sample: it comes back faster than dq_max
  const JointLimits strong = {.q_max = 0.0, .dq_max = 0.3, .ddq_max = 1000.0};
  const double q = -0.3 * 0.3 / 2000.0;
  for (const PaperBounds bounds : kNeverEmpty) {
    const Interval ddq = bounds(strong, q, 0.3, kDt);
    EXPECT_NEAR(ddq.lb, -1000.0, 1e-9);
    EXPECT_NEAR(ddq.ub, -1000.0, 1e-9);
  }
}

TEST(BoundsB, WhereBrakingTakesHalfASampleRoundingGivesNoNan) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const double A = log_uniform(random, 2.0, 200.0);
    const double dq = 0.5 * A * kDt;  // the two solutions of alg. 2 are one
    const double d = dq * dq / (2.0 * A);
    std::feclearexcept(FE_ALL_EXCEPT);
    const Interval ddq = bounds_B({.q_max = 0.0, .dq_max = 2.0, .ddq_max = A}, -d, dq, kDt);
    ASSERT_FALSE(std::fetestexcept(FE_INVALID));
    ASSERT_NEAR(ddq.ub, -A, kAccelerationRounding * A);
    ASSERT_NEAR(ddq.lb, -A, kAccelerationRounding * A);
  }
}

TEST(BoundsA, ARangeThatOneSampleCannotServeStopsTheJoint) {
  // turning back before the upper limit ends below the lower one, and the other way round
  const JointLimits narrow = {.q_min = 0.0, .q_max = 1e-6, .dq_max = 2.0, .ddq_max = 100.0};
  const Interval ddq = bounds_A(narrow, 0.5e-6, 5e-3, kDt);
  EXPECT_EQ(ddq.lb, -5e-3 / kDt);
  EXPECT_EQ(ddq.ub, -5e-3 / kDt);
}

TEST(BoundsB, AtTheEdgeOfTheViableSetTheBoundIsBrakingForEveryPeriod) {
  const double d = 0.05;
  for (const double dt : {2e-3, 1e-3, 5e-4, 1e-4}) {
    const Interval ddq =
        bounds_B(kElbow, kElbow.q_max - d, std::sqrt(2.0 * kElbow.ddq_max * d), dt);
    EXPECT_NEAR(ddq.ub, -kElbow.ddq_max, kAccelerationRounding * kElbow.ddq_max);
    EXPECT_NEAR(ddq.lb, -kElbow.ddq_max, kAccelerationRounding * kElbow.ddq_max);
  }
}

TEST(PaperBounds, BOutsideHoldsTheJointButDoesNotBringItBack) {
  // a known fault of the clamping in [HG], kept because these bounds reproduce [HG]
  EXPECT_EQ(bounds_B(kElbow, 0.6, 0.0, kDt).ub, 0.0);
  EXPECT_EQ(bounds_A(kElbow, 0.6, 0.0, kDt).ub, 0.0);
  EXPECT_EQ(bounds_A(kElbow, 0.6, 1.0, kDt).ub, 0.0);  // does not even brake
}

TEST(BoundsC, OnePeriodAsHorizonEndsExactlyAtTheLimit) {
  for (int seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const Joint joint = random_state(random, limits);
    const Interval ddq = bounds_C(limits, joint.q, joint.dq, kDt);
    ASSERT_NEAR(move(joint, ddq.ub, kDt).end.q, limits.q_max, kPositionRounding);
    ASSERT_NEAR(move(joint, ddq.lb, kDt).end.q, limits.q_min, kPositionRounding);
  }
}

TEST(BoundsC, AHorizonOfManyPeriodsReturnsDampedFromOutside) {
  for (const int periods : {2, 5, 20, 50}) {
    SCOPED_TRACE(periods);
    const double T_C = periods * kDt;
    Joint joint = {kElbow.q_max + 0.01, 0.5};
    const int samples = 40 * periods;  // (1 - 1/n)^(40 n) < exp(-40)
    for (int k = 0; k < samples; ++k) {
      joint = move(joint, bounds_C(kElbow, joint.q, joint.dq, T_C).ub, kDt).end;
    }
    EXPECT_NEAR(joint.q, kElbow.q_max, kPositionRounding);
    EXPECT_NEAR(joint.dq, 0.0, kPositionRounding / kDt);
  }
}

TEST(BoundsC, TwentyPeriodsOvershootByTwoMillimetresAtWalkingSpeed) {
  double overshoot = 0.0;
  for (double dq = 0.3; dq <= 1.5; dq += 0.05) {
    Joint joint = {kElbow.q_max - 0.1, dq};
    for (int k = 0; k < 1000; ++k) {
      const double ub = bounds_C(kElbow, joint.q, joint.dq, 20 * kDt).ub;
      const auto [end, path] = move(joint, std::min(5.0, ub), kDt);  // pushed with 5 m/s^2
      overshoot = std::max(overshoot, path.ub - kElbow.q_max);
      joint = end;
    }
  }
  EXPECT_NEAR(overshoot, 2.2e-3, 0.1e-3);  // measured with the reference implementation
}

}  // namespace
}  // namespace hg::limits
