/// Workspace volume and shape: postures within all limits, drawn at random.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/device.h"
#include "hg/workspace/workspace.h"

namespace hg::haptify {

struct ShapeConfig {
  /// Number of postures of the arm, each with eight positions of the gantry
  int postures = 60'000;
};

/// Measures the workspace. Joint limits, the distance to the singularity (virtual joints), travel
/// of the gantry and walls (Cartesian limits of handle and elbow) all hold; the control loop does
/// not run.
workspace::HandleWorkspace measure_shape(const config::DeviceConfig& device,
                                         const ShapeConfig& config, std::uint64_t seed);

/// A cloud of points seen along one axis: the number of points in each cell of a plane.
struct View {
  int across = 0, up = 1;              ///< axes 0..2 of B that are drawn
  double left = 0.0, bottom = 0.0;     ///< corner of the first cell, m
  double cell = 0.0;                   ///< edge of a cell, m
  std::vector<std::vector<int>> rows;  ///< number of points, from the bottom up
  std::vector<double> box;             ///< limits of the handle: left, right, bottom, top, m
};

/// The positions of the handle from above, from the front and from the side.
std::vector<View> workspace_views(const config::DeviceConfig& device, const ShapeConfig& config,
                                  std::uint64_t seed);

/// A side of the handle's box that the handle does not reach.
struct UnreachedSide {
  int axis = 0;           ///< axis 0..2 of B that is normal to the side
  double limit = 0.0;     ///< position of the side on this axis, m
  double short_by = 0.0;  ///< distance by which the handle misses it, m
  double volume = 0.0;    ///< volume of the box beyond the handle, m^3
  /// Joints and virtual joints that stand at a limit where the handle comes nearest, with that
  /// limit, rad
  std::vector<std::pair<std::string, double>> at_limit;
};

/// Sides of the handle's box that the handle misses by more than 2 mm.
std::vector<UnreachedSide> unreached_sides(const config::DeviceConfig& device,
                                           const workspace::HandleWorkspace& shape,
                                           const ShapeConfig& config, std::uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(View, across, up, left, bottom, cell, rows, box)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UnreachedSide, axis, limit, short_by, volume, at_limit)

}  // namespace hg::haptify
