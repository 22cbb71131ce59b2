/// How hard the motors can brake the handle: what any wall in front of it can act with at most.
///
/// Set-up and evaluation; allocates. SI units, frame B.
#pragma once

#include "hg/rendering/device_model.h"

namespace hg::rendering {

/// How the device stands and moves, the gantry at constant speed.
struct Motion {
  VectorP q_p, dq_p;
  VectorM q_m, dq_m;
  Vector6 w_H = Vector6::Zero();  ///< of the hand on the handle, as in CycleRecord
};

/// Largest acceleration of the handle along the unit vector `direction`, across which and about
/// which it keeps its velocity, for which no motor has to give more than allowed_torque(): M ddq +
/// J ddq_m + h within its bounds, M of the links, J of the rotors, h of gravity, Coriolis and w_H.
/// 0 where they cannot even hold the handle. A device whose law does not know its motors: the
/// rating of the handle along that direction, infinity without one. m/s^2.
double largest_acceleration(const DeviceModel& device, const Motion& motion,
                            const Eigen::Vector3d& direction);

}  // namespace hg::rendering
