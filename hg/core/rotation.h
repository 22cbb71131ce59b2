/// Rotations as vectors: axis times angle.
#pragma once

#include <Eigen/Geometry>

namespace hg {

/// Rotation vector (rad) that turns orientation R_B_1 into R_B_2, resolved in B; angle in [0, pi].
inline Eigen::Vector3d rotation_between(const Eigen::Matrix3d& R_B_1,
                                        const Eigen::Matrix3d& R_B_2) noexcept {
  const Eigen::AngleAxisd turn(R_B_2 * R_B_1.transpose());
  return turn.angle() * turn.axis();
}

}  // namespace hg
