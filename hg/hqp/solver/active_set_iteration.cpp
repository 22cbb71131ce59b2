#include "hg/hqp/solver/active_set_iteration.h"

#include <algorithm>
#include <cmath>

namespace hg::hqp::solver {
namespace {

// Remainder of a gradient, relative to its terms, up to which Gauss elimination has cancelled it.
constexpr double kSmallRest = 1e-10;
// Variables per step from the first point, docs/concepts/hqp.md: more such steps are faster where
// few rows are active, and slower where many are.
constexpr int kVariablesPerEarlyStep = 6;
// Remainder of a gradient, relative to its terms, of a level that counts as optimal by its values.
constexpr double kOptimalRest = 1e-7;
constexpr double kSameSlack = 1e-9;  // share of 1 + slack up to which two points are equally good
constexpr double kZeroStep = 1e-9;   // share of the step below which it counts as zero

// The smallest |x| is a level below all others.
bool wants_smallest_norm(const Problem& problem, const SolverOptions& options,
                         int levels) noexcept {
  return options.minimum_norm && levels == problem.levels();
}

double bound_of(Interval bounds, RowState state) noexcept {
  return as_guess(state) == RowState::kLower ? bounds.lb : bounds.ub;
}

// Writes the rows of the level that the guess has at a bound into `targets`.
void collect_active(const Problem& problem, int level, const std::vector<RowState>& states,
                    std::vector<TargetRow>& targets) noexcept {
  targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = states[row];
    if (state == RowState::kInactive || problem.norm(row) == 0.0) continue;
    targets.push_back({row, bound_of(problem.bounds(row), state)});
  }
}

// Computes the point of the guess by Gauss elimination, from the first level on whose guess has
// changed. Returns false when ranks are in doubt, or when rows leave freedom that no level uses.
bool eliminate_by_gauss(const Problem& problem, const SolverOptions& options, int levels,
                        Factors& factors, Iterate& iterate,
                        std::vector<TargetRow>& targets) noexcept {
  GaussElimination& gauss = factors.gauss;
  std::vector<int>& ranks = factors.gauss_rank_at_level;
  if (factors.gauss_levels == 0) {
    gauss.reset(problem);
  } else {
    gauss.truncate(ranks[factors.gauss_levels]);
  }
  for (int& level = factors.gauss_levels; level < levels; ++level) {
    ranks[level] = gauss.rank();
    factors.fit[level] = Fit::kNoFreedom;
    if (gauss.freedom() == 0) continue;
    collect_active(problem, level, iterate.state, targets);
    if (!gauss.add_least_squares(problem, targets, options.rank_tolerance)) return false;
    factors.fit[level] = gauss.is_met() ? Fit::kMet : Fit::kLeastSquares;
  }
  ranks[levels] = gauss.rank();
  factors.fit[levels] = gauss.freedom() > 0 ? Fit::kLeastSquares : Fit::kNoFreedom;
  if (gauss.freedom() > 0) {
    if (!wants_smallest_norm(problem, options, levels)) return false;
    gauss.add_smallest_norm(problem);
  }

  if (!gauss.find_point(iterate.x.data())) return false;
  iterate.x_norm = iterate.x.head(problem.variables()).norm();
  std::copy_n(ranks.begin(), levels + 1, iterate.rank_at_level.begin());
  return std::isfinite(iterate.x_norm);
}

// Computes the point of the guess by Householder reflections; false when it is not finite.
bool eliminate_by_householder(const Problem& problem, const SolverOptions& options, int levels,
                              Factors& factors, Iterate& iterate, std::vector<TargetRow>& targets,
                              Eigen::VectorXd& direction) noexcept {
  const int n = problem.variables();
  HouseholderQr& householder = factors.householder;
  householder.reset(n);
  iterate.x.head(n).setZero();
  iterate.x_norm = 0.0;

  for (int level = 0; level < levels; ++level) {
    iterate.rank_at_level[level] = householder.rank();
    if (householder.freedom() == 0) continue;
    collect_active(problem, level, iterate.state, targets);
    if (targets.empty()) continue;
    householder.add_least_squares(problem, targets, iterate.x.data(), options.rank_tolerance);
    if (!move(problem, householder.step(), 1.0, iterate)) return false;
  }
  iterate.rank_at_level[levels] = householder.rank();
  if (wants_smallest_norm(problem, options, levels) && householder.freedom() > 0) {
    householder.project_to_free(iterate.x.data(), direction.data());
    if (!move(problem, direction, -1.0, iterate)) return false;
  }
  return true;
}

bool is_inequality_pivot(const Factors& factors, const Iterate& iterate, int t) noexcept {
  return is_at_bound(iterate.state[factors.pivot_row(t)]);
}

// Computes multipliers of the first `rank` pivots that cancel duals.gradient, and writes those from
// `first_inequality` on into duals.mu. Returns false when they do not cancel it.
bool find_multipliers(const Problem& problem, const SolverOptions& options,
                      const LevelGradient& size, int rank, int first_inequality, Factors& factors,
                      Duals& duals) noexcept {
  const int n = problem.variables();
  double rest = 0.0;
  double small_rest = kSmallRest;
  if (factors.is_gauss) {
    rest = factors.gauss.find_multipliers(duals.gradient.data(), rank, first_inequality,
                                          duals.mu.data());
  } else {
    for (int t = rank - 1; t >= 0; --t) {
      const VectorView column(factors.householder.column(t), n);
      duals.mu[t] = -column.dot(duals.gradient.head(n)) / factors.householder.pivot(t);
      add_multiple(problem, factors.pivot_row(t), duals.mu[t], duals.gradient.data());
    }
    rest = duals.gradient.head(n).cwiseAbs().maxCoeff();
    // Remainder that dependent rows may leave
    small_rest = std::max(kSmallRest, options.rank_tolerance);
  }
  return rest <= small_rest * size.scale + size.rounding;
}

// Fixes the active inequalities whose multiplier is surely positive. Returns the row with the most
// negative multiplier, -1: none.
int check_multipliers(const Problem& problem, const LevelGradient& size, int level,
                      int first_inequality, Workspace& work) noexcept {
  int row_to_release = -1;
  double largest = 0.0;
  double most_negative = size.surely_negative();
  for (int t = work.iterate.rank_at_level[level] - 1; t >= first_inequality; --t) {
    if (!is_inequality_pivot(work.factors, work.iterate, t)) continue;
    const int row = work.factors.pivot_row(t);
    const double sign = work.iterate.state[row] == RowState::kUpper ? 1.0 : -1.0;
    const double multiplier = sign * work.duals.mu[t] * problem.norm(row);
    if (multiplier > largest) {
      largest = multiplier;
      work.iterate.blocking_row[level] = row;
    }
    if (work.duals.is_fixed_pivot[t]) continue;
    if (multiplier >
        (work.steps.must_stay_active[row] ? size.surely_negative() : size.surely_positive())) {
      work.duals.is_fixed_pivot[t] = true;
    } else if (-multiplier > most_negative) {
      most_negative = -multiplier;
      row_to_release = row;
    }
  }
  return row_to_release;
}

// Computes the gradient of the quadratic piece of the level that the guessed states stand for.
LevelGradient guess_gradient(const Problem& problem, const SolverOptions& options, int level,
                             const Iterate& iterate, Eigen::VectorXd& gradient) noexcept {
  if (level == problem.levels()) return level_gradient(problem, options, level, iterate, gradient);
  LevelGradient result = {.is_zero = true, .scale = 0.0, .rounding = 0.0};
  gradient.head(problem.variables()).setZero();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = iterate.state[row];
    if (state == RowState::kInactive || is_at_bound(state) || problem.norm(row) == 0.0) continue;
    const double bound = bound_of(problem.bounds(row), state);
    if (add_residual(problem, row, bound, iterate, gradient, result) >
        tolerance(problem, options, iterate, row, bound)) {
      result.is_zero = false;
    }
  }
  return result;
}

