#include "hg/hqp/solver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "hg/hqp/solver/active_set_iteration.h"
#include "hg/hqp/solver/level_by_level.h"
#include "hg/hqp/solver/workspace.h"

namespace hg::hqp {

using namespace solver;

namespace {

// Efforts are counted in direct eliminations.
constexpr int kEffortOfGuess = 2;   // for a guess: the guess itself, and one row more or less
constexpr int kEffortFromZero = 4;  // from x = 0, without a guess
// For a second guess; when it differs more, the dual method is faster
constexpr int kEffortOfSecondGuess = 1;
constexpr int kEffortOfDual = 2;       // almost always right; where it gives up: from zero
constexpr int kEffort = 32;            // total limit, plus kEffortPerVariable per variable
constexpr int kEffortPerVariable = 2;  // beyond the total limit a cycle is assumed
constexpr double kFar = 10.0;          // |x| of the dual method's point beside that of the result
constexpr int kClosing = 4;  // active sets per level after the budget, if the dual method gave up
constexpr int kOrthogonalEffort = 4;  // effort of one orthogonal elimination
// Effort to prove the result of that method, which is almost always right
constexpr int kProofEffort = 12;

// Aborts on misuse by the caller, which would overwrite memory.
void require(bool is_right, const char* what) noexcept {
  if (is_right) return;
  std::fprintf(stderr, "hqp: %s\n", what);
  std::abort();
}

int find_bad_row(const Problem& problem) noexcept {
  const int rows = problem.rows();
  for (int row = 0; row < rows; ++row) {
    if (broken_rule(problem, row) != nullptr) return row;
  }
  return -1;
}

// Whether the point tried last violates more rows than the one that has become active since.
bool misses_rows(const Problem& problem, const SolverOptions& options, int levels,
                 const Workspace& work) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    if (work.iterate.state[row] == RowState::kInactive && problem.norm(row) > 0.0 &&
        violation(problem, options, work.iterate, row) != 0.0) {
      return true;
    }
  }
  return false;
}

// Whether `other` repeats rows of `guess` that later tries have corrected.
bool repeats_mistake(const Problem& problem, int levels, const std::vector<RowState>& guess,
                     const std::vector<RowState>& other, const Workspace& work) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    if (is_equality(problem.bounds(row)) || other[row] != guess[row]) continue;
    if (as_guess(work.iterate.state[row]) != guess[row]) return true;
  }
  return false;
}

// Tries the guess in work.iterate.state and its corrections until one is proven, or `max_effort` is
// spent, or `iterations` reaches `max_iterations`.
bool try_guesses(const Problem& problem, const SolverOptions& options, int levels, int max_effort,
                 int max_iterations, int& iterations, Workspace& work) noexcept {
  int effort = 0;
  while (effort < max_effort && iterations < max_iterations) {
    ++iterations;
    const GuessResult result = solve_guess(problem, options, levels, work);
    if (result == GuessResult::kProven) return true;
    if (result == GuessResult::kInDoubt) return false;
    effort += work.factors.is_gauss ? 1 : kOrthogonalEffort;
  }
  return false;
}

// The guesses of `active`, then that of the dual method, then the method from zero.
bool solve_by_guesses(const Problem& problem, const SolverOptions& options, const ActiveSet& active,
                      int levels, int& iterations, Workspace& work) noexcept {
  std::vector<RowState>& guess = work.iterate.state;
  const int effort_from_zero = kEffort + kEffortPerVariable * problem.variables();
  // the other half is for the method that completes level by level
  const int half = (options.max_iterations + 1) / 2;
  const int max_iterations = options.budget > 0 ? std::min(options.budget, half) : half;
  const auto try_for = [&](int effort) {
    return try_guesses(problem, options, levels, effort, max_iterations, iterations, work);
  };
  std::vector<RowState>& first = work.saved.state;
  std::vector<RowState>& second = work.second_guess;
  const int rows = rows_of(problem, levels);
  // a solution has only inactive rows only if x = 0, which is where a cold start begins
  const bool has_first = std::any_of(active.state.begin(), active.state.begin() + rows,
                                     [](RowState state) { return state != RowState::kInactive; });
  load_guess(problem, levels, active.state, guess);
  if (!has_first) guess_from_zero(problem, levels, guess);
  start_solve(problem, work);
  for (int i = 0; i < (has_first ? kEffortOfGuess : kEffortFromZero); ++i) {
    if (try_for(1)) return true;
    if (has_first && misses_rows(problem, options, levels, work)) break;
  }
  load_guess(problem, levels, active.state, first);
  const bool has_second = load_guess(problem, levels, active.before, second);
  if (has_second && !std::equal(first.begin(), first.begin() + rows, second.begin()) &&
      !repeats_mistake(problem, levels, first, second, work)) {
    start_from_zero_with(problem, second, work);
    if (try_for(kEffortOfSecondGuess)) return true;
  }
  expect_violated(problem, options, levels, active.state, work);
  bool has_guess = start_from_dual(problem, options, levels, work);
  if (has_guess && try_for(kEffortOfDual)) return true;
  // if the levels with violated inequalities were not the expected ones: again with those of the
  // last point
  const bool has_time = options.budget == 0 || iterations < options.budget;
  if (has_time && expect_violated_now(problem, options, levels, work)) {
    has_guess = start_from_dual(problem, options, levels, work);
    if (has_guess && try_for(kEffortOfDual)) return true;
  }
  if (has_guess) {
    if (options.budget == 0 || iterations < options.budget) return false;
    work.outcome.is_last_guess = true;
    const int last = std::min(options.budget + 1, options.max_iterations);
    return try_guesses(problem, options, levels, 1, last, iterations, work);
  }
  guess_from_zero(problem, levels, second);
  start_from_zero_with(problem, second, work);
  return try_for(effort_from_zero);
}

