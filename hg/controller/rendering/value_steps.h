/// Steps of the values of a twin towards their targets, so that the user feels a change and no
/// blow.
///
/// A value approaches its target with a time constant of 0.1 s. Its step in a cycle is shortened
/// where it would change the force on the handle by more than 25 N/s or, where that allows more,
/// the torque by 2.5 Nm/s: of one value, and of all values of a joint together. What a value does
/// to the force follows from the present state: a stiffness from the distance to the rest, a
/// damping from the speed, a mass from the acceleration. The rate of force grows from none within
/// 50 ms. However large a change is, it ends: after some seconds the rate grows by a factor of e
/// each second.
///
/// No allocation, noexcept.
#pragma once

#include "hg/controller/rendering/twin_parameters.h"

namespace hg::rendering {

/// Advances stiffness, rest, preload, damping and friction of the joints, masses, share of gravity
/// and scales of the felt force by one period of `dt`, s.
void approach_targets(const TwinModel& twin, const TwinState& state, double dt, const FeltBy& felt,
                      TwinParameters& parameters) noexcept;

/// One step of `now` towards `target` by `share` of the distance; exactly there when they differ by
/// a billionth.
void approach(double& now, double target, double share) noexcept;

/// Share of the distance to a target that a step takes in a period of `dt`, s.
double share_of_step(double dt, double time_constant) noexcept;

inline constexpr double kApproach = 0.1;  ///< Time constant of small changes, s

}  // namespace hg::rendering
