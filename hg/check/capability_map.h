/// Positions of the handle with the force that the device bears there in the worst direction.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hg/config/device.h"

namespace hg::check {

/// Title, box of the handle, and 60,000 positions within all limits as x, y, z in m, force in N;
/// null = no limit. python/hapticgiant/report/capability.py draws sections through them.
nlohmann::ordered_json capability_map(const config::DeviceConfig& device);

}  // namespace hg::check