// Changes the guessed state of a row; factors of the levels above it remain valid.
void set_guess(const Problem& problem, int row, RowState state, Iterate& iterate,
               Factors& factors) noexcept {
  iterate.state[row] = state;
  factors.gauss_levels = std::min(factors.gauss_levels, problem.level_of(row));
}

// Activates the first inactive row that blocks the step from the last point to the new one; false
// when there is none. `length` receives the feasible share of the step.
bool activate_blocking_row(const Problem& problem, const SolverOptions& options, int rows,
                           double& length, Workspace& work) noexcept {
  int blocking_row = -1;
  double distance_there = 0.0;
  length = kInfinity;
  for (int row = 0; row < rows; ++row) {
    if (work.iterate.state[row] != RowState::kInactive) continue;
    const double distance = violation(problem, options, work.iterate, row);
    if (distance == 0.0 || problem.norm(row) == 0.0) continue;
    const double step = work.iterate.value[row] - work.steps.last_value[row];
    const bool was_inside = distance * step > 0.0;
    const double length_of_row = was_inside ? std::max(0.0, 1.0 - distance / step) : 0.0;
    if (length_of_row >= length) continue;
    length = length_of_row;
    blocking_row = row;
    distance_there = distance;
  }
  if (blocking_row < 0) return false;
  if (blocking_row == work.steps.released_row && length <= kZeroStep) {
    work.steps.must_stay_active[blocking_row] = true;
  }
  set_guess(problem, blocking_row, distance_there > 0.0 ? RowState::kUpper : RowState::kLower,
            work.iterate, work.factors);
  return true;
}

