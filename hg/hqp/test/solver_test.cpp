#include "hg/hqp/solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp {
namespace {

constexpr double kExact = 1e-12;
constexpr Capacity kCapacity = {.variables = 60, .levels = 20, .rows = 600};

// A solver with all that a call needs.
struct Bench {
  Solver solver{kCapacity};
  Solution solution{kCapacity};
  SolverOptions options;
  ActiveSet active;

  Status solve(const Problem& problem, double gap = 1e-6) {
    solver.solve(problem, options, active, solution);
    EXPECT_EQ(fault_of(problem, options, solution, gap), "");
    return solution.status;
  }
  std::vector<double> multipliers(const Problem& problem, int level, double* rest = nullptr) {
    std::vector<double> mu(problem.rows());
    const double residual = solver.multipliers(problem, options, solution, level, mu);
    if (rest != nullptr) *rest = residual;
    return mu;
  }
  RowState state(int row) const { return solution.state[row]; }
  double slack(int row) const { return solution.slack[row]; }
};

Problem empty_problem(int variables) {
  Problem problem(kCapacity);
  problem.clear(variables);
  return problem;
}

// The smallest case in which a law that is not complementary shows (docs/concepts/law.md): M^-1 =
// [1 .8; .8 1], a_free = 0, a <= (-1, -.9). Last level: |L^T a|^2 with L L^T = M.
Problem coupled_limits() {
  Problem problem = empty_problem(2);
  problem.add_level();
  problem.add_bound(0, {-kInfinity, -1.0});
  problem.add_bound(1, {-kInfinity, -0.9});
  problem.add_level();
  const double det = 1.0 - 0.64;
  const double l00 = std::sqrt(1.0 / det);
  const double l10 = -0.8 / det / l00;
  const double l11 = std::sqrt(1.0 / det - l10 * l10);
  problem.add_row(std::vector{l00, l10}, {0.0, 0.0});
  problem.add_row(std::vector{0.0, l11}, {0.0, 0.0});
  return problem;
}

TEST(Solve, KeepsTheBoundThatIsNeededAndOnlyThat) {
  Problem problem = coupled_limits();
  Bench bench;
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.x[0], -1.0, kExact);
  EXPECT_NEAR(bench.solution.x[1], -0.9, kExact);
  EXPECT_EQ(bench.state(0), RowState::kUpper);
  EXPECT_EQ(bench.state(1), RowState::kUpper);

  // with room at the second joint, the first limit alone drags it along to -.8
  problem.set_bounds(1, {-kInfinity, -0.7});
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.x[1], -0.8, kExact);
  EXPECT_EQ(bench.state(1), RowState::kInactive);
  EXPECT_EQ(bench.solution.levels[1].blocking_row, 0);
}

TEST(Solve, GivesHigherLevelsWhatTheyWantFirst) {
  Problem problem = empty_problem(3);
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0, 0.0}, {2.0, 2.0});
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0, 0.0}, {5.0, 5.0});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 0.5});
  problem.add_level();
  problem.add_row(std::vector{1.0, 0.0, 0.0}, {3.0, 3.0});
  Bench bench;
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.x[0], 0.5, kExact);
  EXPECT_NEAR(bench.solution.x[1], 1.5, kExact);
  EXPECT_NEAR(bench.solution.x[2], 0.0, kExact);  // in no level: smallest norm
  EXPECT_NEAR(bench.slack(1), 3.0, kExact);
  EXPECT_NEAR(bench.slack(3), 2.5, kExact);
  EXPECT_NEAR(bench.solution.levels[1].slack_squared, 9.0, kExact);
  EXPECT_EQ(bench.state(0), RowState::kEqual);
  EXPECT_EQ(bench.state(1), RowState::kBelow);
  EXPECT_EQ(bench.state(2), RowState::kUpper);
  EXPECT_EQ(bench.solution.levels[0].freedom, 3);
  EXPECT_EQ(bench.solution.levels[1].freedom, 2);
  EXPECT_EQ(bench.solution.levels[3].freedom, 1);
  EXPECT_EQ(bench.solution.completed_levels, 4);
}

TEST(Solve, SharesContradictionsByTheSquareOfTheWeights) {
  Problem problem = empty_problem(1);
  problem.add_level();
  problem.add_bound(0, {1.0, 1.0}, 1.0);
  problem.add_bound(0, {-kInfinity, -1.0}, 2.0);
  Bench bench;
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.x[0], (1.0 * 1.0 + 4.0 * -1.0) / 5.0, kExact);
  EXPECT_EQ(bench.state(0), RowState::kBelow);
  EXPECT_EQ(bench.state(1), RowState::kAbove);
  EXPECT_NEAR(bench.slack(0), 1.6, kExact);  // not weighted: bound - c x
  EXPECT_NEAR(bench.slack(1), -0.4, kExact);
  EXPECT_NEAR(bench.solution.levels[0].slack_squared, 1.6 * 1.6 + 0.8 * 0.8, kExact);
}

