#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/limits/test/one_joint.h"

namespace hg::limits {
namespace {

// positions are of order 1: a few units in the last place. A speed next to a limit is d / tau, an
// acceleration d / (tau dt).
constexpr double kPositionRounding = 4e-15;
constexpr double kUlp = std::numeric_limits<double>::epsilon();  // of a position between 1 and 2
constexpr JointLimits kElbow = {.q_min = -1.0, .q_max = 0.5, .dq_max = 2.0, .ddq_max = 20.0};
constexpr double kDt = 1e-3;  // s
constexpr int kSeeds = 60;
const std::string kItem = "joint m4";

RecoverableOptions options_for(const JointLimits& limits, double dt) {
  return recoverable_options(limits, dt, dt);
}

// w(d) of bounds R, written again.
double viable_speed(double d, const JointLimits& limits, double tau) {
  const double A = limits.ddq_max;
  const double w = d <= A * tau * tau ? d / tau : std::sqrt(A * (2.0 * d - A * tau * tau));
  return std::min(w, limits.dq_max);
}

Interval viable_speeds(double q, const JointLimits& limits, double tau) {
  return {-viable_speed(q - limits.q_min, limits, tau),
          viable_speed(limits.q_max - q, limits, tau)};
}

Joint random_viable(Random& random, const JointLimits& limits, double tau) {
  const double q = uniform(random, limits.q_min, limits.q_max);
  const Interval dq = viable_speeds(q, limits, tau);
  const double share = uniform(random, -0.2, 1.2);  // one start in three on the edge
  return {q, std::lerp(dq.lb, dq.ub, std::clamp(share, 0.0, 1.0))};
}

// Runs `policy` from a viable state and fails at the first sample that breaks a limit.
void expect_invariant(const JointLimits& limits, const RecoverableOptions& options, double dt_min,
                      double dt_max, Policy policy, int samples, Random& random) {
  const double dq_rounding = kPositionRounding / options.tau;
  Joint joint = random_viable(random, limits, options.tau);
  for (int k = 0; k < samples; ++k) {
    const double dt = dt_min == dt_max ? dt_max : uniform(random, dt_min, dt_max);
    const auto bounds = [&](Joint j) { return recoverable_bounds(limits, options, j.q, j.dq, dt); };
    const Interval ddq = bounds(joint);
    ASSERT_LE(ddq.lb, ddq.ub) << k;
    const double chosen = choose(policy, ddq, k, joint, dt, bounds, random);
    if (options.is_capped) {
      ASSERT_LE(std::abs(chosen), limits.ddq_max + dq_rounding / dt) << k;
    }

    const auto [end, path] = move(joint, chosen, dt);
    ASSERT_LE(path.ub, limits.q_max + kPositionRounding) << k;
    ASSERT_GE(path.lb, limits.q_min - kPositionRounding) << k;
    const Interval viable = viable_speeds(end.q, limits, options.tau);
    ASSERT_LE(end.dq, viable.ub + dq_rounding) << k;
    ASSERT_GE(end.dq, viable.lb - dq_rounding) << k;
    joint = end;
  }
}

TEST(RecoverableBounds, FromViableStatesEveryPolicyKeepsAllLimits) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const double dt = random_period(random);
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", policy " +
                   std::to_string(static_cast<int>(policy)));
      expect_invariant(limits, options_for(limits, dt), dt, dt, policy, 6000, random);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RecoverableBounds, WithoutACapAndWithAnEarlyOnsetEveryPolicyKeepsAllLimits) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const double dt = random_period(random);
    RecoverableOptions options = options_for(limits, dt);
    options.is_capped = false;
    options.tau_onset = dt * log_uniform(random, 0.5, 100.0);
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", policy " +
                   std::to_string(static_cast<int>(policy)));
      expect_invariant(limits, options, dt, dt, policy, 6000, random);
      if (HasFatalFailure()) return;
    }
  }
}

