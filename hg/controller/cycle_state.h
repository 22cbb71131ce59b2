/// Complete state of a control cycle.
#pragma once

#include <cstdint>

#include "hg/controller/estimation/estimation.h"
#include "hg/controller/prepositioning/gantry_target.h"
#include "hg/controller/prepositioning/prepositioning.h"
#include "hg/controller/rendering/rendering_state.h"
#include "hg/controller/safety/brakes.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/compliance/compliance.h"
#include "hg/controller/safety/monitor_state.h"
#include "hg/controller/safety/passivity/passivity.h"
#include "hg/controller/safety/supervisor.h"
#include "hg/controller/tracking/control_state.h"
#include "hg/core/types.h"

namespace hg::controller {

/// How the device moves in a cycle. Decided between estimation and prepositioning; kRender and
/// kRenderStop become kBrakeJoints where the solver finds no solution.
enum class Motion : std::uint8_t {
  kNone,         ///< the sample is unusable: nothing is computed, and the drives are off
  kHold,         ///< the device stands still; before arming, the twin follows it
  kRender,       ///< the law moves twin and device
  kRenderStop,   ///< a stop: the law brings both to rest
  kBrakeJoints,  ///< a stop without a solution or with a collision ahead: joints brake one by one
};

/// Complete state of a cycle. Copy it for a snapshot, assign it to restore.
struct CycleState {
  std::uint64_t cycle = 0;
  std::uint64_t next_sequence = 0;
  safety::SupervisorState supervisor;
  safety::MonitorState monitor;
  safety::BrakeState brakes;
  estimation::EstimationState estimation;
  rendering::RenderingState rendering;
  tracking::ControlState control;
  prepositioning::TargetState gantry_target;
  collision::CollisionState collision;
  passivity::PassivityState passivity;
  compliance::ComplianceState touch;
  /// Motion in the last cycle that was not kNone. Of it, only kBrakeJoints matters later: joints
  /// that brake one by one do so until they are held.
  Motion motion = Motion::kHold;
  Vector6 w_H = Vector6::Zero();  ///< Wrench of the user, the last one within the sensor's range
  VectorP dq_p;                   ///< Gantry command of the last cycle
  VectorM q_m, tau_m;             ///< Positions and torques of the last command
  bool was_on = false;            ///< The last command had the drives on
  prepositioning::Room room;      ///< Room of the gantry in the last cycle
  bool is_blocked = false;        ///< A device limit could not be met in the last cycle
  bool is_coasting = false;       ///< Joints or gantry moved in the last sample
  bool is_apart = false;          ///< The twin cannot reach the handle's pose while held
  bool was_alone = false;         ///< Last rendering without stopping was autonomous
  double force_share = 0.0;       ///< Ramped share of the forces on the twin, 0..1
};

/// Words of the state hash, in its order; `rows` is the number of rows of the rendering problem.
void hashed(auto& hash, const CycleState& state, int rows) {
  const auto& [cycle, next_sequence, supervisor, monitor, brakes, estimation, rendering, control,
               gantry_target, collision, passivity, touch, motion, w_H, dq_p, q_m, tau_m, was_on,
               room, is_blocked, is_coasting, is_apart, was_alone, force_share] = state;
  hashed(hash, rendering, rows);
  hash.mix(gantry_target, dq_p, room,
           std::uint64_t{is_blocked} | std::uint64_t{motion == Motion::kBrakeJoints} << 1U |
               std::uint64_t{was_on} << 2U | std::uint64_t{is_coasting} << 3U |
               std::uint64_t{is_apart} << 4U | std::uint64_t{was_alone} << 5U,
           force_share, cycle, next_sequence, supervisor, monitor, brakes, q_m, tau_m, collision,
           passivity, estimation, control, w_H);
  if (touch.dq.size() > 0) hash.mix(touch, rendering.touch);  // contact detection is active
}

}  // namespace hg::controller
