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

/// Where on its way a joint of the twin is held with the least force.
struct WayForce {
  std::string twin_joint;
  double along = kInfinity;  ///< Force along the way of the joint, to its worse side, N
  double at = 0.0;           ///< Position of the joint there, m or rad
  std::string motor;         ///< Motor that gives way first there
  double any = kInfinity;    ///< Force in the worst direction at the worst place, N
  std::string motor_of_any;  ///< Motor that gives way first to it
};

/// One entry for each joint of the twin that moved the handle on the way. A joint that jams, is
/// locked or meets its stop is pushed along its way; a hand that pushes against its bearings pushes
/// in any direction. An arm with a motion in itself makes room for its motors with it. Empty for a
/// device whose law does not model the motors.
std::vector<WayForce> way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                                 const workspace::Way& way);

/// Adds a line for each joint: a warning where it is held with less than the 50 N of [HG] III-B.
void inspect_way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                        const workspace::Way& way, Collector& out);

}  // namespace hg::check
