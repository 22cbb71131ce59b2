#include "hg/limits/acceleration_bounds.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "hg/core/error.h"

namespace hg::limits {
namespace {

constexpr double kTauPeriods = 2.0;         // an approach of two periods neither rings nor softens
constexpr double kReturnSpeedMax = 0.5;     // rad/s or m/s, see RecoverableOptions::v_rec
constexpr double kReturnSpeedShare = 0.25;  // of dq_max: a slow joint returns slower still

void require(bool ok, std::string_view item, const char* rule, double value) {
  if (ok) return;
  std::ostringstream message;
  message << item << ": " << rule << ", got " << value;
  throw SetupError(message.str());
}

// The helpers below look at the upper limit only: d is the distance left to it, v the speed towards
// it.

// The speed v+ at the end of the sample for which v+ = d+ / tau, with d+ = d - dt (v + v+) / 2.
double speed_on_line(double d, double v, double tau, double dt) noexcept {
  return (d - 0.5 * dt * v) / (tau + 0.5 * dt);
}

// The speed v+ from which ddq_max just stops the joint, v+^2 = 2 ddq_max d+; [DP18] alg. 2.
double speed_on_root(double d, double v, double ddq_max, double dt) noexcept {
  const double half_step = 0.5 * ddq_max * dt;
  const double sum_squared = half_step * half_step + ddq_max * (2.0 * d - dt * v);
  return std::sqrt(std::max(sum_squared, 0.0)) - half_step;  // below 0 by rounding only
}

// The speed v+ = w(d+) of bounds R.
double recoverable_speed(double d, double v, double ddq_max, const RecoverableOptions& options,
                         double dt) noexcept {
  if (d < 0.0) {
    const double back = std::max(speed_on_line(d, v, options.tau_rec, dt), -options.v_rec);
    const double kept = std::max(0.0, 1.0 - dt / options.tau_onset);
    return back + kept * std::max(std::min(v, 0.0) - back, 0.0);
  }

  // line and root touch at v+ = A tau, the line is above: it decides on which of them v+ lies
  const double v_line = speed_on_line(d, v, options.tau, dt);
  if (v_line <= ddq_max * options.tau) return v_line;
  return speed_on_root(d - 0.5 * ddq_max * options.tau * options.tau, v, ddq_max, dt);
}

// w(d) itself, d >= 0.
double approach_speed(double d, double ddq_max, double tau) noexcept {
  const double v_line = d / tau;
  if (v_line <= ddq_max * tau) return v_line;
  return std::sqrt(ddq_max * (2.0 * d - ddq_max * tau * tau));
}

double recoverable_max(double d, double v, const JointLimits& limits,
                       const RecoverableOptions& options, double dt) noexcept {
  // remaining share of the speed margin at the end of the sample
  const double kept = std::max(0.0, 1.0 - dt / options.tau_onset);
  const auto left = [&](double fastest) {
    return std::isfinite(fastest) ? kept * std::max(0.0, fastest - v) : 0.0;
  };
  const double slower = d > 0.0 ? left(approach_speed(d, limits.ddq_max, options.tau)) : 0.0;
  const double v_end =
      std::min(limits.dq_max - left(limits.dq_max),
               recoverable_speed(d, v - slower, limits.ddq_max, options, dt) - slower);
  const double ddq = std::max((v_end - v) / dt, -options.ddq_rec_factor * limits.ddq_max);
  return options.is_capped ? std::min(ddq, limits.ddq_max) : ddq;
}

// Fastest speed from which ddq_max stops the joint within distance d; [DP18] eq. (10).
double viable_speed(double d, const JointLimits& limits) noexcept {
  return d > 0.0 ? std::min(limits.dq_max, std::sqrt(2.0 * limits.ddq_max * d)) : 0.0;
}

// [DP18] alg. 1: the position stays below the limit during the whole sample. v > 0 needs d > 0.
double max_from_position(double d, double v, double dt) noexcept {
  const double ddq_touch = 2.0 * (d - v * dt) / (dt * dt);  // touches the limit at the sample's end
  const double ddq_stop = -v / dt;                          // stands still at the sample's end

  if (v <= 0.0 || ddq_touch > ddq_stop) return ddq_touch;
  return -v * v / (2.0 * d);  // turns back inside the sample
}

// [DP18] alg. 2: after the sample, braking with ddq_max still stops the joint before the limit.
// Where v+ < 0 the bound from position is the lower one and [DP18]'s case distinction superfluous.
double max_from_viability(double d, double v, double ddq_max, double dt) noexcept {
  if (ddq_max == kInfinity) return kInfinity;
  return (speed_on_root(d, v, ddq_max, dt) - v) / dt;
}

// State projected into the limits and to viability, for bounds A and B.
struct ViableState {
  double d_lower;
  double d_upper;
  double dq;
};

ViableState nearest_viable(const JointLimits& limits, double q, double dq) noexcept {
  const double q_v = std::clamp(q, limits.q_min, limits.q_max);
  const double d_lower = q_v - limits.q_min;
  const double d_upper = limits.q_max - q_v;
  return {d_lower, d_upper,
          std::clamp(dq, -viable_speed(d_lower, limits), viable_speed(d_upper, limits))};
}

Interval position_bounds(const ViableState& s, double dt) noexcept {
  const Interval ddq = {-max_from_position(s.d_lower, -s.dq, dt),
                        max_from_position(s.d_upper, s.dq, dt)};
  const double ddq_stop = -s.dq / dt;
  return ddq.empty() ? Interval{ddq_stop, ddq_stop} : ddq;
}

Interval speed_bounds(const ViableState& s, const JointLimits& limits, double dt) noexcept {
  return {(-limits.dq_max - s.dq) / dt, (limits.dq_max - s.dq) / dt};
}

Interval viability_bounds(const ViableState& s, double ddq_max, double dt) noexcept {
  return {-max_from_viability(s.d_lower, -s.dq, ddq_max, dt),
          max_from_viability(s.d_upper, s.dq, ddq_max, dt)};
}

}  // namespace

void check_joint_limits(const JointLimits& limits, std::string_view item) {
  require(limits.q_min < kInfinity, item, "q_min must be a number or -infinity", limits.q_min);
  require(limits.q_max > -kInfinity, item, "q_max must be a number or infinity", limits.q_max);
  require(limits.q_max >= limits.q_min, item, "q_max must not be below q_min", limits.q_max);
  require(limits.dq_max > 0.0, item, "dq_max must be positive", limits.dq_max);
  require(limits.ddq_max > 0.0, item, "ddq_max must be positive", limits.ddq_max);
}

RecoverableOptions recoverable_options(const JointLimits& limits, double dt, double dt_max) {
  return {.tau = std::max(kTauPeriods * dt, dt_max),
          .v_rec = std::min(kReturnSpeedMax, kReturnSpeedShare * limits.dq_max)};
}

void check_recoverable_options(const RecoverableOptions& options, const JointLimits& limits,
                               double dt_max, std::string_view item) {
  require(std::isfinite(options.tau) && options.tau >= dt_max, item,
          "tau must be finite and not below the longest period", options.tau);
  require(std::isfinite(options.tau_rec) && options.tau_rec >= dt_max, item,
          "tau_rec must be finite and not below the longest period", options.tau_rec);
  require(options.v_rec > 0.0 && std::isfinite(options.v_rec) && options.v_rec <= limits.dq_max,
          item, "v_rec must be positive and at most dq_max", options.v_rec);
  require(options.tau_onset >= 0.0 && std::isfinite(options.tau_onset), item,
          "tau_onset must be finite and not negative", options.tau_onset);
  require(options.ddq_rec_factor >= 1.0 && std::isfinite(options.ddq_rec_factor), item,
          "ddq_rec_factor must be finite and at least 1", options.ddq_rec_factor);
}

Interval recoverable_bounds(const JointLimits& limits, const RecoverableOptions& options, double q,
                            double dq, double dt) noexcept {
  const double ub = recoverable_max(limits.q_max - q, dq, limits, options, dt);
  const double lb = -recoverable_max(q - limits.q_min, -dq, limits, options, dt);
  if (lb <= ub) return {lb, ub};
  const double more_urgent = std::abs(ub) > std::abs(lb) ? ub : lb;
  return {more_urgent, more_urgent};
}

Interval bounds_A(const JointLimits& limits, double q, double dq, double dt) noexcept {
  const ViableState s = nearest_viable(limits, q, dq);
  return moved_into(speed_bounds(s, limits, dt), position_bounds(s, dt));
}

Interval bounds_B(const JointLimits& limits, double q, double dq, double dt) noexcept {
  const ViableState s = nearest_viable(limits, q, dq);
  const Interval acceleration = {-limits.ddq_max, limits.ddq_max};
  const Interval viable = moved_into(acceleration, viability_bounds(s, limits.ddq_max, dt));
  return moved_into(moved_into(viable, speed_bounds(s, limits, dt)), position_bounds(s, dt));
}

Interval bounds_C(const JointLimits& limits, double q, double dq, double T_C) noexcept {
  const double gain = 2.0 / (T_C * T_C);
  return {gain * (limits.q_min - q - T_C * dq), gain * (limits.q_max - q - T_C * dq)};
}

}  // namespace hg::limits
