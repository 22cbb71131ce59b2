#include "hg/identify/block_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/interval.h"
#include "hg/simulator/random_stream.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kBlocks = 40, kRows = 50;

// y = 2 x_0 - 3 x_1 + an error that stays the same in `alike` rows; column 2 is without use.
BlockRegression regression(std::uint64_t seed, int alike) {
  simulator::RandomStream random(seed, simulator::RandomEffect::kTorqueNoise, 0);
  BlockRegression result(3);
  double error = 0.0;
  for (int block = 0; block < kBlocks; ++block) {
    result.begin_block();
    for (int row = 0; row < kRows; ++row) {
      if (row % alike == 0) error = 0.1 * random.gaussian();
      MatrixXd A(1, 3);
      A << 1e3 * random.gaussian(), 1.0, 0.0;
      const double y = 2.0 * A(0, 0) - 3.0 * A(0, 1) + error;
      result.add(A, VectorXd::Constant(1, y));
    }
  }
  return result;
}

TEST(BlockRegression, FindsParametersOfAnySizeAndTheirDeviations) {
  const Regressed found = regression(1, 1).solve(VectorXd::Constant(3, kInfinity));
  EXPECT_NEAR(found.x[0], 2.0, 1e-5);
  EXPECT_NEAR(found.x[1], -3.0, 0.01);
  EXPECT_EQ(found.x[2], 0.0);
  EXPECT_NEAR(found.residual, 0.1, 0.01);
  EXPECT_NEAR(std::sqrt(found.covariance(1, 1)), 0.1 / std::sqrt(kBlocks * kRows), 0.0008);
}

TEST(BlockRegression, ErrorsThatLastCountInFull) {
  const Regressed found = regression(1, kRows).solve(VectorXd::Constant(3, kInfinity));
  EXPECT_NEAR(std::sqrt(found.covariance(1, 1)), 0.1 / std::sqrt(kBlocks), 0.006);
}

TEST(BlockRegression, APriorHoldsWhatTheRowsDoNotShow) {
  VectorXd prior = VectorXd::Constant(3, kInfinity);
  prior[1] = 1e-6;
  EXPECT_NEAR(regression(1, 1).solve(prior).x[1], 0.0, 1e-3);
}

}  // namespace
}  // namespace hg::identify
