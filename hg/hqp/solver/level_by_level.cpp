#include "hg/hqp/solver/level_by_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hg::hqp::solver {
namespace {

constexpr double kParallel = 1e-12;    // cosine below which a direction does not change a row
constexpr double kResolution = 1e-16;  // share of |x| below which a step does not change x
// Share of the tolerance that counts as a gain, near the optimum
constexpr double kCorrection = 1e-3;
constexpr int kExchangesPerRow = 3;  // rows released in a corner, per row that meets there
// Steps of a level for which the working set is chosen again each time. After these a row stays in
// it until x is the minimum over the working set: mostly slower, but no working set recurs.
constexpr int kFreeStepsPerVariable = 1;

// Sides of a row that do not stop a step, as bits.
constexpr std::uint8_t kUpperSide = 1;
constexpr std::uint8_t kLowerSide = 2;
constexpr std::uint8_t kBothSides = kUpperSide | kLowerSide;

std::uint8_t side_of(const RowAtBound& t) noexcept {
  return t.sign > 0.0 ? kUpperSide : kLowerSide;
}

class LevelByLevel {
 public:
  LevelByLevel(const Problem& problem, const SolverOptions& options, int levels, int& iterations,
               Workspace& work) noexcept
      : problem_(problem),
        options_(options),
        levels_(levels),
        n_(problem.variables()),
        iterations_(iterations),
        work_(work),
        iterate_(work.iterate),
        householder_(work.factors.householder),
        duals_(work.duals),
        search_(work.search),
        targets_(work.targets),
        rows_at_bounds_(work.rows_at_bounds),
        working_set_(work.working_set) {}

  LevelOutcome run(int& completed) noexcept;

 private:
  enum class DirectionResult { kFound, kOptimal, kIterationLimit };

  LevelOutcome optimise(int level) noexcept;
  void fix(int level) noexcept;
  void release_rows_off_bounds() noexcept;
  RowState state_of_fixed(int row) const noexcept;
  void collect_unmet(int level) noexcept;
  bool find_direction(int level) noexcept;
  void factorise_working_set(int level) noexcept;
  int find_row_to_release(bool take_first) noexcept;
  int blocking_row_at_bound(int level) const noexcept;
  DirectionResult find_feasible_direction(int level) noexcept;
  void find_slopes(int level) noexcept;
  bool gains(int level, double length) const noexcept;
  double length_to_blocking_row(int level, int& blocking_row) const noexcept;
  double best_length(int level, double longest) const noexcept;
  bool is_norm_level(int level) const noexcept { return level == problem_.levels(); }
  int end_of_levels_above(int level) const noexcept {
    return level > 0 ? problem_.end_row(level - 1) : 0;
  }

