#include "hg/check/twin_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"
#include "hg/model/urdf.h"

namespace hg::check {
namespace {

// Extent of the link from its origin, estimated from its joints.
double extent(const model::Urdf& urdf, int link) {
  double longest = 0.0;
  for (const model::UrdfJoint& joint : urdf.joints) {
    if (joint.parent == link) longest = std::max(longest, joint.T_parent_joint.p.norm());
  }
  return longest;
}

void inspect_extent(const model::Urdf& urdf, int index, Collector& out) {
  constexpr double kLongest = 30.0;  // m
  const double length = extent(urdf, index);
  if (length <= kLongest) return;
  out.add_at_urdf(Severity::kWarning, "link", urdf.links[index].name,
                  fmt::format("a joint is {:.3g} m from its origin: millimetres?", length),
                  "give <origin xyz> in metres");
}

// Moving links of different lengths with one and the same mass and inertia: a tool has filled them
// in.
void inspect_alike(const model::Urdf& urdf, Collector& out) {
  constexpr int kFewest = 3;
  constexpr double kAlike = 1e-3;  // m
  const model::UrdfLink* first = nullptr;
  double mass = 0.0, shortest = kInfinity, longest = 0.0;
  int count = 0;
  for (const model::UrdfJoint& joint : urdf.joints) {
    const model::UrdfLink& link = urdf.links[joint.child];
    if (joint.type == model::UrdfJointType::kFixed || !link.inertial) continue;
    if (first == nullptr) first = &link;
    if (link.inertial->mass != first->inertial->mass ||
        !link.inertial->inertia.isApprox(first->inertial->inertia, 1e-9)) {
      return;
    }
    ++count;
    mass += link.inertial->mass;
    const double length = extent(urdf, joint.child);
    if (length == 0.0) continue;  // the last one, whose end no joint shows
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  if (count < kFewest || longest - shortest < kAlike) return;
  out.add_at_urdf(
      Severity::kWarning, "link", first->name,
      fmt::format("all {} moving links have its mass and inertia, {:.2g} kg in all, but "
                  "not its length: placeholders?",
                  count, mass),
      "give each link its own <inertial>: weight, forces and bandwidth follow from it");
}

void inspect_link(const model::Urdf& urdf, int index, Collector& out) {
  constexpr double kAtLeast = 1.0;                     // m; links end in tools that no joint shows
  constexpr double kSlackness = 2.0;                   // times the link's length
  constexpr double kThinnest = 1e-3, kThickest = 5.0;  // m, radius of gyration
  const model::UrdfLink& link = urdf.links[index];
  const bool moves = std::ranges::count(urdf.joints, index, &model::UrdfJoint::child) > 0;
  if (!link.inertial || !moves || !link.inertial_fault.empty()) return;
  const double length = std::max(kAtLeast, kSlackness * extent(urdf, index));
  const double distance = link.inertial->p_com.norm();
  if (distance > length) {
    out.add_at_urdf(Severity::kWarning, "link", link.name,
                    fmt::format("its centre of mass is {:.3g} m from its origin, expected at most "
                                "{:.3g} m",
                                distance, length),
                    "give <inertial><origin xyz> in metres, in the frame of the link");
  }
  const double radius = std::sqrt(link.inertial->inertia.trace() / (2.0 * link.inertial->mass));
  if (radius < kThinnest || radius > kThickest) {
    out.add_at_urdf(Severity::kWarning, "link", link.name,
                    fmt::format("its inertia is that of a body of about {:.2g} m, with {:g} kg",
                                radius, link.inertial->mass),
                    "give <inertia> in kg m^2 about the centre of mass, <mass> in kg");
  }
}

}  // namespace

void inspect_bodies(const std::vector<config::SourceText>& sources, Collector& out) {
  for (const model::Urdf& urdf : urdfs_among(sources)) {
    for (int i = 0; i < static_cast<int>(urdf.links.size()); ++i) {
      inspect_extent(urdf, i, out);
      inspect_link(urdf, i, out);
    }
    inspect_alike(urdf, out);
  }
}

}  // namespace hg::check
