#include "hg/hqp/cone.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

namespace hg::hqp {
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
  void solve(const std::vector<TouchedRow>& rows, const Eigen::Vector2d& g) {
    cone.solve(problem, rows, g.data(), g.norm(), kRank, elimination);
  }
  Problem problem;
  Elimination elimination{2, 4};
  Cone cone{2, 8};
};

TEST(Cone, HoldsOnlyRowsThatPush) {
  Corner corner;
  corner.solve({{0, 1.0}, {1, 1.0}}, {-2.0, 3.0});  // wants to go right and down
  ASSERT_EQ(corner.cone.pushing(), 1);
  EXPECT_EQ(corner.cone.row(0).row, 0);
  EXPECT_NEAR(corner.cone.mu(0), 2.0, 1e-15);
  EXPECT_LT((corner.cone.descent() - Eigen::Vector2d(0.0, -3.0)).norm(), 1e-15);
  EXPECT_EQ(corner.elimination.rank(), 1);
}

TEST(Cone, ProvesACornerWithMoreRowsThanVariables) {
  Corner corner;
  corner.solve({{0, 1.0}, {1, 1.0}, {2, 1.0}, {3, 1.0}}, {-2.0, -1.0});
  EXPECT_LT(corner.cone.descent().norm(), 1e-15);
  double sum_0 = 0.0;
  for (int i = 0; i < corner.cone.pushing(); ++i) {
    EXPECT_GT(corner.cone.mu(i), 0.0);
    EXPECT_NE(corner.cone.row(i).row, 3);  // the earlier of two equal rows
    if (corner.cone.row(i).row != 1) sum_0 += corner.cone.mu(i);
  }
  EXPECT_NEAR(sum_0, 2.0, 1e-14);
}

TEST(Cone, DropsARowThatALaterOneRelieves) {
  // steepest descent (3, 1) first meets row 2, x0 + x1 <= 0, and then x0 <= 0, which takes it all
  // but for what points down
  Corner corner;
  corner.solve({{2, 1.0}, {0, 1.0}, {1, -1.0}}, {-3.0, 1.0});
  ASSERT_EQ(corner.cone.pushing(), 2);
  for (int i = 0; i < 2; ++i) EXPECT_NE(corner.cone.row(i).row, 2);
  EXPECT_LT(corner.cone.descent().norm(), 1e-15);
}

}  // namespace
}  // namespace hg::hqp
