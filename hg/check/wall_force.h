/// Force of a hand up to which the motors of a device hold each wall of the handle's box, at rest.
///
/// Deterministic. Set-up code: it allocates. SI units, frame B.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/model/chain_data.h"

namespace hg::check {

/// Largest force that the motors hold, and the motor that gives way beyond it.
struct HeldForce {
  double force = kInfinity;  ///< N; 0 where they do not even hold the device
  int motor = -1;            ///< Index in the manipulator; -1 = none, the force is infinite
};

/// Largest force of a hand on the handle along the unit vector `direction` that every motor holds
/// beside the weight of the device, within allowed_torque() at rest. `chain`: after update() at
/// rest. For a device whose law models the motors.
HeldForce held_force(const DeviceModel& device, const model::ChainData& chain,
                     const Eigen::Vector3d& direction);

/// The same in the direction in which it is least.
HeldForce held_force(const DeviceModel& device, const model::ChainData& chain);

/// One wall of the box, over places of the handle spread evenly over it.
struct WallForce {
  int limit = 0;  ///< Index of the Cartesian limit that has this wall
  int axis = 0;   ///< Normal of the wall, 0..2 for x, y, z
  bool is_upper = false;
  double tilt = 0.0;  ///< Angle of the handle from its orientation in the device's own posture, rad
  int places = 0;     ///< Number of places that the handle reaches
  double least = kInfinity;   ///< Force held at the worst of them, N; infinite = none reached
  double median = kInfinity;  ///< Median of the held forces, N
  std::string motor;          ///< Motor that gives way first at the worst place
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Worst place, m
  Eigen::VectorXd q;                                ///< Posture there, gantry first

  std::string name() const { return {"xyz"[axis], is_upper ? '+' : '-'}; }  ///< As "x+"
};

/// All walls of the handle's box, where the rendered box has them. The handle keeps the orientation
/// of the device's own posture and is tilted only for a wall that it does not reach so; a
/// HapticGiant also turns about the vertical. An arm with a motion in itself makes room for its
/// motors with it, as under the law. Empty for a device whose law does not model the motors.
std::vector<WallForce> wall_forces(const config::DeviceConfig& device);

/// Adds a line for each wall: a warning where it holds less than the 50 N of [HG] III-B.
void inspect_wall_forces(const config::DeviceConfig& device, Collector& out);

}  // namespace hg::check
