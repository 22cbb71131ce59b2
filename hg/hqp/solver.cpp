#include "hg/hqp/solver.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "hg/hqp/primal.h"
#include "hg/hqp/sweep.h"
#include "hg/hqp/workspace.h"

namespace hg::hqp {
namespace {

constexpr int kGuesses = 12;  // repairs of the guess before the level-by-level method takes over

int find_bad_row(const Problem& problem) noexcept {
  for (int row = 0; row < problem.rows(); ++row) {
    const auto [lb, ub] = problem.bounds(row);
    const double weight = problem.weight(row);
    const bool is_good = lb <= ub && lb < kInfinity && ub > -kInfinity &&
                         std::isfinite(problem.norm(row)) && std::isfinite(weight) && weight > 0.0;
    if (!is_good) return row;
  }
  return -1;
}

void read_point(const Problem& problem, const Options& options, int levels, Workspace& work,
                Solution& solution) noexcept {
  update_values(problem, levels, work);
  for (int level = 0; level < problem.levels(); ++level) {
    LevelResult& result = solution.levels[at(level)];
    result = {.slack_squared = 0.0, .freedom = 0, .blocking_row = -1};
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const bool is_solved = level < levels;
      solution.state[at(row)] = is_solved ? work.state[at(row)] : RowState::kInactive;
      const double slack = is_solved ? -excess(problem.bounds(row), work.value[at(row)]) : 0.0;
      solution.slack[at(row)] = slack;
      const double weighted = problem.weight(row) * slack;
      if (is_solved) result.slack_squared += weighted * weighted;
    }
    if (level < levels) {
      result.freedom = problem.variables() - work.rank_at_level[at(level)];
      result.blocking_row = work.blocking_row[at(level)];
    }
  }
  std::copy_n(work.x.data(), problem.variables(), solution.x.begin());
  (void)options;
}

}  // namespace

Solver::Solver(const Capacity& capacity) {
  check(capacity);
  workspace_ = std::make_unique<Workspace>(capacity);
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Status Solver::solve(const Problem& problem, const Options& options, ActiveSet& active,
                     Solution& solution) noexcept {
  Workspace& work = *workspace_;
  const int bad_row = find_bad_row(problem);
  const int levels = bad_row < 0 ? problem.levels() : problem.level_of(bad_row);
  solution.x.resize(at(problem.variables()));
  solution.state.resize(at(problem.rows()));
  solution.slack.resize(at(problem.rows()));
  solution.levels.resize(at(problem.levels()));
  solution.bad_row = bad_row;
  solution.bad_level = bad_row < 0 ? -1 : levels;
  solution.iterations = 0;
  solution.completed_levels = 0;
  solution.status = Status::kSolved;

  work.x_norm = 0.0;
  std::copy_n(active.state.begin(), problem.rows(), work.state.begin());
  make_consistent(problem, levels, work);
  bool is_proven = false;
  while (!is_proven && solution.iterations < std::min(kGuesses, options.max_iterations)) {
    is_proven = solve_guess(problem, options, levels, work);
    ++solution.iterations;
  }
  solution.completed_levels = levels;

  if (!is_proven) {
    work.x_norm = 0.0;
    const PrimalOutcome outcome = solve_level_by_level(
        problem, options, levels, solution.iterations, solution.completed_levels, work);
    if (outcome == PrimalOutcome::kIterationLimit) solution.status = Status::kIterationLimit;
    if (outcome == PrimalOutcome::kNotFinite) solution.status = Status::kNumericalFailure;
  }
  if (bad_row >= 0 && solution.status == Status::kSolved) solution.status = Status::kBadRow;

  read_point(problem, options, levels, work, solution);
  std::copy_n(solution.state.begin(), problem.rows(), active.state.begin());
  return solution.status;
}

}  // namespace hg::hqp
