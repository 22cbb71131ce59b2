#include "hg/config/describe_surfaces.h"

#include <cmath>

namespace hg::config {

environment::Surface surface_of(const SurfaceDraft& draft, SourceReader& reader) {
  environment::Surface surface = draft.surface;
  surface.pose = pose_of(draft.placement);
  if (!std::isnan(draft.damping)) surface.damping = draft.damping;
  switch (draft.shape) {
    case SurfaceShape::kPlane:
      break;
    case SurfaceShape::kBox:
      surface.shape = environment::Box{draft.size};
      break;
    case SurfaceShape::kSphere:
      surface.shape = environment::Sphere{draft.radius};
      break;
    case SurfaceShape::kCylinder:
      surface.shape = environment::Cylinder{draft.radius, draft.length};
      break;
    case SurfaceShape::kMesh:
      surface.shape =
          environment::read_stl(reader.read(draft.mesh), draft.mesh.generic_string(), draft.scale);
      break;
  }
  return surface;
}

}  // namespace hg::config
