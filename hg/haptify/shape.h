/// Workspace volume and shape: postures within all limits, drawn at random.
#pragma once

#include <cstdint>
#include <string>

#include "hg/config/device.h"
#include "hg/inspection/workspace.h"

namespace hg::haptify {

struct ShapeConfig {
  int postures = 60'000;  ///< of the arm, each with eight positions of the gantry
};

/// Joint limits, the distance to the singularity (virtual joints), travel of the gantry and walls
/// (Cartesian limits of handle and elbow) all hold; the control loop does not run.
inspection::Workspace measure_shape(const config::Device& device, const ShapeConfig& config,
                                    std::uint64_t seed);

/// The sides of the handle's box that it does not reach by more than 2 mm, and the joints that
/// stand at a limit where it comes nearest; empty when there is none.
std::string unreached_sides(const config::Device& device, const inspection::Workspace& shape,
                            const ShapeConfig& config, std::uint64_t seed);

}  // namespace hg::haptify
