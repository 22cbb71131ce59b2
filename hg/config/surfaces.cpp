#include "hg/config/describe_surfaces.h"

#include <cmath>

namespace hg::config {

surfaces::Surface surface_of(const SurfaceDraft& draft, SourceReader& reader) {
  surfaces::Surface surface = draft.surface;
  surface.pose = pose_of(draft.placement);
  if (!std::isnan(draft.damping)) surface.damping = draft.damping;
  switch (draft.shape) {
    case SurfaceShape::kPlane:
      break;
    case SurfaceShape::kBox:
      surface.shape = surfaces::Box{draft.size};
      break;
    case SurfaceShape::kSphere:
      surface.shape = surfaces::Sphere{draft.radius};
      break;
    case SurfaceShape::kCylinder:
      surface.shape = surfaces::Cylinder{draft.radius, draft.length};
      break;
    case SurfaceShape::kMesh:
      surface.shape =
          surfaces::read_stl(reader.read(draft.mesh), draft.mesh.generic_string(), draft.scale);
      break;
  }
  return surface;
}

}  // namespace hg::config
