/// First versions of configuration files, made from a URDF: what can be read or worked out from it
/// is written down, with a comment that says where it is from; the rest are marked assumptions.
///
/// Set-up only: allocates, and throws SetupError when the URDF cannot be a device or a twin.
#pragma once

#include <filesystem>
#include <string>

#include "hg/commissioning/generator/chain_part.h"
#include "hg/config/device.h"

namespace hg::generator {

/// Text of a device.yaml that will stand in `folder`. Leading prismatic joints become the gantry;
/// six or seven joints after them are the manipulator.
std::string device_yaml(const ChainPart& part, const std::filesystem::path& folder);

/// Text of a twin.yaml that will stand in `folder`, placed upright where `device` reaches most of
/// what the twin's joints can do.
std::string twin_yaml(const ChainPart& part, const std::filesystem::path& folder,
                      const config::DeviceConfig& device);

}  // namespace hg::generator
