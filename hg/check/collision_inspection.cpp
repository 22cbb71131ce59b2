#include "hg/check/collision_inspection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/unit_doubt.h"
#include "hg/model/chain_data.h"

namespace hg::check {
namespace {

// The posture where runs begin, with the gantry in its middle.
void inspect_posture(const config::DeviceConfig& device, Collector& out) {
  const DeviceModel& model = device.model;
  if (model.posture.size() != model.n_m || !model.posture.allFinite()) return;
  Eigen::VectorXd q(model.chain.nq());
  for (int i = 0; i < model.n_p; ++i) {
    q[i] = 0.5 * (model.gantry_range[i].lb + model.gantry_range[i].ub);
  }
  q.tail(model.n_m) = model.posture;
  if (!q.allFinite()) return;
  model::ChainData chain(model.chain);
  chain.update_poses(q);
  const std::vector<collision::Shape>& shapes = device.collision.shapes;
  for (const collision::Pair& pair : device.collision.pairs.watched) {
    const double distance = collision::Nearest(shapes, {pair}).distance(chain);
    if (distance > 0.0) continue;
    out.add(Severity::kWarning, "posture",
            fmt::format("{} and {} are {:.0f} mm inside each other there", shapes[pair.a].name,
                        shapes[pair.b].name, -1e3 * distance),
            "a run that begins there stops at once: give a posture in which no parts touch");
  }
}

}  // namespace

void inspect_collisions(const config::DeviceConfig& device, Collector& out) {
  const collision::CollisionConfig& config = device.collision;
  const std::string unknown =
      device.unknown_links.empty()
          ? std::string()
          : fmt::format("not monitored: {}", fmt::join(device.unknown_links, ", "));
  if (config.shapes.empty()) {
    if (unknown.empty()) return;  // switched off
    const bool has_meshes = std::ranges::any_of(device.sources, [](const auto& source) {
      return source.content.find("<mesh") != std::string::npos;
    });
    out.add(Severity::kWarning, "collision", unknown,
            has_meshes ? "the meshes of the URDF do not count here: 'hapticgiant new device' fits "
                         "capsules to them, to be copied from its file"
                       : "give the links <collision> elements that are spheres, cylinders or "
                         "boxes");
    return;
  }
  constexpr double kLargest = 10.0;  // m
  for (const collision::Shape& shape : config.shapes) {
    const double size = collision::reach(shape);
    if (shape.is_surrounding || size <= kLargest) continue;
    out.add(Severity::kWarning, "collision",
            fmt::format("shape {} reaches {:.3g} m; {}", shape.name, size,
                        suspected_unit(size, {0.0, kLargest}, kOtherLengths, "m")),
            "give lengths in metres, and meshes in millimetres a scale of 0.001");
  }
  inspect_posture(device, out);
  const auto count = [&](collision::Exclusion reason) {
    return std::ranges::count(config.pairs.excluded, reason, &collision::Excluded::reason);
  };
  const auto given = count(collision::Exclusion::kGiven);
  out.add(Severity::kNote, "collision",
          fmt::format("{} pairs of {} shapes are watched; left out: {} of neighbours, {} that "
                      "always touch, {} that never come within {:g} mm{}{}",
                      config.pairs.watched.size(), config.shapes.size(),
                      count(collision::Exclusion::kNeighbours),
                      count(collision::Exclusion::kAlways), count(collision::Exclusion::kNever),
                      1e3 * (config.safe_distance + collision::kFarEnough),
                      given == 0 ? "" : fmt::format(", {} named by collision.unwatched", given),
                      unknown.empty() ? "" : "; " + unknown),
          "");
}

void inspect_floor(const config::DeviceConfig& device, const workspace::Survey& survey,
                   Collector& out) {
  if (!device.has_floor) return;
  constexpr const char* kKey = "floor_z_m";
  double highest = -kInfinity;
  for (const workspace::Position& position : survey.cloud.positions) {
    highest = std::max(highest, position.p.z());
  }
  if (std::isfinite(highest) && highest <= device.floor_z) {
    out.add(Severity::kFault, kKey,
            fmt::format("{:g} m is above every place that the handle reaches, at most {:.2f} m",
                        device.floor_z, highest),
            "z points up from the root link: check the sign");
    return;
  }
  std::vector<std::string> inside;
  for (const collision::Excluded& pair : device.collision.pairs.excluded) {
    if (pair.reason != collision::Exclusion::kAlways) continue;
    const auto at = [&](int shape) -> const collision::Shape& {
      return device.collision.shapes[shape];
    };
    if (at(pair.a).is_surrounding) inside.push_back(at(pair.b).name);
    if (at(pair.b).is_surrounding) inside.push_back(at(pair.a).name);
  }
  if (inside.empty()) return;
  out.add(Severity::kWarning, kKey,
          fmt::format("{} in every posture in the floor at {:g} m: how deep is not monitored",
                      fmt::join(inside, ", "), device.floor_z),
          "lower the floor, or make the collision elements of these links smaller");
}

}  // namespace hg::check
