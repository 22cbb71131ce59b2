#include "hg/check/ignored_urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "hg/model/urdf.h"

namespace hg::check {
namespace {

// Friction of a device is a matter of its actuators and of its simulation.
void add_dynamics(model::Urdf& urdf) {
  model::UrdfIgnored dynamics = {.what = "<dynamics> damping and friction"};
  for (const model::UrdfJoint& joint : urdf.joints) {
    if (joint.damping == 0.0 && joint.friction == 0.0) continue;
    if (dynamics.count++ == 0) dynamics.line = joint.line;
  }
  if (dynamics.count > 0) urdf.ignored.push_back(dynamics);
}

// What is wrong with parts that are not used: with a used one the file would not be read.
void add_faults(model::Urdf& urdf) {
  const auto add = [&](const std::optional<InputFault>& fault, int line) {
    if (!fault) return;
    urdf.ignored.push_back({.what = text_without_place(*fault), .line = line, .count = 1});
  };
  for (const model::UrdfJoint& joint : urdf.joints) add(joint.fault, joint.line);
  for (const model::UrdfLink& link : urdf.links) {
    const bool is_point =
        link.inertial && std::isfinite(link.inertial->mass) && link.inertial->inertia.isZero(0.0);
    if (!is_point) add(link.inertial_fault, link.line);
  }
}

}  // namespace

void inspect_ignored(const std::vector<config::SourceText>& sources, UrdfUse use, Collector& out) {
  for (model::Urdf& urdf : urdfs_among(sources)) {
    if (use == UrdfUse::kDevice) add_dynamics(urdf);
    add_faults(urdf);
    if (urdf.ignored.empty()) continue;
    std::string list;
    int first_line = urdf.ignored.front().line;
    for (const model::UrdfIgnored& ignored : urdf.ignored) {
      list += list.empty() ? "" : ", ";
      list += ignored.what;
      if (ignored.count > 1) list += fmt::format(" ({} times)", ignored.count);
      first_line = std::min(first_line, ignored.line);
    }
    out.findings.push_back({.severity = Severity::kNote,
                            .file = urdf.source,
                            .place = {first_line, 1},
                            .item = "urdf",
                            .what = "not read: " + list,
                            .fix = ""});
  }
}

}  // namespace hg::check