// From rest with all that is allowed: the acceleration of each sample until the joint stops.
std::vector<double> sprint(const RecoverableOptions& options) {
  Joint joint = {kElbow.q_min, 0.0};
  std::vector<double> chosen;
  for (int k = 0; k < 5000; ++k) {
    const double ub = recoverable_bounds(kElbow, options, joint.q, joint.dq, kDt).ub;
    const double ddq = std::min(ub, 5.0 * kElbow.ddq_max);  // of a strong motor
    joint = move(joint, ddq, kDt).end;
    chosen.push_back(ddq);
  }
  EXPECT_NEAR(joint.q, kElbow.q_max, 1e-6);
  return chosen;
}

TEST(RecoverableBounds, WithoutACapAJointAcceleratesAsItsMotorCan) {
  const std::vector<double> ddq = sprint({.is_capped = false});
  EXPECT_EQ(ddq.front(), 5.0 * kElbow.ddq_max);
  EXPECT_NEAR(*std::ranges::min_element(ddq), -kElbow.ddq_max, 1e-6);
}

TEST(RecoverableBounds, AnEarlyOnsetBrakesWithoutAJump) {
  const auto largest_jump = [](const std::vector<double>& ddq) {
    double largest = 0.0;
    for (std::size_t k = 1; k < ddq.size(); ++k) {
      largest = std::max(largest, std::abs(ddq[k] - ddq[k - 1]));
    }
    return largest;
  };
  const double at_once = largest_jump(sprint({.is_capped = false}));
  const double gradual = largest_jump(sprint({.tau_onset = 25e-3, .is_capped = false}));
  EXPECT_GT(at_once, 4.0 * kElbow.ddq_max);
  EXPECT_LT(gradual, 0.5 * kElbow.ddq_max);
}

TEST(RecoverableBounds, PeriodsMayVaryUpToTau) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const double tau = random_period(random);
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      expect_invariant(limits, {.tau = tau}, 0.1 * tau, tau, policy, 4000, random);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RecoverableBounds, RangesBelowOneSampleOfAccelerationKeepTheirLimits) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const double dt = random_period(random);
    JointLimits limits = random_limits(random);
    const double range = limits.ddq_max * dt * dt;
    for (const double width : {1e-6, 1e-9, 0.1 * range, 0.5 * range, range, 3.0 * range}) {
      limits.q_min = limits.q_max - width;
      for (const Policy policy : kPolicies) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", width " + std::to_string(width));
        expect_invariant(limits, options_for(limits, dt), dt, dt, policy, 500, random);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(RecoverableBounds, MoreThanTheBoundBreaksAConditionAndLessBreaksNone) {
  constexpr double kStep = 1e-6;  // relative to the acceleration, far above rounding
  for (int seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    limits.q_min = -kInfinity;  // the upper side alone
    const double dt = random_period(random);
    const double tau = options_for(limits, dt).tau;
    const double d = log_uniform(random, 1e-4, 2.0);
    const Joint joint = {limits.q_max - d, std::lerp(-limits.dq_max, viable_speed(d, limits, tau),
                                                     uniform(random, 0.0, 1.0))};
    const double ub = recoverable_bounds(limits, options_for(limits, dt), joint.q, joint.dq, dt).ub;
    const auto is_allowed = [&](double ddq) {
      const Joint end = move(joint, ddq, dt).end;
      return ddq <= limits.ddq_max && end.dq <= viable_speed(limits.q_max - end.q, limits, tau);
    };
    const double step = kStep * (limits.ddq_max + std::abs(ub));
    ASSERT_TRUE(is_allowed(ub - step));
    ASSERT_FALSE(is_allowed(ub + step));
  }
}

// Any state, viable or not; a third of them outside.
Joint random_state(Random& random, const JointLimits& limits) {
  const double margin = log_uniform(random, 1e-6, 1.0);
  return {uniform(random, limits.q_min - margin, limits.q_max + margin),
          uniform(random, -2.0, 2.0) * limits.dq_max};
}

TEST(RecoverableBounds, AnyStateGivesANonEmptyIntervalWithinTheRecoveryAcceleration) {
  for (int seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    if (seed % 3 == 0) limits.q_min = limits.q_max;
    const double dt = random_period(random);
    const auto [q, dq] = random_state(random, limits);
    const Interval ddq = recoverable_bounds(limits, options_for(limits, dt), q, dq, dt);
    ASSERT_LE(ddq.lb, ddq.ub);
    ASSERT_GE(ddq.lb, -1.5 * limits.ddq_max);
    ASSERT_LE(ddq.ub, 1.5 * limits.ddq_max);
  }
}

