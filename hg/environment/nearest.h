/// Where solids are nearest to a point: the planes in front of what must not enter them.
///
/// SI units, frame B. No allocation.
#pragma once

#include <array>

#include "hg/environment/surface.h"

namespace hg::environment {

inline constexpr int kMostFacing = 3;

/// A plane that a point must stay in front of.
struct Facing {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< out of the surface, unit
  double distance = kInfinity;                       ///< of the point along it, m; negative inside
  int surface = -1;                                  ///< -1: none
  bool is_edge = false;  ///< of a mesh: the nearest point is not inside of its triangle
  int solid = 0;         ///< of a mesh: Triangle::solid
};

/// The planes with the least to spare, and how much that is.
class FacingPlanes {
 public:
  /// Keeps the plane if it has less to spare than one of those that are kept. One that is nearly
  /// parallel to another takes its place or is left out.
  void add(const Facing& facing, double to_spare) noexcept;
  /// Whether the nearest point that belongs to an edge lies on or behind a plane of the same
  /// surface that is kept, which then is enough: the edge of a flat or outward bent neighbour.
  bool covers(const Facing& edge) const noexcept;
  const std::array<Facing, kMostFacing>& planes() const noexcept { return planes_; }

 private:
  std::array<Facing, kMostFacing> planes_;
  std::array<double, kMostFacing> to_spare_ = {kInfinity, kInfinity, kInfinity};
};

/// Calls `visit` with the plane, without its surface, of each part of `surface` in front of
/// `point`: of a convex solid the one at its nearest point, of a mesh those of all triangles within
/// `reach` that face it. What is deeper than kBehind behind a triangle is not in front of it.
template <class Visit>
void for_each_facing(const Surface& surface, const Eigen::Vector3d& point, double reach,
                     const Visit& visit) noexcept;

inline constexpr double kBehind = 5e-3;  ///< m

/// Out of a closed mesh: the surface nearest to the point `p` (frame of the mesh), if the point is
/// behind all that is as near. Nothing is farther away than `reach` (m). Distance infinite: there
/// is none.
Facing way_out(const Mesh& mesh, const Eigen::Vector3d& p, double reach) noexcept;

// Of shapes in their own frame; normal out of it and distance.
Facing facing(const Plane& plane, const Eigen::Vector3d& p) noexcept;
Facing facing(const Box& box, const Eigen::Vector3d& p) noexcept;
Facing facing(const Sphere& sphere, const Eigen::Vector3d& p) noexcept;
Facing facing(const Cylinder& cylinder, const Eigen::Vector3d& p) noexcept;
/// Distance infinite: it does not face the point.
Facing facing(const Triangle& triangle, const Eigen::Vector3d& p) noexcept;

template <class Visit>
void for_each_facing(const Surface& surface, const Eigen::Vector3d& point, double reach,
                     const Visit& visit) noexcept {
  const Eigen::Matrix3d& R = surface.pose.R;
  const Eigen::Vector3d p = R.transpose() * (point - surface.pose.p);
  const auto tell = [&](const Facing& found) {
    if (found.distance > reach) return;
    visit(Facing{R * found.normal, found.distance, -1, found.is_edge, found.solid});
  };
  std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<decltype(shape), const Mesh&>) {
          shape.for_each_near(p, p, reach,
                              [&](const Triangle& triangle) { tell(facing(triangle, p)); });
        } else {
          tell(facing(shape, p));
        }
      },
      surface.shape);
}

}  // namespace hg::environment
