/// The shapes of a device that are watched: those of its URDF and the capsules of device.yaml.
#pragma once

#include "hg/config/device_schema.h"
#include "hg/config/loader.h"

namespace hg::config {

/// Fills the collision model of the device, whose chain is known. `text`: its URDF.
void watch_collisions(const UrdfText& text, DeviceDraft& draft);

}  // namespace hg::config
