/// Inspects the file of a machine on a bus beside the device that it moves.
#pragma once

#include <string>

#include "hg/check/findings.h"
#include "hg/config/device.h"

namespace hg::check {

/// What the drives of the machine in `file` give, beside the ratings of the device's joints. Throws
/// SetupError where the machine is not one of this device.
Findings inspect_machine(const std::string& file, const config::DeviceConfig& device);

}  // namespace hg::check
