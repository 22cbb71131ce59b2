#include "hg/check/twin_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hg/core/interval.h"
#include "hg/core/unit_doubt.h"
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
  const double length = extent(urdf, index);
  if (doubt_of_length(length).empty()) return;
  out.add_at_urdf(Severity::kWarning, "link", urdf.links[index].name,
                  "a joint is far from its origin: " + doubt_of_length(length),
                  "give <origin xyz> in metres");
}

// Whether two links have one inertia, with one mass or as no real body has it: alike about all
// axes.
bool are_alike(const model::UrdfLink& a, const model::UrdfLink& b) {
  const Eigen::Matrix3d& I = a.inertial->inertia;
  return I.isApprox(b.inertial->inertia, 1e-9) &&
         (a.inertial->mass == b.inertial->mass ||
          I.isApprox(I(0, 0) * Eigen::Matrix3d::Identity(), 1e-9));
}

// Most of the moving links, of different lengths, with one and the same inertia: a tool has filled
// them in.
void inspect_alike(const model::Urdf& urdf, const std::vector<std::string>& joints,
                   Collector& out) {
  constexpr int kFewest = 3;
  constexpr double kAlike = 1e-3;  // m
  std::vector<int> moving;
  for (const model::UrdfJoint& joint : urdf.joints) {
    const bool counts = joints.empty() || std::ranges::count(joints, joint.name) > 0;
    if (joint.type == model::UrdfJointType::kFixed || !counts) continue;
    if (!urdf.links[joint.child].inertial) continue;
    moving.push_back(joint.child);
  }
  for (const int first : moving) {
    std::vector<int> alike;
    std::ranges::copy_if(moving, std::back_inserter(alike), [&](int other) {
      return are_alike(urdf.links[first], urdf.links[other]);
    });
    if (std::ssize(alike) < kFewest || 2 * alike.size() <= moving.size()) continue;
    double mass = 0.0, shortest = kInfinity, longest = 0.0;
    for (const int link : alike) {
      mass += urdf.links[link].inertial->mass;
      const double length = extent(urdf, link);
      if (length == 0.0) continue;  // the last one, whose end no joint shows
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    if (longest - shortest < kAlike) return;
    const bool is_all = alike.size() == moving.size();
    out.add_at_urdf(
        Severity::kWarning, "link", urdf.links[first].name,
        fmt::format("{} {} moving links have its inertia, {:.2g} kg in all, but not its length: "
                    "placeholders?",
                    is_all ? "all" : fmt::format("{} of", alike.size()), moving.size(), mass),
        "give each link its own <inertial>: weight, forces and bandwidth follow from it");
    return;
  }
}

// Least mean distance of the mass from its centre, m: that of a ball of tungsten.
double densest(double mass) {
  constexpr double kDensity = 2e4;  // kg/m^3
  return std::sqrt(0.6) * std::cbrt(0.75 * mass / (M_PI * kDensity));
}

void inspect_inertia(const model::UrdfLink& link, double length, Collector& out) {
  constexpr double kThinnest = 1e-3, kThickest = 5.0;  // m, radius of gyration
  constexpr double kHeavy = 50.0;                      // kg, for one link of an arm
  constexpr double kLight = 0.01;                      // kg; less is a frame
  constexpr double kSmaller = 20.0;  // grams make a body 30 to 150 times too small
  const double mass = link.inertial->mass, sum = link.inertial->inertia.trace();
  const double radius = std::sqrt(sum / (2.0 * mass));
  const auto warn = [&](const std::string& what, const std::string& suspected) {
    out.add_at_urdf(Severity::kWarning, "link", link.name, what + after_semicolon(suspected),
                    "give <inertia> in kg m^2 about the centre of mass, <mass> in kg");
  };
  if (mass > kHeavy && kSmaller * radius < densest(mass)) {
    warn(fmt::format("{:.4g} kg with this inertia are denser than any metal", mass),
         suspected_unit(mass, {0.0, kHeavy}, kOtherMasses, "kg"));
  } else if (radius < kThinnest || radius > kThickest) {
    warn(fmt::format("its inertia is that of a body of about {:.2g} m, with {:g} kg", radius, mass),
         mass < kLight
             ? ""
             : suspected_unit(sum / 3.0, moments_of(mass, length), kOtherInertias, "kg m^2"));
  }
}

void inspect_shapes(const model::UrdfLink& link, Collector& out) {
  for (const model::UrdfCollision& collision : link.collisions) {
    const double size = std::max(collision.size.maxCoeff(), collision.T_link_shape.p.norm());
    const std::string doubt = doubt_of_length(size);
    if (doubt.empty()) continue;
    out.add_at_urdf(Severity::kWarning, "link", link.name, "<collision>: " + doubt,
                    "give sizes and <origin xyz> in metres");
  }
}

void inspect_link(const model::Urdf& urdf, int index, Collector& out) {
  constexpr double kAtLeast = 1.0;    // m; links end in tools that no joint shows
  constexpr double kSlackness = 2.0;  // times the link's length
  const model::UrdfLink& link = urdf.links[index];
  const bool moves = std::ranges::count(urdf.joints, index, &model::UrdfJoint::child) > 0;
  if (moves) inspect_shapes(link, out);
  if (!link.inertial || !moves || link.inertial_fault) return;
  double size = extent(urdf, index);
  if (!doubt_of_length(size).empty()) size *= kOtherLengths[0].size;
  const double length = std::max(kAtLeast, kSlackness * size);
  const double distance = link.inertial->p_com.norm();
  const std::string millimetres = suspected_unit(distance, {0.0, length}, kOtherLengths, "m");
  if (distance > length) {
    out.add_at_urdf(Severity::kWarning, "link", link.name,
                    fmt::format("its centre of mass is {:.3g} m from its origin, expected at most "
                                "{:.3g} m{}",
                                distance, length, after_semicolon(millimetres)),
                    "give <inertial><origin xyz> in metres, in the frame of the link");
  }
  inspect_inertia(link, length, out);
}

}  // namespace

Interval moments_of(double mass, double reach) {
  const double share = 2.0 / 3.0 * mass, least = densest(mass);
  return {share * least * least, share * reach * reach};
}

void inspect_bodies(const std::vector<config::SourceText>& sources,
                    const std::vector<std::string>& joints, Collector& out) {
  for (const model::Urdf& urdf : urdfs_among(sources)) {
    for (int i = 0; i < static_cast<int>(urdf.links.size()); ++i) {
      inspect_extent(urdf, i, out);
      inspect_link(urdf, i, out);
    }
    inspect_alike(urdf, joints, out);
  }
}

}  // namespace hg::check
