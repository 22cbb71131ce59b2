/// A virtual surface: a solid of some shape at some place, and how it feels.
///
/// Set-up data in SI units; check() throws SetupError.
#pragma once

#include <optional>
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

/// What becomes of a handle that comes to a surface.
enum class Contact {
  kSpring,  ///< it is pushed out again
  kStop,    ///< it is braked before, and does not enter: a limit of the twin
};

struct Surface {
  std::string name;
  Shape shape;
  Pose pose;  ///< T_B_surface
  Contact contact = Contact::kSpring;
  double stiffness = 2000.0;  ///< N/m
  /// Ns/m. None: critical_damping(), and the surface catches what meets it,
  /// Environment::catch_it().
  std::optional<double> damping;
  double friction = 0.0;  ///< Coulomb coefficient, sticking as slipping
};

inline constexpr Interval kStiffness = {10.0, 5e4};
/// What is critical for a body of 500 kg on the stiffest spring.
inline constexpr Interval kDamping = {0.0, 1e4};
inline constexpr Interval kFriction = {0.0, 2.0};
inline constexpr Interval kSize = {1e-3, 100.0};  ///< m, of edges, radii and lengths

/// With which a body on a spring of `stiffness` (N/m) comes to rest without a swing, Ns/m; `mass`
/// (kg) in the directions in which it is lightest and heaviest. Less where that is more than
/// samples of `period` (s) allow for the lightest. 0 for a body that nothing can move.
double critical_damping(double stiffness, const Interval& mass, double period) noexcept;

/// Throws SetupError "surface NAME: rule, got value".
void check(const Surface& surface);

}  // namespace hg::environment
