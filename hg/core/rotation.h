/// Rotations as vectors: axis times angle.
#pragma once

#include <Eigen/Core>

namespace hg {

/// Rotation vector (rad) that turns orientation R_B_1 into R_B_2, resolved in B; angle in [0, pi].
Eigen::Vector3d rotation_between(const Eigen::Matrix3d& R_B_1,
                                 const Eigen::Matrix3d& R_B_2) noexcept;

/// Angle of the rotation between two frames, rad, 0..pi.
double angle_between(const Eigen::Matrix3d& R_B_1, const Eigen::Matrix3d& R_B_2) noexcept;

}  // namespace hg
