/// Contact planes of a proxy: at most three, all through the proxy.
///
/// The target of the proxy is the point nearest to the handle on the free side of all planes
/// (Zilles, Salisbury 1995); friction holds it back within the cone (Ruspini et al. 1997): the
/// tangential part of the spring is at most the coefficient times the normal part. SI units. No
/// allocation.
#pragma once

#include <array>

#include "hg/controller/rendering/surfaces/surface.h"

namespace hg::surfaces {

/// Decomposition of the offset between proxy and handle by the planes.
struct Spread {
  /// Outward normal of the surfaces, unit; zero = free
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double depth = 0.0;  ///< depth of the handle along it, m
  /// Tangential offset from there to the proxy, m
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();
  int surface = -1;  ///< surface with the largest share
  // mean of the surfaces by their shares in `normal`
  double stiffness = 0.0, damping = 0.0, friction = 0.0;
  bool catches = false;  ///< the surface with the largest share has no damping of its own
};

class Planes {
 public:
  /// Adds a plane of surface `index`, described by `surface`, with `damping` (Ns/m); false when
  /// there are three already. It replaces one to which it is nearly parallel.
  bool add(const Eigen::Vector3d& normal, const Surface& surface, double damping,
           int index) noexcept;
  bool empty() const noexcept { return count_ == 0; }

  Spread spread(const Eigen::Vector3d& handle, const Eigen::Vector3d& proxy) const noexcept;

  /// Next position of the proxy, limited by friction.
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

}  // namespace hg::surfaces
