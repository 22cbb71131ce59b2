/// Moves the gantry to its target: P controller (27), velocity bounds. The target: gantry_target.h.
///
/// Differs from [HG]: the bounds use the drive's braking distance instead of (28)-(29).
/// Prismatic axes: m and m/s, revolute ones rad and rad/s. No allocation, noexcept after set-up.
#pragma once

#include <vector>

#include "hg/controller/prepositioning/prepositioning_config.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/limits/velocity_bounds.h"
#include "hg/model/device_model.h"
#include "hg/signals/gantry_task.h"
#include "hg/signals/state.h"

namespace hg::prepositioning {

/// Distance that each axis may move before it carries a frame of the device over a limit; negative
/// beyond one, m or rad. Empty: there are no such limits.
struct Room {
  VectorP down, up;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const Room& room) {
  const auto& [down, up] = room;
  hash.mix(down, up);
}

struct GantryCommand {
  VectorP q_target;        ///< Target of the gantry, within its limits, m or rad
  VectorP dq;              ///< Velocity command, m/s or rad/s
  VectorP dq_min, dq_max;  ///< Bounds of the velocity command, m/s or rad/s
};

class Prepositioning {
 public:
  /// Throws SetupError naming the value that is out of range.
  Prepositioning(const PrepositioningConfig& config, const DeviceModel& device);

  /// Computes the velocity command. `robot` gives the gantry. `device_blocked` (a manipulator row
  /// could not be met) makes the command zero: a gantry that drags a blocked arm is a fault. No
  /// axis is faster than `dq_max`, nor more than `taken_back` faster than lets it stop within its
  /// `room`: an arm at its limits compensates no more. `away` replaces the motion to the
  /// target: the velocity with which the gantry leaves a contact of the arm; empty: no contact.
  GantryCommand step(const RobotState& robot, const VectorP& q_target, bool device_blocked,
                     double dq_max = kInfinity, const Room& room = {},
                     const VectorP& away = {}) const noexcept;

  /// Range in which the law may lead the gantry instead of `command`, which is its aim: 0.1 m/s
  /// (rad/s) beside it within the bounds of the command. Steps from `last` reach the full
  /// acceleration of the drives within the larger of 60 ms and 15 dead times. `last` (n_p, or
  /// empty) is the acceleration that the law demanded a period before.
  GantryTask accelerations(const GantryCommand& command, const RobotState& robot,
                           const VectorP& last) const noexcept;

  /// Velocity command that makes the drives accelerate by `ddq`, within the bounds of `command`.
  VectorP velocity_for(const VectorP& ddq, const GantryCommand& command,
                       const RobotState& robot) const noexcept;

  /// Largest speed of an axis, m/s or rad/s.
  double dq_max() const noexcept { return config_.dq_max; }

 private:
  PrepositioningConfig config_;
  std::vector<Interval> range_;  ///< Ranges of the axes, m or rad
  DriveModel drive_;
  double dt_;                       ///< Period, s
  limits::DriveResponse response_;  ///< Response that braking relies on
};

}  // namespace hg::prepositioning
