/// Moves the gantry along with the hand: target (30), P controller (27), velocity bounds.
///
/// Differs from [HG]: the target is written in closed form (equal to (30) to rounding), and the
/// bounds know the drive's braking distance instead of (28)-(29).
/// No allocation, noexcept after set-up.
#pragma once

#include <array>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/limits/velocity_bounds.h"
#include "hg/signals/state.h"

namespace hg::prepositioning {

/// Set-up data. Arrays are indexed by gantry joint.
struct Config {
  int n_p = 0;
  std::array<Interval, kMaxGantry> q_limits;  ///< m
  double dq_max = 1.5;                        ///< m/s
  double k_ppu = 4.0;  ///< gain of (27), 1/s; below 1 / (4 lag) there is no overshoot
  limits::DriveResponse drive;
};

/// Throws SetupError naming the field that is out of range.
void check(const Config& config);

struct Command {
  VectorP q_target;  ///< where the gantry should be, m
  VectorP dq;        ///< velocity command, m/s
};

/// `robot` gives the gantry, `q_m` the manipulator reference. `device_blocked` (a manipulator row
/// could not be met) scales the command to zero: a gantry that drags a blocked arm is a fault.
Command step(const Config& config, const RobotState& robot, const VectorM& q_m,
             bool device_blocked) noexcept;

}  // namespace hg::prepositioning
