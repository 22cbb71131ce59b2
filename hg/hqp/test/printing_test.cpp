#include "hg/hqp/printing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"

namespace hg::hqp {
namespace {

constexpr Capacity kCapacity = {.variables = 9, .levels = 4, .rows = 8};

// x0 <= 1, then x0 + x1 = 3, then x0 = 5 and, less, x1 = 0
Problem example() {
  Problem problem({.variables = 2, .levels = 3, .rows = 5});
  problem.add_level();
  problem.add_bound(0, {.ub = 1.0});
  problem.add_bound(1, {.lb = -7.0});
  problem.add_level();
  problem.add_row(std::array{1.0, 1.0}, {3.0, 3.0});
  problem.add_level();
  problem.add_bound(0, {5.0, 5.0});
  problem.add_row(std::array{0.0, -2.0}, {0.0, 0.0}, 0.5);
  return problem;
}

TEST(Explanation, ListsLevelsAndRowsThatAct) {
  const Problem problem = example();
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  ActiveSet active;
  solver.solve(problem, {}, active, solution);
  const std::string head = to_string(problem, solution);
  EXPECT_EQ(head.substr(head.find(';')),
            "; 2 variables, 5 rows, 3 levels\n"
            "level  rows equal  held  violated  freedom        slack\n"
            "    0     2     0     1         0        2            0  optimal\n"
            "    1     1     1     0         0        1            0  optimal\n"
            "    2     2     0     0         2        0      4.47214  optimal, blocked by row 0\n"
            "row 0 (level 0): x0 in [-inf, 1]: held at its upper bound, value 1\n"
            "row 3 (level 2): x0 = 5: violated, too small by 4, value 1\n"
            "row 4 (level 2): -2 x1 = 0, weight 0.5: violated, too small by 4, value -4\n");
  EXPECT_EQ(head.find("solved: "), 0U);

  std::vector<double> mu(5);
  const double remainder = solver.multipliers(problem, {}, solution, 2, mu);
  const std::string text = to_string(problem, 2, mu, remainder);
  EXPECT_NE(text.find("multipliers of level 2"), std::string::npos) << text;
  EXPECT_NE(text.find("\n            6  row 0 (level 0): x0 in [-inf, 1]\n"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("row 1"), std::string::npos) << text;
}

TEST(Explanation, NamesTheFirstBadRowAndWhatIsIgnored) {
  Problem problem = example();
  problem.set_bounds(2, {4.0, 3.0});
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  ActiveSet active;
  solver.solve(problem, {}, active, solution);
  const std::string text = to_string(problem, solution);
  EXPECT_EQ(text.find("bad row: "), 0U) << text;
  EXPECT_NE(text.find("\nrow 2 (level 1): x0 + x1 in [4, 3]: lb must not be above ub\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("    1     1  ignored\n    2     2  ignored\n"), std::string::npos) << text;
  EXPECT_NE(text.find("    0     2     0     0         0        2            0  optimal\n"),
            std::string::npos)
      << text;
}

TEST(Explanation, ListsLevelsThatAreNotOptimal) {
  const Problem problem = example();
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  ActiveSet active;
  solver.solve(problem, {.max_iterations = 1}, active, solution);
  ASSERT_EQ(solution.status, Status::kIterationLimit);
  const std::string text = to_string(problem, solution);
  EXPECT_EQ(text.find("iteration limit: 1 active set tried"), 0U) << text;
  EXPECT_NE(text.find("  not optimal"), std::string::npos) << text;
}

TEST(Explanation, ShortensRows) {
  Problem problem(kCapacity);
  problem.add_level();
  problem.add_row(std::array{-1.0, 0.0, 1.0, -0.5, std::nan(""), 1e-9, 2.0, 3.0, 4.0}, {0.0, 1.0});
  problem.add_row(std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {0.0, 0.0}, 2.0);
  EXPECT_EQ(to_string(problem, 0),
            "row 0 (level 0): -x0 + x2 - 0.5 x3 + nan x4 + 1e-09 x5 + 2 x6 + ... in [0, 1]");
  EXPECT_EQ(to_string(problem, 1), "row 1 (level 0): 0 = 0, weight 2");
}

TEST(Explanation, ListsOptions) {
  EXPECT_EQ(
      to_string(SolverOptions{.max_iterations = 7}),
      "rank_tolerance 1e-09, feasibility_tolerance 1e-10, max_iterations 7, freedom left goes "
      "to the smallest |x|");
}

}  // namespace
}  // namespace hg::hqp
