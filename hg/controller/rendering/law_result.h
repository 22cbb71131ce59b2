/// Input and result of one step of the rendering law.
///
/// SI units; frames and chains as in hg/signals/state.h.
#pragma once

#include <array>
#include <cstdint>

#include "hg/signals/gantry_task.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// What the law gets in one cycle, besides its own state.
struct LawInput {
  const RobotState& robot;    ///< Measured device and wrench of the user
  double braking_rate = 0.0;  ///< Rate at which the twin is brought to rest, 1/s; 0: not braked
  /// Share of the user's wrench, the twin's springs, its weight, its reference wrench and the
  /// surfaces around it, 0..1. With it a run against a leaning hand begins and ends without a jump.
  /// 0 with a braking rate: the twin is a body without friction and without the user.
  double force_share = 1.0;
  /// Largest speed of the handle along each axis of B where the device has Cartesian limits for it,
  /// m/s.
  double handle_speed_max = kInfinity;
  /// Cap on active sets of a solve, where smaller than in the options; 0 = none.
  std::uint32_t most_active_sets = 0;
  GantryTask gantry = {};   ///< Accelerations with which the law may lead the gantry
  std::uint64_t cycle = 0;  ///< Number of the cycle under which its problem is kept
};

/// What the law found in one cycle. Poses and velocities are those at the time of the sample.
struct LawResult {
  VectorM ddq_m;  ///< Accelerations of the manipulator joints
  VectorA ddq_a;  ///< Accelerations of the twin joints

  Pose T_B_H;                                     ///< Handle at the reference
  Pose T_B_E;                                     ///< End effector of the twin
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();  ///< Velocity of the handle at the reference, m/s
  Eigen::Vector3d a_H = Eigen::Vector3d::Zero();  ///< Acceleration of the end effector, m/s^2
  Eigen::Vector3d p_B_elbow = Eigen::Vector3d::Zero();  ///< Elbow; zero: the device names none
  double sync_error = 0.0;                              ///< Distance of H and E, m
  double sync_error_angle = 0.0;                        ///< Angle between H and E, rad

  VectorA tau_a;          ///< Torque of the user on the twin, J_a^T w
  Budget budget;          ///< Parts of the user's torque
  ContactReport contact;  ///< Contact of the end effector with virtual surfaces
  std::array<LimitReport, kMaxLimits> limits{};  ///< In the order of the catalogue
  int limit_count = 0;                           ///< Number of limits in the catalogue
  int felt_limit = -1;                           ///< Index of the limit felt most; -1 = none
  Vector6 w_felt = Vector6::Zero();  ///< Wrench of that limit on the handle (device rows only)

  SolverStatus solver_status = SolverStatus::kNotRun;
  int solver_iterations = 0;   ///< Active sets of all solves of this cycle
  int active_set_changes = 0;  ///< Limit rows whose state differs from that in the last cycle
};

}  // namespace hg::rendering
