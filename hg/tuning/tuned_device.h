/// From a device file to what tuning needs of it.
#pragma once

#include "hg/config/device.h"
#include "hg/tuning/handle_loop.h"

namespace hg::tuning {

/// The loop of a device with elastic joints, with the delay of the wrench that its simulation has.
/// Throws SetupError for a device that cannot be tuned: one whose drives follow positions, with
/// fewer than six joints, without an accelerometer, or whose sensors have no noise.
Device device_of(const config::Device& device);

/// What the simulation adds to what is measured.
Noise noise_of(const config::Device& device);

/// Friction that nobody expects: that share of what the device file says, Nm.
Eigen::VectorXd unexpected_friction(const config::Device& device);

/// As the simulation has it, which differs from what the controller believes.
control::Reality simulated(const config::Device& device);

}  // namespace hg::tuning
