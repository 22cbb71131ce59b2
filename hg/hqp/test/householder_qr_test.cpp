#include "hg/hqp/solver/householder_qr.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "hg/hqp/solver/dense_least_squares.h"

namespace hg::hqp::solver {
namespace {

constexpr double kRank = 1e-9;

Problem problem_of(const Eigen::MatrixXd& rows) {
  const int m = static_cast<int>(rows.rows());
  Problem problem({.variables = static_cast<int>(rows.cols()), .levels = 1, .rows = m});
  problem.add_level();
  for (int i = 0; i < m; ++i) {
    const Eigen::VectorXd c = rows.row(i);
    problem.add_row({c.data(), c.data() + c.size()}, {});
  }
  return problem;
}

Eigen::MatrixXd basis(const HouseholderQr& elimination, int n) {
  Eigen::MatrixXd Q(n, n);
  for (int t = 0; t < n; ++t)
    Q.col(t) = Eigen::Map<const Eigen::VectorXd>(elimination.column(t), n);
  return Q;
}

TEST(HouseholderQr, KeepsAnOrthogonalBasisWithTriangularPivots) {
  srand(1);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Random(5, 7);
  const Problem problem = problem_of(C);
  HouseholderQr elimination(7, 5);
  elimination.reset(7);
  for (int row = 0; row < 5; ++row) ASSERT_TRUE(elimination.add_row(problem, row, kRank));
  const Eigen::MatrixXd Q = basis(elimination, 7);
  EXPECT_LT((Q.transpose() * Q - Eigen::MatrixXd::Identity(7, 7)).norm(), 1e-13);
  const Eigen::MatrixXd L = C * Q;
  for (int t = 0; t < 5; ++t) {
    EXPECT_EQ(elimination.pivot_row(t), t);
    EXPECT_NEAR(L(t, t), elimination.pivot(t), 1e-13);
    EXPECT_LT(L.row(t).tail(6 - t).norm(), 1e-13);
  }
}

TEST(HouseholderQr, RefusesDependentAndZeroRows) {
  Eigen::MatrixXd C(4, 3);
  C << 1, 2, 3, -2, -4, -6 + 1e-12, 0, 0, 0, 1, 2, 3 + 1e-6;
  const Problem problem = problem_of(C);
  HouseholderQr elimination(3, 4);
  elimination.reset(3);
  EXPECT_TRUE(elimination.add_row(problem, 0, kRank));
  EXPECT_FALSE(elimination.add_row(problem, 1, kRank));
  EXPECT_FALSE(elimination.add_row(problem, 2, kRank));
  EXPECT_TRUE(elimination.add_row(problem, 3, kRank));
  EXPECT_EQ(elimination.freedom(), 1);
  elimination.truncate(0);
  EXPECT_TRUE(elimination.add_row(problem, 1, kRank));
}

TEST(HouseholderQr, StepsToTheSmallestLeastSquaresPointBesideFixedRows) {
  srand(2);
  Eigen::MatrixXd C = Eigen::MatrixXd::Random(7, 6);
  C.row(4) = C.row(2) + C.row(0);  // dependent on the fixed row and another
  C.row(6) = 1e-4 * C.row(3);
  const Problem problem = problem_of(C);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(6);
  const Eigen::VectorXd targets = Eigen::VectorXd::Random(7);
  HouseholderQr elimination(6, 7);
  elimination.reset(6);
  ASSERT_TRUE(elimination.add_row(problem, 0, kRank));
  std::vector<TargetRow> rows;
  for (int row = 2; row < 7; ++row) rows.push_back({row, targets[row]});
  elimination.add_least_squares(problem, rows, x.data(), kRank);
  EXPECT_EQ(elimination.rank(), 4);  // rows 0, 2 (or 4), 3 (or 6), 5

  // the same by dense algebra: minimise in the null space of row 0
  const Eigen::VectorXd c0 = C.row(0).normalized();
  const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(6, 6) - c0 * c0.transpose();
  const Eigen::MatrixXd A = C.bottomRows(5) * P;
  const Eigen::VectorXd d =
      A.completeOrthogonalDecomposition().solve(targets.tail(5) - C.bottomRows(5) * x);
  EXPECT_LT((elimination.step() - d).norm(), 1e-9);
}

TEST(HouseholderQr, JudgesRankByTheMostIndependentRows) {
  // rows 0 and 1 differ by 2e-9 of row 2: taken in order, row 1 would give a bad direction, and row
  // 2 would seem to add a third one
  const Eigen::RowVector3d a = Eigen::RowVector3d(1, 2, 3).normalized();
  const Eigen::RowVector3d b = Eigen::RowVector3d(-3, 1, 2).normalized();
  Eigen::MatrixXd C(3, 3);
  C << a, a + 2e-9 * b, b;
  const Problem problem = problem_of(C);
  HouseholderQr elimination(3, 3);
  elimination.reset(3);
  const std::vector<TargetRow> rows = {{0, 1.0}, {1, 1.0}, {2, 1.0}};
  const Eigen::Vector3d x = Eigen::Vector3d::Zero();
  elimination.add_least_squares(problem, rows, x.data(), kRank);
  EXPECT_EQ(elimination.rank(), 2);
}

TEST(HouseholderQr, ProjectsToWhatIsFree) {
  const Eigen::MatrixXd C = Eigen::RowVector3d(0, 2, 0);
  const Problem problem = problem_of(C);
  HouseholderQr elimination(3, 1);
  elimination.reset(3);
  elimination.add_row(problem, 0, kRank);
  const Eigen::Vector3d g(1, 2, 3);
  Eigen::Vector3d out;
  elimination.project_to_free(g.data(), out.data());
  EXPECT_LT((out - Eigen::Vector3d(1, 0, 3)).norm(), 1e-15);
}

TEST(SolveLeastSquares, KeepsSmallRowsAccurateBesideLargeOnes) {
  // large rows fix z0, small ones z1; without sorting the small ones drown
  Eigen::MatrixXd A(4, 2);
  A << 1e-6, 1e-6, 1e-6, 2e-6, 1e6, 0, 1e6, 0;
  Eigen::VectorXd e(4);
  e << 3e-6, 5e-6, 1e6, 1e6;
  Eigen::VectorXd z(2);
  Eigen::VectorXi order(2);
  solve_least_squares(4, 2, A.data(), e.data(), order.data(), z.data());
  EXPECT_NEAR(z[0], 1.0, 1e-12);
  EXPECT_NEAR(z[1], 2.0, 1e-12);
}

TEST(SolveLeastSquares, PivotsColumnsForStiffRows) {
  // the large row is zero in column 0: taken first, it would be mixed into the small rows
  const double M = 1e10;
  Eigen::MatrixXd A(3, 2);
  A << 0, M, 1, 1, 1, -1;
  Eigen::VectorXd e(3);
  e << M, 3, 1;
  Eigen::VectorXd z(2);
  Eigen::VectorXi order(2);
  solve_least_squares(3, 2, A.data(), e.data(), order.data(), z.data());
  EXPECT_LT((z - Eigen::Vector2d(2.0, 1.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace hg::hqp::solver