TEST(Solve, TakesInfiniteBoundsThatComeAndGo) {
  Problem problem = empty_problem(1);
  problem.add_level();
  const int limit = problem.add_bound(0, {-1.0, 1.0});
  problem.add_level();
  problem.add_bound(0, {3.0, 3.0});
  Bench bench;
  for (const auto& [bounds, x] :
       {std::pair{Interval{-1.0, 1.0}, 1.0}, std::pair{Interval{}, 3.0},
        std::pair{Interval{4.0, kInfinity}, 4.0}, std::pair{Interval{2.0, 2.0}, 2.0},
        std::pair{Interval{-kInfinity, -2.0}, -2.0}}) {
    problem.set_bounds(limit, bounds);
    ASSERT_EQ(bench.solve(problem), Status::kSolved);
    EXPECT_NEAR(bench.solution.x[0], x, kExact);
  }
}

TEST(Solve, ReportsZeroRowsThatCannotBeMet) {
  Problem problem = empty_problem(2);
  problem.add_level();
  problem.add_row(std::vector{0.0, 0.0}, {1.0, 2.0});
  problem.add_row(std::vector{0.0, 0.0}, {-3.0, -3.0});
  problem.add_row(std::vector{0.0, 0.0}, {-1.0, 1.0});
  problem.add_level();
  problem.add_bound(1, {7.0, 7.0});
  Bench bench;
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_EQ(bench.state(0), RowState::kBelow);
  EXPECT_EQ(bench.state(1), RowState::kAbove);
  EXPECT_EQ(bench.state(2), RowState::kInactive);
  EXPECT_EQ(bench.slack(1), -3.0);
  EXPECT_EQ(bench.solution.x[1], 7.0);
}

TEST(Solve, LeavesAProblemWithoutRowsAtZero) {
  Problem problem = empty_problem(3);
  Bench bench;
  EXPECT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_EQ(bench.solution.x, std::vector(3, 0.0));
  problem.add_level();
  EXPECT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_EQ(bench.solution.levels[0].freedom, 3);
}

TEST(Solve, MakesXSmallOnlyWhenRequested) {
  // the last level leaves a line of points on which the level-by-level path need not end at the
  // smallest one; both are optimal
  Problem problem = empty_problem(2);
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0}, {2.0, kInfinity});
  problem.add_bound(0, {-kInfinity, 0.5});
  Bench bench;
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.x[0], 0.5, kExact);
  EXPECT_NEAR(bench.solution.x[1], 1.5, kExact);
  bench.options.minimum_norm = false;
  bench.active = {};
  ASSERT_EQ(bench.solve(problem), Status::kSolved);
  EXPECT_NEAR(bench.solution.levels[0].slack_squared, 0.0, kExact);
}

TEST(Solve, NamesTheFirstBadRowAndKeepsTheLevelsAbove) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    Interval bounds;
    double coefficient;
    double weight;
  };
  for (const Case& bad :
       {Case{{2.0, 1.0}, 1.0, 1.0}, Case{{nan, 1.0}, 1.0, 1.0}, Case{{1.0, nan}, 1.0, 1.0},
        Case{{kInfinity, kInfinity}, 1.0, 1.0}, Case{{-kInfinity, -kInfinity}, 1.0, 1.0},
        Case{{0.0, 1.0}, nan, 1.0}, Case{{0.0, 1.0}, kInfinity, 1.0}, Case{{0.0, 1.0}, 1.0, nan},
        Case{{0.0, 1.0}, 1.0, 0.0}, Case{{0.0, 1.0}, 1.0, -1.0}}) {
    Problem problem = empty_problem(2);
    problem.add_level();
    problem.add_bound(0, {4.0, 4.0});
    problem.add_level();
    problem.add_bound(1, {5.0, 5.0});
    problem.add_row(std::vector{0.0, bad.coefficient}, bad.bounds, bad.weight);
    Bench bench;
    EXPECT_EQ(bench.solve(problem), Status::kBadRow);
    EXPECT_EQ(bench.solution.bad_row, 2);
    EXPECT_EQ(bench.solution.bad_level, 1);
    EXPECT_EQ(bench.solution.completed_levels, 1);
    EXPECT_EQ(bench.solution.x, (std::vector{4.0, 0.0}));
    EXPECT_EQ(bench.slack(1), 0.0);
  }
}

