/// Velocity bounds that keep one velocity-controlled joint (a gantry axis) inside its position
/// limits.
///
/// Sources: [HG] sec. VI-D, eqs. (28)-(29), a constant-velocity model.
/// Differs from [HG]: braking_velocity_bounds() accounts for the delay of the drive; with (28)-(29)
/// a drive with a lag of 50 ms overshoots by 9 mm at 1.5 m/s.
///
/// Prismatic joints: m, m/s, m/s^2 (rad, rad/s, rad/s^2 for revolute joints); time in s. Infinite
/// limits give infinite bounds. Pure functions: no state, no allocation, noexcept.
#pragma once

#include <string_view>

#include "hg/core/interval.h"

namespace hg::limits {

/// Response of a drive to its velocity command. Set-up data: check_drive_response() once, trust
/// afterwards.
struct DriveResponse {
  double tau = 45e-3;    ///< Delay of the velocity, > 0, s: dead time + lag + one period
  double ddq_max = 2.0;  ///< Guaranteed deceleration, > 0, m/s^2
};

/// Throws SetupError unless both values are finite and positive; the message begins with `item`.
void check_drive_response(const DriveResponse& drive, std::string_view item);

/// Bounds from the braking distance. Towards a limit at distance d
///   dq <= min(-a tau + sqrt((a tau)^2 + 2 a d), d / (4 tau)),   a = drive.ddq_max:
/// the first term solves v tau + v^2 / (2 a) = d, the second makes the approach critically damped.
/// Outside (d < 0) dq <= d / (4 tau): the joint returns, slowly enough to stop before the opposite
/// limit. Never empty as long as q_limits is not.
Interval braking_velocity_bounds(Interval q_limits, const DriveResponse& drive, double q) noexcept;

}  // namespace hg::limits
