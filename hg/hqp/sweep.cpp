#include "hg/hqp/sweep.h"

#include <algorithm>
#include <cmath>

namespace hg::hqp {
namespace {

// Rest of a gradient, relative to its terms, up to which direct elimination has cancelled it.
constexpr double kSmallRest = 1e-10;
// Steps from the first point, docs/concepts/hqp.md: more help where few rows act, and harm where
// many do.
constexpr int kVariablesPerEarlyStep = 6;
// Rest of a gradient, relative to its terms, of a level that counts as optimal by values alone.
constexpr double kOptimalRest = 1e-7;
constexpr double kSameSlack = 1e-9;  // share of 1 + slack up to which two points are equally good
constexpr double kNoWay = 1e-9;      // share of the step below which it counts as zero

// The smallest |x| is a level below all others.
bool wants_smallest_norm(const Problem& problem, const Options& options, int levels) noexcept {
  return options.minimum_norm && levels == problem.levels();
}

double bound_of(Interval bounds, RowState state) noexcept {
  return as_guess(state) == RowState::kLower ? bounds.lb : bounds.ub;
}

// Rows of the level that the guess has at a bound, into work.targets.
void collect_active(const Problem& problem, int level, Workspace& work) noexcept {
  work.targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = work.point.state[at(row)];
    if (state == RowState::kInactive || problem.norm(row) == 0.0) continue;
    work.targets.push_back({row, bound_of(problem.bounds(row), state)});
  }
}

// The point of the guess by direct elimination, from the first level on whose guess has changed;
// false when in doubt, or when rows leave freedom that no level uses.
bool eliminate_directly(const Problem& problem, const Options& options, int levels,
                        Workspace& work) noexcept {
  DirectElimination& direct = work.direct;
  std::vector<int>& ranks = work.direct_rank_at_level;
  if (work.direct_levels == 0) {
    direct.reset(problem);
  } else {
    direct.truncate(ranks[at(work.direct_levels)]);
  }
  for (int& level = work.direct_levels; level < levels; ++level) {
    ranks[at(level)] = direct.rank();
    work.fit[at(level)] = Fit::kFrozen;
    if (direct.freedom() == 0) continue;
    collect_active(problem, level, work);
    if (!direct.add_least_squares(problem, work.targets, options.rank_tolerance)) return false;
    work.fit[at(level)] = direct.is_met() ? Fit::kMet : Fit::kLeastSquares;
  }
  ranks[at(levels)] = direct.rank();
  work.fit[at(levels)] = direct.freedom() > 0 ? Fit::kLeastSquares : Fit::kFrozen;
  if (direct.freedom() > 0) {
    if (!wants_smallest_norm(problem, options, levels)) return false;
    direct.add_smallest_norm(problem);
  }

  if (!direct.find_point(work.point.x.data())) return false;
  work.x_norm = work.point.x.head(problem.variables()).norm();
  std::copy_n(ranks.begin(), levels + 1, work.point.rank_at_level.begin());
  return std::isfinite(work.x_norm);
}

// The point of the guess by orthogonal elimination; false when it is not finite.
bool eliminate_orthogonally(const Problem& problem, const Options& options, int levels,
                            Workspace& work) noexcept {
  const int n = problem.variables();
  Elimination& elimination = work.elimination;
  elimination.reset(n);
  work.point.x.head(n).setZero();
  work.x_norm = 0.0;

  for (int level = 0; level < levels; ++level) {
    work.point.rank_at_level[at(level)] = elimination.rank();
    if (elimination.freedom() == 0) continue;
    collect_active(problem, level, work);
    if (work.targets.empty()) continue;
    elimination.add_least_squares(problem, work.targets, work.point.x.data(),
                                  options.rank_tolerance);
    if (!move(problem, elimination.step(), 1.0, work)) return false;
  }
  work.point.rank_at_level[at(levels)] = elimination.rank();
  if (wants_smallest_norm(problem, options, levels) && elimination.freedom() > 0) {
    elimination.project_to_free(work.point.x.data(), work.direction.data());
    if (!move(problem, work.direction, -1.0, work)) return false;
  }
  return true;
}

int pivot_row(const Workspace& work, int t) noexcept {
  return work.is_direct ? work.direct.pivot_row(t) : work.elimination.pivot_row(t);
}

bool is_held_pivot(const Workspace& work, int t) noexcept {
  return is_held(work.point.state[at(pivot_row(work, t))]);
}

// Multipliers of the pivots above `level` that cancel its gradient, from `first_held` on, into
// work.mu; false when they do not cancel it.
bool find_multipliers(const Problem& problem, const Options& options, const LevelGradient& size,
                      int level, int first_held, Workspace& work) noexcept {
  const int n = problem.variables();
  const int rank = work.point.rank_at_level[at(level)];
  double rest = 0.0;
  double small_rest = kSmallRest;
  if (work.is_direct) {
    rest = work.direct.find_multipliers(work.gradient.data(), rank, first_held, work.mu.data());
  } else {
    for (int t = rank - 1; t >= 0; --t) {
      const VectorView column(work.elimination.column(t), n);
      work.mu[t] = -column.dot(work.gradient.head(n)) / work.elimination.pivot(t);
      add_multiple(problem, pivot_row(work, t), work.mu[t], work.gradient.data());
    }
    rest = work.gradient.head(n).cwiseAbs().maxCoeff();
    // Remainder that dependent rows may leave
    small_rest = std::max(kSmallRest, options.rank_tolerance);
  }
  return rest <= small_rest * size.scale + size.rounding;
}

// Freezes those held rows that push against the level; returns the one that pulls most, -1: none.
int judge_multipliers(const Problem& problem, const LevelGradient& size, int level, int first_held,
                      Workspace& work) noexcept {
  int pulling_row = -1;
  double largest_push = 0.0;
  double largest_pull = size.surely_pulling();
  for (int t = work.point.rank_at_level[at(level)] - 1; t >= first_held; --t) {
    if (!is_held_pivot(work, t)) continue;
    const int row = pivot_row(work, t);
    const double sign = work.point.state[at(row)] == RowState::kUpper ? 1.0 : -1.0;
    const double push = sign * work.mu[t] * problem.norm(row);
    if (push > largest_push) {
      largest_push = push;
      work.point.blocking_row[at(level)] = row;
    }
    if (work.is_frozen[at(t)]) continue;
    if (push > (work.is_needed[at(row)] ? size.surely_pulling() : size.surely_pushing())) {
      work.is_frozen[at(t)] = true;
    } else if (-push > largest_pull) {
      largest_pull = -push;
      pulling_row = row;
    }
  }
  return pulling_row;
}

// Gradient of the level as guessed: of the quadratic piece that the states stand for.
LevelGradient guess_gradient(const Problem& problem, const Options& options, int level,
                             Workspace& work) noexcept {
  if (level == problem.levels()) return level_gradient(problem, options, level, work);
  LevelGradient result = {.is_zero = true, .scale = 0.0, .rounding = 0.0};
  work.gradient.head(problem.variables()).setZero();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = work.point.state[at(row)];
    if (state == RowState::kInactive || is_held(state) || problem.norm(row) == 0.0) continue;
    const double bound = bound_of(problem.bounds(row), state);
    if (add_pull(problem, row, bound, work, result) >
        tolerance(problem, options, work, row, bound)) {
      result.is_zero = false;
    }
  }
  return result;
}

