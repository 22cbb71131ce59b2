#include "hg/controller/rendering/bearing_wrench.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "hg/core/allocation_counter.h"
#include "hg/core/linear_algebra.h"

namespace hg::rendering {
namespace {

TEST(BearingWrench, IsWhatLeastSquaresLeaveForAnyRank) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const int n_a : {1, 2, 6, 7, 30}) {
    for (const int rank : {0, 1, 2, 5, 6}) {
      SCOPED_TRACE(std::to_string(n_a) + " joints, rank " + std::to_string(rank));
      const auto of = [&](int rows, int cols) -> Eigen::MatrixXd {
        return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(random); });
      };
      const model::Jacobian J = of(6, rank) * of(rank, n_a);
      const Vector6 w = of(6, 1);
      Vector6 part;
      {
        const AllocationCounter allocations;
        part = bearing_wrench(J, w);
        EXPECT_EQ(allocations.count(), 0u);
      }
      const Vector6 expected = w - J * LeastSquares(J, 1e-10).solve(w);
      EXPECT_LT((part - expected).norm(), 1e-9);
      EXPECT_LT((J.transpose() * part).norm(), 1e-9);
    }
  }
}

TEST(BearingWrench, OfAJointThatMovesNothingIsAllOfIt) {
  const Vector6 w = Vector6::Ones();
  EXPECT_EQ(bearing_wrench(model::Jacobian::Zero(6, 2), w), w);
}

}  // namespace
}  // namespace hg::rendering
