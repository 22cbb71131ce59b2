/// Nearest points of solids to a point, as planes that the point must not pass.
///
/// SI units, frame B. No allocation.
#pragma once

#include <array>

#include "hg/controller/rendering/surfaces/surface.h"

namespace hg::surfaces {

inline constexpr int kMostFacing = 3;

/// Plane that bounds the free space of a point.
struct Facing {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward normal of the surface, unit
  double distance = kInfinity;  ///< distance of the point along it, m; negative inside
  int surface = -1;             ///< surface index; -1: none
  bool is_edge = false;  ///< mesh only: the nearest point is not in the interior of its triangle
  int solid = 0;         ///< mesh only: Triangle::solid
};

/// The planes with the smallest margins.
class FacingPlanes {
 public:
  /// Keeps the plane if its margin `to_spare` is smaller than one of those kept. Of two nearly
  /// parallel planes only one is kept.
  void add(const Facing& facing, double to_spare) noexcept;
  /// Whether the nearest point of an edge lies on or behind a kept plane of the same surface, which
  /// then suffices: the edge belongs to a flat or convex neighbour.
  bool covers(const Facing& edge) const noexcept;
  const std::array<Facing, kMostFacing>& planes() const noexcept { return planes_; }

 private:
  std::array<Facing, kMostFacing> planes_;
  std::array<double, kMostFacing> to_spare_ = {kInfinity, kInfinity, kInfinity};
};

/// Calls `visit` with the plane, without its surface, of each part of `surface` in front of
/// `point`: for a convex solid the one at its nearest point, for a mesh those of all triangles
/// within `reach` that face it. A point deeper than kBehind behind a triangle does not face it.
template <class Visit>
void for_each_facing(const Surface& surface, const Eigen::Vector3d& point, double reach,
                     const Visit& visit) noexcept;

/// Depth behind a triangle up to which it is considered, m
inline constexpr double kBehind = 5e-3;

/// Plane leading out of a closed mesh: the surface nearest to the point `p` (frame of the mesh), if
/// the point is behind all surfaces that are as near. Searches up to `reach` (m). Distance
/// infinite: none.
Facing way_out(const Mesh& mesh, const Eigen::Vector3d& p, double reach) noexcept;

// Nearest planes of shapes in their own frame: outward normal and distance.
Facing facing(const Plane& plane, const Eigen::Vector3d& p) noexcept;
Facing facing(const Box& box, const Eigen::Vector3d& p) noexcept;
Facing facing(const Sphere& sphere, const Eigen::Vector3d& p) noexcept;
Facing facing(const Cylinder& cylinder, const Eigen::Vector3d& p) noexcept;
/// The same for a triangle; distance infinite: it does not face the point.
Facing facing(const Triangle& triangle, const Eigen::Vector3d& p) noexcept;

template <class Visit>
void for_each_facing(const Surface& surface, const Eigen::Vector3d& point, double reach,
                     const Visit& visit) noexcept {
  const Eigen::Matrix3d& R = surface.pose.R;
  const Eigen::Vector3d p = R.transpose() * (point - surface.pose.p);
  const auto visit_near = [&](const Facing& found) {
    if (found.distance > reach) return;
    visit(Facing{R * found.normal, found.distance, -1, found.is_edge, found.solid});
  };
  std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<decltype(shape), const Mesh&>) {
          shape.for_each_near(p, p, reach,
                              [&](const Triangle& triangle) { visit_near(facing(triangle, p)); });
        } else {
          visit_near(facing(shape, p));
        }
      },
      surface.shape);
}

}  // namespace hg::surfaces
