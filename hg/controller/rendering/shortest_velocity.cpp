#include "hg/controller/rendering/shortest_velocity.h"

#include <Eigen/QR>
#include <utility>

namespace hg::rendering {

// Like solve() of the decomposition, which allocates where the rank is less than n_a.
VectorA shortest_velocity(const model::Jacobian& jacobian, const Vector6& twist) noexcept {
  const Eigen::CompleteOrthogonalDecomposition<model::Jacobian> decomposition(jacobian);
  const Eigen::Index rank = decomposition.rank(), rest = jacobian.cols() - rank;
  VectorA velocity = VectorA::Zero(jacobian.cols());
  if (rank == 0) return velocity;
  Vector6 c = twist;
  c.applyOnTheLeft(decomposition.matrixQ().setLength(rank).adjoint());
  const auto T = decomposition.matrixT().topLeftCorner(rank, rank);
  velocity.head(rank) = T.triangularView<Eigen::Upper>().solve(c.head(rank));
  for (Eigen::Index k = 0; rest > 0 && k < rank; ++k) {
    double temp = 0.0;
    std::swap(velocity[k], velocity[rank - 1]);
    velocity.segment(rank - 1, rest + 1)
        .applyHouseholderOnTheLeft(decomposition.matrixQTZ().row(k).tail(rest).adjoint(),
                                   decomposition.zCoeffs()(k), &temp);
    std::swap(velocity[k], velocity[rank - 1]);
  }
  return decomposition.colsPermutation() * velocity;
}

}  // namespace hg::rendering
