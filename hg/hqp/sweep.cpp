#include "hg/hqp/sweep.h"

#include <cmath>

namespace hg::hqp {
namespace {

// Rest of a gradient, relative to its terms, up to which direct elimination has cancelled it.
constexpr double kSmallRest = 1e-10;

bool is_held_state(RowState state) noexcept {
  return state == RowState::kLower || state == RowState::kUpper;
}

double bound_of(Interval bounds, RowState state) noexcept {
  return state == RowState::kLower || state == RowState::kBelow ? bounds.lb : bounds.ub;
}

// Equality and violated rows of the level, by their state, into work.targets.
void collect_guessed_targets(const Problem& problem, int level, Workspace& work) noexcept {
  work.targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (problem.norm(row) == 0.0) continue;
    const RowState state = work.point.state[at(row)];
    if (state == RowState::kEqual || is_violated(state)) {
      work.targets.push_back({row, bound_of(problem.bounds(row), state)});
    }
  }
}

// Pivots of the level in work.direct; false when in doubt.
bool add_directly(const Problem& problem, const Options& options, int level,
                  Workspace& work) noexcept {
  DirectElimination& direct = work.direct;
  if (direct.freedom() == 0) return true;
  collect_guessed_targets(problem, level, work);
  if (!direct.add_least_squares(problem, work.targets, options.rank_tolerance)) return false;

  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = work.point.state[at(row)];
    if (direct.freedom() == 0) return true;
    if (!is_held_state(state)) continue;
    const TargetRow target = {row, bound_of(problem.bounds(row), state)};
    if (direct.add_row(problem, target, options.rank_tolerance) ==
        DirectElimination::Outcome::kUnsure) {
      return false;
    }
  }
  return true;
}

// The point of the guess by direct elimination, from the first level on whose guess has changed;
// false when in doubt, or when the rows leave freedom.
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
    if (!add_directly(problem, options, level, work)) return false;
  }
  ranks[at(levels)] = direct.rank();
  if (direct.freedom() > 0) return false;

  direct.find_point(work.point.x.data());
  work.x_norm = work.point.x.head(problem.variables()).norm();
  std::copy_n(ranks.begin(), levels + 1, work.point.rank_at_level.begin());
  return std::isfinite(work.x_norm);
}

bool add_held_rows(const Problem& problem, const Options& options, int level,
                   Workspace& work) noexcept {
  Elimination& elimination = work.elimination;
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = work.point.state[at(row)];
    if (elimination.freedom() == 0) return true;
    if (!is_held_state(state)) continue;
    if (!elimination.add_row(problem, row, options.rank_tolerance)) continue;
    const int t = elimination.rank() - 1;
    const double distance =
        bound_of(problem.bounds(row), state) - dot(problem, row, work.point.x.data());
    work.direction.head(problem.variables()) =
        VectorView(elimination.column(t), problem.variables());
    if (!move(problem, work.direction, distance / elimination.pivot(t), work)) return false;
  }
  return true;
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
    collect_guessed_targets(problem, level, work);
    if (!work.targets.empty()) {
      elimination.add_least_squares(problem, work.targets, work.point.x.data(),
                                    options.rank_tolerance);
      if (!move(problem, elimination.step(), 1.0, work)) return false;
    }
    if (!add_held_rows(problem, options, level, work)) return false;
  }
  work.point.rank_at_level[at(levels)] = elimination.rank();
  if (options.minimum_norm && elimination.freedom() > 0) {
    elimination.project_to_free(work.point.x.data(), work.direction.data());
    if (!move(problem, work.direction, -1.0, work)) return false;
  }
  return true;
}

int pivot_row(const Workspace& work, int t) noexcept {
  return work.is_direct ? work.direct.pivot_row(t) : work.elimination.pivot_row(t);
}

bool is_held_pivot(const Workspace& work, int t) noexcept {
  return is_held_state(work.point.state[at(pivot_row(work, t))]);
}