// A guess that differs from the last one in this row.
void set_guess(const Problem& problem, int row, RowState state, Workspace& work) noexcept {
  work.point.state[at(row)] = state;
  work.direct_levels = std::min(work.direct_levels, problem.level_of(row));
}

// Holds the first inactive row that blocks the step from the last point to the new one; false when
// there is none. `way` receives the feasible share of the step.
bool hold_obstacle(const Problem& problem, const Options& options, int rows, double& way,
                   Workspace& work) noexcept {
  int obstacle = -1;
  double distance_there = 0.0;
  way = kInfinity;
  for (int row = 0; row < rows; ++row) {
    if (work.point.state[at(row)] != RowState::kInactive) continue;
    const double distance = violation(problem, options, work, row);
    if (distance == 0.0 || problem.norm(row) == 0.0) continue;
    const double step = work.value[at(row)] - work.last_value[at(row)];
    const bool was_inside = distance * step > 0.0;
    const double way_of_row = was_inside ? std::max(0.0, 1.0 - distance / step) : 0.0;
    if (way_of_row >= way) continue;
    way = way_of_row;
    obstacle = row;
    distance_there = distance;
  }
  if (obstacle < 0) return false;
  if (obstacle == work.released_row && way <= kNoWay) work.is_needed[at(obstacle)] = true;
  set_guess(problem, obstacle, distance_there > 0.0 ? RowState::kUpper : RowState::kLower, work);
  return true;
}