TEST(RecoverableBounds, MirroringTheJointMirrorsTheBounds) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    JointLimits mirrored = limits;
    mirrored.q_min = -limits.q_max;
    mirrored.q_max = -limits.q_min;
    const auto [q, dq] = random_state(random, limits);
    const RecoverableOptions options = options_for(limits, kDt);
    const Interval ddq = recoverable_bounds(limits, options, q, dq, kDt);
    const Interval ddq_mirrored = recoverable_bounds(mirrored, options, -q, -dq, kDt);
    ASSERT_EQ(ddq_mirrored.lb, -ddq.ub);
    ASSERT_EQ(ddq_mirrored.ub, -ddq.lb);
  }
}

TEST(RecoverableBounds, MovingJointAndLimitsTogetherChangesNothing) {
  constexpr double kGrid = 1.0 / (1 << 20);  // positions and the shift are multiples: no rounding
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const auto on_grid = [](double x) { return std::round(x / kGrid) * kGrid; };
    JointLimits limits = random_limits(random);
    limits.q_min = on_grid(limits.q_min);
    limits.q_max = on_grid(limits.q_max);
    const auto [q_raw, dq] = random_state(random, limits);
    const double q = on_grid(q_raw);
    const double shift = on_grid(uniform(random, -50.0, 50.0));
    JointLimits shifted = limits;
    shifted.q_min += shift;
    shifted.q_max += shift;
    const RecoverableOptions options = options_for(limits, kDt);
    const Interval ddq = recoverable_bounds(limits, options, q, dq, kDt);
    const Interval ddq_shifted = recoverable_bounds(shifted, options, q + shift, dq, kDt);
    ASSERT_EQ(ddq_shifted.lb, ddq.lb);
    ASSERT_EQ(ddq_shifted.ub, ddq.ub);
  }
}

TEST(RecoverableBounds, AWiderRangeNeverTightensTheBoundOfAViableState) {
  for (int seed = 0; seed < 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const RecoverableOptions options = options_for(limits, kDt);
    const auto [q, dq] = random_viable(random, limits, options.tau);
    JointLimits wider = limits;
    wider.q_max += log_uniform(random, 1e-6, 1.0);
    ASSERT_GE(recoverable_bounds(wider, options, q, dq, kDt).ub,
              recoverable_bounds(limits, options, q, dq, kDt).ub - 1e-9);  // rounding of sqrt / dt
  }
}

TEST(RecoverableBounds, ALimitFurtherAwayNeverTightensTheBoundOutside) {
  JointLimits limits = kElbow;
  const RecoverableOptions options = options_for(limits, kDt);
  for (const double dq : {-1.0, -0.1, 0.0, 0.1, 1.0}) {
    double previous = -kInfinity;
    for (limits.q_max = 0.3; limits.q_max < 0.5; limits.q_max += 1e-3) {
      const double ub = recoverable_bounds(limits, options, 0.5, dq, kDt).ub;
      ASSERT_GE(ub, previous) << limits.q_max << ", " << dq;
      previous = ub;
    }
  }
}

TEST(RecoverableBounds, WithoutPositionLimitsOnlySpeedAndAccelerationRemain) {
  const JointLimits unlimited = {.dq_max = 2.0, .ddq_max = 20.0};
  for (const double dq : {-2.5, -2.0, -1.99, 0.0, 0.5, 1.999, 2.0, 2.5}) {
    const Interval ddq = recoverable_bounds(unlimited, options_for(unlimited, kDt), 1e3, dq, kDt);
    EXPECT_EQ(ddq.ub, std::clamp((2.0 - dq) / kDt, -30.0, dq < -2.0 ? 30.0 : 20.0)) << dq;
    EXPECT_EQ(ddq.lb, std::clamp((-2.0 - dq) / kDt, dq > 2.0 ? -30.0 : -20.0, 30.0)) << dq;
  }
}

