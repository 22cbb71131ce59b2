/// Speeds that lead a Franka along the reference of the law, where the robot's own joint control
/// follows speeds instead of torques.
///
///     dq_c = dq_r + k (q_r - q)
///
/// with k = 10/s. So a hand does not bend the arm away from its reference for long, but the robot
/// pushes the harder against an obstacle the longer it is held up, until it stops for a collision.
#pragma once

#include "hg/core/types.h"
#include "hg/signals/frames.h"

namespace hg::franka {

/// Speeds for a reference, rad/s; not limited yet.
VectorM led_speeds(const CommandFrame& command, const VectorM& q) noexcept;

/// Speeds nearest to `wanted` that the robot accepts in its next period at `q`, after the speeds
/// and accelerations of its last one: an FR3's limits of speed, which fall towards the ends of its
/// joints, 10 rad/s^2 and 5000 rad/s^3. Joints 5 and 7 cannot brake as fast as their limit falls,
/// so the reference must keep away from their ends.
VectorM limited_speeds(const VectorM& wanted, const VectorM& q, const VectorM& last,
                       const VectorM& last_acceleration) noexcept;

}  // namespace hg::franka
