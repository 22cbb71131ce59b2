#include "hg/hqp/test/random_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/certificate.h"

namespace hg::hqp {
namespace {

constexpr double kSameSlack = 1e-9;  // relative; the slack of every level is unique
constexpr double kSamePoint = 1e-7;  // relative; so is x, but it hangs on the rows' conditioning

struct NamedKind {
  const char* name;
  RandomKind kind;
  std::uint32_t problems = 2000;
  double gap = 1e-6;  ///< largest gap of a level relative to its gradient
};

void PrintTo(const NamedKind& kind, std::ostream* out) { *out << kind.name; }

class RandomProblems : public testing::TestWithParam<NamedKind> {
 protected:
  static constexpr Capacity kCapacity = {.variables = 60, .levels = 20, .rows = 600};

  Solver solver_{kCapacity};
  Solution solution_{kCapacity};
};

TEST_P(RandomProblems, AreSolvedToOptimality) {
  for (std::uint32_t seed = 0; seed < GetParam().problems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, GetParam().kind);
    ActiveSet active;
    ASSERT_EQ(solver_.solve(problem, SolverOptions{}, active, solution_), Status::kSolved);
    ASSERT_EQ(fault_of(problem, {}, solution_, GetParam().gap), "");
  }
}

TEST_P(RandomProblems, HaveOneSolutionWhateverTheGuess) {
  std::mt19937 random(7);
  for (std::uint32_t seed = 0; seed < GetParam().problems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, GetParam().kind);
    ActiveSet active;
    solver_.solve(problem, SolverOptions{}, active, solution_);
    const Solution cold = solution_;

    // from its own active set, and from a random one
    for (int trial = 0; trial < 2; ++trial) {
      ASSERT_EQ(solver_.solve(problem, SolverOptions{}, active, solution_), Status::kSolved);
      ASSERT_EQ(fault_of(problem, {}, solution_, GetParam().gap), "");
      double x_norm = 0.0;
      for (const double x : cold.x) x_norm = std::hypot(x_norm, x);
      for (int i = 0; i < problem.variables(); ++i) {
        ASSERT_NEAR(solution_.x[i], cold.x[i],
                    kSamePoint * x_norm + kSameSlack * GetParam().kind.scale);
      }
      for (std::size_t p = 0; p < cold.levels.size(); ++p) {
        const double slack = std::sqrt(cold.levels[p].slack_squared);
        ASSERT_NEAR(std::sqrt(solution_.levels[p].slack_squared), slack,
                    kSameSlack * (slack + GetParam().kind.scale));
      }
      for (int row = 0; row < problem.rows(); ++row) {
        active.state[row] = static_cast<RowState>(random() % 6);
      }
    }
  }
}

// Rows that differ by little more than rank_tolerance: the point needs an |x| of up to 1e10, and
// which rows are at a bound is a matter of rounding. What is not proven is judged by its values
// before it is called solved. What is left are problems of which two certificates with different
// tolerances say different things.
TEST(NearlyDependentRows, AreNotCalledSolvedWhereTheValuesSayNo) {
  constexpr std::uint32_t kProblems = 1500;
  constexpr int kMostFaults = 18, kMostUnsolved = 11;
  const RandomKind kind = {.noise = 1e-8};
  Solver solver({.variables = 60, .levels = 20, .rows = 600});
  Solution solution({.variables = 60, .levels = 20, .rows = 600});
  int faults = 0, unsolved = 0;
  for (std::uint32_t seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, kind);
    ActiveSet active;
    const Status status = solver.solve(problem, {}, active, solution);
    const std::string fault = fault_of(problem, {}, solution);
    if (status != Status::kSolved) {
      ++unsolved;
      ASSERT_EQ(status, Status::kIterationLimit);
      ASSERT_EQ(fault, "");  // of the levels that are completed
    } else if (!fault.empty()) {
      ++faults;
      // the states are those of the values, whatever has found them
      ASSERT_TRUE(fault.starts_with("level ")) << fault;
    }
  }
  EXPECT_LE(faults, kMostFaults);
  EXPECT_LE(unsolved, kMostUnsolved);
}

INSTANTIATE_TEST_SUITE_P(
    , RandomProblems,
    testing::Values(NamedKind{"ordinary", {}}, NamedKind{"integers", {.has_integers = true}},
                    NamedKind{"badly_scaled", {.row_decades = 1.0}, 5000},
                    // what a nearly dependent row demands beyond the others is not done
                    NamedKind{.name = "nearly_dependent", .kind = {.noise = 1e-12}, .gap = 1e-5},
                    NamedKind{"tiny", {.scale = 1e-9}}, NamedKind{"huge", {.scale = 1e9}},
                    NamedKind{
                        .name = "large",
                        .kind = {.max_variables = 60, .max_levels = 16, .max_rows_per_level = 30},
                        .problems = 100}),
    [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace hg::hqp
