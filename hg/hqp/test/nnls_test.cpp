#include "hg/hqp/solver/nnls.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace hg::hqp::solver {
namespace {

constexpr double kRank = 1e-9;

struct Corner {
  Corner() : problem({.variables = 2, .levels = 1, .rows = 4}) {
    problem.add_level();
    problem.add_bound(0, {});
    problem.add_bound(1, {});
    problem.add_row(std::vector{1.0, 1.0}, {});
    problem.add_row(std::vector{1.0, 0.0}, {});  // duplicate of the first
    elimination.reset(2);
  }
  void solve(const std::vector<RowAtBound>& rows, const Eigen::Vector2d& g) {
    nnls.solve(problem, rows, g.data(), g.norm(), kRank, elimination);
  }
  Problem problem;
  HouseholderQr elimination{2, 4};
  Nnls nnls{2, 8};
};

TEST(Nnls, HoldsOnlyRowsThatPush) {
  Corner corner;
  corner.solve({{0, 1.0}, {1, 1.0}}, {-2.0, 3.0});  // wants to go right and down
  ASSERT_EQ(corner.nnls.size(), 1);
  EXPECT_EQ(corner.nnls.row(0).row, 0);
  EXPECT_NEAR(corner.nnls.mu(0), 2.0, 1e-15);
  EXPECT_LT((corner.nnls.descent() - Eigen::Vector2d(0.0, -3.0)).norm(), 1e-15);
  EXPECT_EQ(corner.elimination.rank(), 1);
}

TEST(Nnls, ProvesACornerWithMoreRowsThanVariables) {
  Corner corner;
  corner.solve({{0, 1.0}, {1, 1.0}, {2, 1.0}, {3, 1.0}}, {-2.0, -1.0});
  EXPECT_LT(corner.nnls.descent().norm(), 1e-15);
  double sum_0 = 0.0;
  for (int i = 0; i < corner.nnls.size(); ++i) {
    EXPECT_GT(corner.nnls.mu(i), 0.0);
    EXPECT_NE(corner.nnls.row(i).row, 3);  // the earlier of two equal rows
    if (corner.nnls.row(i).row != 1) sum_0 += corner.nnls.mu(i);
  }
  EXPECT_NEAR(sum_0, 2.0, 1e-14);
}

TEST(Nnls, HoldsARowThatIsHardlyInTheWay) {
  Corner corner;
  corner.solve({{0, 1.0}}, {-1e-5, 1.0});  // wants to go down, and right a little
  ASSERT_EQ(corner.nnls.size(), 1);
  EXPECT_EQ(corner.nnls.descent()[0], 0.0);
}

TEST(Nnls, MeetsTheConditionsOfItsMinimum) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  int largest = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    const int n = 2 + trial % 7;
    const int m = 3 * n;
    Problem problem({.variables = n, .levels = 1, .rows = m});
    problem.add_level();
    std::vector<RowAtBound> candidates;
    Eigen::MatrixXd C(m, n);
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) C(i, j) = normal(random) + (j == 0 ? 1.0 : 0.0);
      const Eigen::VectorXd c = C.row(i);
      candidates.push_back(
          {problem.add_row({c.data(), c.data() + n}, {}), i % 4 == 0 ? -1.0 : 1.0});
    }
    const Eigen::VectorXd g = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    HouseholderQr elimination(n, m);
    elimination.reset(n);
    Nnls nnls(n, m);
    nnls.solve(problem, candidates, g.data(), g.norm(), kRank, elimination);

    // descent = -(g + sum mu s c), opposed by no row and neutral to those that push
    const Eigen::VectorXd descent = nnls.descent().head(n);
    Eigen::VectorXd sum = g + descent;
    for (int i = 0; i < nnls.size(); ++i) {
      ASSERT_GT(nnls.mu(i), 0.0);
      const auto [row, sign] = nnls.row(i);
      sum += nnls.mu(i) * sign * C.row(row).transpose();
      ASSERT_LT(std::abs(C.row(row).dot(descent)), 1e-9 * C.row(row).norm() * g.norm());
    }
    ASSERT_LT(sum.norm(), 1e-9 * g.norm());
    for (const auto& [row, sign] : candidates) {
      ASSERT_LT(sign * C.row(row).dot(descent), 1e-9 * C.row(row).norm() * g.norm());
    }
    largest = std::max(largest, nnls.size());
  }
  EXPECT_EQ(largest, 8);
}

}  // namespace
}  // namespace hg::hqp::solver
