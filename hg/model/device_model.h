/// The controller's model of the device: chain, frames, period, limits, drives, sensor.
///
/// Set-up data: filled by config, checked once, constant afterwards. Every part of the controller
/// is built from it, so that no other struct repeats a fact that stands here. SI units.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_model.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"

namespace hg {

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
  double rate_Hz = 1000.0;  ///< Cycles per second, Hz
  Pose T_H_S;               ///< Pose of the force/torque sensor S in the handle frame H
  /// Start posture and gantry target have a closed form: a HapticGiant.
  bool has_closed_form = false;
  DriveModel drive;                               ///< Drive of every gantry axis
  std::vector<Interval> gantry_range;             ///< Ranges of the gantry axes, m or rad
  std::vector<limits::JointLimits> joint_limits;  ///< Limits of the manipulator joints
  /// Actuators, one per manipulator joint; empty: not known.
  std::vector<ActuatorModel> actuators;
  bool follows_positions = false;  ///< The drives follow positions; otherwise they take torques
  /// Whether the law models the torques of the motors: they are limits, and where the drives take
  /// torques, an acceleration rating is no limit of its own.
  bool has_torque_limits = false;
  std::vector<VirtualJoint> virtual_joints;
  std::vector<CartesianLimit> cartesian_limits;  ///< Cartesian limits, highest priority first
  bool keeps_apart = false;  ///< Whether a row of the law keeps the device's shapes apart
  /// Goals of the manipulator joints (n_m; empty: none), NaN = no goal. The gantry moves so that
  /// they are reached; a manipulator with more joints than the task needs moves there on its own.
  VectorM posture;

  /// Period of the control cycle, s.
  double dt() const noexcept { return 1.0 / rate_Hz; }
  /// Motors whose torques are limits of the law, one per manipulator joint; empty: not known to it.
  std::span<const ActuatorModel> motors() const noexcept {
    return has_torque_limits ? std::span(actuators) : std::span<const ActuatorModel>();
  }
  /// Whether the law keeps accelerations within their ratings also far from a limit.
  bool has_rated_accelerations() const noexcept { return motors().empty() || follows_positions; }
  /// Number of catalogue entries that belong to the device.
  int limit_count() const noexcept {
    return n_m +
           static_cast<int>(virtual_joints.size() + motors().size() + 3 * cartesian_limits.size()) +
           (keeps_apart ? 1 : 0);
  }
  /// Catalogue entry of the first axis of the first Cartesian limit; the others follow.
  int first_cartesian() const noexcept {
    return limit_count() - (keeps_apart ? 1 : 0) - 3 * static_cast<int>(cartesian_limits.size());
  }
  const std::string& manipulator_joint(int i) const { return chain.joints()[n_p + i].name; }
  /// Whether a manipulator joint is prismatic.
  bool is_slide(int joint) const noexcept { return chain.joints()[n_p + joint].is_slide(); }
  /// Whether the gantry's axes are prismatic; true without any.
  bool is_gantry_slide() const noexcept { return n_p == 0 || chain.joints()[0].is_slide(); }
};

/// Throws SetupError where a list has not one entry per joint or axis, where the rate is not
/// 100..20000 Hz, or where a dead time spans too many periods.
void check_device_model(const DeviceModel& device);

/// All Cartesian limits of the handle combined, along x, y, z of B; infinite where there are none.
std::array<limits::JointLimits, 3> handle_limits(const DeviceModel& device);

}  // namespace hg
