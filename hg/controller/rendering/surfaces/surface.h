/// A virtual surface: shape and pose of a solid, and its haptic properties.
///
/// Set-up data in SI units; check_surface() throws SetupError.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "hg/controller/rendering/surfaces/mesh.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg::surfaces {

/// Half-space: all points with z <= 0.
struct Plane {};
/// Box with its centre in the origin.
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m, edges along x, y, z; each > 0
};
/// Sphere with its centre in the origin.
struct Sphere {
  double radius = 0.0;  ///< m, > 0
};
/// Cylinder with its axis along z and its centre in the origin.
struct Cylinder {
  double radius = 0.0;  ///< m, > 0
  double length = 0.0;  ///< m, > 0
};

using Shape = std::variant<Plane, Box, Sphere, Cylinder, Mesh>;

/// Reaction of a surface to the handle.
enum class Contact {
  kSpring,  ///< spring force pushes the handle out
  kStop,    ///< the handle is braked before it and does not enter: a limit of the twin
};

struct Surface {
  std::string name;
  Shape shape;
  Pose pose;  ///< T_B_surface
  Contact contact = Contact::kSpring;
  double stiffness = 2000.0;  ///< N/m
  /// Ns/m. Empty: critical_damping(), and impacts are absorbed by Environment::catch_it().
  std::optional<double> damping;
  double friction = 0.0;  ///< Coulomb coefficient, same for sticking and slipping
};

inline constexpr Interval kStiffness = {10.0, 5e4};
/// Damping range, up to critical for a body of 500 kg on the stiffest spring, Ns/m.
inline constexpr Interval kDamping = {0.0, 1e4};
inline constexpr Interval kFriction = {0.0, 2.0};
inline constexpr Interval kSize = {1e-3, 100.0};  ///< m, for edges, radii and lengths

/// Damping with which a body on a spring of `stiffness` (N/m) comes to rest without overshoot,
/// Ns/m; `mass` (kg) in the directions in which it is lightest and heaviest. Limited to the maximum
/// that samples of `period` (s) allow for the lightest. 0 for an immovable body.
double critical_damping(double stiffness, const Interval& mass, double period) noexcept;

/// Throws SetupError "surface NAME: rule, got value".
void check_surface(const Surface& surface);

}  // namespace hg::surfaces
