#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/solver/level_by_level.h"
#include "hg/hqp/test/random_problem.h"

#ifndef HG_SANITIZED

namespace hg::hqp::solver {
namespace {

constexpr Capacity kCapacity = {.variables = 60, .levels = 20, .rows = 600};

TEST(Allocation, IsCounted) {
  const AllocationCounter allocations;
  const std::vector<double> v(100);
  EXPECT_GE(allocations.count(), 1U) << v.size();
}

TEST(Allocation, DoesNotHappenAfterConstruction) {
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  std::vector<double> mu(600);
  std::mt19937 random(1);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const RandomKind kind = {.max_variables = 60, .max_levels = 16, .max_rows_per_level = 30};
    Problem problem = random_problem(seed, kind);
    ActiveSet active;
    for (int row = 0; row < problem.rows(); ++row) {
      active.state[row] = static_cast<RowState>(random() % 6);
      active.before[row] = static_cast<RowState>(random() % 6);
    }
    const AllocationCounter allocations;
    solver.solve(problem, SolverOptions{}, active, solution);
    active = {};
    solver.solve(problem, SolverOptions{}, active, solution);
    for (int level = 0; level < problem.levels(); ++level) {
      solver.multipliers(problem, SolverOptions{}, solution, level,
                         std::span(mu).first(problem.rows()));
    }
    for (int row = 0; row < problem.rows(); ++row) {
      problem.set_bounds(row, {-1.0, 1.0});
      if (problem.variable(row) < 0) {
        problem.set_row(row, {solution.x.data(), solution.x.size()});
      }
    }
    ASSERT_EQ(allocations.count(), 0U) << "seed " << seed;
  }
}

// solve() itself comes to this method in very few of these problems
TEST(Allocation, DoesNotHappenLevelByLevel) {
  Workspace work(kCapacity);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Problem problem = random_problem(seed, {});
    int iterations = 0;
    int completed = 0;
    const AllocationCounter allocations;
    solve_level_by_level(problem, {}, problem.levels(), iterations, completed, work);
    ASSERT_EQ(allocations.count(), 0U) << "seed " << seed;
  }
}

}  // namespace
}  // namespace hg::hqp::solver

#endif
