#include <utility>

#include "hg/config/describe_surfaces.h"

namespace hg::config {

std::vector<environment::Surface> surfaces_of(const std::vector<SurfaceDraft>& drafts,
                                              SourceReader& reader) {
  std::vector<environment::Surface> surfaces;
  for (const SurfaceDraft& draft : drafts) {
    environment::Surface& surface = surfaces.emplace_back(draft.surface);
    surface.pose = pose_of(draft.placement);
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
        surface.shape = environment::read_stl(reader.read(draft.mesh), draft.mesh.generic_string(),
                                              draft.scale);
        break;
    }
  }
  return surfaces;
}

}  // namespace hg::config
