/// The cross product as a matrix.
#pragma once

#include <Eigen/Core>

namespace hg {

/// Skew-symmetric matrix [v]x (3 x 3): cross_matrix(v) * w = v x w.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace hg
