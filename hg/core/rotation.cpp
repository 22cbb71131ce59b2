#include "hg/core/rotation.h"

#include <Eigen/Geometry>

namespace hg {

Eigen::Vector3d rotation_between(const Eigen::Matrix3d& R_B_1,
                                 const Eigen::Matrix3d& R_B_2) noexcept {
  const Eigen::AngleAxisd turn(R_B_2 * R_B_1.transpose());
  return turn.angle() * turn.axis();
}

double angle_between(const Eigen::Matrix3d& R_B_1, const Eigen::Matrix3d& R_B_2) noexcept {
  return Eigen::AngleAxisd(R_B_1.transpose() * R_B_2).angle();
}

}  // namespace hg
