#include "hg/inspection/collision_inspection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace hg::inspection {

void inspect_collisions(const config::Device& device, Collector& out) {
  const collision::Config& config = device.collision;
  const std::string unknown =
      device.unknown_links.empty()
          ? std::string()
          : fmt::format("nobody watches {}", fmt::join(device.unknown_links, ", "));
  if (config.shapes.empty()) {
    if (unknown.empty()) return;  // switched off
    out.add(Severity::kWarning, "collision", unknown,
            "give the links <collision> elements that are spheres, cylinders or boxes: meshes do "
            "not count");
    return;
  }
  const auto count = [&](collision::Exclusion reason) {
    return std::ranges::count(config.pairs.excluded, reason, &collision::Excluded::reason);
  };
  out.add(Severity::kNote, "collision",
          fmt::format("{} pairs of {} shapes are watched; left out: {} of neighbours, {} that "
                      "always touch, {} that never come within {:g} mm{}",
                      config.pairs.watched.size(), config.shapes.size(),
                      count(collision::Exclusion::kNeighbours),
                      count(collision::Exclusion::kAlways), count(collision::Exclusion::kNever),
                      1e3 * (config.safe_distance + collision::kFarEnough),
                      unknown.empty() ? "" : "; " + unknown),
          "");
}

}  // namespace hg::inspection