TEST(Solve, StopsAtTheIterationCapWithWhatIsSettled) {
  int stopped = 0, stopped_later = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, {});
    Bench full;
    full.solve(problem);
    for (int cap = 1; cap < full.solution.iterations; ++cap) {
      Bench bench;
      bench.options.max_iterations = cap;
      const Status status = bench.solve(problem);
      ASSERT_LE(bench.solution.iterations, cap);
      if (status == Status::kSolved) continue;
      ASSERT_EQ(status, Status::kIterationLimit);
      ASSERT_LT(bench.solution.completed_levels, problem.levels() + 1);
      for (int level = 0; level < bench.solution.completed_levels; ++level) {
        ASSERT_NEAR(bench.solution.levels[level].slack_squared,
                    full.solution.levels[level].slack_squared,
                    1e-9 * (1.0 + full.solution.levels[level].slack_squared));
      }
      ++stopped;
      stopped_later += bench.solution.completed_levels > 0;
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(stopped_later, 30);
}

TEST(Solve, KeepsAFinitePointWhereNumbersOverflow) {
  Problem problem({.variables = 2, .levels = 2, .rows = 3});
  problem.add_level();
  problem.add_row(std::vector{-0.48, 0.74}, {-2.96, kInfinity});
  problem.add_level();
  problem.add_row(std::vector{-0.52, 0.17}, {3.74, 3.74}, 1e-154);  // its square is denormal
  problem.add_row(std::vector{4.6, -2.3}, {3.0, 3.0});
  Bench bench;
  bench.solve(problem, kInfinity);
  for (const double x : bench.solution.x) EXPECT_TRUE(std::isfinite(x));
}

TEST(Solve, ReportsWhereSlacksOverflow) {
  Problem problem({.variables = 2, .levels = 2, .rows = 2});
  problem.add_level();
  problem.add_bound(0, {-1.0, 1.0});
  problem.add_level();
  problem.add_bound(0, {1e300, 1e300});
  Bench bench;
  EXPECT_EQ(bench.solve(problem), Status::kNumericalFailure);
  EXPECT_EQ(bench.solution.completed_levels, 1);
  EXPECT_TRUE(std::isfinite(bench.solution.x[0]));
}

TEST(SolveDeathTest, StopsBeforeItOverwritesMemory) {
  Problem problem({.variables = 3, .levels = 1, .rows = 3});
  problem.add_level();
  for (int i = 0; i < 3; ++i) problem.add_bound(i, {1.0, 1.0});
  const Capacity small = {.variables = 2, .levels = 1, .rows = 2};
  ActiveSet active;
  EXPECT_DEATH(
      {
        Solution solution(problem.capacity());
        Solver(small).solve(problem, {}, active, solution);
      },
      "larger than the capacity of the solver");
  EXPECT_DEATH(
      {
        Solution solution(small);
        Solver(problem.capacity()).solve(problem, {}, active, solution);
      },
      "larger than the capacity of the solution");
}

TEST(Solve, ConfirmsItsOwnActiveSetInOneIteration) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, {});
    Bench bench;
    ASSERT_EQ(bench.solve(problem), Status::kSolved);
    ASSERT_EQ(bench.solve(problem), Status::kSolved);
    ASSERT_EQ(bench.solution.iterations, 1);
  }
}

TEST(Solve, IsAPureFunctionOfItsArguments) {
  const Problem problem = random_problem(3, {});
  const Problem other = random_problem(4, {.max_variables = 30});
  Bench bench;
  bench.solve(problem);
  const std::vector<double> x = bench.solution.x;
  bench.solve(other);
  bench.active = {};
  bench.solve(problem);
  EXPECT_EQ(bench.solution.x, x);
}

TEST(Solve, SurvivesNumbersBeyondRange) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> decade(-150.0, 150.0);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    Problem problem = empty_problem(4);
    for (int level = 0; level < 3; ++level) {
      problem.add_level();
      for (int i = 0; i < 3; ++i) {
        std::vector<double> c(4);
        for (double& c_j : c) c_j = std::pow(10.0, decade(random));
        const double b = std::pow(10.0, decade(random));
        problem.add_row(c, i == 0 ? Interval{b, b} : Interval{-b, b});
      }
    }
    Bench bench;
    bench.solve(problem, kInfinity);
    for (const double x : bench.solution.x) ASSERT_TRUE(std::isfinite(x));
  }
}