// Multipliers of the pivots above `level` that cancel its gradient, from `first_held` on, into
// work.mu; false when they do not cancel it.
bool find_multipliers(const Problem& problem, const LevelGradient& size, int level, int first_held,
                      Workspace& work) noexcept {
  const int rank = work.point.rank_at_level[at(level)];
  if (work.is_direct) {
    const double rest =
        work.direct.find_multipliers(work.gradient.data(), rank, first_held, work.mu.data());
    return rest <= kSmallRest * size.scale + size.rounding;
  }
  const int n = problem.variables();
  for (int t = rank - 1; t >= first_held; --t) {
    work.mu[t] = -VectorView(work.elimination.column(t), n).dot(work.gradient.head(n)) /
                 work.elimination.pivot(t);
    add_multiple(problem, pivot_row(work, t), work.mu[t], work.gradient.data());
  }
  return true;
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
    if (push > size.surely_pushing()) {
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
    if (problem.norm(row) == 0.0 || state == RowState::kInactive || is_held_state(state)) continue;
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

// State of a row as its value tells, given the state it was solved with.
RowState next_state(const Problem& problem, const Options& options, int row,
                    const Workspace& work) noexcept {
  const Interval bounds = problem.bounds(row);
  const RowState state = work.point.state[at(row)];
  const double distance = violation(problem, options, work, row);
  const RowState outside = distance > 0.0 ? RowState::kAbove : RowState::kBelow;
  const RowState held = distance > 0.0 ? RowState::kUpper : RowState::kLower;

  if (is_equality(bounds) || problem.norm(row) == 0.0) {
    if (distance != 0.0) return outside;
    return is_equality(bounds) ? RowState::kEqual : RowState::kInactive;
  }
  if (state == RowState::kInactive) return distance != 0.0 ? held : state;
  const double bound = bound_of(bounds, state);
  if (distance != 0.0) {
    if (is_held_state(state)) return outside;
    return state == outside ? state : held;
  }
  const bool is_lower = bound == bounds.lb;
  if (!touches(problem, options, work, row, bound)) return RowState::kInactive;
  return is_lower ? RowState::kLower : RowState::kUpper;
}

// Corrects the state of the level's row that is farthest from the bound where the guess has it.
// False when none contradicts its value.
bool correct_row(const Problem& problem, const Options& options, int level,
                 Workspace& work) noexcept {
  int worst_row = -1;
  double worst = -1.0;
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    RowState& state = work.point.state[at(row)];
    const double norm = problem.norm(row);
    const bool is_finding = is_equality(problem.bounds(row)) || norm == 0.0;  // no guess
    if (state == RowState::kInactive && !is_finding) continue;
    const RowState next = next_state(problem, options, row, work);
    if (is_finding) {
      state = next;
    } else if (next != state) {
      const double bound = bound_of(problem.bounds(row), state);
      const double distance = std::abs(work.value[at(row)] - bound) / norm;
      if (distance <= worst) continue;
      worst = distance;
      worst_row = row;
    }
  }
  if (worst_row < 0) return false;
  set_guess(problem, worst_row, next_state(problem, options, worst_row, work), work);
  return true;
}

// Holds the inactive row that is violated most, relative to its size: a limit that is far off
// beside a small one that acts is mostly a consequence. False when none is violated.
bool hold_row(const Problem& problem, const Options& options, int levels,
              Workspace& work) noexcept {
  int worst_row = -1;
  double worst = 0.0;
  const int end = levels > 0 ? problem.end_row(levels - 1) : 0;
  for (int row = 0; row < end; ++row) {
    if (work.point.state[at(row)] != RowState::kInactive || problem.norm(row) == 0.0) continue;
    const double distance = violation(problem, options, work, row);
    if (distance == 0.0) continue;
    const double value = work.value[at(row)];
    const double share = std::abs(distance) / (std::abs(value) + std::abs(value - distance));
    if (share <= worst) continue;
    worst = share;
    worst_row = row;
  }
  if (worst_row < 0) return false;
  set_guess(problem, worst_row, next_state(problem, options, worst_row, work), work);
  return true;
}

enum class Judgement { kProven, kCorrected, kInDoubt };

// Level after level: first rows that are not where the guess has them, then held rows that pull;
// at last violated ones. One row is corrected at a time.
Judgement judge_guess(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept {
  const int rank = work.point.rank_at_level[at(levels)];
  int first_held = 0;
  while (first_held < rank && !is_held_pivot(work, first_held)) ++first_held;
  std::fill_n(work.is_frozen.begin(), rank, false);

  const int end = levels == problem.levels() && options.minimum_norm ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    if (level < levels && correct_row(problem, options, level, work)) return Judgement::kCorrected;
    work.point.blocking_row[at(level)] = -1;
    if (work.point.rank_at_level[at(level)] <= first_held) continue;
    const LevelGradient size = guess_gradient(problem, options, level, work);
    if (size.is_zero) continue;
    if (!find_multipliers(problem, size, level, first_held, work)) return Judgement::kInDoubt;
    const int pulling_row = judge_multipliers(problem, size, level, first_held, work);
    if (pulling_row < 0) continue;
    set_guess(problem, pulling_row, RowState::kInactive, work);
    return Judgement::kCorrected;
  }
  return hold_row(problem, options, levels, work) ? Judgement::kCorrected : Judgement::kProven;
}

}  // namespace

void make_consistent(const Problem& problem, int levels, Workspace& work) noexcept {
  const int end = levels > 0 ? problem.end_row(levels - 1) : 0;
  for (int row = 0; row < end; ++row) {
    const Interval bounds = problem.bounds(row);
    RowState& state = work.point.state[at(row)];
    if (is_equality(bounds)) {
      state = RowState::kEqual;
    } else if (problem.norm(row) == 0.0 || state == RowState::kEqual ||
               !std::isfinite(bound_of(bounds, state))) {
      state = RowState::kInactive;
    }
  }
}

bool solve_guess(const Problem& problem, const Options& options, int levels,
                 Workspace& work) noexcept {
  work.is_direct = eliminate_directly(problem, options, levels, work);
  if (work.is_direct) {
    update_values(problem, levels, work);
    const Judgement judgement = judge_guess(problem, options, levels, work);
    if (judgement != Judgement::kInDoubt) return judgement == Judgement::kProven;
    work.is_direct = false;
  }
  if (!eliminate_orthogonally(problem, options, levels, work)) return false;
  update_values(problem, levels, work);
  return judge_guess(problem, options, levels, work) == Judgement::kProven;
}

}  // namespace hg::hqp
