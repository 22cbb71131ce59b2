#include "hg/controller/rendering/shortest_velocity.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <string>

#include "hg/core/allocation_counter.h"

namespace hg::rendering {
namespace {

TEST(ShortestVelocity, IsThatOfEigenWithoutAnAllocation) {
  for (const int n_a : {1, 2, 6, 7, 20, 30}) {
    for (const int rank : {0, 1, 5, 6}) {
      SCOPED_TRACE(std::to_string(n_a) + " joints, rank " + std::to_string(rank));
      model::Jacobian jacobian = model::Jacobian::Random(6, n_a);
      jacobian.bottomRows(6 - rank).setZero();
      const Vector6 twist = Vector6::Random();
      VectorA velocity;
      {
        const AllocationCounter allocations;
        velocity = shortest_velocity(jacobian, twist);
        EXPECT_EQ(allocations.count(), 0u);
      }
      const VectorA expected = jacobian.completeOrthogonalDecomposition().solve(twist);
      EXPECT_EQ(velocity, expected);
    }
  }
}

}  // namespace
}  // namespace hg::rendering
