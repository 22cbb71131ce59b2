/// Postures for a pose, for any chain of scalar joints: damped Gauss-Newton steps from several
/// starts. For set-up, not for the loop: it allocates and may take milliseconds.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "hg/core/types.h"
#include "hg/model/chain.h"

namespace hg::model {

/// What is looked for: `frame` of the chain at `T_B_frame`, all coordinates within their ranges.
struct InverseProblem {
  int frame = -1;
  Pose T_B_frame;
  Eigen::VectorXd q_min, q_max;  ///< (nv), infinite = no limit
  Eigen::VectorXd goal;          ///< (nv), wanted as far as the pose permits; NaN = no wish
  /// Further conditions, for example on sums of joints; empty = none. They choose among the
  /// solutions found and do not lead to one.
  std::function<bool(const Eigen::VectorXd& q)> permits = {};
};

struct InverseResult {
  bool is_solved = false;     ///< both errors below 1e-9
  bool is_permitted = false;  ///< solved, and the problem permits q
  /// Of the permitted solutions, otherwise of all solutions, the one nearest to the goals; without
  /// a solution the posture that comes nearest to the pose.
  Eigen::VectorXd q;
  double position_error = 0.0;  ///< m
  double angle_error = 0.0;     ///< rad
};

/// Deterministic: the starts are the goals, the middle of the ranges and a fixed sequence.
InverseResult inverse_kinematics(const Chain& chain, const InverseProblem& problem);

}  // namespace hg::model