// Level by level, and the proof of what that finds. `levels` becomes the number of levels that are
// optimal.
Status complete_levels(const Problem& problem, const SolverOptions& options, int all_levels,
                       int& levels, int& iterations, Workspace& work) noexcept {
  const LevelOutcome outcome =
      solve_level_by_level(problem, options, all_levels, iterations, levels, work);
  if (outcome == LevelOutcome::kIterationLimit) return Status::kIterationLimit;
  if (outcome == LevelOutcome::kNotFinite) return Status::kNumericalFailure;

  // tolerances are relative to the largest x on the way: from a distant start they were too large
  const double x_norm = work.iterate.x.head(problem.variables()).norm();
  const bool came_from_afar = work.outcome.has_dual_point && work.iterate.x_norm > kFar * x_norm;

  // the same active set always gives the same bits, however it was found
  work.saved = work.iterate.point();
  load_guess(problem, levels, work.saved.state, work.iterate.state);
  start_from_zero(problem, work);
  std::copy_n(work.iterate.value.begin(), problem.rows(), work.steps.last_value.begin());
  if (!try_guesses(problem, options, levels, kProofEffort, options.max_iterations, iterations,
                   work)) {
    if (came_from_afar) {
      work.outcome.has_dual_point = false;
      return complete_levels(problem, options, all_levels, levels, iterations, work);
    }
    work.iterate.point() = work.saved;
    const int optimal = count_optimal_levels(problem, options, all_levels, work);
    levels = std::min(optimal, all_levels);
    if (optimal <= all_levels) {
      const bool is_finite =
          std::isfinite(work.duals.gradient.head(problem.variables()).squaredNorm());
      return is_finite ? Status::kIterationLimit : Status::kNumericalFailure;
    }
  }
  return Status::kSolved;
}

// Leaves the result in work; `levels` becomes the number of levels that are optimal.
Status solve_levels(const Problem& problem, const SolverOptions& options, const ActiveSet& active,
                    int& levels, int& iterations, Workspace& work) noexcept {
  const int all_levels = levels;
  if (solve_by_guesses(problem, options, active, levels, iterations, work)) return Status::kSolved;

  SolverOptions limited = options;
  if (options.budget > 0) {
    if (work.outcome.is_last_guess) {
      levels = choose_better_point(problem, options, all_levels, work);
      if (levels > 0) return Status::kIterationLimit;
    }
    work.outcome.is_last_guess = false;
    limited.max_iterations =
        std::min(options.max_iterations, options.budget + kClosing * all_levels);
  }
  return complete_levels(problem, limited, all_levels, levels, iterations, work);
}

// Receives the states of a solution; its previous states are kept as the second guess when they
// differ.
void update(const Problem& problem, const std::vector<RowState>& state,
            ActiveSet& active) noexcept {
  if (std::memcmp(state.data(), active.state.data(), state.size()) == 0) return;
  bool is_same = true;
  for (int row = 0; row < problem.rows() && is_same; ++row) {
    is_same =
        is_equality(problem.bounds(row)) || as_guess(state[row]) == as_guess(active.state[row]);
  }
  if (!is_same) std::copy_n(active.state.begin(), problem.rows(), active.before.begin());
  std::copy_n(state.begin(), problem.rows(), active.state.begin());
}

// Needs work.iterate.value.
void read_levels(const Problem& problem, int levels, const Workspace& work,
                 Solution& solution) noexcept {
  for (int level = 0; level < levels; ++level) {
    double slack_squared = 0.0;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const double slack = -excess(problem.bounds(row), work.iterate.value[row]);
      const double weighted = problem.weight(row) * slack;
      solution.state[row] = work.iterate.state[row];
      solution.slack[row] = slack;
      slack_squared += weighted * weighted;
    }
    solution.levels[level] = {.slack_squared = slack_squared,
                              .freedom = problem.variables() - work.iterate.rank_at_level[level],
                              .blocking_row = work.iterate.blocking_row[level]};
  }
  std::copy_n(work.iterate.x.data(), problem.variables(), solution.x.begin());

  const int rows = rows_of(problem, levels);
  std::fill(solution.state.begin() + rows, solution.state.end(), RowState::kInactive);
  std::fill(solution.slack.begin() + rows, solution.slack.end(), 0.0);
  std::fill(solution.levels.begin() + levels, solution.levels.end(), LevelResult{});
}

}  // namespace

