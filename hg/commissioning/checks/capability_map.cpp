#include "hg/commissioning/checks/capability_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hg/commissioning/checks/survey.h"
#include "hg/commissioning/checks/workspace.h"
#include "hg/core/index.h"

namespace hg::checks {
namespace {

constexpr int kPostures = 60'000;
constexpr double kCells = 40.0;  // along the longer side of the workspace

struct Cut {
  Section section;
  double thickness = 0.0;                   // m: points this near count
  std::vector<std::vector<double>> values;  // per cell
};

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// 1, 2 or 5 times a power of ten
double round_number(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power) return step * power;
  }
  return 10.0 * power;
}

Cut make_cut(const Eigen::AlignedBox3d& bounds, const Eigen::AlignedBox3d& box, int right, int up) {
  Cut cut;
  Section& section = cut.section;
  section.right = right;
  section.up = up;
  section.normal = 3 - right - up;
  section.height = bounds.center()[section.normal];
  section.cell = std::max(1e-3, bounds.sizes().maxCoeff() / kCells);
  section.columns = static_cast<int>(std::ceil(bounds.sizes()[right] / section.cell - 1e-9));
  section.rows = static_cast<int>(std::ceil(bounds.sizes()[up] / section.cell - 1e-9));
  section.x = {bounds.min()[right], bounds.min()[right] + section.columns * section.cell};
  section.y = {bounds.min()[up], bounds.min()[up] + section.rows * section.cell};
  section.box_x = {box.min()[right], box.max()[right]};
  section.box_y = {box.min()[up], box.max()[up]};
  cut.thickness = section.cell;
  cut.values.resize(index(section.columns * section.rows));
  return cut;
}

void add(const Position& position, Cut& cut) {
  const Section& section = cut.section;
  if (std::abs(position.p[section.normal] - section.height) > cut.thickness) return;
  const int column =
      std::clamp(static_cast<int>((position.p[section.right] - section.x.lb) / section.cell), 0,
                 section.columns - 1);
  const int row =
      std::clamp(static_cast<int>((position.p[section.up] - section.y.lb) / section.cell), 0,
                 section.rows - 1);
  cut.values[index(row * section.columns + column)].push_back(position.force);
}

}  // namespace

CapabilityMap capability_map(const config::DeviceConfig& device) {
  CapabilityMap map;
  map.title = device.name + ": force that the handle bears in the worst direction";
  Random random(1);
  const Cloud points = cloud(device, kPostures, false, random);
  if (points.positions.empty()) return map;
  Eigen::AlignedBox3d bounds;
  for (const Position& position : points.positions) bounds.extend(position.p);

  const Eigen::AlignedBox3d box = handle_box(device.model);
  std::vector<double> all;
  for (Cut cut : {make_cut(bounds, box, 0, 1), make_cut(bounds, box, 0, 2)}) {
    for (const Position& position : points.positions) add(position, cut);
    for (const std::vector<double>& values : cut.values) {
      cut.section.force.push_back(median(values));
      if (std::isfinite(cut.section.force.back())) all.push_back(cut.section.force.back());
    }
    map.sections.push_back(cut.section);
  }
  std::ranges::sort(all);
  const auto high = static_cast<std::size_t>(0.98 * static_cast<double>(all.size()));
  if (!all.empty() && all[high] > 0.0) map.force_max = round_number(all[high]);
  return map;
}

}  // namespace hg::checks