// Returns the state of an active row by its value; kInactive: x is inside its bounds.
RowState found_state(const Problem& problem, const SolverOptions& options, int row,
                     const Iterate& iterate) noexcept {
  const double distance = violation(problem, options, iterate, row);
  if (distance != 0.0) return distance > 0.0 ? RowState::kAbove : RowState::kBelow;
  const Interval bounds = problem.bounds(row);
  if (is_equality(bounds)) return RowState::kEqual;
  const double bound = bound_of(bounds, iterate.state[row]);
  if (problem.norm(row) == 0.0 || !reaches(problem, options, iterate, row, bound)) {
    return RowState::kInactive;
  }
  return bound == bounds.lb ? RowState::kLower : RowState::kUpper;
}

// Determines the states of active rows from their values, and releases rows that x is inside of.
// Returns whether the guess has changed.
bool release_inner_rows(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept {
  bool is_changed = false;
  for (int level = 0; level < levels; ++level) {
    bool has_violated = false;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      RowState& state = work.iterate.state[row];
      const bool is_zero = !(problem.norm(row) > 0.0);
      if (state == RowState::kInactive && !is_zero) continue;
      const RowState found = found_state(problem, options, row, work.iterate);
      const bool is_as_guessed =
          is_zero || is_equality(problem.bounds(row)) || as_guess(found) == as_guess(state);
      if (is_as_guessed) {
        state = found;
      } else {
        set_guess(problem, row, found, work.iterate, work.factors);
        is_changed = true;
      }
      has_violated |= is_violated(found) && !is_zero;
    }
    work.levels.has_violated[level] = has_violated;
  }
  return is_changed;
}

// Checks the signs of the multipliers level by level. At the first level with a negative one, the
// row with the most negative one is released.
GuessResult check_levels(const Problem& problem, const SolverOptions& options, int levels,
                         Workspace& work) noexcept {
  const int rank = work.iterate.rank_at_level[levels];
  int first_inequality = 0;
  while (first_inequality < rank &&
         !is_inequality_pivot(work.factors, work.iterate, first_inequality))
    ++first_inequality;
  std::fill_n(work.duals.is_fixed_pivot.begin(), rank, false);

  const int end = wants_smallest_norm(problem, options, levels) ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    work.iterate.blocking_row[level] = -1;
    // a level that should be met is not: Gauss elimination has lost digits
    const Fit fit = work.factors.is_gauss ? work.factors.fit[level] : Fit::kLeastSquares;
    if (work.outcome.is_last_guess) work.outcome.proven_levels = std::min(level, levels);
    if (fit == Fit::kMet && work.levels.has_violated[level]) return GuessResult::kInDoubt;
    const bool has_inequality_pivots = work.iterate.rank_at_level[level] > first_inequality;
    if (!has_inequality_pivots && fit != Fit::kLeastSquares) continue;
    const LevelGradient size =
        guess_gradient(problem, options, level, work.iterate, work.duals.gradient);
    if (size.is_zero) continue;
    if (!find_multipliers(problem, options, size, work.iterate.rank_at_level[level],
                          first_inequality, work.factors, work.duals)) {
      return GuessResult::kInDoubt;
    }
    const int row_to_release = check_multipliers(problem, size, level, first_inequality, work);
    if (row_to_release < 0) continue;
    work.steps.released_row = row_to_release;
    work.steps.released_state = work.iterate.state[row_to_release];
    set_guess(problem, row_to_release, RowState::kInactive, work.iterate, work.factors);
    return GuessResult::kCorrected;
  }
  if (work.outcome.is_last_guess) work.outcome.proven_levels = levels;
  return GuessResult::kProven;
}