  const Problem& problem_;
  const SolverOptions& options_;
  const int levels_;
  const int n_;
  int& iterations_;
  Workspace& work_;
  Iterate& iterate_;
  HouseholderQr& householder_;
  Duals& duals_;
  LineSearch& search_;
  std::vector<TargetRow>& targets_;
  std::vector<RowAtBound>& rows_at_bounds_;
  std::vector<RowAtBound>& working_set_;
  LevelGradient size_ = {};
  int base_ = 0;                 ///< number of pivots of the levels above
  int steps_ = 0;                ///< number of steps of this level
  bool is_constrained_ = false;  ///< the working set limits the last level
};

LevelOutcome LevelByLevel::run(int& completed) noexcept {
  const int end = rows_of(problem_, levels_);
  std::fill_n(iterate_.state.begin(), end, RowState::kInactive);
  std::fill_n(search_.is_fixed.begin(), end, false);
  if (work_.outcome.has_dual_point) {
    iterate_.x.head(n_) = work_.dual.point().head(n_);
  } else {
    iterate_.x.head(n_).setZero();
  }
  iterate_.x_norm = iterate_.x.head(n_).norm();
  householder_.reset(n_);
  update_values(problem_, levels_, iterate_);

  for (completed = 0; completed < levels_; ++completed) {
    const LevelOutcome outcome = optimise(completed);
    if (outcome != LevelOutcome::kOptimal) {
      const auto ranks = iterate_.rank_at_level.begin();
      std::fill(ranks + completed, ranks + levels_ + 1, base_);
      std::fill_n(iterate_.blocking_row.begin() + completed, levels_ - completed, -1);
      release_rows_off_bounds();
      return outcome;
    }
    fix(completed);
  }
  LevelOutcome outcome = LevelOutcome::kOptimal;
  if (options_.minimum_norm && levels_ == problem_.levels()) {
    outcome = optimise(problem_.levels());
    fix(problem_.levels());
  }
  release_rows_off_bounds();
  return outcome;
}

// Writes the level's equalities and unmet rows into targets_: the quadratic piece of its objective
// at x.
void LevelByLevel::collect_unmet(int level) noexcept {
  targets_.clear();
  for (int row = problem_.first_row(level); row < problem_.end_row(level); ++row) {
    const auto [lb, ub] = problem_.bounds(row);
    const double value = iterate_.value[row];
    const bool is_unmet = problem_.norm(row) > 0.0 && (lb == ub || value < lb || value > ub);
    if (is_unmet) targets_.push_back({row, value < lb ? lb : ub});
  }
}

// Computes the direction to the minimum of the level's quadratic piece within the free columns;
// false when its gain is negligible.
bool LevelByLevel::find_direction(int level) noexcept {
  if (householder_.freedom() == 0) return false;
  if (is_norm_level(level)) {
    householder_.project_to_free(iterate_.x.data(), search_.direction.data());
    search_.direction.head(n_) *= -1.0;
    find_slopes(level);
    return gains(level, 1.0);
  }
  const int rank = householder_.rank();
  householder_.add_least_squares(problem_, targets_, iterate_.x.data(), options_.rank_tolerance);
  householder_.truncate(rank);
  search_.direction.head(n_) = householder_.step().head(n_);
  find_slopes(level);
  return gains(level, 1.0);
}

// Whether a step of `length` along the direction changes a slack of the level's objective by more
// than the tolerance.
bool LevelByLevel::gains(int level, double length) const noexcept {
  const double share = work_.outcome.has_dual_point ? kCorrection : 1.0;
  if (is_norm_level(level)) {
    return length * search_.direction.head(n_).norm() >
           share * options_.feasibility_tolerance * iterate_.x_norm;
  }
  return std::any_of(targets_.begin(), targets_.end(), [&](const TargetRow& t) {
    return std::abs(length * search_.slope[t.row]) >
           share * tolerance(problem_, options_, iterate_, t.row, t.target);
  });
}

// Computes search_.slope for all rows that matter to the level: 0 where it is only rounding or, for
// rows of the level, the free part of a dependent row.
void LevelByLevel::find_slopes(int level) noexcept {
  const int end = is_norm_level(level) ? problem_.rows() : problem_.end_row(level);
  const double direction_norm = search_.direction.head(n_).norm();
  for (int row = 0; row < end; ++row) {
    const double slope = dot(problem_, row, search_.direction.data());
    const double parallel = row < end_of_levels_above(level) ? kParallel : options_.rank_tolerance;
    const bool is_rounding = std::abs(slope) <= parallel * problem_.norm(row) * direction_norm;
    search_.slope[row] = is_rounding ? 0.0 : slope;
  }
}

// Length along the direction until a row of a higher level blocks it.
double LevelByLevel::length_to_blocking_row(int level, int& blocking_row) const noexcept {
  double length = kInfinity;
  blocking_row = -1;
  for (int row = 0; row < end_of_levels_above(level); ++row) {
    const double slope = search_.slope[row];
    if (search_.is_fixed[row] || slope == 0.0) continue;
    if (search_.skipped_sides[row] & (slope > 0.0 ? kUpperSide : kLowerSide)) continue;
    const auto [lb, ub] = problem_.bounds(row);
    const double distance = slope > 0.0 ? ub - iterate_.value[row] : iterate_.value[row] - lb;
    const double length_of_row = std::max(0.0, distance) / std::abs(slope);
    if (length_of_row < length) {
      length = length_of_row;
      blocking_row = row;
    }
  }
  return length;
}

// Minimum of the level's objective along the direction, a convex piecewise quadratic, up to
// `longest`: proceeds from kink to kink until its derivative is positive.
double LevelByLevel::best_length(int level, double longest) const noexcept {
  if (is_norm_level(level)) {
    const double d_d = search_.direction.head(n_).squaredNorm();
    return std::min(longest, -search_.direction.head(n_).dot(iterate_.x.head(n_)) / d_d);
  }
  const int first = problem_.first_row(level);
  const int end = problem_.end_row(level);
  double length = 0.0;
  for (int piece = 0; piece <= 2 * (end - first); ++piece) {
    double derivative = 0.0;
    double curvature = 0.0;
    double kink = kInfinity;
    for (int row = first; row < end; ++row) {
      const double slope = search_.slope[row];
      if (slope == 0.0) continue;
      const double value = iterate_.value[row];
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

// Makes the working set the pivots behind those of the levels above; rows that depend on others
// leave it.
void LevelByLevel::factorise_working_set(int level) noexcept {
  householder_.truncate(base_);
  std::fill_n(search_.skipped_sides.begin(), end_of_levels_above(level), std::uint8_t{0});
  std::erase_if(working_set_, [&](const RowAtBound& t) {
    search_.skipped_sides[t.row] = kBothSides;
    return !householder_.add_row(problem_, t.row, options_.rank_tolerance);
  });
}

// Computes the multipliers of the working set into duals_.mu. Returns the index of the row to
// release, -1 when no multiplier is negative.
int LevelByLevel::find_row_to_release(bool take_first) noexcept {
  search_.direction.head(n_) = duals_.gradient.head(n_);
  int released = -1;
  double most_negative = size_.surely_negative();
  for (int i = static_cast<int>(working_set_.size()) - 1; i >= 0; --i) {
    const auto [row, sign] = working_set_[i];
    const int t = base_ + i;
    const double mu = -VectorView(householder_.column(t), n_).dot(search_.direction.head(n_)) /
                      householder_.pivot(t);
    add_multiple(problem_, row, mu, search_.direction.data());
    duals_.mu[i] = sign * mu;
    const double negative = -sign * mu * problem_.norm(row);
    if (negative <= size_.surely_negative()) continue;
    const bool is_better =
        take_first ? released < 0 || row < working_set_[released].row : negative > most_negative;
    if (!is_better) continue;
    most_negative = negative;
    released = i;
  }
  return released;
}

// Index in rows_at_bounds_ of the row that blocks the direction at x; -1 = none.
int LevelByLevel::blocking_row_at_bound(int level) const noexcept {
  int blocking_row = -1;
  length_to_blocking_row(level, blocking_row);
  if (blocking_row < 0) return -1;
  const double side = search_.slope[blocking_row] > 0.0 ? 1.0 : -1.0;
  const auto found =
      std::find_if(rows_at_bounds_.begin(), rows_at_bounds_.end(),
                   [&](const RowAtBound& t) { return t.row == blocking_row && t.sign == side; });
  return found == rows_at_bounds_.end() ? -1 : static_cast<int>(found - rows_at_bounds_.begin());
}

// Finds a direction along which the objective decreases and x can move. In a corner, rows enter and
// leave the working set until there is one, or until no multiplier is negative: x is optimal.
LevelByLevel::DirectionResult LevelByLevel::find_feasible_direction(int level) noexcept {
  if (steps_ <= kFreeStepsPerVariable * n_) {
    working_set_.clear();
    for (int i = 0; i < work_.nnls.size(); ++i) working_set_.push_back(work_.nnls.row(i));
  }
  factorise_working_set(level);

  const int corner_size = static_cast<int>(rows_at_bounds_.size());
  for (int exchange = 0; exchange <= kExchangesPerRow * corner_size; ++exchange) {
    bool has_gain = find_direction(level);
    for (int blocking_row = blocking_row_at_bound(level); has_gain && blocking_row >= 0;
         blocking_row = blocking_row_at_bound(level)) {
      const RowAtBound t = rows_at_bounds_[blocking_row];
      search_.skipped_sides[t.row] = kBothSides;
      if (!householder_.add_row(problem_, t.row, options_.rank_tolerance)) continue;
      working_set_.push_back(t);
      has_gain = find_direction(level);
    }
    if (has_gain) return DirectionResult::kFound;

    const int released = find_row_to_release(exchange > corner_size);
    if (released < 0) return DirectionResult::kOptimal;
    if (iterations_ >= options_.max_iterations) return DirectionResult::kIterationLimit;
    ++iterations_;
    working_set_.erase(working_set_.begin() + released);
    factorise_working_set(level);
  }

  // a cycle: the steepest feasible descent leads out of the corner
  std::fill_n(search_.skipped_sides.begin(), end_of_levels_above(level), std::uint8_t{0});
  for (const RowAtBound& t : rows_at_bounds_) search_.skipped_sides[t.row] |= side_of(t);
  search_.direction.head(n_) = work_.nnls.descent().head(n_);
  find_slopes(level);
  if (!gains(level, best_length(level, kInfinity))) return DirectionResult::kOptimal;
  working_set_.clear();
  return DirectionResult::kFound;
}

LevelOutcome LevelByLevel::optimise(int level) noexcept {
  base_ = householder_.rank();
  iterate_.rank_at_level[level] = base_;
  iterate_.blocking_row[level] = -1;
  steps_ = 0;
  while (true) {
    if (iterations_ >= options_.max_iterations) return LevelOutcome::kIterationLimit;
    ++iterations_;
    householder_.truncate(base_);

    size_ = level_gradient(problem_, options_, level, iterate_, duals_.gradient);
    // levels met by the dual method within the tolerance are met up to rounding here
    const bool is_zero =
        work_.outcome.has_dual_point ? size_.scale <= size_.rounding : size_.is_zero;
    is_constrained_ = !is_zero && householder_.freedom() > 0;
    if (!is_constrained_) return LevelOutcome::kOptimal;
    if (!is_norm_level(level)) collect_unmet(level);
    rows_at_bounds_.clear();
    for (int above = 0; above < level; ++above) {
      collect_rows_at_bounds(problem_, options_, above, iterate_, rows_at_bounds_);
    }
    work_.nnls.solve(problem_, rows_at_bounds_, duals_.gradient.data(), size_.scale,
                     options_.rank_tolerance, householder_);
    const DirectionResult outcome = find_feasible_direction(level);
    if (outcome == DirectionResult::kOptimal) return LevelOutcome::kOptimal;
    if (outcome == DirectionResult::kIterationLimit) return LevelOutcome::kIterationLimit;

    int blocking_row = -1;
    const double longest = length_to_blocking_row(level, blocking_row);
    const double length = best_length(level, longest);
    const double step = length * search_.direction.head(n_).norm();
    if (!(step > kResolution * iterate_.x_norm)) return LevelOutcome::kOptimal;
    if (!move(problem_, search_.direction, length, iterate_)) return LevelOutcome::kNotFinite;
    update_values(problem_, levels_, iterate_);
    ++steps_;
    if (length == longest && static_cast<int>(working_set_.size()) < n_ - base_) {
      working_set_.push_back({blocking_row, search_.slope[blocking_row] > 0.0 ? 1.0 : -1.0});
    }
  }
}

// Returns the state of a row whose value no level can change any more.
RowState LevelByLevel::state_of_fixed(int row) const noexcept {
  const double distance = violation(problem_, options_, iterate_, row);
  if (distance > 0.0) return RowState::kAbove;
  if (distance < 0.0) return RowState::kBelow;
  return is_equality(problem_.bounds(row)) ? RowState::kEqual : RowState::kInactive;
}

// Fixes the optimal slacks of the level: its equality and violated rows, and the rows with surely
// positive multipliers, remain constant from here on.
void LevelByLevel::fix(int level) noexcept {
  householder_.truncate(base_);
  targets_.clear();
  if (!is_norm_level(level)) collect_targets(problem_, options_, level, iterate_, targets_);
  householder_.add_least_squares(problem_, targets_, iterate_.x.data(), options_.rank_tolerance);
  for (const TargetRow& t : targets_) {
    search_.is_fixed[t.row] = true;
    iterate_.state[t.row] = state_of_fixed(t.row);
  }
  if (!is_constrained_) return;
  double largest = 0.0;
  for (int i = 0; i < static_cast<int>(working_set_.size()); ++i) {
    const auto [row, sign] = working_set_[i];
    const double multiplier = duals_.mu[i] * problem_.norm(row);
    iterate_.state[row] = sign > 0.0 ? RowState::kUpper : RowState::kLower;
    if (multiplier > largest) {
      largest = multiplier;
      iterate_.blocking_row[level] = row;
    }
  }
}

// Marks rows inactive whose bound a lower level has moved away from.
void LevelByLevel::release_rows_off_bounds() noexcept {
  const int end = rows_of(problem_, levels_);
  for (int row = 0; row < end; ++row) {
    RowState& state = iterate_.state[row];
    const auto [lb, ub] = problem_.bounds(row);
    if ((state == RowState::kUpper && !reaches(problem_, options_, iterate_, row, ub)) ||
        (state == RowState::kLower && !reaches(problem_, options_, iterate_, row, lb))) {
      state = RowState::kInactive;
    }
    if (problem_.norm(row) == 0.0) state = state_of_fixed(row);
  }
}

}  // namespace

LevelOutcome solve_level_by_level(const Problem& problem, const SolverOptions& options, int levels,
                                  int& iterations, int& completed, Workspace& work) noexcept {
  return LevelByLevel(problem, options, levels, iterations, work).run(completed);
}

}  // namespace hg::hqp::solver
