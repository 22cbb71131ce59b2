#include "hg/hqp/sweep.h"

#include <cmath>

namespace hg::hqp {
namespace {

bool is_held_state(RowState state) noexcept {
  return state == RowState::kLower || state == RowState::kUpper;
}

double bound_of(Interval bounds, RowState state) noexcept {
  return state == RowState::kLower || state == RowState::kBelow ? bounds.lb : bounds.ub;
}

void add_least_squares_rows(const Problem& problem, const Options& options, int level,
                            Workspace& work) noexcept {
  work.targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (problem.norm(row) == 0.0) continue;
    const RowState state = work.point.state[at(row)];
    if (state == RowState::kEqual || is_violated(state)) {
      work.targets.push_back({row, bound_of(problem.bounds(row), state)});
    }
  }
  if (work.targets.empty()) return;
  Elimination& elimination = work.elimination;
  const int first = elimination.rank();
  elimination.add_least_squares(problem, work.targets, work.point.x.data(), options.rank_tolerance);
  std::fill(work.is_held.begin() + first, work.is_held.begin() + elimination.rank(), false);
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
    work.is_held[at(t)] = true;
    work.is_frozen[at(t)] = false;
    const double distance =
        bound_of(problem.bounds(row), state) - dot(problem, row, work.point.x.data());
    work.direction.head(problem.variables()) =
        VectorView(elimination.column(t), problem.variables());
    if (!move(problem, work.direction, distance / elimination.pivot(t), work)) return false;
  }
  return true;
}

// The lexicographic least-squares point of the guess; false when it is not finite.
bool eliminate(const Problem& problem, const Options& options, int levels,
               Workspace& work) noexcept {
  const int n = problem.variables();
  Elimination& elimination = work.elimination;
  elimination.reset(n);
  work.point.x.head(n).setZero();
  work.x_norm = 0.0;

  for (int level = 0; level < levels; ++level) {
    work.point.rank_at_level[at(level)] = elimination.rank();
    if (elimination.freedom() == 0) continue;
    const int first = elimination.rank();
    add_least_squares_rows(problem, options, level, work);
    if (elimination.rank() > first && !move(problem, elimination.step(), 1.0, work)) return false;
    if (!add_held_rows(problem, options, level, work)) return false;
  }
  work.point.rank_at_level[at(levels)] = elimination.rank();
  if (options.minimum_norm && elimination.freedom() > 0) {
    elimination.project_to_free(work.point.x.data(), work.direction.data());
    if (!move(problem, work.direction, -1.0, work)) return false;
  }
  return true;
}

// Multipliers of one level, from its last higher pivot to the first held one. Releases rows that
// pull and freezes those that push; returns the number of releases.
int check_multipliers(const Problem& problem, const LevelGradient& size, int level, int first_held,
                      Workspace& work) noexcept {
  const int n = problem.variables();
  const Elimination& elimination = work.elimination;
  int releases = 0;
  double largest_push = 0.0;
  for (int t = work.point.rank_at_level[at(level)] - 1; t >= first_held; --t) {
    const int row = elimination.pivot_row(t);
    const double mu =
        -VectorView(elimination.column(t), n).dot(work.gradient.head(n)) / elimination.pivot(t);
    add_multiple(problem, row, mu, work.gradient.data());
    if (!work.is_held[at(t)]) continue;

    const double sign = work.point.state[at(row)] == RowState::kUpper ? 1.0 : -1.0;
    const double push = sign * mu * problem.norm(row);
    if (push > largest_push) {
      largest_push = push;
      work.point.blocking_row[at(level)] = row;
    }
    if (work.is_frozen[at(t)]) continue;
    if (push > size.surely_pushing()) {
      work.is_frozen[at(t)] = true;
    } else if (push < -size.surely_pulling()) {
      work.point.state[at(row)] = RowState::kInactive;
      ++releases;
    }
  }
  return releases;
}

int check_all_multipliers(const Problem& problem, const Options& options, int levels,
                          Workspace& work) noexcept {
  const auto held_begin = work.is_held.begin();
  const auto held_end = held_begin + work.elimination.rank();
  const int first_held = static_cast<int>(std::find(held_begin, held_end, true) - held_begin);

  int releases = 0;
  const int end = levels == problem.levels() && options.minimum_norm ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    work.point.blocking_row[at(level)] = -1;
    if (work.point.rank_at_level[at(level)] <= first_held) continue;
    const LevelGradient size = level_gradient(problem, options, level, work);
    if (!size.is_zero) releases += check_multipliers(problem, size, level, first_held, work);
  }
  return releases;
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

// Corrects the state of the row that is farthest off, of the highest level where one is off: rows
// of lower levels may only follow from it. False when no state contradicts its value.
bool correct_worst_row(const Problem& problem, const Options& options, int levels,
                       Workspace& work) noexcept {
  for (int level = 0; level < levels; ++level) {
    int worst_row = -1;
    double worst = -1.0;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const RowState next = next_state(problem, options, row, work);
      RowState& state = work.point.state[at(row)];
      const double norm = problem.norm(row);
      if (is_equality(problem.bounds(row)) || norm == 0.0) {
        state = next;  // no guess, only a finding
      } else if (next != state) {
        const double distance = std::abs(excess(problem.bounds(row), work.value[at(row)])) / norm;
        if (distance <= worst) continue;
        worst = distance;
        worst_row = row;
      }
    }
    if (worst_row < 0) continue;
    work.point.state[at(worst_row)] = next_state(problem, options, worst_row, work);
    return true;
  }
  return false;
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
  if (!eliminate(problem, options, levels, work)) return false;
  update_values(problem, levels, work);

  if (correct_worst_row(problem, options, levels, work)) return false;
  return check_all_multipliers(problem, options, levels, work) == 0;
}

}  // namespace hg::hqp
