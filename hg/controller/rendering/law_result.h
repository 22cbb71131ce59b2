/// Input and result of one step of the rendering law.
///
/// SI units; frames and chains as in hg/signals/state.h.
#pragma once

#include <array>
#include <cstdint>

#include "hg/signals/collision_task.h"
#include "hg/signals/gantry_task.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// What the law gets in one cycle, besides its own state.
struct LawInput {
  const RobotState& robot;    ///< Measured device and wrench of the user
  double braking_rate = 0.0;  ///< Rate at which the twin is brought to rest, 1/s; 0: not braked
  /// Rate at which every joint of the manipulator at least slows down in a stop, 1/s, with what its
  /// motors give; with a gantry, with at most a share of its rating.
  double joint_braking_rate = 0.0;
  double kept_acceleration = 0.0;  ///< In a stop: kept share of what makes a joint faster
  /// Share of the user's wrench, the twin's springs, its weight, its reference wrench, the surfaces
  /// around it and a remote machine, 0..1. With it a run against a leaning hand begins and ends
  /// without a jump. 0 with a braking rate: the twin is a body without friction and without the
  /// user.
  double force_share = 1.0;
  /// Largest speed of the handle along each axis of B where the device has Cartesian limits for it,
  /// m/s.
  double handle_speed_max = kInfinity;
  /// Cap on active sets of a solve, where smaller than in the options; 0 = none.
  std::uint32_t most_active_sets = 0;
  GantryTask gantry = {};        ///< Accelerations with which the law may lead the gantry
  std::uint64_t cycle = 0;       ///< Number of the cycle under which its problem is kept
  CollisionTask collision = {};  ///< What the law keeps apart
  /// Force of a remote machine on the twin, with finite values; nullptr = none.
  const TwinForce* twin_force = nullptr;
};

/// What the law found in one cycle, recorded but for the accelerations.
struct LawResult : LawReport {
  VectorM ddq_m;  ///< Accelerations of the manipulator joints, rad/s^2 or m/s^2
  VectorA ddq_a;  ///< Accelerations of the twin joints, rad/s^2 or m/s^2
  /// Distance outside its range that each limit of the device will reach within kLookAhead, if it
  /// could not be met in this cycle, else 0; rad or m, in the order of `limits`. Of frames that of
  /// the measured device, too.
  std::array<double, kMaxLimits> passing{};
};

/// How far ahead a limit that cannot be met is followed, s: brakes close and stop within less.
inline constexpr double kLookAhead = 0.1;

}  // namespace hg::rendering
