/// Moves the gantry to its target: P controller (27), velocity bounds. The target: gantry_target.h.
///
/// Differs from [HG]: the bounds know the drive's braking distance instead of (28)-(29).
/// Prismatic axes: m and m/s, revolute ones rad and rad/s. No allocation, noexcept after set-up.
#pragma once

#include <array>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/limits/velocity_bounds.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/gantry_task.h"
#include "hg/signals/state.h"

namespace hg::prepositioning {

/// Set-up data. Arrays are indexed by gantry joint.
struct Config {
  int n_p = 0;
  bool has_closed_form = false;               ///< of the target: the device is a HapticGiant
  std::array<Interval, kMaxGantry> q_limits;  ///< m or rad
  double dq_max = 1.5;                        ///< m/s or rad/s
  double k_ppu = 4.0;  ///< gain of (27), 1/s; below 1 / (4 lag) there is no overshoot
  limits::DriveResponse drive;
};

/// Throws SetupError naming the field that is out of range.
void check(const Config& config);

/// How far each axis may go by itself, the arm held stiff, before it carries a frame of the device
/// over a limit; negative beyond one, m or rad. Empty: there are no such limits.
struct Room {
  VectorP down, up;
};

struct Command {
  VectorP q_target;        ///< where the gantry should be, within its limits, m or rad
  VectorP dq;              ///< velocity command, m/s or rad/s
  VectorP dq_min, dq_max;  ///< that may be commanded instead, m/s or rad/s
};

/// `robot` gives the gantry. `device_blocked` (a manipulator row could not be met) makes the
/// command zero: a gantry that drags a blocked arm is a fault. No axis is faster than `dq_max`,
/// nor more than 0.25 m/s (rad/s) faster than lets it stop within its `room`: an arm at its limits
/// takes no more back. `away` takes the place of the way to the target: with this velocity the
/// gantry leaves what the arm touches; empty: nothing touches.
Command step(const Config& config, const RobotState& robot, const VectorP& q_target,
             bool device_blocked, double dq_max = kInfinity, const Room& room = {},
             const VectorP& away = {}) noexcept;

/// Where the law may lead the gantry instead of `command`, which is its aim: 0.1 m/s (rad/s) beside
/// it within what may be commanded, in steps from `last` that bring all that the drives have within
/// 60 ms or 15 dead times. `last` (n_p, or empty) is where the law has led it a period of `dt` (s)
/// before.
GantryTask accelerations(const Command& command, const DriveModel& drive, const RobotState& robot,
                         const VectorP& last, double dt) noexcept;

/// The velocity command that makes the drives accelerate by `ddq`, within what may be commanded.
VectorP velocity_for(const VectorP& ddq, const Command& command, const DriveModel& drive,
                     const RobotState& robot) noexcept;

}  // namespace hg::prepositioning
