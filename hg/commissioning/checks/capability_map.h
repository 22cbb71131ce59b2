/// Two sections through the workspace, coloured by the force that the device bears in the worst
/// direction, as an SVG picture.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/core/interval.h"

namespace hg::checks {

/// A plane of B through the middle of the workspace, cut into square cells.
struct Section {
  int right = 0, up = 1;  ///< axes of B shown in the picture
  int normal = 2;
  double height = 0.0;    ///< height along the normal, m
  Interval x, y;          ///< range of the picture, m
  Interval box_x, box_y;  ///< Cartesian limit of the handle, m; infinite = none
  double cell = 0.1;      ///< edge of a cell, m
  int columns = 0, rows = 0;
  /// Median force per cell, N, row by row from below; NaN = not reached
  std::vector<double> force;
};

struct CapabilityMap {
  std::string title;
  std::vector<Section> sections;  ///< sections: horizontal, then vertical
  double force_max = 0.0;         ///< upper end of the force scale, N
};

CapabilityMap capability_map(const config::DeviceConfig& device);

std::string to_svg(const CapabilityMap& map);

}  // namespace hg::checks