// State of an active row by its value; kInactive: it is inside.
RowState found_state(const Problem& problem, const Options& options, int row,
                     const Workspace& work) noexcept {
  const double distance = violation(problem, options, work, row);
  if (distance != 0.0) return distance > 0.0 ? RowState::kAbove : RowState::kBelow;
  const Interval bounds = problem.bounds(row);
  if (is_equality(bounds)) return RowState::kEqual;
  const double bound = bound_of(bounds, work.point.state[at(row)]);
  if (problem.norm(row) == 0.0 || !touches(problem, options, work, row, bound)) {
    return RowState::kInactive;
  }
  return bound == bounds.lb ? RowState::kLower : RowState::kUpper;
}

// Reads the states of active rows from their values, and releases those that x is inside of. True
// when the guess has changed.
bool drop_rows(const Problem& problem, const Options& options, int levels,
               Workspace& work) noexcept {
  bool is_changed = false;
  for (int level = 0; level < levels; ++level) {
    bool has_violated = false;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      RowState& state = work.point.state[at(row)];
      const bool is_zero = !(problem.norm(row) > 0.0);
      if (state == RowState::kInactive && !is_zero) continue;
      const RowState found = found_state(problem, options, row, work);
      const bool is_as_guessed =
          is_zero || is_equality(problem.bounds(row)) || as_guess(found) == as_guess(state);
      if (is_as_guessed) {
        state = found;
      } else {
        set_guess(problem, row, found, work);
        is_changed = true;
      }
      has_violated |= is_violated(found) && !is_zero;
    }
    work.has_violated[at(level)] = has_violated;
  }
  return is_changed;
}

// Level after level: whether held rows push against it. Releases the one that pulls most.
Judgement judge_levels(const Problem& problem, const Options& options, int levels,
                       Workspace& work) noexcept {
  const int rank = work.point.rank_at_level[at(levels)];
  int first_held = 0;
  while (first_held < rank && !is_held_pivot(work, first_held)) ++first_held;
  std::fill_n(work.is_frozen.begin(), rank, false);

  const int end = wants_smallest_norm(problem, options, levels) ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    work.point.blocking_row[at(level)] = -1;
    // a level that should be met is not: direct elimination has lost digits
    const Fit fit = work.is_direct ? work.fit[at(level)] : Fit::kLeastSquares;
    if (work.is_last) work.proven_levels = std::min(level, levels);
    if (fit == Fit::kMet && work.has_violated[at(level)]) return Judgement::kInDoubt;
    const bool can_push = work.point.rank_at_level[at(level)] > first_held;
    if (!can_push && fit != Fit::kLeastSquares) continue;
    const LevelGradient size = guess_gradient(problem, options, level, work);
    if (size.is_zero) continue;
    if (!find_multipliers(problem, options, size, level, first_held, work)) {
      return Judgement::kInDoubt;
    }
    const int pulling_row = judge_multipliers(problem, size, level, first_held, work);
    if (pulling_row < 0) continue;
    work.released_row = pulling_row;
    work.released_state = work.point.state[at(pulling_row)];
    set_guess(problem, pulling_row, RowState::kInactive, work);
    return Judgement::kCorrected;
  }
  if (work.is_last) work.proven_levels = levels;
  return Judgement::kProven;
}

Judgement judge_last(const Problem& problem, const Options& options, int levels,
                     Workspace& work) noexcept;

// One step of an active-set method. The first steps all start at the same point, and release rows
// before they hold others: where few rows act, that is one step for each. It could cycle, so after
// that the last point moves, and the slacks fall.
Judgement judge_guess(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept {
  if (work.is_last) return judge_last(problem, options, levels, work);
  const int rows = rows_of(problem, levels);
  const bool is_early = work.steps <= problem.variables() / kVariablesPerEarlyStep;
  double way = 1.0;
  if (!is_early) {
    if (hold_obstacle(problem, options, rows, way, work)) {
      for (int row = 0; row < rows; ++row) {
        work.last_value[at(row)] += way * (work.value[at(row)] - work.last_value[at(row)]);
      }
      return Judgement::kCorrected;
    }
    std::copy_n(work.value.begin(), rows, work.last_value.begin());
  }
  if (drop_rows(problem, options, levels, work)) return Judgement::kCorrected;
  const Judgement judgement = judge_levels(problem, options, levels, work);
  const bool is_blocked = judgement == Judgement::kProven && is_early &&
                          hold_obstacle(problem, options, rows, way, work);
  return is_blocked ? Judgement::kCorrected : judgement;
}

// States of all rows by their values: a row at its bound is held where the guess says so.
void read_states(const Problem& problem, const Options& options, int levels,
                 Workspace& work) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    RowState& state = work.point.state[at(row)];
    if (state != RowState::kInactive) {
      state = found_state(problem, options, row, work);
    } else if (const double distance = violation(problem, options, work, row); distance != 0.0) {
      state = distance > 0.0 ? RowState::kAbove : RowState::kBelow;
    }
  }
}

