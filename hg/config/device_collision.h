/// Collision shapes of a device, from its URDF.
#pragma once

#include "hg/config/describe_device.h"
#include "hg/config/device.h"
#include "hg/config/read_chain.h"

namespace hg::config {

/// Writes shapes and pairs into `device.collision`; the rest of `device` must be complete.
void watch_collisions(const UrdfText& urdf, const model::ChainOptions& options,
                      const DeviceDraft& draft, Device& device);

/// Sets the reaction time from the period `dt`, s: how soon joints and gantry begin to brake.
void set_reaction(Device& device, double dt);

}  // namespace hg::config
