/// A surface of triangles, and the search for those that a short path crosses.
///
/// Each triangle pushes to the side from which its corners run counter-clockwise, as in STL. A mesh
/// need not be closed; a closed one has an inside.
/// The search walks a tree of boxes: a query takes at most as many steps as the tree has nodes, two
/// for a triangle. No allocation after construction.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace hg::surfaces {

inline constexpr int kMaxTriangles = 20'000;

struct Triangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;  ///< normal, unit
  int solid = 0;  ///< number of the solid: triangles connected by corners have the same one
};

/// Whether the projection of `point` lies in the triangle, or beside it by at most `beside` (m).
inline bool is_over(const Triangle& triangle, const Eigen::Vector3d& point,
                    double beside) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& corner = triangle.corners[i];
    const Eigen::Vector3d edge = triangle.corners[(i + 1) % 3] - corner;
    if (edge.cross(point - corner).dot(triangle.normal) < -beside * edge.norm()) return false;
  }
  return true;
}

class Mesh {
 public:
  Mesh() = default;  ///< no triangles
  /// Mesh from three points per triangle, m. Triangles without an area are left out. Throws
  /// SetupError when none is left or more than kMaxTriangles are.
  explicit Mesh(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles);

  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  /// Bounding box of a mesh that has triangles.
  const Eigen::AlignedBox3d& extent() const noexcept { return nodes_.front().box; }
  /// Whether the mesh is closed: each edge is used equally often in both directions.
  bool is_closed() const noexcept { return is_closed_; }
  bool is_one_solid() const noexcept { return is_one_solid_; }
  /// Whether a closed mesh has `point` inside. Tests all triangles.
  bool encloses(const Eigen::Vector3d& point) const noexcept;

  /// Calls `visit` for triangles whose box, enlarged by `margin` (m), the path from `a` to `b`
  /// touches; no other triangle is nearer to it.
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double margin,
                     const Visit& visit) const noexcept;

 private:
  /// Tree node; its subtree are the nodes up to `next`; only a leaf has a triangle.
  struct Node {
    Eigen::AlignedBox3d box;
    int next = 0;
    int triangle = -1;
  };
  void build(std::vector<int>& order, std::size_t begin, std::size_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;  ///< in depth-first order, parent first
  bool is_closed_ = false, is_one_solid_ = true;
};

/// Reads the triangles of an STL file, binary or text, times `scale` (m per unit of the file).
/// Throws SetupError "SOURCE: rule, got value".
Mesh read_stl(std::string_view content, std::string_view source, double scale);

template <class Visit>
void Mesh::for_each_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double margin,
                         const Visit& visit) const noexcept {
  // a box is missed when the path intervals between its pairs of faces have no common part; a
  // division by zero gives infinities, which stand for always or never
  const Eigen::Array3d inverse = (b - a).array().inverse();
  const auto is_missed = [&](const Eigen::AlignedBox3d& box) {
    const Eigen::Array3d to_min = (box.min() - a).array() - margin;
    const Eigen::Array3d to_max = (box.max() - a).array() + margin;
    double first = 0.0, last = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = to_min[axis] * inverse[axis], y = to_max[axis] * inverse[axis];
      first = std::max(first, std::min(x, y));
      last = std::min(last, std::max(x, y));
    }
    return first > last;
  };
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    if (is_missed(node.box)) {
      i = node.next;
      continue;
    }
    if (node.triangle >= 0) visit(triangles_[node.triangle]);
    ++i;
  }
}

}  // namespace hg::surfaces