GuessResult check_last_guess(const Problem& problem, const SolverOptions& options, int levels,
                             Workspace& work) noexcept;

// One step of the active-set method. The first steps all start at the same point, and release rows
// before they activate others: where few rows are active, one step per row suffices. This could
// cycle; so later steps start at the point reached, and the slacks decrease.
GuessResult check_guess(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept {
  if (work.outcome.is_last_guess) return check_last_guess(problem, options, levels, work);
  const int rows = rows_of(problem, levels);
  const bool is_early = work.steps.count <= problem.variables() / kVariablesPerEarlyStep;
  double length = 1.0;
  if (!is_early) {
    if (activate_blocking_row(problem, options, rows, length, work)) {
      for (int row = 0; row < rows; ++row) {
        work.steps.last_value[row] +=
            length * (work.iterate.value[row] - work.steps.last_value[row]);
      }
      return GuessResult::kCorrected;
    }
    std::copy_n(work.iterate.value.begin(), rows, work.steps.last_value.begin());
  }
  if (release_inner_rows(problem, options, levels, work)) return GuessResult::kCorrected;
  const GuessResult result = check_levels(problem, options, levels, work);
  const bool is_blocked = result == GuessResult::kProven && is_early &&
                          activate_blocking_row(problem, options, rows, length, work);
  return is_blocked ? GuessResult::kCorrected : result;
}

// Determines the states of all rows from their values: a row at its bound is active where it is
// active in the guess.
void read_states(const Problem& problem, const SolverOptions& options, int levels,
                 Iterate& iterate) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    RowState& state = iterate.state[row];
    if (state != RowState::kInactive) {
      state = found_state(problem, options, row, iterate);
    } else if (const double distance = violation(problem, options, iterate, row); distance != 0.0) {
      state = distance > 0.0 ? RowState::kAbove : RowState::kBelow;
    }
  }
}

// Checks a guess that no step follows: writes the number of levels that its point is optimal for
// into work.outcome.proven_levels.
GuessResult check_last_guess(const Problem& problem, const SolverOptions& options, int levels,
                             Workspace& work) noexcept {
  int consistent = levels;
  for (int row = 0; row < rows_of(problem, consistent); ++row) {
    const RowState state = work.iterate.state[row];
    if (problem.norm(row) == 0.0 || is_equality(problem.bounds(row))) continue;
    const bool is_right =
        state == RowState::kInactive
            ? violation(problem, options, work.iterate, row) == 0.0
            : as_guess(found_state(problem, options, row, work.iterate)) == as_guess(state);
    if (!is_right) consistent = problem.level_of(row);
  }
  release_inner_rows(problem, options, consistent,
                     work);  // releases nothing here; determines states
  const GuessResult result = check_levels(problem, options, consistent, work);
  if (result == GuessResult::kCorrected) {
    work.iterate.state[work.steps.released_row] = work.steps.released_state;
  }
  read_states(problem, options, levels, work.iterate);
  if (consistent == levels || result == GuessResult::kInDoubt) return result;
  return GuessResult::kCorrected;
}

RowState state_at_zero(const Problem& problem, int row) noexcept {
  const Interval bounds = problem.bounds(row);
  if (is_equality(bounds)) return RowState::kEqual;
  const double distance = problem.norm(row) > 0.0 ? excess(bounds, 0.0) : 0.0;
  if (distance == 0.0) return RowState::kInactive;
  return distance > 0.0 ? RowState::kUpper : RowState::kLower;
}

bool has_inequality(const Problem& problem, int level) noexcept {
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (!is_equality(problem.bounds(row))) return true;
  }
  return false;
}

}  // namespace