TEST(RecoverableBounds, InfiniteLimitsInAnyCombinationGiveNoNan) {
  for (int mask = 0; mask < 16; ++mask) {
    JointLimits limits = kElbow;
    if (mask & 1) limits.q_min = -kInfinity;
    if (mask & 2) limits.q_max = kInfinity;
    if (mask & 4) limits.dq_max = kInfinity;
    if (mask & 8) limits.ddq_max = kInfinity;
    const RecoverableOptions options = options_for(limits, kDt);
    check_joint_limits(limits, kItem);
    check_recoverable_options(options, limits, kDt, kItem);
    for (const double q : {-2.0, -1.0, 0.0, 0.499, 0.5, 0.5001, 2.0}) {
      for (const double dq : {-3.0, -1e-3, 0.0, 1e-3, 3.0}) {
        std::feclearexcept(FE_ALL_EXCEPT);
        const Interval ddq = recoverable_bounds(limits, options, q, dq, kDt);
        ASSERT_FALSE(std::fetestexcept(FE_INVALID)) << mask << ", " << q << ", " << dq;
        ASSERT_LE(ddq.lb, ddq.ub) << mask << ", " << q << ", " << dq;  // false for NaN
        ASSERT_LT(ddq.lb, kInfinity);
        ASSERT_GT(ddq.ub, -kInfinity);
      }
    }
  }
}

TEST(RecoverableBounds, UnlimitedAccelerationStopsAtTheLimitWithinAFewTau) {
  const JointLimits limits = {.q_max = 1.0, .dq_max = 2.0};
  const RecoverableOptions options = options_for(limits, kDt);
  Joint joint = {0.99, 2.0};
  for (int k = 0; k < 40; ++k) {  // 5 periods at full speed, 17 time constants of two periods
    const Interval ddq = recoverable_bounds(limits, options, joint.q, joint.dq, kDt);
    const auto [end, path] = move(joint, std::min(ddq.ub, 1e4), kDt);
    ASSERT_LE(path.ub, 1.0 + kPositionRounding);
    joint = end;
  }
  EXPECT_NEAR(joint.q, 1.0, 4e-3 * std::exp(-17.0));
}

TEST(RecoverableBounds, OvershootFromANonViableStateIsThePhysicalMinimum) {
  constexpr double kTolerance = 1e-4;  // m or rad; one sample moves by up to A_rec dt^2 = 1e-4
  for (int seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    limits.ddq_max = uniform(random, 4.0, 60.0);
    const double A_rec = 1.5 * limits.ddq_max;
    const RecoverableOptions options = options_for(limits, kDt);
    const double d = uniform(random, -0.1, 0.05);
    Joint joint = {limits.q_max - d, uniform(random, -0.3, 1.5)};
    const double q_stop = joint.dq > 0.0 ? joint.q + joint.dq * joint.dq / (2.0 * A_rec) : joint.q;
    const double minimum = std::max(0.0, q_stop - limits.q_max);

    double overshoot = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double ub = recoverable_bounds(limits, options, joint.q, joint.dq, kDt).ub;
      const auto [end, path] = move(joint, ub, kDt);
      overshoot = std::max(overshoot, path.ub - limits.q_max);
      joint = end;
    }
    ASSERT_NEAR(overshoot, minimum, kTolerance);
  }
}

TEST(RecoverableBounds, FromOutsideTheJointReturnsInTimeWhateverThePolicy) {
  constexpr double kArrived = 1e-6;  // m or rad
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const RecoverableOptions options = options_for(limits, kDt);
    const double A_rec = 1.5 * limits.ddq_max;
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", policy " +
                   std::to_string(static_cast<int>(policy)));
      Joint joint = {limits.q_max + log_uniform(random, 1e-5, 0.5),
                     uniform(random, -1.0, 1.0) * limits.dq_max};
      const double t_turn = (std::abs(joint.dq) + options.v_rec) / A_rec;
      const double distance = joint.q - limits.q_max + 0.5 * joint.dq * joint.dq / A_rec;
      const double t_return = distance / options.v_rec + 14.0 * options.tau_rec;  // exp(-14) = 1e-6
      const int samples = static_cast<int>(std::ceil((2.0 * t_turn + t_return) / kDt));
      const auto bounds = [&](Joint j) {
        return recoverable_bounds(limits, options, j.q, j.dq, kDt);
      };
      for (int k = 0; k < samples; ++k) {
        joint = move(joint, choose(policy, bounds(joint), k, joint, kDt, bounds, random), kDt).end;
      }
      ASSERT_LE(joint.q, limits.q_max + kArrived);
      ASSERT_GE(joint.q, limits.q_min - kArrived);
    }
  }
}

