/// Torques that the law may demand of a motor of the manipulator.
///
/// A share of the torque is left to the control that follows the reference. The spring behind a
/// motor cannot be twisted at once, so the demanded torque approaches its bound gradually. Nm and
/// rad; of a prismatic joint N and m. Pure functions, no allocation, noexcept.
#pragma once

#include "hg/core/interval.h"
#include "hg/signals/actuator_model.h"

namespace hg::rendering {

/// Share of the torque that the motor has at its speed.
inline constexpr double kTorqueShare = 0.75;
inline constexpr double kTorqueOnset = 20e-3;  ///< Time constant of the approach to the bound, s
/// Of a device with a gantry: share of the peak torque that is light, whose bound is approached
/// with kTorqueOnset, and the time constant beyond it, s. Faster, a motor of HapticGiant has no
/// torque left to twist its spring.
inline constexpr double kLightShare = 0.5, kHeavyOnset = 0.1;

/// Range of torques, without friction, that the law may demand of `motor` at speed `dq` (rad/s):
/// accelerating, less with growing speed; braking, all of the share.
Interval allowed_torque(const ActuatorModel& motor, double dq) noexcept;

/// Range reachable within `dt` (s) from the torque `before` of the last sample, Nm or N. The
/// distance to either end of `allowed` shrinks with kTorqueOnset, also from beyond, where a limit
/// with priority over the motors has put it; what lies beyond `light` with kHeavyOnset. Never
/// empty.
Interval reached_torque(Interval allowed, double light, double before, double dt) noexcept;

/// Whether a motor of the torque `most` holds so much that eased_torque() may change its range.
bool is_loaded(double most, double held) noexcept;

/// Range that does not ask for a motion against a push. A motor of the torque `most` that needs
/// more than `torque` to hold its joint at rest, `held`, has what that takes where it takes even
/// more to yield, `led`: to move as the twin would without limits. From the torque `before` of the
/// last sample it gets there four times as fast as by reached_torque() with `light`. Nm or N.
Interval eased_torque(Interval torque, double most, double light, double held, double led,
                      double before, double dt) noexcept;

}  // namespace hg::rendering
