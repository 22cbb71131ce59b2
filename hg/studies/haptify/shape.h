/// Workspace volume and shape: postures within all limits, drawn at random.
#pragma once

#include <cstdint>
#include <string>

#include "hg/commissioning/checks/workspace.h"
#include "hg/config/device.h"
#include "hg/studies/haptify/figures.h"

namespace hg::haptify {

struct ShapeConfig {
  /// Number of postures of the arm, each with eight positions of the gantry
  int postures = 60'000;
};

/// Measures the workspace. Joint limits, the distance to the singularity (virtual joints), travel
/// of the gantry and walls (Cartesian limits of handle and elbow) all hold; the control loop does
/// not run.
checks::HandleWorkspace measure_shape(const config::DeviceConfig& device, const ShapeConfig& config,
                                      std::uint64_t seed);

/// The positions of the handle from above, from the front and from the side.
std::vector<View> workspace_views(const config::DeviceConfig& device, const ShapeConfig& config,
                                  std::uint64_t seed);

/// Sides of the handle's box that the handle misses by more than 2 mm, with the joints at a limit
/// where it comes nearest; empty = none.
std::string unreached_sides(const config::DeviceConfig& device,
                            const checks::HandleWorkspace& shape, const ShapeConfig& config,
                            std::uint64_t seed);

}  // namespace hg::haptify
