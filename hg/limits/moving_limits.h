/// Position limits that change at run time without a jump: they move to their new values slowly
/// enough for bounds R to push the joint along.
///
/// A closing limit can overrun even a viable joint, because the bounds cannot predict its
/// motion. With bounds R, f = ddq_rec_factor > 1 and A = ddq_max it gets outside
/// by at most
///   max(v_rec tau_rec, v_rec^2 / (2 A (f - 1))) + v_rec dt
/// (10.5 mrad with the defaults, 1 kHz and A >= 25 rad/s^2): the lag of the return law, or the way
/// that braking with A_rec still needs; then one step of the limit. It is inside again shortly
/// after the limit rests.
///
/// Joint space: rad or m; time in s. Plain value, part of the copyable state of a cycle; no
/// allocation, noexcept.
#pragma once

#include "hg/core/interval.h"

namespace hg::limits {

/// Present position limits of one joint.
struct MovingLimits {
  Interval q;               ///< Present limits; never empty; infinite = no limit
  bool is_crossed = false;  ///< The target had lb > ub; to be reported as a fault
};

/// The limits one period later: each end has moved towards its target by at most v_rec dt.
///
/// A crossed target (lb > ub) counts as its midpoint; if that is not finite the limits stay.
/// A limit that disappears (infinite target) is removed at once. One that appears starts at its
/// target, or at the joint position `q` if that is beyond the target, and moves from there.
[[nodiscard]] MovingLimits advanced(const MovingLimits& now, Interval target, double q,
                                    double v_rec, double dt) noexcept;

}  // namespace hg::limits