// Largest change of the acceleration from sample to sample in the second half of a run.
double jitter(const std::vector<double>& ddq) {
  double largest = 0.0;
  for (std::size_t k = ddq.size() / 2; k < ddq.size(); ++k) {
    largest = std::max(largest, std::abs(ddq[k] - ddq[k - 1]));
  }
  return largest;
}

TEST(RecoverableBounds, AHeldLimitDoesNotRing) {
  for (int seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const JointLimits limits = random_limits(random);
    const double dt = random_period(random);
    const RecoverableOptions options = options_for(limits, dt);
    Joint joint = random_viable(random, limits, options.tau);
    const bool is_upper = seed % 2 == 0;
    const double range = limits.q_max - limits.q_min;
    const double duration = range / limits.dq_max + 3.0 * limits.dq_max / limits.ddq_max +
                            3.0 * std::sqrt(range / limits.ddq_max) + 40.0 * options.tau;
    std::vector<double> accelerations;
    for (int k = 0; k < static_cast<int>(2.0 * duration / dt); ++k) {
      const Interval ddq = recoverable_bounds(limits, options, joint.q, joint.dq, dt);
      accelerations.push_back(is_upper ? ddq.ub : ddq.lb);
      joint = move(joint, accelerations.back(), dt).end;
    }
    ASSERT_NEAR(joint.q, is_upper ? limits.q_max : limits.q_min, kPositionRounding);
    ASSERT_LE(jitter(accelerations), kPositionRounding / (options.tau * dt));
  }
}

TEST(RecoverableBounds, ALockStandsStillAndComesToRestWhenEnteredWithSpeed) {
  for (int seed = 0; seed < 100; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    JointLimits limits = random_limits(random);
    limits.q_min = limits.q_max;
    const double dt = random_period(random);
    const RecoverableOptions options = options_for(limits, dt);
    const double speed = seed % 4 == 0 ? 0.0 : log_uniform(random, 1e-6, limits.dq_max);
    const double overshoot = speed * speed / (3.0 * limits.ddq_max);  // braking with A_rec
    const double duration =
        2.0 * speed / limits.ddq_max + overshoot / options.v_rec + 40.0 * options.tau_rec;
    for (const Policy policy : kPolicies) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", policy " +
                   std::to_string(static_cast<int>(policy)));
      Joint joint = {limits.q_max, speed};
      const auto bounds = [&](Joint j) {
        return recoverable_bounds(limits, options, j.q, j.dq, dt);
      };
      std::vector<double> accelerations;
      for (int k = 0; k < static_cast<int>(2.0 * duration / dt); ++k) {
        accelerations.push_back(choose(policy, bounds(joint), k, joint, dt, bounds, random));
        const auto [end, path] = move(joint, accelerations.back(), dt);
        ASSERT_LE(path.ub - limits.q_max, overshoot + limits.ddq_max * dt * dt);
        joint = end;
      }
      // the return ends where its step, (q - q_max) dt / tau_rec, is lost in the rounding of q
      ASSERT_NEAR(joint.q, limits.q_max, kPositionRounding + kUlp * options.tau_rec / dt);
      ASSERT_LE(jitter(accelerations), kPositionRounding / (options.tau * dt));
    }
  }
}