Solver::Solver(const Capacity& capacity) {
  check_capacity(capacity);
  workspace_ = std::make_unique<Workspace>(capacity);
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Status Solver::solve(const Problem& problem, const SolverOptions& options, ActiveSet& active,
                     Solution& solution) noexcept {
  Workspace& work = *workspace_;
  require(problem.variables() <= work.iterate.x.size() &&
              problem.levels() < static_cast<int>(work.iterate.rank_at_level.size()) &&
              problem.rows() <= static_cast<int>(work.iterate.state.size()),
          "the problem is larger than the capacity of the solver");
  require(std::cmp_less_equal(problem.variables(), solution.x.capacity()) &&
              std::cmp_less_equal(problem.rows(), solution.slack.capacity()) &&
              std::cmp_less_equal(problem.levels(), solution.levels.capacity()),
          "the problem is larger than the capacity of the solution");
  const int bad_row = find_bad_row(problem);
  const int levels = bad_row < 0 ? problem.levels() : problem.level_of(bad_row);

  solution.x.resize(problem.variables());
  solution.state.resize(problem.rows());
  solution.slack.resize(problem.rows());
  solution.levels.resize(problem.levels());
  solution.bad_row = bad_row;
  solution.bad_level = bad_row < 0 ? -1 : levels;
  solution.iterations = 0;
  solution.completed_levels = levels;

  solution.status =
      solve_levels(problem, options, active, solution.completed_levels, solution.iterations, work);
  if (bad_row >= 0 && solution.status == Status::kSolved) solution.status = Status::kBadRow;

  read_levels(problem, levels, work, solution);
  for (int level = 0; level < solution.completed_levels; ++level) {
    if (std::isfinite(solution.levels[level].slack_squared)) continue;
    solution.status = Status::kNumericalFailure;
    solution.completed_levels = level;
  }
  work.budgets_spent += options.budget > 0 && solution.status == Status::kIterationLimit;
  update(problem, solution.state, active);
  return solution.status;
}

std::uint64_t Solver::budgets_spent() const noexcept { return workspace_->budgets_spent; }

double Solver::multipliers(const Problem& problem, const SolverOptions& options,
                           const Solution& solution, int level, std::span<double> mu) noexcept {
  require(level >= 0 && level < problem.levels(), "no such level to have multipliers");
  require(static_cast<int>(mu.size()) == problem.rows(), "multipliers need a number per row");
  Workspace& work = *workspace_;
  const int n = problem.variables();
  std::fill(mu.begin(), mu.end(), 0.0);
  std::copy_n(solution.x.begin(), n, work.iterate.x.data());
  work.iterate.x_norm = work.iterate.x.head(n).norm();
  update_values(problem, level + 1, work.iterate);

  // rows of higher levels: those with multipliers of either sign first, then those at one bound
  HouseholderQr& elimination = work.factors.householder;
  elimination.reset(n);
  work.rows_at_bounds.clear();
  for (int above = 0; above < level; ++above) {
    collect_targets(problem, options, above, work.iterate, work.targets);
    elimination.add_least_squares(problem, work.targets, work.iterate.x.data(),
                                  options.rank_tolerance);
    collect_rows_at_bounds(problem, options, above, work.iterate, work.rows_at_bounds);
  }
  const int two_sided = elimination.rank();
  const LevelGradient size =
      level_gradient(problem, options, level, work.iterate, work.duals.gradient);
  work.nnls.solve(problem, work.rows_at_bounds, work.duals.gradient.data(), size.scale,
                  options.rank_tolerance, elimination);
  for (int i = 0; i < work.nnls.size(); ++i) {
    const auto [row, sign] = work.nnls.row(i);
    mu[row] = sign * work.nnls.mu(i);
    add_multiple(problem, row, mu[row], work.duals.gradient.data());
  }
  for (int t = two_sided - 1; t >= 0; --t) {
    const int row = elimination.pivot_row(t);
    mu[row] = -VectorView(elimination.column(t), n).dot(work.duals.gradient.head(n)) /
              elimination.pivot(t);
    add_multiple(problem, row, mu[row], work.duals.gradient.data());
  }
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const double factor = problem.weight(row) * problem.weight(row);
    mu[row] = factor * excess(problem.bounds(row), work.iterate.value[row]);
  }
  return work.duals.gradient.head(n).norm();
}

}  // namespace hg::hqp
