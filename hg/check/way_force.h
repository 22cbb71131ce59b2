/// Force of a hand up to which the motors of a device hold a twin that jams, at rest.
///
/// Deterministic. Set-up code: it allocates. SI units.
#pragma once

#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/core/types.h"
#include "hg/workspace/way.h"

namespace hg::check {

/// The least force of all places on a way, and the motor that gives way first there.
struct LeastForce {
  double force = kInfinity;  ///< N; infinite = none was found
  std::string motor;
};

/// A push along the way of one joint of the twin, to its worse side: where it jams, is locked or
/// meets its stop.
struct JointForce : LeastForce {
  int dof = 0;      ///< Index in TwinModel::dofs
  double at = 0.0;  ///< Position of the joint there, m or rad
};

struct WayForces {
  std::vector<JointForce> joints;  ///< Of those that were led and move the handle
  LeastForce any;                  ///< In the worst direction, as against the joints' bearings
};

/// Forces held over the places of `way`. An arm with a motion in itself makes room for its motors
/// with it. Without forces for a device whose law does not model the motors.
WayForces way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                     const workspace::Way& way);

/// Adds a line for each joint and one for all directions: a warning where it is less than the 50 N
/// of [HG] III-B.
void inspect_way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                        const workspace::Way& way, Collector& out);

}  // namespace hg::check
