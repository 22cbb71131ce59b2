/// Largest acceleration with which the motors can brake the handle: upper bound for any wall in
/// front of it.
///
/// Set-up and evaluation; allocates. SI units, frame B.
#pragma once

#include "hg/model/device_model.h"

namespace hg::rendering {

/// State of the device, the gantry at constant speed.
struct DeviceMotion {
  VectorP q_p, dq_p;
  VectorM q_m, dq_m;
  Vector6 w_H = Vector6::Zero();  ///< Wrench of the hand on the handle, as in CycleRecord
};

/// Largest acceleration of the handle along the unit vector `direction`, m/s^2, with unchanged
/// velocity across and about it and every motor within allowed_torque(): M ddq + J ddq_m + h within
/// its bounds, M of the links, J of the rotors, h of gravity, Coriolis and w_H. 0 where the motors
/// cannot even hold the handle. Where the law does not model the motors: rating of the handle along
/// that direction, infinity without one; it is the most also for drives that follow positions.
double largest_acceleration(const DeviceModel& device, const DeviceMotion& motion,
                            const Eigen::Vector3d& direction);

}  // namespace hg::rendering
