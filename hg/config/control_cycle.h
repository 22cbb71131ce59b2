/// The control cycle of a device and a twin, for any machine: real or simulated.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/controller/cycle.h"
#include "hg/controller/tracking/loop_stability.h"

namespace hg::config {

/// The control cycle of `device` with `twin` in its hand, in contact with `surfaces`. Throws
/// SetupError where they do not fit together, or where the torque loop is not stable with the
/// expected latency. `solver_caps`: injected faults of the computer; a machine has none.
controller::Cycle make_cycle(const DeviceConfig& device, const Twin& twin,
                             std::vector<surfaces::Surface> surfaces = {},
                             std::vector<SolverCap> solver_caps = {});

/// The torque loop of a device with elastic joints, as modelled by its controller.
tracking::Loop torque_loop(const DeviceConfig& device);

/// `count` postures (gantry at 0 first) all over the limits of the joints; a joint without limits
/// is sampled over one turn. Throws SetupError if hardly any is within the virtual limits.
std::vector<Eigen::VectorXd> random_postures(const DeviceModel& device, int count,
                                             std::uint32_t seed);

}  // namespace hg::config