TEST(Multipliers, AreTheForcesOfTheLimits) {
  const Problem problem = coupled_limits();
  Bench bench;
  bench.solve(problem);
  double rest = 1.0;
  const std::vector<double> mu = bench.multipliers(problem, 1, &rest);
  // M a = -mu: constraint torques of two upper limits, both pushing down
  EXPECT_NEAR(mu[0], (1.0 - 0.8 * 0.9) / 0.36, 1e-9);
  EXPECT_NEAR(mu[1], (0.9 - 0.8 * 1.0) / 0.36, 1e-9);
  EXPECT_LT(rest, 1e-12);
}

TEST(Multipliers, HaveTheRightSignsAndBalanceTheGradient) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, {});
    Bench bench;
    bench.solve(problem);
    const std::size_t n = problem.variables();
    for (int level = 0; level < problem.levels(); ++level) {
      double rest = 0.0;
      const std::vector<double> mu = bench.multipliers(problem, level, &rest);
      std::vector<double> sum(n, 0.0);
      double size = 0.0;
      for (int row = 0; row < problem.rows(); ++row) {
        const double mu_i = mu[row];
        if (problem.level_of(row) > level) {
          ASSERT_EQ(mu_i, 0.0);
        }
        if (problem.level_of(row) < level && !is_violated(bench.state(row)) &&
            bench.state(row) != RowState::kEqual) {
          double value = 0.0;
          for (std::size_t j = 0; j < n; ++j) {
            const double c_j = problem.variable(row) < 0
                                   ? problem.coefficients(row)[j]
                                   : (static_cast<int>(j) == problem.variable(row) ? 1.0 : 0.0);
            value += c_j * bench.solution.x[j];
          }
          const auto [lb, ub] = problem.bounds(row);
          if (mu_i > 0.0) {
            ASSERT_NEAR(value, ub, 1e-8 * (1.0 + std::abs(ub)));
          }
          if (mu_i < 0.0) {
            ASSERT_NEAR(value, lb, 1e-8 * (1.0 + std::abs(lb)));
          }
        }
        for (std::size_t j = 0; j < n; ++j) {
          const double c_j = problem.variable(row) < 0
                                 ? problem.coefficients(row)[j]
                                 : (static_cast<int>(j) == problem.variable(row) ? 1.0 : 0.0);
          sum[j] += mu_i * c_j;
        }
        size += std::abs(mu_i) * problem.norm(row);
      }
      double norm = 0.0;
      for (const double s : sum) norm = std::hypot(norm, s);
      ASSERT_LE(norm, 1e-7 * (size + 1e-3));
      ASSERT_LE(rest, 1e-7 * (size + 1e-3));
    }
  }
}

TEST(Multipliers, GoToTheDuplicateOfHighestPriority) {
  Problem problem = empty_problem(1);
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 1.0});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 1.0});
  problem.add_level();
  problem.add_bound(0, {3.0, 3.0});
  Bench bench;
  bench.solve(problem);
  const std::vector<double> mu = bench.multipliers(problem, 2);
  EXPECT_NEAR(mu[0], 2.0, kExact);
  EXPECT_EQ(mu[1], 0.0);
  EXPECT_NEAR(mu[2], -2.0, kExact);
}

TEST(Multipliers, ShowThatAPointIsNotOptimal) {
  const Problem problem = coupled_limits();
  Bench bench;
  bench.solve(problem);
  bench.solution.x = {-1.0, -0.976};  // what the law `paper` gives
  double rest = 0.0;
  bench.multipliers(problem, 1, &rest);
  EXPECT_GT(rest, 0.01);
}

TEST(Capacity, IsCheckedByName) {
  const auto message_of = [](const Capacity& capacity) -> std::string {
    try {
      Solver solver(capacity);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of({129, 1, 1}), "hqp capacity: variables: must be 1..128, got 129");
  EXPECT_EQ(message_of({1, 0, 1}), "hqp capacity: levels: must be 1..32, got 0");
  EXPECT_EQ(message_of({1, 1, 1025}), "hqp capacity: rows: must be 1..1024, got 1025");
  EXPECT_EQ(message_of({128, 32, 1024}), "");
}

TEST(ToString, NamesEveryStatus) {
  EXPECT_STREQ(to_string(Status::kSolved), "solved");
  EXPECT_STREQ(to_string(Status::kIterationLimit), "iteration limit");
  EXPECT_STREQ(to_string(Status::kBadRow), "bad row");
  EXPECT_STREQ(to_string(Status::kNumericalFailure), "numerical failure");
}

}  // namespace
}  // namespace hg::hqp
