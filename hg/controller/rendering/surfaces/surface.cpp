#include "hg/controller/rendering/surfaces/surface.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "hg/core/arm_mass.h"
#include "hg/core/error.h"

namespace hg::surfaces {
namespace {

void require(const Surface& surface, const char* what, const Interval& range, double value) {
  if (range.contains(value)) return;
  std::ostringstream text;
  text << "surface " << surface.name << ": " << what << " must be " << range.lb << " .. "
       << range.ub << ", got " << value;
  throw SetupError(text.str());
}

}  // namespace

double critical_damping(double stiffness, const Interval& mass, double period) noexcept {
  if (!std::isfinite(mass.lb)) return 0.0;
  return std::min(2.0 * std::sqrt(stiffness * (mass.ub + kArmMass)), mass.lb / period);
}

void check_surface(const Surface& surface) {
  require(surface, "stiffness", kStiffness, surface.stiffness);
  if (surface.damping) require(surface, "damping", kDamping, *surface.damping);
  require(surface, "friction", kFriction, surface.friction);
  if (const auto* box = std::get_if<Box>(&surface.shape)) {
    for (const double edge : box->size) require(surface, "edge", kSize, edge);
  } else if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) {
    require(surface, "radius", kSize, sphere->radius);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&surface.shape)) {
    require(surface, "radius", kSize, cylinder->radius);
    require(surface, "length", kSize, cylinder->length);
  } else if (const auto* mesh = std::get_if<Mesh>(&surface.shape)) {
    if (mesh->triangles().empty()) {
      throw SetupError("surface " + surface.name + ": a mesh needs triangles, got none");
    }
    if (surface.contact == Contact::kStop && !mesh->is_closed()) {
      throw SetupError("surface " + surface.name +
                       ": a mesh that is a stop must be closed: each edge that of two triangles, "
                       "which run along it in opposite directions");
    }
    require(surface, "size (scale: 0.001 for millimetres)", kSize,
            mesh->extent().sizes().maxCoeff());
  }
  const bool is_pose = surface.pose.p.allFinite() && surface.pose.R.isUnitary(1e-9);
  if (!is_pose) throw SetupError("surface " + surface.name + ": its pose must be one");
}

}  // namespace hg::surfaces
