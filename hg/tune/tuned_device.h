/// Inputs of tuning from a device file.
#pragma once

#include "hg/config/simulation/simulation.h"
#include "hg/handle_loop/loop_device.h"

namespace hg::tune {

using handle_loop::LoopDevice;
using handle_loop::Noise;
using handle_loop::simulated;

/// The loop of a device with elastic joints, with the delay of the wrench that its simulation has.
/// Throws SetupError for a device that cannot be tuned: one whose drives follow positions, with
/// fewer than six joints, without an accelerometer, or whose sensors have no noise.
LoopDevice device_of(const config::SimulatedDeviceConfig& device);

/// Sensor noise of the simulation.
Noise noise_of(const config::SimulatedDeviceConfig& device);

/// Unmodelled friction: assumed share of the friction in the device file, Nm.
Eigen::VectorXd unexpected_friction(const config::SimulatedDeviceConfig& device);

}  // namespace hg::tune
