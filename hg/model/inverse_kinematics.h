/// Numerical inverse kinematics for any chain of scalar joints: damped Gauss-Newton steps from
/// several starts. For set-up, not for the loop: allocates and may take milliseconds.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::model {

/// Problem to solve: `frame` of the chain at `T_B_frame`, coordinates within their ranges.
struct InverseProblem {
  int frame = -1;
  Pose T_B_frame;
  Eigen::VectorXd q_min, q_max;  ///< Position ranges (nv); infinite = no limit
  Eigen::VectorXd goal;          ///< Preferred positions (nv), second to the pose; NaN = none
  /// Further conditions, for example on sums of joints; empty = none. Used to select among the
  /// solutions found, not in the search.
  std::function<bool(const Eigen::VectorXd& q)> permits = {};
};

/// Result of the inverse kinematics.
struct InverseResult {
  bool is_solved = false;     ///< Both errors below 1e-9
  bool is_permitted = false;  ///< Solved, and `permits` accepts q
  /// Solution nearest to the goals, among permitted ones if there are any; without a solution the
  /// posture nearest to the pose.
  Eigen::VectorXd q;
  double position_error = 0.0;  ///< Position error, m
  double angle_error = 0.0;     ///< Angle error, rad
};

/// Solves the problem. Deterministic: starts are the goals, the middle of the ranges and a fixed
/// sequence.
InverseResult inverse_kinematics(const ChainModel& chain, const InverseProblem& problem);

}  // namespace hg::model
