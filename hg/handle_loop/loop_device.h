/// A device as the loop around its handle needs it.
#pragma once

#include "hg/config/simulation/simulation.h"
#include "hg/handle_loop/handle_loop.h"

namespace hg::handle_loop {

/// Loop and sensor of a device whose torques we control (control.method: modal), with the delay of
/// the wrench that its simulation has.
LoopDevice device_of(const config::SimulatedDeviceConfig& device);

/// Reality of the simulation, which differs from the controller's model.
tracking::TruePlant simulated(const config::SimulatedDeviceConfig& device);

}  // namespace hg::handle_loop
