/// Description of the virtual surfaces in a scenario.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/sources.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/core/index.h"

namespace hg::config {

enum class SurfaceShape { kPlane, kBox, kSphere, kCylinder, kMesh };

inline constexpr auto kContacts = choices_of<surfaces::Contact>();

inline constexpr auto kSurfaceShapes = choices_of<SurfaceShape>();

/// Content of an item of `surfaces`, before it becomes a Surface.
struct SurfaceDraft {
  surfaces::Surface surface;  ///< surface without its shape, place and damping
  SurfaceShape shape = SurfaceShape::kPlane;
  Eigen::Vector3d size = Eigen::Vector3d::Constant(kNoDefault);
  double radius = 0.0, length = 0.0, scale = 1.0;
  double damping = kNoDefault;
  std::filesystem::path mesh;
  Placement placement;
};

constexpr Range range_of(const Interval& interval) {
  return {.lb = interval.lb, .ub = interval.ub};
}

template <class V>
void describe_shape(V& v, SurfaceDraft& d) {
  const Range length = range_of(surfaces::kSize);
  v.choice("shape", d.shape, kSurfaceShapes,
           "a plane is hard where z < 0 in its own frame; the others are solids");
  if (v.covers(d.shape == SurfaceShape::kBox)) {
    v.vector("size_m", d.size, length, "edges of a box along its x, y, z");
    v.rule(v.is_given("size_m"), "", "a box needs 'size_m'");
  }
  if (v.covers(d.shape == SurfaceShape::kSphere || d.shape == SurfaceShape::kCylinder)) {
    v.number("radius_m", d.radius, length, "of a sphere or cylinder", Need::kRequired);
  }
  if (v.covers(d.shape == SurfaceShape::kCylinder)) {
    v.number("length_m", d.length, length, "of a cylinder, along its z", Need::kRequired);
  }
  if (v.covers(d.shape == SurfaceShape::kMesh)) {
    v.path("mesh", d.mesh, "STL file of a mesh, binary or text", Need::kRequired);
    v.number("scale", d.scale, {.lb = 1e-9, .ub = 1e3},
             "of a mesh, m per unit of the file; 0.001 for mm");
  }
}

template <class V>
void describe(V& v, std::vector<SurfaceDraft>& surfaces) {
  SurfaceDraft& d = surfaces.emplace_back();
  v.words("name", d.surface.name, "for the page and for messages", Need::kRequired);
  const auto same = [&](const SurfaceDraft& other) { return other.surface.name == d.surface.name; };
  v.rule(std::count_if(surfaces.begin(), surfaces.end(), same) == 1, "name",
         "surfaces must not use a name twice");
  describe_shape(v, d);
  v.group(
      "placement", [&](auto& child) { describe(child, d.placement); },
      "of the surface in B; without it, its frame is B");
  v.choice("contact", d.surface.contact, kContacts,
           "spring: pushes out what enters; stop: brakes the twin before it, like its own limits");
  const bool is_stop = d.surface.contact == surfaces::Contact::kStop;
  for (const char* key : {"stiffness_N_per_m", "damping_Ns_per_m", "friction"}) {
    v.rule(!is_stop || !v.is_given(key), key, "a surface that is a stop has no such key");
  }
  v.number("stiffness_N_per_m", d.surface.stiffness, range_of(surfaces::kStiffness),
           "of the spring between handle and surface");
  v.number("damping_Ns_per_m", d.damping, range_of(surfaces::kDamping),
           "against the motion of the handle inside; without it critical for the twin, and the "
           "surface catches what meets it, docs/concepts/environment.md");
  v.number("friction", d.surface.friction, range_of(surfaces::kFriction),
           "coefficient of Coulomb friction");
}

template <class V>
void describe_surfaces(V& v, std::vector<SurfaceDraft>& surfaces) {
  v.list(
      "surfaces", [&](auto& child) { describe(child, surfaces); },
      "virtual surfaces that push the twin, docs/concepts/environment.md");
  v.rule(surfaces.size() <= surfaces::kMaxSurfaces, "surfaces", "at most 64 surfaces");
}

/// The surface of a draft; reads the file of a mesh. Throws SetupError.
surfaces::Surface surface_of(const SurfaceDraft& draft, SourceReader& reader);

}  // namespace hg::config
