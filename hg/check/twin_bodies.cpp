#include "hg/check/twin_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

void inspect_link(const model::Urdf& urdf, int index, Collector& out) {
  constexpr double kAtLeast = 1.0;                     // m; links end in tools that no joint shows
  constexpr double kSlackness = 2.0;                   // times the link's length
  constexpr double kThinnest = 1e-3, kThickest = 5.0;  // m, radius of gyration
  const model::UrdfLink& link = urdf.links[index];
  if (!link.inertial) return;
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
    for (int i = 0; i < static_cast<int>(urdf.links.size()); ++i) inspect_link(urdf, i, out);
  }
}

}  // namespace hg::check
