#include "hg/hqp/primal.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hg::hqp {
namespace {

constexpr double kParallel = 1e-12;    // cosine below which a direction does not change a row
constexpr double kResolution = 1e-16;  // share of |x| below which a step does not change x
// Share of the tolerance that counts as a gain, near the optimum
constexpr double kCorrection = 1e-3;
constexpr int kExchangesPerRow = 3;  // rows released in a corner, per row that meets there
// Steps of a level for which the held rows are chosen anew each time. After these a row is held
// until x is the minimum over the held rows: mostly slower, but no set of rows recurs.
constexpr int kFreeStepsPerVariable = 1;

// Sides of a row that do not stop a step, as bits.
constexpr std::uint8_t kUpperSide = 1;
constexpr std::uint8_t kLowerSide = 2;
constexpr std::uint8_t kBothSides = kUpperSide | kLowerSide;

std::uint8_t side_of(const TouchedRow& t) noexcept {
  return t.sign > 0.0 ? kUpperSide : kLowerSide;
}

class LevelByLevel {
 public:
  LevelByLevel(const Problem& problem, const Options& options, int levels, int& iterations,
               Workspace& work) noexcept
      : problem_(problem),
        options_(options),
        levels_(levels),
        n_(problem.variables()),
        iterations_(iterations),
        work_(work) {}

  PrimalOutcome run(int& completed) noexcept;

 private:
  enum class Aim { kAhead, kOptimal, kIterationLimit };

  PrimalOutcome optimise(int level) noexcept;
  void fix(int level) noexcept;
  void release_untouched() noexcept;
  RowState state_of_fixed(int row) const noexcept;
  void collect_pulling(int level) noexcept;
  bool aim(int level) noexcept;
  void hold_rows(int level) noexcept;
  int find_pulling_row(bool take_first) noexcept;
  int touched_obstacle(int level) const noexcept;
  Aim aim_past_obstacles(int level) noexcept;
  void find_slopes(int level) noexcept;
  bool gains(int level, double length) const noexcept;
  double way_to_obstacle(int level, int& obstacle) const noexcept;
  double best_length(int level, double longest) const noexcept;
  bool is_norm_level(int level) const noexcept { return level == problem_.levels(); }
  int end_of_levels_above(int level) const noexcept {
    return level > 0 ? problem_.end_row(level - 1) : 0;
  }

