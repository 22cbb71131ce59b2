/// One joint under constant acceleration per sample, with exact extrema between the samples, and
/// random limits and seeds for the property tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "hg/core/interval.h"
#include "hg/limits/acceleration_bounds.h"

namespace hg::limits {

using Random = std::mt19937_64;

inline double uniform(Random& random, double lb, double ub) {
  return std::uniform_real_distribution<double>(lb, ub)(random);
}

inline double log_uniform(Random& random, double lb, double ub) {
  return std::exp(uniform(random, std::log(lb), std::log(ub)));
}

inline double random_period(Random& random) {
  constexpr std::array kPeriods = {2e-3, 1e-3, 5e-4, 1e-4};  // s, 500 Hz to 10 kHz
  return kPeriods[std::uniform_int_distribution<std::size_t>(0, kPeriods.size() - 1)(random)];
}

inline JointLimits random_limits(Random& random) {
  return {.q_min = -uniform(random, 0.05, 2.0),
          .q_max = uniform(random, 0.05, 2.0),
          .dq_max = uniform(random, 0.3, 5.0),
          .ddq_max = log_uniform(random, 2.0, 200.0)};
}

struct Joint {
  double q;
  double dq;
};

struct Sample {
  Joint end;
  Interval path;  ///< lowest and highest position from the beginning to the end of the sample
};

inline Sample move(Joint now, double ddq, double dt) {
  const Joint end = {now.q + dt * now.dq + 0.5 * dt * dt * ddq, now.dq + dt * ddq};
  const double t_turn = ddq == 0.0 ? 0.0 : std::clamp(-now.dq / ddq, 0.0, dt);
  const double q_turn = now.q + t_turn * (now.dq + 0.5 * t_turn * ddq);
  return {end, {std::min({now.q, end.q, q_turn}), std::max({now.q, end.q, q_turn})}};
}

/// How a person, or the worst of luck, uses the freedom that bounds leave.
enum class Policy { kUpper, kLower, kRandom, kSwitching, kAlternating, kSeeking };
inline constexpr std::array kPolicies = {Policy::kUpper,       Policy::kLower,
                                         Policy::kRandom,      Policy::kSwitching,
                                         Policy::kAlternating, Policy::kSeeking};
inline constexpr int kSwitchSamples = 700;  ///< long enough to lean on a limit in between

/// The choice of `policy` in sample k; `bounds(joint)` gives the bounds at a state.
template <typename Bounds>
double choose(Policy policy, Interval ddq, int k, Joint now, double dt, const Bounds& bounds,
              Random& random) {
  const double any = uniform(random, 0.0, 1.0);
  const double between = ddq.lb + any * (ddq.ub - ddq.lb);
  switch (policy) {
    case Policy::kUpper:
      return ddq.ub;
    case Policy::kLower:
      return ddq.lb;
    case Policy::kRandom:
      return between;
    case Policy::kSwitching:
      return (k / kSwitchSamples) % 2 == 0 ? ddq.ub : ddq.lb;
    case Policy::kAlternating:
      return k % 2 == 0 ? ddq.ub : ddq.lb;
    case Policy::kSeeking:
      break;
  }

  // the choice after which the next sample must brake hardest
  double worst_demand = -kInfinity;
  double worst = between;
  for (const double candidate : {ddq.lb, ddq.ub, 0.5 * (ddq.lb + ddq.ub), between}) {
    const Interval next = bounds(move(now, candidate, dt).end);
    const double demand = std::max(next.lb, -next.ub);
    if (demand > worst_demand) {
      worst_demand = demand;
      worst = candidate;
    }
  }
  return worst;
}

}  // namespace hg::limits