// No step follows: how many levels the point is optimal for, into work.proven_levels.
Judgement judge_last(const Problem& problem, const Options& options, int levels,
                     Workspace& work) noexcept {
  int settled = levels;
  for (int row = 0; row < rows_of(problem, settled); ++row) {
    const RowState state = work.point.state[at(row)];
    if (problem.norm(row) == 0.0 || is_equality(problem.bounds(row))) continue;
    const bool is_right =
        state == RowState::kInactive
            ? violation(problem, options, work, row) == 0.0
            : as_guess(found_state(problem, options, row, work)) == as_guess(state);
    if (!is_right) settled = problem.level_of(row);
  }
  drop_rows(problem, options, settled, work);  // has nothing to drop, but reads states
  const Judgement judgement = judge_levels(problem, options, settled, work);
  if (judgement == Judgement::kCorrected) {
    work.point.state[at(work.released_row)] = work.released_state;
  }
  read_states(problem, options, levels, work);
  if (settled == levels || judgement == Judgement::kInDoubt) return judgement;
  return Judgement::kCorrected;
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
    RowState& state = states[at(row)];
    if (is_equality(bounds)) {
      state = RowState::kEqual;
      continue;
    }
    state = as_guess(guess[at(row)]);
    if (state == RowState::kInactive) continue;
    // an equality that has become an interval: where |c x| is smaller
    if (state == RowState::kEqual) {
      state = std::abs(bounds.lb) < std::abs(bounds.ub) ? RowState::kLower : RowState::kUpper;
    }
    const bool can_be_held = problem.norm(row) > 0.0 && std::isfinite(bound_of(bounds, state));
    if (!can_be_held) state = RowState::kInactive;
    is_empty &= state == RowState::kInactive;
  }
  return !is_empty;
}

void guess_from_zero(const Problem& problem, int levels, std::vector<RowState>& states) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) states[at(row)] = state_at_zero(problem, row);
}

bool is_guess_from_zero(const Problem& problem, int levels,
                        const std::vector<RowState>& states) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    if (states[at(row)] != state_at_zero(problem, row)) return false;
  }
  return true;
}

void start_from_zero(const Problem& problem, Workspace& work) noexcept {
  std::fill_n(work.last_value.begin(), problem.rows(), 0.0);
  work.direct_levels = 0;
  work.steps = 0;
}

void start_from_zero_with(const Problem& problem, std::vector<RowState>& guess,
                          Workspace& work) noexcept {
  int kept = work.direct_levels;
  for (int row = 0; row < rows_of(problem, kept); ++row) {
    const bool is_same = is_equality(problem.bounds(row)) ||
                         as_guess(guess[at(row)]) == as_guess(work.point.state[at(row)]);
    if (!is_same) kept = problem.level_of(row);
  }
  work.point.state.swap(guess);
  start_from_zero(problem, work);
  work.direct_levels = kept;
}

void start_solve(const Problem& problem, Workspace& work) noexcept {
  // a try that ends in doubt leaves values alone: those of the last solve say nothing
  std::fill_n(work.value.begin(), problem.rows(), 0.0);
  work.x_norm = 0.0;
  start_from_zero(problem, work);
  work.released_row = -1;
  work.has_dual_point = false;
  work.is_last = false;
  work.proven_levels = 0;
  std::fill_n(work.is_needed.begin(), problem.rows(), std::uint8_t{0});
}

int take_better_point(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept {
  const double* x = work.dual.point().data();
  for (int level = 0; level < levels; ++level) {
    double at_guess = 0.0;
    double at_dual = 0.0;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const Interval bounds = problem.bounds(row);
      const double weight = problem.weight(row);
      const double slack = weight * excess(bounds, work.value[at(row)]);
      const double dual_slack = weight * excess(bounds, dot(problem, row, x));
      at_guess += slack * slack;
      at_dual += dual_slack * dual_slack;
    }
    const double difference = std::sqrt(at_dual) - std::sqrt(at_guess);
    if (std::abs(difference) <= kSameSlack * (1.0 + std::sqrt(at_guess))) continue;
    if (difference > 0.0) break;
    work.point.x.head(problem.variables()) = work.dual.point().head(problem.variables());
    work.x_norm = work.point.x.head(problem.variables()).norm();
    update_values(problem, levels, work);
    work.proven_levels = std::min(work.proven_levels, level);
    break;
  }
  read_states(problem, options, levels, work);
  return work.proven_levels;
}