  const Problem& problem_;
  const Options& options_;
  const int levels_;
  const int n_;
  int& iterations_;
  Workspace& work_;
  LevelGradient size_ = {};
  int base_ = 0;               ///< pivots of the levels above
  int steps_ = 0;              ///< of this level
  bool is_held_back_ = false;  ///< the last level was settled by the rows of work_.held
};

PrimalOutcome LevelByLevel::run(int& completed) noexcept {
  const int end = rows_of(problem_, levels_);
  std::fill_n(work_.point.state.begin(), end, RowState::kInactive);
  std::fill_n(work_.is_fixed.begin(), end, false);
  if (work_.has_dual_point) {
    work_.point.x.head(n_) = work_.dual.point().head(n_);
  } else {
    work_.point.x.head(n_).setZero();
  }
  work_.x_norm = work_.point.x.head(n_).norm();
  work_.elimination.reset(n_);
  update_values(problem_, levels_, work_);

  for (completed = 0; completed < levels_; ++completed) {
    const PrimalOutcome outcome = optimise(completed);
    if (outcome != PrimalOutcome::kOptimal) {
      const auto ranks = work_.point.rank_at_level.begin();
      std::fill(ranks + completed, ranks + levels_ + 1, base_);
      std::fill_n(work_.point.blocking_row.begin() + completed, levels_ - completed, -1);
      release_untouched();
      return outcome;
    }
    fix(completed);
  }
  PrimalOutcome outcome = PrimalOutcome::kOptimal;
  if (options_.minimum_norm && levels_ == problem_.levels()) {
    outcome = optimise(problem_.levels());
    fix(problem_.levels());
  }
  release_untouched();
  return outcome;
}

// Rows of the level that pull at x: the quadratic piece of its objective that x is on.
void LevelByLevel::collect_pulling(int level) noexcept {
  work_.targets.clear();
  for (int row = problem_.first_row(level); row < problem_.end_row(level); ++row) {
    const auto [lb, ub] = problem_.bounds(row);
    const double value = work_.value[at(row)];
    const bool is_pulling = problem_.norm(row) > 0.0 && (lb == ub || value < lb || value > ub);
    if (is_pulling) work_.targets.push_back({row, value < lb ? lb : ub});
  }
}

// Direction to the minimum of the level's quadratic piece within the free columns; false when its
// gain is negligible.
bool LevelByLevel::aim(int level) noexcept {
  Elimination& elimination = work_.elimination;
  if (elimination.freedom() == 0) return false;
  if (is_norm_level(level)) {
    elimination.project_to_free(work_.point.x.data(), work_.direction.data());
    work_.direction.head(n_) *= -1.0;
    find_slopes(level);
    return gains(level, 1.0);
  }
  const int rank = elimination.rank();
  elimination.add_least_squares(problem_, work_.targets, work_.point.x.data(),
                                options_.rank_tolerance);
  elimination.truncate(rank);
  work_.direction.head(n_) = elimination.step().head(n_);
  find_slopes(level);
  return gains(level, 1.0);
}

// Whether a step of `length` along the direction changes a slack of the level's objective by more
// than the tolerance.
bool LevelByLevel::gains(int level, double length) const noexcept {
  const double share = work_.has_dual_point ? kCorrection : 1.0;
  if (is_norm_level(level)) {
    return length * work_.direction.head(n_).norm() >
           share * options_.feasibility_tolerance * work_.x_norm;
  }
  return std::any_of(work_.targets.begin(), work_.targets.end(), [&](const TargetRow& t) {
    return std::abs(length * work_.slope[at(t.row)]) >
           share * tolerance(problem_, options_, work_, t.row, t.target);
  });
}

// c d of all rows that matter to the level, into work_.slope; 0 where it is only rounding or, for
// rows of the level, the free part of a dependent row.
void LevelByLevel::find_slopes(int level) noexcept {
  const int end = is_norm_level(level) ? problem_.rows() : problem_.end_row(level);
  const double direction_norm = work_.direction.head(n_).norm();
  for (int row = 0; row < end; ++row) {
    const double slope = dot(problem_, row, work_.direction.data());
    const double parallel = row < end_of_levels_above(level) ? kParallel : options_.rank_tolerance;
    const bool is_none = std::abs(slope) <= parallel * problem_.norm(row) * direction_norm;
    work_.slope[at(row)] = is_none ? 0.0 : slope;
  }
}

// Length along the direction until a row of a higher level blocks it.
double LevelByLevel::way_to_obstacle(int level, int& obstacle) const noexcept {
  double way = kInfinity;
  obstacle = -1;
  for (int row = 0; row < end_of_levels_above(level); ++row) {
    const double slope = work_.slope[at(row)];
    if (work_.is_fixed[at(row)] || slope == 0.0) continue;
    if (work_.skipped_sides[at(row)] & (slope > 0.0 ? kUpperSide : kLowerSide)) continue;
    const auto [lb, ub] = problem_.bounds(row);
    const double distance = slope > 0.0 ? ub - work_.value[at(row)] : work_.value[at(row)] - lb;
    const double way_of_row = std::max(0.0, distance) / std::abs(slope);
    if (way_of_row < way) {
      way = way_of_row;
      obstacle = row;
    }
  }
  return way;
}

// Minimum of the level's objective along the direction, a convex piecewise quadratic, up to
// `longest`: proceeds from kink to kink until its derivative is positive.
double LevelByLevel::best_length(int level, double longest) const noexcept {
  if (is_norm_level(level)) {
    const double d_d = work_.direction.head(n_).squaredNorm();
    return std::min(longest, -work_.direction.head(n_).dot(work_.point.x.head(n_)) / d_d);
  }
  const int first = problem_.first_row(level);
  const int end = problem_.end_row(level);
  double length = 0.0;
  for (int piece = 0; piece <= 2 * (end - first); ++piece) {
    double derivative = 0.0;
    double curvature = 0.0;
    double kink = kInfinity;
    for (int row = first; row < end; ++row) {
      const double slope = work_.slope[at(row)];
      if (slope == 0.0) continue;
      const double value = work_.value[at(row)];
      const auto [lb, ub] = problem_.bounds(row);
      const double to_lb = (lb - value) / slope;
      const double to_ub = (ub - value) / slope;
      const double in = std::min(to_lb, to_ub);
      const double out = std::max(to_lb, to_ub);
      if (in > length) kink = std::min(kink, in);
      if (out > length) kink = std::min(kink, out);
      const bool is_inside = in <= length && length < out;
      if (is_inside) continue;
      const double nearest = length < in ? in : out;
      const double factor = problem_.weight(row) * problem_.weight(row) * slope * slope;
      derivative += factor * (length - nearest);
      curvature += factor;
    }
    if (derivative >= 0.0 || curvature == 0.0) return length;
    const double minimum = length - derivative / curvature;
    length = std::min({minimum, kink, longest});
    if (length == minimum || length == longest) return length;
  }
  return length;
}

// Makes the rows of held the pivots above those of the levels above; what depends on them is not
// held any more.
void LevelByLevel::hold_rows(int level) noexcept {
  Elimination& elimination = work_.elimination;
  elimination.truncate(base_);
  std::fill_n(work_.skipped_sides.begin(), end_of_levels_above(level), std::uint8_t{0});
  std::erase_if(work_.held, [&](const TouchedRow& t) {
    work_.skipped_sides[at(t.row)] = kBothSides;
    return !elimination.add_row(problem_, t.row, options_.rank_tolerance);
  });
}

// Multipliers of the held rows, into work_.mu; returns the one to release, -1 when all push.
int LevelByLevel::find_pulling_row(bool take_first) noexcept {
  const Elimination& elimination = work_.elimination;
  work_.direction.head(n_) = work_.gradient.head(n_);
  int released = -1;
  double largest_pull = size_.surely_pulling();
  for (int i = static_cast<int>(work_.held.size()) - 1; i >= 0; --i) {
    const auto [row, sign] = work_.held[at(i)];
    const int t = base_ + i;
    const double mu =
        -VectorView(elimination.column(t), n_).dot(work_.direction.head(n_)) / elimination.pivot(t);
    add_multiple(problem_, row, mu, work_.direction.data());
    work_.mu[i] = sign * mu;
    const double pull = -sign * mu * problem_.norm(row);
    if (pull <= size_.surely_pulling()) continue;
    const bool is_better =
        take_first ? released < 0 || row < work_.held[at(released)].row : pull > largest_pull;
    if (!is_better) continue;
    largest_pull = pull;
    released = i;
  }
  return released;
}

// Index in work_.touched of the row that blocks the direction at x; -1 = none.
int LevelByLevel::touched_obstacle(int level) const noexcept {
  int obstacle = -1;
  way_to_obstacle(level, obstacle);
  if (obstacle < 0) return -1;
  const double side = work_.slope[at(obstacle)] > 0.0 ? 1.0 : -1.0;
  const auto found =
      std::find_if(work_.touched.begin(), work_.touched.end(),
                   [&](const TouchedRow& t) { return t.row == obstacle && t.sign == side; });
  return found == work_.touched.end() ? -1 : static_cast<int>(found - work_.touched.begin());
}

// A direction along which the objective falls and x can move at once. In a corner, rows are held
// and released until there is one, or all held rows push: x is optimal.
LevelByLevel::Aim LevelByLevel::aim_past_obstacles(int level) noexcept {
  if (steps_ <= kFreeStepsPerVariable * n_) {
    work_.held.clear();
    for (int i = 0; i < work_.cone.pushing(); ++i) work_.held.push_back(work_.cone.row(i));
  }
  hold_rows(level);

  const int corner_size = static_cast<int>(work_.touched.size());
  for (int exchange = 0; exchange <= kExchangesPerRow * corner_size; ++exchange) {
    bool has_gain = aim(level);
    for (int obstacle = touched_obstacle(level); has_gain && obstacle >= 0;
         obstacle = touched_obstacle(level)) {
      const TouchedRow t = work_.touched[at(obstacle)];
      work_.skipped_sides[at(t.row)] = kBothSides;
      if (!work_.elimination.add_row(problem_, t.row, options_.rank_tolerance)) continue;
      work_.held.push_back(t);
      has_gain = aim(level);
    }
    if (has_gain) return Aim::kAhead;

    const int released = find_pulling_row(exchange > corner_size);
    if (released < 0) return Aim::kOptimal;
    if (iterations_ >= options_.max_iterations) return Aim::kIterationLimit;
    ++iterations_;
    work_.held.erase(work_.held.begin() + released);
    hold_rows(level);
  }

  // a cycle: the steepest feasible descent leads out of the corner
  std::fill_n(work_.skipped_sides.begin(), end_of_levels_above(level), std::uint8_t{0});
  for (const TouchedRow& t : work_.touched) work_.skipped_sides[at(t.row)] |= side_of(t);
  work_.direction.head(n_) = work_.cone.descent().head(n_);
  find_slopes(level);
  if (!gains(level, best_length(level, kInfinity))) return Aim::kOptimal;
  work_.held.clear();
  return Aim::kAhead;
}

PrimalOutcome LevelByLevel::optimise(int level) noexcept {
  Elimination& elimination = work_.elimination;
  base_ = elimination.rank();
  work_.point.rank_at_level[at(level)] = base_;
  work_.point.blocking_row[at(level)] = -1;
  steps_ = 0;
  while (true) {
    if (iterations_ >= options_.max_iterations) return PrimalOutcome::kIterationLimit;
    ++iterations_;
    elimination.truncate(base_);

    size_ = level_gradient(problem_, options_, level, work_);
    // levels met by the dual method within the tolerance are met up to rounding here
    const bool is_zero = work_.has_dual_point ? size_.scale <= size_.rounding : size_.is_zero;
    is_held_back_ = !is_zero && elimination.freedom() > 0;
    if (!is_held_back_) return PrimalOutcome::kOptimal;
    if (!is_norm_level(level)) collect_pulling(level);
    work_.touched.clear();
    for (int above = 0; above < level; ++above) collect_touched(problem_, options_, above, work_);
    work_.cone.solve(problem_, work_.touched, work_.gradient.data(), size_.scale,
                     options_.rank_tolerance, elimination);
    const Aim outcome = aim_past_obstacles(level);
    if (outcome == Aim::kOptimal) return PrimalOutcome::kOptimal;
    if (outcome == Aim::kIterationLimit) return PrimalOutcome::kIterationLimit;

    int obstacle = -1;
    const double longest = way_to_obstacle(level, obstacle);
    const double length = best_length(level, longest);
    const double way = length * work_.direction.head(n_).norm();
    if (!(way > kResolution * work_.x_norm)) return PrimalOutcome::kOptimal;
    if (!move(problem_, work_.direction, length, work_)) return PrimalOutcome::kNotFinite;
    update_values(problem_, levels_, work_);
    ++steps_;
    if (length == longest && static_cast<int>(work_.held.size()) < n_ - base_) {
      work_.held.push_back({obstacle, work_.slope[at(obstacle)] > 0.0 ? 1.0 : -1.0});
    }
  }
}

// State of a row that no level can move any more.
RowState LevelByLevel::state_of_fixed(int row) const noexcept {
  const double distance = violation(problem_, options_, work_, row);
  if (distance > 0.0) return RowState::kAbove;
  if (distance < 0.0) return RowState::kBelow;
  return is_equality(problem_.bounds(row)) ? RowState::kEqual : RowState::kInactive;
}

// Keeps the optimal slacks of the level: its equality and violated rows, and the rows that surely
// push, do not change any more.
void LevelByLevel::fix(int level) noexcept {
  Elimination& elimination = work_.elimination;
  elimination.truncate(base_);
  work_.targets.clear();
  if (!is_norm_level(level)) collect_targets(problem_, options_, level, work_);
  elimination.add_least_squares(problem_, work_.targets, work_.point.x.data(),
                                options_.rank_tolerance);
  for (const TargetRow& t : work_.targets) {
    work_.is_fixed[at(t.row)] = true;
    work_.point.state[at(t.row)] = state_of_fixed(t.row);
  }
  if (!is_held_back_) return;
  double largest_push = 0.0;
  for (int i = 0; i < static_cast<int>(work_.held.size()); ++i) {
    const auto [row, sign] = work_.held[at(i)];
    const double push = work_.mu[i] * problem_.norm(row);
    work_.point.state[at(row)] = sign > 0.0 ? RowState::kUpper : RowState::kLower;
    if (push > largest_push) {
      largest_push = push;
      work_.point.blocking_row[at(level)] = row;
    }
  }
}

// Rows that held one level back may have been left by a later one.
void LevelByLevel::release_untouched() noexcept {
  const int end = rows_of(problem_, levels_);
  for (int row = 0; row < end; ++row) {
    RowState& state = work_.point.state[at(row)];
    const auto [lb, ub] = problem_.bounds(row);
    if ((state == RowState::kUpper && !touches(problem_, options_, work_, row, ub)) ||
        (state == RowState::kLower && !touches(problem_, options_, work_, row, lb))) {
      state = RowState::kInactive;
    }
    if (problem_.norm(row) == 0.0) state = state_of_fixed(row);
  }
}

}  // namespace

PrimalOutcome solve_level_by_level(const Problem& problem, const Options& options, int levels,
                                   int& iterations, int& completed, Workspace& work) noexcept {
  return LevelByLevel(problem, options, levels, iterations, work).run(completed);
}

}  // namespace hg::hqp
