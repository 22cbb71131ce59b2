/// What the law may ask of a motor of the manipulator.
///
/// Of its torque a share is left to the control that follows the reference. The spring behind a
/// motor cannot be twisted at once, so that what is asked for comes to its bound gradually.
/// Nm and rad; of a prismatic joint N and m. Pure functions, no allocation, noexcept.
#pragma once

#include "hg/core/interval.h"
#include "hg/signals/actuator_model.h"

namespace hg::rendering {

inline constexpr double kTorqueShare = 0.75;   ///< of what the motor has at its speed
inline constexpr double kTorqueOnset = 20e-3;  ///< time constant to the bound, s

/// The torques, without those of friction, that the law may ask of `motor` at speed `dq` (rad/s):
/// onward less and less with the speed, for braking all of the share.
Interval allowed_torque(const ActuatorModel& motor, double dq) noexcept;

/// What may be reached within `dt` (s) from the torque `before` of the last sample: the distance to
/// either end of `allowed` shrinks with kTorqueOnset, also from beyond, where a limit that stands
/// above the motors has put it. Never empty.
Interval reached_torque(Interval allowed, double before, double dt) noexcept;

}  // namespace hg::rendering
