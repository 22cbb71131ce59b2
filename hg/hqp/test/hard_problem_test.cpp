// Problems that have caught a solver, ours or a mutation of it: each small, with the reason why.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/random_problem.h"
#include "hg/hqp/text.h"

namespace hg::hqp {
namespace {

Problem problem_of(const char* text) { return parse_problems(text, "test").front(); }

Solution solve(const Problem& problem) {
  Solver solver(problem.capacity());
  Solution solution(problem.capacity());
  ActiveSet active;
  solver.solve(problem, {}, active, solution);
  EXPECT_EQ(fault_of(problem, {}, solution), "");
  return solution;
}

// Wilkinson's example of growth: elimination by rows loses a digit every three or four rows,
// although the condition number is about n. The last row is an equality, or held at its upper bound
// by the next level.
Problem problem_with_growth(int n, bool is_equality, std::vector<double>& expected) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0.9, 1.0);
  Problem problem({.variables = n, .levels = 2, .rows = 2 * n});
  problem.add_level();
  expected.resize(n);
  for (double& x : expected) x = number(random);
  for (int row = 0; row < n; ++row) {
    const bool is_last = row == n - 1;
    std::vector<double> c(expected.size(), 0.0);
    double value = 0.0;
    for (int i = is_last ? 0 : row; i < n; ++i) {
      c[i] = is_last ? number(random) : (i == row ? 1.0 : -number(random));
      value += c[i] * expected[i];
    }
    problem.add_row(c, {is_last && !is_equality ? -kInfinity : value, value});
  }
  problem.add_level();
  for (int i = 0; i < n; ++i) {
    const double wish = expected[i] + 1.0;
    problem.add_bound(i, {wish, wish});
  }
  return problem;
}

// W. Kahan's matrix: rows e_t - sum of the e_j behind it depend on each other but for 2^-n, which
// no row shows.
TEST(HardProblem, ARankThatNoRowShowsIsNoticed) {
  for (const int n : {20, 32, 48, 60}) {
    for (const bool is_one_level : {false, true}) {
      SCOPED_TRACE("n " + std::to_string(n) + (is_one_level ? ", one level" : ""));
      Problem problem({.variables = n, .levels = 2, .rows = n});
      problem.add_level();
      std::vector<double> row(n, -1.0);
      for (int t = 0; t + 1 < n; ++t) {
        row[t] = 1.0;
        problem.add_row(row, {0.0, 0.0});
        row[t] = 0.0;
      }
      if (!is_one_level) problem.add_level();
      problem.add_row(row, {-1.0, -1.0});  // -x[n-1]
      solve(problem);                      // judges the result
    }
  }
}

TEST(HardProblem, EliminationThatLosesDigitsIsNoticed) {
  for (const auto& [n, is_equality] : {std::pair{60, true}, std::pair{30, false}}) {
    std::vector<double> expected;
    const Solution solution = solve(problem_with_growth(n, is_equality, expected));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(solution.x[i], expected[i], 1e-9) << "x" << i << " of " << n;
    }
  }
}

// The last row of level 1 is that of level 0 up to noise, and contradicts it. Its noise must not
// pull the second row, of small weight, off its bound: level 2 would lose a freedom.
TEST(HardProblem, NoiseOfAContradictoryRowDoesNotPull) {
  const Solution solution = solve(problem_of(R"(hqp 3 3
level 1 0
-1 1.5303539187327417 1.3010656908001557 2
level 1 2
1 0 0 -2
0 1 0 -inf -0.23999316588306338 weight 0.12511847266687945
-1 1.5303539187313069 1.301065690801242 0 0
level 0 1
0 0 1 1 inf
end
)"));
  EXPECT_NEAR(solution.levels[2].slack_squared, 0.0, 1e-9);
}

// Two rows of level 1 nearly cancel; what is left, a millionth, pushes against level 0 and fixes x.
TEST(HardProblem, AWeakPushHoldsAgainstLowerLevels) {
  const Solution solution = solve(problem_of(R"(hqp 1 3
level 0 1
1 -inf 0
level 2 0
1 1
1 -0.999996
level 1 0
1 -1
end
)"));
  EXPECT_EQ(solution.x[0], 0.0);
}

// A contradiction of a few units of the tolerance is shared like any other.
TEST(HardProblem, ASmallContradictionIsShared) {
  const Solution solution = solve(problem_of(R"(hqp 1 1
level 2 0
1 1
1 1.000000004
end
)"));
  EXPECT_NEAR(solution.x[0], 1.000000002, 1e-15);
}

// Which active sets are tried must not become a matter of chance: it does not change results.
TEST(HardProblem, ActiveSetsAreTriedInASensibleOrder) {
  int iterations = 0;
  int most = 0;
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    const Solution solution = solve(random_problem(seed, {}));
    iterations += solution.iterations;
    most = std::max(most, solution.iterations);
  }
  EXPECT_LT(iterations, 1600);  // 1443
  EXPECT_LT(most, 20);          // 12
}

}  // namespace
}  // namespace hg::hqp
