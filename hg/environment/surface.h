/// A virtual surface: a solid of some shape at some place, and how it feels.
///
/// Set-up data in SI units; check() throws SetupError.
#pragma once

#include <string>
#include <variant>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/environment/mesh.h"

namespace hg::environment {

/// All points with z <= 0.
struct Plane {};
/// Its centre in the origin.
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m, edges along x, y, z; each > 0
};
/// Its centre in the origin.
struct Sphere {
  double radius = 0.0;  ///< m, > 0
};
/// Its axis along z, its centre in the origin.
struct Cylinder {
  double radius = 0.0;  ///< m, > 0
  double length = 0.0;  ///< m, > 0
};

using Shape = std::variant<Plane, Box, Sphere, Cylinder, Mesh>;

struct Surface {
  std::string name;
  Shape shape;
  Pose pose;                  ///< T_B_surface
  double stiffness = 2000.0;  ///< N/m
  double damping = 20.0;      ///< Ns/m, in full from 5 mm inside on
  double friction = 0.0;      ///< Coulomb coefficient, sticking as slipping
};

inline constexpr Interval kStiffness = {10.0, 1e5};
inline constexpr Interval kDamping = {0.0, 1e3};
inline constexpr Interval kFriction = {0.0, 2.0};
inline constexpr Interval kSize = {1e-4, 100.0};  ///< m, of edges, radii and lengths

/// Throws SetupError "surface NAME: rule, got value".
void check(const Surface& surface);

}  // namespace hg::environment
