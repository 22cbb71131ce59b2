/// The torque loop of a device, and where it has to be stable.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/config/device.h"
#include "hg/controller/tracking/loop_stability.h"

namespace hg::config {

/// The torque loop of a device with elastic joints, as modelled by its controller.
tracking::Loop torque_loop(const DeviceConfig& device);

/// `count` postures (gantry at 0 first) all over the limits of the joints; a joint without limits
/// is sampled over one turn. Throws SetupError if hardly any is within the virtual limits.
std::vector<Eigen::VectorXd> random_postures(const DeviceModel& device, int count,
                                             std::uint32_t seed);

}  // namespace hg::config
