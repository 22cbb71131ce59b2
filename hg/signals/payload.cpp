#include "hg/signals/payload.h"

#include <Eigen/Geometry>

namespace hg {

Vector6 payload_wrench(const Payload& payload, const Eigen::Vector3d& a_S,
                       const Eigen::Vector3d& omega_S, const Eigen::Vector3d& alpha_S) noexcept {
  const Eigen::Vector3d a_com =
      a_S + alpha_S.cross(payload.com) + omega_S.cross(omega_S.cross(payload.com));
  const Eigen::Vector3d f = -payload.mass * a_com;
  const Eigen::Vector3d spin = payload.inertia * omega_S;  // angular momentum about the COM
  const Eigen::Vector3d n = payload.com.cross(f) - payload.inertia * alpha_S - omega_S.cross(spin);
  return (Vector6() << f, n).finished();
}

}  // namespace hg
