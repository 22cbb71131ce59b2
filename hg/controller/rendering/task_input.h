/// What the tasks of the law are filled from in a cycle, and its limits.
#pragma once

#include "hg/controller/rendering/constraint_directions.h"
#include "hg/controller/rendering/paper_law.h"
#include "hg/controller/rendering/stops.h"
#include "hg/controller/rendering/twin_forces.h"
#include "hg/core/interval.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_data.h"
#include "hg/signals/collision_task.h"
#include "hg/signals/gantry_task.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// One limit, in catalogue order. With bounds paper a joint has a second row, for its acceleration
/// rating; where limits brake together a motor has one for the torque that holds the device.
struct LimitRow {
  int row = -1;                ///< Row of the problem
  int holding_row = -1;        ///< Row of a motor's torque at rest; -1 = none
  int stop_row = -1;           ///< Row of a wall for where the device comes to rest; -1 = none
  Interval range;              ///< Configured positions; of the twin as changed, this cycle
  limits::JointLimits limits;  ///< Limits as rendered: with margins, and this cycle's locks
  limits::RecoverableOptions options;
  double rating = 1.0;  ///< Largest acceleration; 1 = none
  int rating_row = -1;  ///< Row of bounds B; -1 = none
  /// Row of a motor torque, as an acceleration of its joint; `q` is then the motor's torque.
  bool is_motor = false;
  double inertia = 0.0;    ///< Inertia that this motor moves, kg m^2 or kg
  bool is_slowed = false;  ///< This motor's row holds its speed, in this cycle
  Interval torque;         ///< Torques of this motor that the law has in this cycle, Nm or N
  /// Bounds R are used in this cycle. With bounds paper only for a twin joint that may be beyond
  /// limits which were not there before: from outside, bounds A let it coast away.
  bool is_recoverable = true;
  Holds held_by;             ///< Locks, latches and friction, this cycle
  double q = 0.0, dq = 0.0;  ///< Position and speed in this cycle
  double known = 0.0;        ///< Acceleration without the unknowns, this cycle
  Interval ddq;              ///< Bounds of the first row in this cycle, without known accelerations
  bool brakes_together = false;  ///< Bounds R alone would let it move faster, in this cycle
};

/// Inputs of one cycle.
struct TaskInput {
  /// Device in this cycle, after update(); without motors in the law update_kinematics()
  /// is enough.
  const model::ChainData& device_chain;
  const model::ChainData& twin_chain;  ///< Twin in this cycle, after update()
  const RobotState& robot;
  const ReferenceState& reference;
  const TwinState& twin;
  const TwinInnerState& inner;
  const VectorM& motor_torque;       ///< Motor torques of the last cycle, Nm or N; empty: none
  const GantryTask& gantry;          ///< Task of the gantry; empty: it moves as measured
  const TouchedEnds& touched;        ///< Limit ends touched by the last result; law paper only
  const MatrixA& L;                  ///< Cholesky factor of M_a = L L^T
  const model::Jacobian& J_H;        ///< Jacobian of the handle, gantry first
  const model::Jacobian& J_a;        ///< Jacobian of the twin's end effector
  ConstraintDirections& directions;  ///< Directions for J_H and J_a; found by law paper
  const Stops& stops;                ///< Virtual surfaces in front of the twin
  VectorA tau;  ///< Sum of all torques on the twin that are not constraints, without c_a
  /// Largest speed of H along each axis of B, where the device limits H, m/s.
  double handle_speed = kInfinity;
  double joint_braking_rate = 0.0;  ///< Rate at which every joint at least slows down, 1/s
  double kept_acceleration = 0.0;   ///< In a stop: kept share of what makes a joint faster
  bool is_braked = false;           ///< The twin is brought to rest, and so is a joint to spare
  bool has_surfaces = false;        ///< There are virtual surfaces, near or far
  CollisionTask collision = {};     ///< What is kept apart; with infinite distance nothing
};

}  // namespace hg::rendering