int count_optimal_levels(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept {
  work.x_norm = work.point.x.head(problem.variables()).norm();
  update_values(problem, levels, work);
  read_states(problem, options, levels, work);
  work.elimination.reset(problem.variables());
  work.touched.clear();
  const int end = wants_smallest_norm(problem, options, levels) ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    const int rank = work.elimination.rank();
    const LevelGradient size = level_gradient(problem, options, level, work);
    if (!size.is_zero) {
      work.cone.solve(problem, work.touched, work.gradient.data(), size.scale,
                      options.rank_tolerance, work.elimination);
      work.elimination.project_to_free(work.gradient.data(), work.direction.data());
      work.elimination.truncate(rank);
      const double rest = work.direction.head(problem.variables()).norm();
      if (!(rest <= kOptimalRest * size.scale + size.rounding)) return level;
    }
    if (level == levels) break;
    collect_targets(problem, options, level, work);
    work.elimination.add_least_squares(problem, work.targets, work.point.x.data(),
                                       options.rank_tolerance);
    collect_touched(problem, options, level, work);
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

void expect_violated(const Problem& problem, const Options& options, int levels,
                     std::span<const RowState> last, Workspace& work) noexcept {
  bool has_any = false;
  for (int level = 0; level < levels; ++level) {
    work.gives_way[at(level)] = has_violated_inequality(
        problem, level, [&](int row) { return is_violated(last[at(row)]); });
    has_any |= work.gives_way[at(level)] != 0;
  }
  if (has_any) return;
  for (int level = 0; level < levels; ++level) {
    const bool has = has_violated_inequality(
        problem, level, [&](int row) { return violation(problem, options, work, row) != 0.0; });
    work.gives_way[at(level)] = has && has_any;
    has_any |= has;
  }
}

bool expect_violated_now(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept {
  bool is_new = false;
  for (int level = 0; level < levels; ++level) {
    const bool has = has_violated_inequality(
        problem, level, [&](int row) { return violation(problem, options, work, row) != 0.0; });
    is_new |= has != (work.gives_way[at(level)] != 0);
    work.gives_way[at(level)] = has;
  }
  return is_new;
}

bool start_from_dual(const Problem& problem, const Options& options, int levels,
                     Workspace& work) noexcept {
  int top = 0;  // number of levels that the guesses so far have in common
  while (top < work.direct_levels && !has_inequality(problem, top)) ++top;
  if (top == 0) {
    work.direct.reset(problem);
  } else {
    work.direct.truncate(work.direct_rank_at_level[at(top)]);
  }
  work.direct_levels = top;
  work.has_dual_point = false;  // the point of a run before is overwritten
  if (!work.dual.find_guess(problem, options, levels, top, work.gives_way, work.direct,
                            work.point.state)) {
    return false;
  }
  const auto found = work.dual.point().head(problem.variables());
  if (!std::isfinite(found.squaredNorm())) return false;
  work.has_dual_point = true;
  work.steps = 0;
  work.released_row = -1;
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    work.last_value[at(row)] = dot(problem, row, work.dual.point().data());
    work.is_needed[at(row)] = work.dual.is_pushing(row);
  }
  return true;
}

// If the last step released a row and lost all digits thereby, the row is held again permanently.
bool take_back(const Problem& problem, Workspace& work) noexcept {
  const int row = work.released_row;
  if (row < 0 || work.is_needed[at(row)]) return false;
  if (work.point.state[at(row)] != RowState::kInactive) return false;
  work.is_needed[at(row)] = true;
  set_guess(problem, row, work.released_state, work);
  return true;
}

Judgement solve_guess(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept {
  ++work.steps;
  work.is_direct = eliminate_directly(problem, options, levels, work);
  if (work.is_direct) {
    update_values(problem, levels, work);
    const Judgement judgement = judge_guess(problem, options, levels, work);
    if (judgement != Judgement::kInDoubt) return judgement;
    work.is_direct = false;
  }
  if (!work.is_last && take_back(problem, work)) return Judgement::kCorrected;
  work.direct_levels = 0;
  if (!eliminate_orthogonally(problem, options, levels, work)) return Judgement::kInDoubt;
  update_values(problem, levels, work);
  return judge_guess(problem, options, levels, work);
}

}  // namespace hg::hqp
