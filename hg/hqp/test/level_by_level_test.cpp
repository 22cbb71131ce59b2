#include "hg/hqp/solver/level_by_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp::solver {
namespace {

struct NamedKind {
  const char* name;
  RandomKind kind;
  std::uint32_t problems;
};

void PrintTo(const NamedKind& kind, std::ostream* out) { *out << kind.name; }

// Solver::solve() hardly ever comes to this method: here it solves everything.
class LevelByLevel : public testing::TestWithParam<NamedKind> {
 protected:
  LevelOutcome solve(const Problem& problem) {
    iterations_ = 0;
    const LevelOutcome outcome =
        solve_level_by_level(problem, options_, problem.levels(), iterations_, completed_, work_);
    solution_.status =
        outcome == LevelOutcome::kOptimal ? Status::kSolved : Status::kIterationLimit;
    solution_.iterations = iterations_;
    solution_.completed_levels = completed_;
    solution_.levels.resize(problem.levels());
    solution_.x.assign(work_.iterate.x.data(), work_.iterate.x.data() + problem.variables());
    solution_.state.assign(work_.iterate.state.begin(),
                           work_.iterate.state.begin() + problem.rows());
    solution_.slack.clear();
    for (int row = 0; row < problem.rows(); ++row) {
      solution_.slack.push_back(-excess(problem.bounds(row), work_.iterate.value[row]));
    }
    return outcome;
  }

  SolverOptions options_;
  Workspace work_{{.variables = 60, .levels = 20, .rows = 600}};
  Solution solution_{{.variables = 60, .levels = 20, .rows = 600}};
  int iterations_ = 0;
  int completed_ = 0;
};

TEST_P(LevelByLevel, SolvesRandomProblems) {
  int most = 0;
  for (std::uint32_t seed = 0; seed < GetParam().problems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, GetParam().kind);
    ASSERT_EQ(solve(problem), LevelOutcome::kOptimal);
    ASSERT_EQ(fault_of(problem, options_, solution_), "");
    most = std::max(most, iterations_);
  }
  EXPECT_LT(most, 300);
}

TEST_P(LevelByLevel, StopsWithTheLevelsThatAreDone) {
  for (std::uint32_t seed = 0; seed < GetParam().problems / 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, GetParam().kind);
    for (options_.max_iterations = 1; options_.max_iterations < 20; options_.max_iterations += 3) {
      solve(problem);
      ASSERT_EQ(fault_of(problem, options_, solution_), "") << options_.max_iterations;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, LevelByLevel,
                         testing::Values(NamedKind{"ordinary", {}, 1000},
                                         NamedKind{"integers", {.has_integers = true}, 2000},
                                         NamedKind{"badly_scaled", {.row_decades = 1.0}, 500},
                                         NamedKind{.name = "large",
                                                   .kind = {.max_variables = 60,
                                                            .max_levels = 16,
                                                            .max_rows_per_level = 30},
                                                   .problems = 20}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace hg::hqp::solver
