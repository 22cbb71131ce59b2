/// Two sections through the workspace, coloured by the force that the device bears in the worst
/// direction, as an SVG picture.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/core/interval.h"

namespace hg::inspection {

/// A plane of B through the middle of the workspace, cut into square cells.
struct Section {
  int right = 0, up = 1;  ///< axes of B that the picture shows
  int normal = 2;
  double height = 0.0;    ///< m, along the normal
  Interval x, y;          ///< m, what the picture shows
  Interval box_x, box_y;  ///< m, Cartesian limit of the handle; infinite = none
  double cell = 0.1;      ///< m
  int columns = 0, rows = 0;
  std::vector<double> force;  ///< N, median per cell, row by row from below; NaN = not reached
};

struct CapabilityMap {
  std::string title;
  std::vector<Section> sections;  ///< horizontal, then vertical
  double force_max = 0.0;         ///< N, upper end of the scale
};

CapabilityMap capability_map(const config::Device& device);

std::string to_svg(const CapabilityMap& map);

}  // namespace hg::inspection
