#include "hg/hqp/solver/gauss_elimination.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <vector>

namespace hg::hqp::solver {
namespace {

using Outcome = GaussElimination::Outcome;

constexpr double kRank = 1e-9;
constexpr double kRounding = 1e-12;

// Rows of C as dense rows 0..m-1, after them one bound per variable.
Problem problem_of(const Eigen::MatrixXd& C) {
  const int m = static_cast<int>(C.rows()), n = static_cast<int>(C.cols());
  Problem problem({.variables = n, .levels = 1, .rows = m + n});
  problem.add_level();
  for (int i = 0; i < m; ++i) {
    const Eigen::VectorXd c = C.row(i);
    problem.add_row({c.data(), c.data() + c.size()}, {}, 1.0 + i);
  }
  for (int v = 0; v < n; ++v) problem.add_bound(v, {0.0, 1.0});
  return problem;
}

TEST(GaussElimination, FindsThePointWhereAllRowsHaveTheirValues) {
  srand(1);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Random(4, 6);
  const Problem problem = problem_of(C);
  GaussElimination elimination(6, 10);
  elimination.reset(problem);
  const std::vector<TargetRow> rows = {{0, 1.0}, {4, 2.0}, {1, 3.0}, {2, -4.0}, {8, 5.0}, {3, 6.0}};
  for (const TargetRow& row : rows) {
    ASSERT_EQ(elimination.add_row(problem, row, kRank), Outcome::kIndependent);
  }
  Eigen::VectorXd x(6);
  ASSERT_TRUE(elimination.find_point(x.data()));
  const Eigen::Vector4d expected(1.0, 3.0, -4.0, 6.0);
  EXPECT_LT((C * x - expected).norm(), kRounding);
  EXPECT_NEAR(x[0], 2.0, kRounding);
  EXPECT_NEAR(x[4], 5.0, kRounding);
}

TEST(GaussElimination, SeparatesDependentRowsFromDoubtfulOnes) {
  Eigen::MatrixXd C(4, 3);
  C << 1, 2, 3, -2, -4, -6, 1, 2, 3 + 5.2e-9, 1, 2, 3 + 1e-4;
  const Problem problem = problem_of(C);
  GaussElimination elimination(3, 7);
  elimination.reset(problem);
  EXPECT_EQ(elimination.add_row(problem, {0, 0.0}, kRank), Outcome::kIndependent);
  EXPECT_EQ(elimination.add_row(problem, {1, 0.0}, kRank), Outcome::kDependent);
  EXPECT_EQ(elimination.add_row(problem, {2, 0.0}, kRank), Outcome::kUnsure);
  EXPECT_EQ(elimination.add_row(problem, {3, 0.0}, kRank), Outcome::kIndependent);
  EXPECT_EQ(elimination.add_row(problem, {4, 0.0}, kRank), Outcome::kIndependent);
  EXPECT_EQ(elimination.add_row(problem, {5, 0.0}, kRank), Outcome::kDependent);
  EXPECT_EQ(elimination.rank(), 3);
}

// The row is a pivot plus a little of the last variable. Along the free direction, in which all
// other variables move with it a million times as far, the row hardly changes: it depends.
TEST(GaussElimination, IsNotSureOfARowThatOnlyGrowthKeepsApart) {
  constexpr int n = 24;
  Eigen::MatrixXd C = Eigen::MatrixXd::Constant(n, n, -0.95);
  C.triangularView<Eigen::StrictlyLower>().setZero();
  C.diagonal().setOnes();
  C.row(n - 1) = C.row(0) + 5e-7 * Eigen::RowVectorXd::Unit(n, n - 1);
  const Problem problem = problem_of(C);
  GaussElimination elimination(n, 2 * n);
  elimination.reset(problem);
  for (int row = 0; row < n - 1; ++row) {
    ASSERT_EQ(elimination.add_row(problem, {row, 0.0}, kRank), Outcome::kIndependent);
  }
  EXPECT_EQ(elimination.add_row(problem, {n - 1, 0.0}, kRank), Outcome::kUnsure);
}

TEST(GaussElimination, IsSureOfARowThatIsNearerThanTheTolerance) {
  Eigen::MatrixXd C(2, 3);
  C << 1, 2, 3, 1, 2, 3 + 1e-10;
  const Problem problem = problem_of(C);
  GaussElimination elimination(3, 5);
  elimination.reset(problem);
  ASSERT_EQ(elimination.add_row(problem, {0, 0.0}, kRank), Outcome::kIndependent);
  EXPECT_EQ(elimination.add_row(problem, {1, 0.0}, kRank), Outcome::kDependent);
}

TEST(GaussElimination, MeetsContradictoryRowsInTheSenseOfWeightedLeastSquares) {
  srand(2);
  Eigen::MatrixXd C = Eigen::MatrixXd::Random(7, 4);
  C.row(6) = C.row(5);  // duplicate with another target
  const Problem problem = problem_of(C);
  GaussElimination elimination(4, 11);
  elimination.reset(problem);
  ASSERT_EQ(elimination.add_row(problem, {0, 0.5}, kRank), Outcome::kIndependent);
  std::vector<TargetRow> rows;
  for (int i = 1; i < 7; ++i) rows.push_back({i, 0.3 * i});
  ASSERT_TRUE(elimination.add_least_squares(problem, rows, kRank));
  ASSERT_EQ(elimination.freedom(), 0);
  Eigen::VectorXd x(4);
  ASSERT_TRUE(elimination.find_point(x.data()));
  EXPECT_NEAR(C.row(0).dot(x), 0.5, kRounding);

  // the weighted gradient is a multiple of the row above
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(4);
  for (int i = 1; i < 7; ++i) {
    const double weight = problem.weight(i);
    gradient += weight * weight * (C.row(i).dot(x) - 0.3 * i) * C.row(i).transpose();
  }
  EXPECT_GT(gradient.norm(), 0.1);
  double mu = 0.0;
  EXPECT_LT(elimination.find_multipliers(gradient.data(), 1, 0, &mu), 100 * kRounding);
  EXPECT_LT((gradient + mu * C.row(0).transpose()).norm(), 100 * kRounding);
}

TEST(GaussElimination, FindsMultipliersAndTheirResidual) {
  srand(3);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Random(3, 5);
  const Problem problem = problem_of(C);
  GaussElimination elimination(5, 8);
  elimination.reset(problem);
  for (const int row : {0, 4, 1, 2}) {  // row 4: variable 1
    ASSERT_EQ(elimination.add_row(problem, {row, 0.0}, kRank), Outcome::kIndependent);
  }
  const Eigen::VectorXd x1 = Eigen::VectorXd::Unit(5, 1);
  const Eigen::VectorXd g = -(C.transpose() * Eigen::Vector3d(2.0, -3.0, 4.0) + 5.0 * x1);
  Eigen::VectorXd mu(4);
  EXPECT_LT(elimination.find_multipliers(g.data(), 4, 0, mu.data()), kRounding);
  EXPECT_LT((mu - Eigen::Vector4d(2.0, 5.0, -3.0, 4.0)).norm(), 100 * kRounding);
  EXPECT_GT(elimination.find_multipliers(g.data(), 3, 0, mu.data()), 0.1);
}

TEST(GaussElimination, LeavesFixedVariablesToTheirOwnRows) {
  Eigen::MatrixXd C(1, 3);
  C << 0.7, 9.1, 0.3;
  Problem problem = problem_of(C);
  problem.set_bounds(2, {0.1, 0.1});  // x[1] = 0.1
  GaussElimination elimination(3, 4);
  elimination.reset(problem);
  ASSERT_EQ(elimination.add_row(problem, {0, 1.3}, kRank), Outcome::kIndependent);
  ASSERT_EQ(elimination.add_row(problem, {2, 0.1}, kRank), Outcome::kIndependent);
  ASSERT_EQ(elimination.add_row(problem, {3, 1.7}, kRank), Outcome::kIndependent);
  Eigen::Vector3d x;
  ASSERT_TRUE(elimination.find_point(x.data()));
  EXPECT_EQ(x[1], 0.1);  // without rounding, as the longest number of row 0 was not eliminated
  EXPECT_NEAR(C.row(0).dot(x), 1.3, kRounding);
}

// What x was where variables are taken, NaN included, does not show.
TEST(GaussElimination, CompletesAPointFromItsFreeVariables) {
  srand(5);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Random(3, 4);
  const Problem problem = problem_of(C);
  GaussElimination elimination(4, 7);
  elimination.reset(problem);
  for (int row = 0; row < 3; ++row) {
    ASSERT_EQ(elimination.add_row(problem, {row, 1.0 + row}, kRank), Outcome::kIndependent);
  }
  Eigen::Vector4d x;
  for (int v = 0; v < 4; ++v) {
    x[v] = elimination.is_free(v) ? 0.5 : std::numeric_limits<double>::quiet_NaN();
  }
  elimination.complete(x.data());
  EXPECT_LT((C * x - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), kRounding);
}

TEST(GaussElimination, ForgetsPivotsOnDemand) {
  srand(4);
  const Problem problem = problem_of(Eigen::MatrixXd::Random(4, 3));
  GaussElimination elimination(3, 7);
  elimination.reset(problem);
  const auto point_of = [&](int last_row) {
    EXPECT_EQ(elimination.add_row(problem, {last_row, 1.0}, kRank), Outcome::kIndependent);
    Eigen::Vector3d x;
    EXPECT_TRUE(elimination.find_point(x.data()));
    return x;
  };
  ASSERT_EQ(elimination.add_row(problem, {0, 1.0}, kRank), Outcome::kIndependent);
  ASSERT_EQ(elimination.add_row(problem, {1, 1.0}, kRank), Outcome::kIndependent);
  const Eigen::Vector3d first = point_of(2);
  elimination.truncate(2);
  const Eigen::Vector3d other = point_of(3);
  elimination.truncate(2);
  EXPECT_EQ(point_of(2), first);
  EXPECT_NE(other, first);
}

}  // namespace
}  // namespace hg::hqp::solver
