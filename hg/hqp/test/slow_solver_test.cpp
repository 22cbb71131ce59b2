#include "hg/hqp/test/slow_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp {
namespace {

constexpr double kSameSlack = 1e-9;  // relative to slack and bounds
constexpr double kSamePoint = 1e-7;  // relative to |x|, times what errors of rows do to it

struct NamedKind {
  const char* name;
  RandomKind kind;
  std::uint32_t problems = 500;
  double doubtful = 0.02;  ///< largest share of ill-posed problems
};

void PrintTo(const NamedKind& kind, std::ostream* out) { *out << kind.name; }

TEST(SolveSlowly, GivesHigherLevelsWhatTheyWantFirst) {
  Problem problem({.variables = 2, .levels = 3, .rows = 4});
  problem.add_level();
  problem.add_bound(0, {-kInfinity, 0.5});
  problem.add_level();
  problem.add_bound(0, {1.0, 1.0}, 1.0);  // blocked
  problem.add_bound(1, {-kInfinity, -1.0}, 2.0);
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0}, {2.0, kInfinity});
  const SlowSolution slow = solve_slowly(problem, true);
  EXPECT_EQ(slow.doubt, "");
  EXPECT_NEAR(slow.x[0], 0.5, 1e-12);
  EXPECT_NEAR(slow.x[1], -1.0, 1e-12);
  EXPECT_NEAR(slow.slack_norms[0], 0.0, 1e-12);
  EXPECT_NEAR(slow.slack_norms[1], 0.5, 1e-12);
  EXPECT_NEAR(slow.slack_norms[2], 2.5, 1e-12);
}

TEST(SolveSlowly, ReportsNearlyDependentRows) {
  Problem problem({.variables = 2, .levels = 2, .rows = 2});
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0}, {1.0, 1.0});
  problem.add_level();
  problem.add_row(std::vector{1.0, 1.0 + 1e-9}, {2.0, 2.0});
  EXPECT_EQ(solve_slowly(problem, true).doubt.substr(0, 11), "a free part");
}

class SecondOpinion : public testing::TestWithParam<NamedKind> {};

TEST_P(SecondOpinion, IsTheSame) {
  const Capacity capacity = {.variables = 60, .levels = 20, .rows = 600};
  Solver solver(capacity);
  Solution solution(capacity);
  const double scale = GetParam().kind.scale;
  std::uint32_t doubtful = 0;
  for (std::uint32_t seed = 0; seed < GetParam().problems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, GetParam().kind);
    const bool minimum_norm = seed % 4 != 0;
    const SlowSolution slow = solve_slowly(problem, minimum_norm);
    if (!slow.doubt.empty()) {
      ++doubtful;
      continue;
    }
    ActiveSet active;
    ASSERT_EQ(solver.solve(problem, {.minimum_norm = minimum_norm}, active, solution),
              Status::kSolved);
    for (std::size_t p = 0; p < slow.slack_norms.size(); ++p) {
      ASSERT_NEAR(std::sqrt(solution.levels[p].slack_squared), slow.slack_norms[p],
                  kSameSlack * (slow.slack_norms[p] + scale))
          << "level " << p;
    }
    if (!minimum_norm) continue;
    const double x_norm =
        Eigen::Map<const Eigen::VectorXd>(slow.x.data(), problem.variables()).norm();
    for (std::size_t i = 0; i < slow.x.size(); ++i) {
      ASSERT_NEAR(solution.x[i], slow.x[i], kSamePoint * (x_norm + scale)) << "variable " << i;
    }
  }
  EXPECT_LE(doubtful, GetParam().doubtful * GetParam().problems);
}

INSTANTIATE_TEST_SUITE_P(
    , SecondOpinion,
    testing::Values(
        NamedKind{"small", {.max_variables = 4, .max_levels = 5, .max_rows_per_level = 4}, 1000},
        NamedKind{"ordinary", {.max_variables = 8, .max_levels = 6, .max_rows_per_level = 6}, 500},
        NamedKind{
            "integers",
            {.max_variables = 6, .max_levels = 6, .max_rows_per_level = 6, .has_integers = true},
            1000},
        NamedKind{
            "many_rows", {.max_variables = 3, .max_levels = 4, .max_rows_per_level = 12}, 300},
        NamedKind{
            "badly_scaled",
            {.max_variables = 6, .max_levels = 5, .max_rows_per_level = 6, .row_decades = 1.0},
            500,
            0.2},
        NamedKind{"tiny", {.max_variables = 6, .max_levels = 5, .scale = 1e-9}, 100},
        NamedKind{"huge", {.max_variables = 6, .max_levels = 5, .scale = 1e9}, 100},
        NamedKind{
            "medium", {.max_variables = 20, .max_levels = 8, .max_rows_per_level = 12}, 60, 0.1}),
    [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace hg::hqp
