/// The planes that a proxy lies on: at most three, all through the proxy.
///
/// Where the proxy wants to go is the point nearest to the handle on the free side of all of them
/// (Zilles, Salisbury 1995); friction holds it back within the cone (Ruspini et al. 1997): the
/// tangential part of the spring is at most the coefficient times the normal part. SI units. No
/// allocation.
#pragma once

#include <array>

#include "hg/environment/surface.h"

namespace hg::environment {

/// What the planes make of the way between proxy and handle.
struct Spread {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< out of the surfaces, unit; zero = free
  double depth = 0.0;                                 ///< of the handle along it, m
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();  ///< from there to the proxy, m
  int surface = -1;                                   ///< that has the largest share
  // mean of the surfaces by their shares in `normal`
  double stiffness = 0.0, damping = 0.0, friction = 0.0;
  bool catches = false;  ///< the surface with the largest share says no damping
};

class Planes {
 public:
  /// A plane of surface `index`, which `surface` describes, with `damping` (Ns/m); false when there
  /// are three already. One that is nearly parallel to another takes its place.
  bool add(const Eigen::Vector3d& normal, const Surface& surface, double damping,
           int index) noexcept;
  bool empty() const noexcept { return count_ == 0; }

  Spread spread(const Eigen::Vector3d& handle, const Eigen::Vector3d& proxy) const noexcept;

  /// How far the proxy goes now: until friction holds it.
  Eigen::Vector3d step(const Eigen::Vector3d& handle, const Eigen::Vector3d& proxy) const noexcept;

 private:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    const Surface* surface = nullptr;
    double damping = 0.0;  ///< Ns/m
    int index = -1;
  };
  Eigen::Vector3d shares(const Eigen::Vector3d& to_handle) const noexcept;

  std::array<Plane, 3> planes_;
  int count_ = 0;
};

}  // namespace hg::environment