bool load_guess(const Problem& problem, int levels, std::span<const RowState> guess,
                std::vector<RowState>& states) noexcept {
  bool is_empty = true;
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    const Interval bounds = problem.bounds(row);
    RowState& state = states[row];
    if (is_equality(bounds)) {
      state = RowState::kEqual;
      continue;
    }
    state = as_guess(guess[row]);
    if (state == RowState::kInactive) continue;
    // an equality that has become an interval: where |c x| is smaller
    if (state == RowState::kEqual) {
      state = std::abs(bounds.lb) < std::abs(bounds.ub) ? RowState::kLower : RowState::kUpper;
    }
    const bool can_be_active = problem.norm(row) > 0.0 && std::isfinite(bound_of(bounds, state));
    if (!can_be_active) state = RowState::kInactive;
    is_empty &= state == RowState::kInactive;
  }
  return !is_empty;
}

void guess_from_zero(const Problem& problem, int levels, std::vector<RowState>& states) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) states[row] = state_at_zero(problem, row);
}

void start_from_zero(const Problem& problem, Workspace& work) noexcept {
  std::fill_n(work.steps.last_value.begin(), problem.rows(), 0.0);
  work.factors.gauss_levels = 0;
  work.steps.count = 0;
}

void start_from_zero_with(const Problem& problem, std::vector<RowState>& guess,
                          Workspace& work) noexcept {
  int common = work.factors.gauss_levels;
  for (int row = 0; row < rows_of(problem, common); ++row) {
    const bool is_same = is_equality(problem.bounds(row)) ||
                         as_guess(guess[row]) == as_guess(work.iterate.state[row]);
    if (!is_same) common = problem.level_of(row);
  }
  work.iterate.state.swap(guess);
  start_from_zero(problem, work);
  work.factors.gauss_levels = common;
}

void start_solve(const Problem& problem, Workspace& work) noexcept {
  // a guess that ends in doubt computes no values, and those of the last solve are meaningless
  std::fill_n(work.iterate.value.begin(), problem.rows(), 0.0);
  work.iterate.x_norm = 0.0;
  start_from_zero(problem, work);
  work.steps.released_row = -1;
  work.outcome.has_dual_point = false;
  work.outcome.is_last_guess = false;
  work.outcome.proven_levels = 0;
  std::fill_n(work.steps.must_stay_active.begin(), problem.rows(), std::uint8_t{0});
}

int choose_better_point(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept {
  const double* x = work.dual.point().data();
  for (int level = 0; level < levels; ++level) {
    double at_guess = 0.0;
    double at_dual = 0.0;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const Interval bounds = problem.bounds(row);
      const double weight = problem.weight(row);
      const double slack = weight * excess(bounds, work.iterate.value[row]);
      const double dual_slack = weight * excess(bounds, dot(problem, row, x));
      at_guess += slack * slack;
      at_dual += dual_slack * dual_slack;
    }
    const double difference = std::sqrt(at_dual) - std::sqrt(at_guess);
    if (std::abs(difference) <= kSameSlack * (1.0 + std::sqrt(at_guess))) continue;
    if (difference > 0.0) break;
    work.iterate.x.head(problem.variables()) = work.dual.point().head(problem.variables());
    work.iterate.x_norm = work.iterate.x.head(problem.variables()).norm();
    update_values(problem, levels, work.iterate);
    work.outcome.proven_levels = std::min(work.outcome.proven_levels, level);
    break;
  }
  read_states(problem, options, levels, work.iterate);
  return work.outcome.proven_levels;
}

int count_optimal_levels(const Problem& problem, const SolverOptions& options, int levels,
                         Workspace& work) noexcept {
  work.iterate.x_norm = work.iterate.x.head(problem.variables()).norm();
  update_values(problem, levels, work.iterate);
  read_states(problem, options, levels, work.iterate);
  work.factors.householder.reset(problem.variables());
  work.rows_at_bounds.clear();
  const int end = wants_smallest_norm(problem, options, levels) ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    const int rank = work.factors.householder.rank();
    const LevelGradient size =
        level_gradient(problem, options, level, work.iterate, work.duals.gradient);
    if (!size.is_zero) {
      work.nnls.solve(problem, work.rows_at_bounds, work.duals.gradient.data(), size.scale,
                      options.rank_tolerance, work.factors.householder);
      work.factors.householder.project_to_free(work.duals.gradient.data(),
                                               work.search.direction.data());
      work.factors.householder.truncate(rank);
      const double rest = work.search.direction.head(problem.variables()).norm();
      if (!(rest <= kOptimalRest * size.scale + size.rounding)) return level;
    }
    if (level == levels) break;
    collect_targets(problem, options, level, work.iterate, work.targets);
    work.factors.householder.add_least_squares(problem, work.targets, work.iterate.x.data(),
                                               options.rank_tolerance);
    collect_rows_at_bounds(problem, options, level, work.iterate, work.rows_at_bounds);
  }
  return levels + 1;
}

