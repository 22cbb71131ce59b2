/// The device as the rendering sees it: chain, frames, and the limits that are part of the law.
///
/// Set-up data: filled by config, checked once, constant afterwards. SI units.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_model.h"
#include "hg/signals/actuator_model.h"

namespace hg::rendering {

/// A weighted sum of manipulator joints with limits of its own, for example q4 + q5, whose ends are
/// singular; [HG] sec. VI-C3.
struct VirtualJoint {
  std::string name;
  VectorM weights;  ///< Weight of each manipulator joint
  limits::JointLimits limits;
};

/// A frame whose origin stays inside a box of B; [HG] sec. VI-C4.
struct CartesianLimit {
  std::string name;
  int frame = -1;                           ///< Index of the frame in the chain
  std::array<limits::JointLimits, 3> axes;  ///< Limits along x, y, z of B, m; infinite = no row
  double margin = 5e-3;  ///< Margin by which the rendered box is smaller on every side, m
};

struct DeviceModel {
  model::ChainModel chain;  ///< Gantry joints first, then the manipulator
  int n_p = 0;              ///< Number of gantry joints
  int n_m = 0;              ///< Number of manipulator joints
  int handle = -1;          ///< Index of frame H
  int elbow = -1;           ///< Index of the frame shown as the elbow; -1 = none
  std::vector<limits::JointLimits> joint_limits;  ///< Limits of the manipulator joints
  /// Motors, one per manipulator joint: their torques are limits of the law. Empty: the law does
  /// not know them, and no limit is accelerated beyond its rating.
  std::vector<ActuatorModel> motors;
  std::vector<VirtualJoint> virtual_joints;
  std::vector<CartesianLimit> cartesian_limits;  ///< Cartesian limits, highest priority first
  /// Goals of the manipulator joints (n_m; empty: none), NaN = no goal. The gantry moves so that
  /// they are reached; a manipulator with more joints than the task needs moves there autonomously.
  VectorM posture;

  /// Number of catalogue entries that belong to the device.
  int limit_count() const {
    return n_m +
           static_cast<int>(virtual_joints.size() + motors.size() + 3 * cartesian_limits.size());
  }
  const std::string& manipulator_joint(int i) const {
    return chain.joints()[static_cast<std::size_t>(n_p + i)].name;
  }
};

/// All Cartesian limits of the handle combined, along x, y, z of B; infinite where there are none.
std::array<limits::JointLimits, 3> handle_limits(const DeviceModel& device);

}  // namespace hg::rendering
