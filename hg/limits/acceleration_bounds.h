/// Acceleration bounds that keep one coordinate inside its limits at every sample and in between.
///
/// Sources: [HG] sec. VI-B, eqs. (7)-(8) for the bounds A, B and C; [DP18] A. Del Prete, RA-L 3(1),
/// 2018, algs. 1 and 2.  Bounds R, the default, are ours; recoverable_bounds() states them.
/// Differs from [DP18]: each condition is written once, for the upper side, in terms of the
/// distance to the limit; the lower side is its mirror image (q -> -q).
///
/// A coordinate is a joint, a sum of joints (rad, rad/s, rad/s^2) or a Cartesian axis (m, m/s,
/// m/s^2); time in s. The acceleration is constant over a sample. Every function needs dt > 0.
/// Pure functions of their arguments: no state, no allocation, noexcept.
#pragma once

#include <string_view>

#include "hg/core/interval.h"

namespace hg::limits {

/// Limits of one coordinate; infinity means "no limit". Set-up data: check_joint_limits() once,
/// trust afterwards.
struct JointLimits {
  double q_min = -kInfinity;   ///< lowest position
  double q_max = kInfinity;    ///< highest position, >= q_min; equal: a lock
  double dq_max = kInfinity;   ///< largest speed in either direction, > 0
  double ddq_max = kInfinity;  ///< largest acceleration in either direction, > 0
};

/// Throws SetupError unless all limits are in range; the message begins with `item`, for example
/// "joint m4" or "handle z".
void check_joint_limits(const JointLimits& limits, std::string_view item);

/// Shape of bounds R close to a limit and beyond it. Set-up data: check_recoverable_options() once,
/// trust afterwards.
struct RecoverableOptions {
  double tau = 2e-3;            ///< time constant of the approach, s; two periods of 1 kHz
  double tau_rec = 20e-3;       ///< time constant of the return, s; slow enough to be no jerk
  double v_rec = 0.5;           ///< speed of the return, rad/s or m/s; a slow hand movement
  double ddq_rec_factor = 1.5;  ///< Braking beyond the limits, times ddq_max, >= 1
  double tau_onset = 0.0;  ///< Time constant of the onset of braking and return, s; 0: immediate
  bool is_capped = true;   ///< ddq_max limits accelerations everywhere, not only braking
};

/// Default options for a nominal period `dt` and the longest period `dt_max` that may occur, s:
/// tau = max(2 dt, dt_max) and v_rec = min(0.5, dq_max / 4), so that a return is always slow.
RecoverableOptions recoverable_options(const JointLimits& limits, double dt, double dt_max);

/// Throws SetupError unless the options suit the limits and periods up to `dt_max`.
void check_recoverable_options(const RecoverableOptions& options, const JointLimits& limits,
                               double dt_max, std::string_view item);

/// Bounds R, for any state. With the distance d = q_max - q, its value d+ and the speed v+ at the
/// end of the sample, A = ddq_max, A_rec = ddq_rec_factor A, and likewise for q_min:
///
///   v+ <= w(d+),  w(d) = d / tau for d <= A tau^2, else sqrt(A (2 d - A tau^2))    for q <= q_max
///   v+ <= -min(v_rec, -d+ / tau_rec)                                               for q > q_max
///   v+ <= dq_max,  ddq <= A if capped,  and in any case ddq >= -A_rec
///
/// With tau_onset T > dt what the speed still lacks to each of the two, w(d) - v and dq_max - v,
/// shrinks by no more than dt / T in a sample: braking comes in before it is needed, without a
/// jump. Likewise, beyond a limit, what a speed of at most 0 lacks to that of the return.
///
/// A state with |dq| <= dq_max and -w(q - q_min) <= dq <= w(q_max - q) is viable. From a viable
/// state every choice inside the bounds leads to a viable state, keeps position and speed inside
/// their limits (also between samples) and needs no more than A, for all dt <= tau, however small
/// the range is. From any other state the joint brakes with A_rec: it overshoots by the physical
/// minimum max(0, q - q_max + dq^2 / (2 A_rec)) and returns. The interval is never empty and stays
/// within -A_rec and A_rec; where the sides contradict each other, the one of larger magnitude
/// takes both. Infinite limits give infinite or absent bounds, never NaN. With ddq_max infinite
/// there is no braking distance and w(d) = d / tau everywhere: the joint then stops within a few
/// tau, whatever acceleration that takes.
Interval recoverable_bounds(const JointLimits& limits, const RecoverableOptions& options, double q,
                            double dq, double dt) noexcept;

/// Bounds A of [HG]: position and speed hold in this sample; the acceleration may become
/// arbitrarily large. As in [HG] the state is first moved to the nearest viable one, q into its
/// limits, then dq to |dq| <= sqrt(2 ddq_max distance): a joint that is outside is held there but
/// not brought back. Never empty: where conditions contradict each other position is stronger than
/// speed; where position alone has no solution (range below ddq_max dt^2) the joint stands still.
Interval bounds_A(const JointLimits& limits, double q, double dq, double dt) noexcept;

/// Bounds B of [HG]: as A, and braking with ddq_max always suffices. Where conditions contradict
/// each other the stronger one decides: position, speed, viability, acceleration. Meant for ranges
/// of at least ddq_max dt^2 and dq_max >= ddq_max dt.
Interval bounds_B(const JointLimits& limits, double q, double dq, double dt) noexcept;

/// Bounds C of [HG], eq. (8), with the horizon T_C > 0 in s in the place of dt: the position
/// reaches its limits within T_C, from outside as well. Speed and acceleration are not limited. T_C
/// = dt is the printed form, an undamped bounce; n periods damp by 1 - 1 / n per period.
Interval bounds_C(const JointLimits& limits, double q, double dq, double T_C) noexcept;

}  // namespace hg::limits