// Whether an inequality of the level is violated, by its state or at the point tried last.
template <typename IsViolated>
bool has_violated_inequality(const Problem& problem, int level, const IsViolated& is_it) noexcept {
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (!is_equality(problem.bounds(row)) && problem.norm(row) > 0.0 && is_it(row)) return true;
  }
  return false;
}

void expect_violated(const Problem& problem, const SolverOptions& options, int levels,
                     std::span<const RowState> last, Workspace& work) noexcept {
  bool has_any = false;
  for (int level = 0; level < levels; ++level) {
    work.levels.expected_violated[level] =
        has_violated_inequality(problem, level, [&](int row) { return is_violated(last[row]); });
    has_any |= work.levels.expected_violated[level] != 0;
  }
  if (has_any) return;
  for (int level = 0; level < levels; ++level) {
    const bool has = has_violated_inequality(problem, level, [&](int row) {
      return violation(problem, options, work.iterate, row) != 0.0;
    });
    work.levels.expected_violated[level] = has && has_any;
    has_any |= has;
  }
}

bool expect_violated_now(const Problem& problem, const SolverOptions& options, int levels,
                         Workspace& work) noexcept {
  bool is_new = false;
  for (int level = 0; level < levels; ++level) {
    const bool has = has_violated_inequality(problem, level, [&](int row) {
      return violation(problem, options, work.iterate, row) != 0.0;
    });
    is_new |= has != (work.levels.expected_violated[level] != 0);
    work.levels.expected_violated[level] = has;
  }
  return is_new;
}

bool start_from_dual(const Problem& problem, const SolverOptions& options, int levels,
                     Workspace& work) noexcept {
  int top = 0;  // number of levels that the guesses so far have in common
  while (top < work.factors.gauss_levels && !has_inequality(problem, top)) ++top;
  if (top == 0) {
    work.factors.gauss.reset(problem);
  } else {
    work.factors.gauss.truncate(work.factors.gauss_rank_at_level[top]);
  }
  work.factors.gauss_levels = top;
  work.outcome.has_dual_point = false;  // the point of an earlier run is overwritten
  if (!work.dual.find_guess(problem, options, levels, top, work.levels.expected_violated,
                            work.factors.gauss, work.iterate.state)) {
    return false;
  }
  const auto found = work.dual.point().head(problem.variables());
  if (!std::isfinite(found.squaredNorm())) return false;
  work.outcome.has_dual_point = true;
  work.steps.count = 0;
  work.steps.released_row = -1;
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    work.steps.last_value[row] = dot(problem, row, work.dual.point().data());
    work.steps.must_stay_active[row] = work.dual.has_positive_multiplier(row);
  }
  return true;
}

// Activates the row released by the last step again, for good, because the step lost all digits.
// Returns false if there is no such row.
bool restore_released_row(const Problem& problem, Workspace& work) noexcept {
  const int row = work.steps.released_row;
  if (row < 0 || work.steps.must_stay_active[row]) return false;
  if (work.iterate.state[row] != RowState::kInactive) return false;
  work.steps.must_stay_active[row] = true;
  set_guess(problem, row, work.steps.released_state, work.iterate, work.factors);
  return true;
}

GuessResult solve_guess(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept {
  ++work.steps.count;
  work.factors.is_gauss =
      eliminate_by_gauss(problem, options, levels, work.factors, work.iterate, work.targets);
  if (work.factors.is_gauss) {
    update_values(problem, levels, work.iterate);
    const GuessResult result = check_guess(problem, options, levels, work);
    if (result != GuessResult::kInDoubt) return result;
    work.factors.is_gauss = false;
  }
  if (!work.outcome.is_last_guess && restore_released_row(problem, work))
    return GuessResult::kCorrected;
  work.factors.gauss_levels = 0;
  if (!eliminate_by_householder(problem, options, levels, work.factors, work.iterate, work.targets,
                                work.search.direction))
    return GuessResult::kInDoubt;
  update_values(problem, levels, work.iterate);
  return check_guess(problem, options, levels, work);
}

}  // namespace hg::hqp::solver
