// The dual method by what it is for: contradictions over several levels are found in few active
// sets. Its guesses are judged as part of the solver, whose results the certificate proves.
#include "hg/hqp/solver/dual_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp::solver {
namespace {

using Row = std::vector<double>;

/// Couplings, then `depth` levels of limits that cannot all be met, then wishes that pull at them.
struct Contradiction {
  int variables;
  int depth;          ///< 2: two levels contradict each other, 3: only all three do
  int count;          ///< such contradictions
  bool is_duplicate;  ///< every limit twice
  bool is_corner;     ///< more limits meet at x = 0, where the couplings hold, than dimensions
};

Problem contradictory_problem(const Contradiction& kind, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> number;
  const int n = kind.variables;
  const auto random_row = [&] {
    Row row(n);
    for (double& c : row) c = number(random);
    return row;
  };
  Problem problem({.variables = n, .levels = kind.depth + 2, .rows = kMaxRows});
  problem.add_level();
  for (int i = 0; i < n / 4; ++i) problem.add_row(random_row(), {0.0, 0.0});

  const auto add_limit = [&](const Row& row, Interval bounds) {
    for (int copy = 0; copy <= (kind.is_duplicate ? 1 : 0); ++copy) problem.add_row(row, bounds);
  };
  // rows of the last of these levels are sums of rows above, and want what these forbid
  std::vector<Row> sums(kind.count, Row(n));
  for (int level = 0; level + 1 < kind.depth; ++level) {
    problem.add_level();
    for (Row& sum : sums) {
      const Row row = random_row();
      for (std::size_t i = 0; i < row.size(); ++i) sum[i] += row[i];
      add_limit(row, {-kInfinity, kind.is_corner ? 0.0 : 0.1});
    }
  }
  problem.add_level();
  for (const Row& sum : sums) add_limit(sum, {1.0, 2.0});
  if (kind.is_corner) {
    for (int i = 0; i < n; ++i) problem.add_bound(i, {-kInfinity, 0.0});
  }
  problem.add_level();
  for (int i = 0; i < n; ++i) {
    const double wish = number(random);
    problem.add_bound(i, {wish, wish});
  }
  return problem;
}

struct Effort {
  int most = 0;
  int sum = 0;
};

Effort solve_all(const Contradiction& kind, int seeds) {
  Effort effort;
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(seeds); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = contradictory_problem(kind, seed);
    Solver solver(problem.capacity());
    Solution solution(problem.capacity());
    ActiveSet active;
    EXPECT_EQ(solver.solve(problem, {}, active, solution), Status::kSolved);
    EXPECT_EQ(fault_of(problem, {}, solution), "");
    EXPECT_GT(solution.levels[kind.depth].slack_squared, 0.1);
    effort.most = std::max(effort.most, solution.iterations);
    effort.sum += solution.iterations;

    Solution again(problem.capacity());
    EXPECT_EQ(solver.solve(problem, {}, active, again), Status::kSolved);
    EXPECT_EQ(again.iterations, 1);
    EXPECT_EQ(again.x, solution.x);  // bit for bit
  }
  return effort;
}

// A second guess that is wrong in what the first one has just been corrected in is not tried: the
// first guess and that of the dual method are.
TEST(DualMethod, IsTriedBeforeAWrongSecondGuess) {
  constexpr int n = 6;
  Problem problem({.variables = n, .levels = 2, .rows = 2 * n});
  problem.add_level();
  for (int i = 0; i < n; ++i) problem.add_bound(i, {-kInfinity, 1.0});
  problem.add_level();
  for (int i = 0; i < n; ++i) {
    const double wish = i == 2 ? 9.0 : 2.0;
    problem.add_bound(i, {wish, wish});  // all limits act, that of x2 is first in the way
  }
  Solver solver(problem.capacity());
  Solution solution(problem.capacity());
  ActiveSet active;
  active.state[0] = RowState::kUpper;
  active.before[1] = RowState::kUpper;
  EXPECT_EQ(solver.solve(problem, {}, active, solution), Status::kSolved);
  EXPECT_EQ(solution.iterations, 2);
  for (const double x : solution.x) EXPECT_EQ(x, 1.0);
}

int iterations_of(const Problem& problem) {
  Solver solver(problem.capacity());
  Solution solution(problem.capacity());
  ActiveSet active;
  EXPECT_EQ(solver.solve(problem, {}, active, solution), Status::kSolved);
  EXPECT_EQ(fault_of(problem, {}, solution), "");
  return solution.iterations;
}

// Where its guess was wrong about the levels that give way, it starts again with those of the point
// that the guess gave, instead of leaving the problem to the method that goes level by level.
TEST(DualMethod, StartsAgainWithTheLevelsThatGaveWay) {
  for (const std::uint32_t seed : {2148u, 5832u}) {
    EXPECT_LE(iterations_of(random_problem(seed, {})), 7) << "seed " << seed;  // else 32, 20
  }
}

// The same where it has given up on rows that are nearly dependent.
TEST(DualMethod, StartsAgainWhereItHasGivenUp) {
  for (const std::uint32_t seed : {1272u, 5044u}) {
    const Problem problem = random_problem(seed, {.noise = 1e-7});
    EXPECT_LE(iterations_of(problem), 5) << "seed " << seed;  // else 12, 20
  }
}

// Cold, 4 active sets are tried before the dual method; its guess needs one.
TEST(DualMethod, FindsContradictionsOfTwoLevels) {
  const Effort effort = solve_all({.variables = 12, .depth = 2, .count = 3}, 50);
  EXPECT_LE(effort.most, 7);
  EXPECT_LE(effort.sum, 50 * 6);
}

TEST(DualMethod, FindsContradictionsOfThreeLevels) {
  const Effort effort = solve_all({.variables = 12, .depth = 3, .count = 3}, 50);
  EXPECT_LE(effort.most, 7);
  EXPECT_LE(effort.sum, 50 * 6);
}

TEST(DualMethod, FindsContradictionsOfATwinOf30Joints) {
  for (const int depth : {2, 3}) {
    const Effort effort = solve_all({.variables = 30, .depth = depth, .count = 10}, 10);
    EXPECT_LE(effort.most, 7);
    EXPECT_LE(effort.sum, 10 * 6);
  }
}

TEST(DualMethod, DuplicatedRowsShareWhatIsLeft) {
  for (const int depth : {2, 3}) {
    const Effort effort =
        solve_all({.variables = 12, .depth = depth, .count = 3, .is_duplicate = true}, 50);
    EXPECT_LE(effort.most, 12);
  }
}

TEST(DualMethod, LeavesDegenerateCorners) {
  for (const int depth : {2, 3}) {
    const Effort effort =
        solve_all({.variables = 12, .depth = depth, .count = 6, .is_corner = true}, 50);
    EXPECT_LE(effort.most, 40);
  }
}

}  // namespace
}  // namespace hg::hqp::solver
