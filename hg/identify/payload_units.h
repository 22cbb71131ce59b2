/// Readings of a force/torque sensor that can only be in another unit: compared with gravity, with
/// what a person holds, and with the payload of device.yaml.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hg/identify/payload.h"
#include "hg/signals/payload.h"

namespace hg::identify {

/// What is wrong with the accelerations: at rest each is that of gravity, 9.81 m/s^2. Empty:
/// nothing.
std::string acceleration_fault(std::span<const StaticPose> poses);

/// Doubts about forces and torques, one line each. `expected` has no mass where device.yaml has no
/// payload.
std::vector<std::string> payload_doubts(const PayloadEstimate& found, const Payload& expected);

}  // namespace hg::identify
