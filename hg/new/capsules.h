/// Capsules around points and triangles. Deterministic; set-up only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

namespace hg::new_files {

/// All points within `radius` of the segment between `from` and `to`, m.
struct Capsule {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Distance of `p` from the surface of the capsule, m; negative inside.
double distance_to(const Capsule& capsule, const Eigen::Vector3d& p);

double volume_of(const Capsule& capsule);

/// A small capsule that contains all triangles: its axis is searched from the principal axes of the
/// points. Rounded to 0.1 mm, outwards.
Capsule fit_capsule(const std::vector<Triangle>& triangles);

/// Parts the triangles by the plane across a principal axis that leaves the smallest capsules. The
/// second part is empty where none of the planes parts them.
std::pair<std::vector<Triangle>, std::vector<Triangle>> split(
    const std::vector<Triangle>& triangles);

/// The triangles, cut until no edge is longer than `longest` (m).
std::vector<Triangle> cut(const std::vector<Triangle>& triangles, double longest);

}  // namespace hg::new_files
