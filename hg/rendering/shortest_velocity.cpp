#include "hg/rendering/shortest_velocity.h"

#include <Eigen/QR>

namespace hg::rendering {

VectorA shortest_velocity(const model::Jacobian& jacobian, const Vector6& twist) noexcept {
  return jacobian.completeOrthogonalDecomposition().solve(twist);
}

}  // namespace hg::rendering