TEST(RecoverableBounds, ShorterPeriodsConvergeToTheContinuousLaw) {
  constexpr double kTau = 4e-3;
  RecoverableOptions options = {.tau = kTau};
  // on the edge of the viable set the continuous law is ddq = w'(d) w(d), on line, root and beyond
  struct Case {
    double q, dq, continuous;
  };
  const double d_line = 1e-4;
  const double d_root = 0.02;
  const std::vector<Case> cases = {
      {kElbow.q_max - d_line, d_line / kTau, -d_line / (kTau * kTau)},
      {kElbow.q_max - d_root, viable_speed(d_root, kElbow, kTau), -kElbow.ddq_max}};
  for (const auto& [q, dq, continuous] : cases) {
    double previous_error = kInfinity;
    for (const double dt : {2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
      const double error = std::abs(recoverable_bounds(kElbow, options, q, dq, dt).ub - continuous);
      EXPECT_LE(error, 0.6 * previous_error + 1e-9) << dt;  // first order: halves with dt
      previous_error = error;
    }
    EXPECT_LE(previous_error, 0.02 * std::abs(continuous));  // dt / (2 tau)
  }
}

TEST(RecoverableOptions, DefaultsFollowPeriodsAndSpeed) {
  const RecoverableOptions slow = recoverable_options({.dq_max = 1.0}, 1e-3, 1e-3);
  EXPECT_EQ(slow.tau, 2e-3);
  EXPECT_EQ(slow.tau_rec, 20e-3);
  EXPECT_EQ(slow.v_rec, 0.25);
  EXPECT_EQ(slow.ddq_rec_factor, 1.5);
  const RecoverableOptions fast = recoverable_options({.dq_max = kInfinity}, 1e-4, 3e-3);
  EXPECT_EQ(fast.tau, 3e-3);
  EXPECT_EQ(fast.v_rec, 0.5);
}

// Message of the check of these arguments; empty when they pass.
template <typename... Arguments>
std::string refusal(const Arguments&... arguments) {
  try {
    if constexpr (sizeof...(arguments) == 1) {
      check_joint_limits(arguments..., kItem);
    } else {
      check_recoverable_options(arguments..., kItem);
    }
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckRecoverableOptions, AnImpossibleOptionIsRefusedAndNamed) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto said = [](const RecoverableOptions& options) {
    return refusal(options, kElbow, 1.5e-3);
  };
  EXPECT_EQ(said({}), "");
  EXPECT_EQ(said({.tau = 1e-3}),
            "joint m4: tau must be finite and not below the longest period, got 0.001");
  for (const double bad : {kNan, kInfinity, -1.0, 0.0}) {
    EXPECT_TRUE(said({.tau = bad}).starts_with("joint m4: tau must")) << bad;
    EXPECT_TRUE(said({.tau_rec = bad}).starts_with("joint m4: tau_rec must")) << bad;
    if (bad != 0.0) {
      EXPECT_TRUE(said({.tau_onset = bad}).starts_with("joint m4: tau_onset must")) << bad;
    }
    EXPECT_TRUE(said({.v_rec = bad}).starts_with("joint m4: v_rec must")) << bad;
    EXPECT_TRUE(said({.ddq_rec_factor = bad}).starts_with("joint m4: ddq_rec_factor must")) << bad;
  }
  EXPECT_NE(said({.tau_rec = 1e-3}), "");
  EXPECT_NE(said({.v_rec = 2.1}), "");  // faster than the joint may move
  EXPECT_NE(said({.ddq_rec_factor = 0.99}), "");
}

TEST(CheckJointLimits, AnImpossibleLimitIsRefusedAndNamed) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(JointLimits{}), "");
  EXPECT_EQ(refusal(kElbow), "");
  EXPECT_EQ(refusal(JointLimits{.q_min = 0.3, .q_max = 0.3}), "");  // a lock
  EXPECT_EQ(refusal(JointLimits{.q_min = 0.3, .q_max = 0.2}),
            "joint m4: q_max must not be below q_min, got 0.2");
  for (const double bad : {kNan, kInfinity}) {
    EXPECT_TRUE(refusal(JointLimits{.q_min = bad}).starts_with("joint m4: q_min must")) << bad;
  }
  for (const double bad : {kNan, -kInfinity}) {
    EXPECT_TRUE(refusal(JointLimits{.q_max = bad}).starts_with("joint m4: q_max must")) << bad;
  }
  for (const double bad : {kNan, 0.0, -1.0}) {
    EXPECT_TRUE(refusal(JointLimits{.dq_max = bad}).starts_with("joint m4: dq_max must")) << bad;
    EXPECT_TRUE(refusal(JointLimits{.ddq_max = bad}).starts_with("joint m4: ddq_max must")) << bad;
  }
}

}  // namespace
}  // namespace hg::limits
