/// Figures of the benchmark as SVG: panels of lines on logarithmic axes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/times.h"

namespace hg::bench {

struct Series {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< x > 0, y > 0
};

struct Panel {
  std::string title;
  std::vector<Series>
      series;  ///< at most 6 series; the index gives colour and marker, empty ones are not shown
};

/// Figure whose panels share their axes, for comparison.
struct Figure {
  std::string title, x_label, y_label;
  std::vector<Panel> panels;
  bool has_markers = false;  ///< markers at every point, one shape per series, for few points
};

/// Outline of the histogram of the times; bins without any are at half a count.
Series outline(const std::string& label, const Times& times);

/// The figure as SVG. Empty panels are left out; an empty figure has its title only.
std::string to_svg(const Figure& figure);

}  // namespace hg::bench
