/// The control cycle of a device and a twin, for any machine: real or simulated.
#pragma once

#include <vector>

#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/controller/cycle.h"
#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/signals/timed_load.h"

namespace hg::config {

/// The control cycle of `device` with `twin` in its hand, in contact with `surfaces`. Throws
/// SetupError where they do not fit together, or where the torque loop is not stable with the
/// expected latency. `solver_caps`: injected faults of the computer; a machine has none.
controller::Cycle make_cycle(const DeviceConfig& device, const Twin& twin,
                             std::vector<surfaces::Surface> surfaces = {},
                             std::vector<SolverCap> solver_caps = {});

}  // namespace hg::config
