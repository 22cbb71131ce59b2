#include "hg/hqp/solver/dual_method.h"

#include <algorithm>
#include <cmath>

#include "hg/hqp/solver/rows.h"

namespace hg::hqp::solver {
namespace {

constexpr double kViolated = 1e-9;    // share of |bound| + norm |x| beyond which a row is violated
constexpr double kDependent = 1e-11;  // remainder up to which a row depends on the active ones
constexpr double kLittleLost = 1e-3;  // share of a row (squared) from which enough digits remain
constexpr double kTakesPart = 1e-8;   // share of a contradiction from which a row belongs to it
constexpr double kTurns = 1e-12;      // ratio from which a multiplier falls
constexpr double kPositive =
    1e-10;                     // share of the gradient above which a multiplier is surely positive
constexpr double kMet = 1e-9;  // share of its terms up to which a gradient counts as zero
// Weight of |x|, squared in the objective, beside a level that leaves freedom.
constexpr double kRegularisation = 1e-6;
constexpr double kSingular = 1e-7;  // pivots below this share of the largest need regularisation

constexpr int kMoreActive = 32;  // rows that can be active at once, beyond 2 n

int padded(int n) noexcept { return (n + 3) / 4 * 4; }

// y += factor x
void add(int n, double factor, const double* __restrict x, double* __restrict y) noexcept {
  for (int i = 0; i < n; ++i) y[i] += factor * x[i];
}

}  // namespace

DualMethod::DualMethod(const Capacity& c)
    : rank_at_level_(c.levels + 1),
      has_positive_multiplier_(c.rows),
      side_(c.rows),
      max_active_(2 * c.variables + kMoreActive),
      objective_((std::max(c.rows, c.variables) + c.variables) * c.variables),
      objective_rhs_(std::max(c.rows, c.variables) + c.variables),
      candidate_rows_(c.rows * padded(c.variables)),
      x_(c.variables),
      reduced_(padded(c.variables)),
      is_slot_used_(max_active_),
      Q_(max_active_ * (padded(c.variables) + padded(max_active_))),
      R_(max_active_ * max_active_),
      u_(padded(c.variables) + padded(max_active_)),
      a_(u_.size()),
      z_(u_.size()),
      d_(max_active_),
      ratio_(max_active_) {
  free_.reserve(c.variables);
  candidates_.reserve(c.rows);
  active_.reserve(max_active_);
  targets_.reserve(c.rows);
}

// Takes equalities of level after level as pivots, up to the first level s that contradicts itself
// or leaves no freedom, or to last_. False: in doubt.
bool DualMethod::choose_level(GaussElimination& direct) noexcept {
  for (; level_ < last_; ++level_) {
    const int rank = direct.rank();
    rank_at_level_[level_] = rank;
    collect_targets();
    if (targets_.empty()) continue;
    if (2 * static_cast<int>(targets_.size()) >= direct.freedom()) return true;
    if (!direct.add_least_squares(*problem_, targets_, options_->rank_tolerance)) return false;
    if (direct.is_met() && direct.freedom() > 0) continue;
    direct.truncate(rank);
    return true;
  }
  rank_at_level_[level_] = direct.rank();
  return true;
}

// Collects the inequalities of the levels down to s.
void DualMethod::collect_candidates() noexcept {
  candidates_.clear();
  reduced_rows_ = 0;
  const int levels = std::min(level_ + 1, levels_);
  for (int level = 0; level < levels; ++level) {
    for (int row = problem_->first_row(level); row < problem_->end_row(level); ++row) {
      const auto [lb, ub] = problem_->bounds(row);
      if (side_[row] != 0 || lb == ub || problem_->norm(row) == 0.0) continue;
      if (!std::isfinite(lb) && !std::isfinite(ub)) continue;
      candidates_.push_back({.row = row,
                             .is_soft = level == level_,
                             .is_excluded = false,
                             .slot = kNoSlot,
                             .length = 0.0});
    }
  }
}

// Reduces a candidate by the equalities, in the metric of the program.
void DualMethod::reduce(int i, GaussElimination& direct) noexcept {
  Candidate& candidate = candidates_[i];
  candidate.slot = reduced_rows_++;
  direct.reduce_to_free(*problem_, candidate.row, reduced_.data());
  double* y = candidate_row(i);
  double largest = 0.0;
  for (int k = 0; k < freedom_; ++k) {
    y[k] = reduced_[free_[k]];
    largest = std::max(largest, std::abs(y[k]));
  }
  std::fill(y + freedom_, y + stride_, 0.0);
  if (largest <= options_->rank_tolerance * problem_->norm(candidate.row)) {
    std::fill(y, y + freedom_, 0.0);
  } else {
    for (int j = 0; j < freedom_; ++j) {
      const double* column = objective_.data() + j * freedom_;
      y[j] = (y[j] - dot(j, column, y)) / column[j];
    }
  }
  double squared = dot(freedom_, y, y);
  if (candidate.is_soft) {
    const double weight = problem_->weight(candidate.row);
    squared += 1.0 / (weight * weight);
  }
  candidate.length = std::sqrt(squared);
}

// Equalities of level s, into targets_.
void DualMethod::collect_targets() noexcept {
  targets_.clear();
  for (int row = problem_->first_row(level_); row < problem_->end_row(level_); ++row) {
    const Interval bounds = problem_->bounds(row);
    if (is_equality(bounds) && problem_->norm(row) > 0.0) targets_.push_back({row, bounds.ub});
  }
}

// Writes the objective of level s, targets_ or the smallest |x|, as rows of objective_, a column
// per free variable, with room for as many rows more as there are columns. Returns the number of
// rows.
int DualMethod::collect_objective(GaussElimination& direct, bool is_regular) noexcept {
  const bool is_norm = level_ == levels_;
  const int wanted = is_norm ? problem_->variables() : static_cast<int>(targets_.size());
  const int rows = is_regular ? wanted + freedom_ : wanted;
  double largest = 0.0;
  for (int i = 0; i < wanted; ++i) {
    double offset = 0.0;
    double weight = 1.0;
    double target = 0.0;
    double norm = 1.0;
    if (is_norm) {
      offset = direct.reduce_to_free(i, reduced_.data());
    } else {
      const TargetRow& row = targets_[i];
      offset = direct.reduce_to_free(*problem_, row.row, reduced_.data());
      weight = problem_->weight(row.row);
      norm = problem_->norm(row.row);
      target = row.target;
    }
    double largest_of_row = 0.0;
    for (int k = 0; k < freedom_; ++k) {
      const double number = weight * reduced_[free_[k]];
      objective_[k * rows + i] = number;
      largest_of_row = std::max(largest_of_row, std::abs(number));
    }
    objective_rhs_[i] = weight * (target - offset);
    if (largest_of_row <= options_->rank_tolerance * weight * norm) {  // nothing can change it
      for (int k = 0; k < freedom_; ++k) objective_[k * rows + i] = 0.0;
      objective_rhs_[i] = 0.0;
      continue;
    }
    largest = std::max(largest, largest_of_row);
  }
  if (!is_regular) return rows;

  for (const Candidate& candidate : candidates_) {
    if (candidate.is_soft) {
      largest = std::max(largest, problem_->weight(candidate.row) * problem_->norm(candidate.row));
    }
  }
  has_objective_ = largest > 0.0;
  regularisation_ = has_objective_ ? kRegularisation * largest : 1.0;
  for (int k = 0; k < freedom_; ++k) {
    double* column = objective_.data() + k * rows + wanted;
    std::fill_n(column, freedom_, 0.0);
    column[k] = regularisation_;
    objective_rhs_[wanted + k] = 0.0;
  }
  return rows;
}

// Makes the objective's columns a triangle by reflections; smallest and largest length on its
// diagonal, and no further than a column of length 0.
Interval DualMethod::triangularise(int rows, bool is_regular) noexcept {
  Interval lengths = {kInfinity, 0.0};
  for (int j = 0; j < freedom_; ++j) {
    // below these rows, only later columns have numbers
    const int size = is_regular ? rows - freedom_ + 1 : rows - j;
    double* h = objective_.data() + j * rows + j;
    const double length = std::sqrt(dot(size, h, h));
    lengths.lb = std::min(lengths.lb, length);
    lengths.ub = std::max(lengths.ub, length);
    if (length == 0.0) break;
    const double diagonal = h[0] > 0.0 ? -length : length;
    h[0] -= diagonal;
    const double factor = 1.0 / (diagonal * h[0]);
    for (int k = j + 1; k <= freedom_; ++k) {
      double* c = k < freedom_ ? objective_.data() + k * rows + j : objective_rhs_.data() + j;
      const double product = dot(size, h, c);
      if (product != 0.0) add(size, factor * product, h, c);
    }
    h[0] = diagonal;
  }
  return lengths;
}

// Triangular factor of the objective, regularised where it is singular. False: not finite.
bool DualMethod::factorise(GaussElimination& direct, bool is_regular) noexcept {
  int rows = 0;
  for (;; is_regular = true) {
    rows = collect_objective(direct, is_regular);
    const Interval lengths = triangularise(rows, is_regular);
    if (lengths.lb > kSingular * lengths.ub) break;
    if (!is_regular) continue;
    if (!(lengths.lb > 0.0)) return false;
    break;
  }
  // the triangle, its columns stride_ apart
  for (int j = 0; j < freedom_; ++j) {
    std::copy_n(objective_.data() + j * rows, j + 1, objective_.data() + j * freedom_);
  }
  return true;
}

// Factor of the objective, and the candidates in its metric. False: not finite.
bool DualMethod::set_up_metric(GaussElimination& direct) noexcept {
  const int n = problem_->variables();
  free_.clear();
  for (int v = 0; v < n; ++v) {
    if (direct.is_free(v)) free_.push_back(v);
  }
  freedom_ = static_cast<int>(free_.size());
  stride_ = padded(freedom_);
  collect_candidates();
  regularisation_ = 0.0;
  has_objective_ = true;
  bool is_regular = false;
  if (level_ < levels_) {
    collect_targets();
    is_regular = static_cast<int>(targets_.size()) < freedom_;
  }
  if (!factorise(direct, is_regular)) return false;

  u_.head(stride_).setZero();
  find_point(direct);
  x_norm_ = x_.head(problem_->variables()).norm();
  if (!std::isfinite(x_norm_)) return false;
  const auto soft = std::count_if(candidates_.begin(), candidates_.end(),
                                  [](const Candidate& candidate) { return candidate.is_soft; });
  slots_ = std::min(static_cast<int>(soft), max_active_);
  used_slots_ = 0;
  std::fill_n(is_slot_used_.begin(), slots_, false);
  q_stride_ = stride_ + padded(slots_);
  u_.head(q_stride_).setZero();
  active_.clear();
  return true;
}

// The candidate that x is outside of by the largest share of its norm, -1: none.
int DualMethod::most_violated() const noexcept {
  int best = -1;
  double largest = 0.0;
  for (int i = 0; i < static_cast<int>(candidates_.size()); ++i) {
    const Candidate& candidate = candidates_[i];
    if (candidate.is_excluded) continue;
    const Interval bounds = problem_->bounds(candidate.row);
    const double distance = excess(bounds, dot(*problem_, candidate.row, x_.data()));
    if (distance == 0.0) continue;
    const double norm = problem_->norm(candidate.row);
    const double bound = distance > 0.0 ? bounds.ub : bounds.lb;
    if (std::abs(distance) <= kViolated * (norm * x_norm_ + std::abs(bound))) continue;
    const double share = std::abs(distance) / norm;
    if (share <= largest) continue;
    largest = share;
    best = i;
  }
  return best;
}

// The entering row a = N ratio + z, z orthogonal to N. Returns |z|^2, 0 when a depends on N.
double DualMethod::project(const Active& entering) noexcept {
  const int size = stride_ + used_slots_;
  const Candidate& candidate = candidates_[entering.candidate];
  const double* y = candidate_row(entering.candidate);
  double* a = a_.data();
  double* z = z_.data();
  for (int k = 0; k < stride_; ++k) a[k] = entering.sign * y[k];
  std::fill(a + stride_, a + size, 0.0);
  if (entering.slot >= 0) a[stride_ + entering.slot] = -1.0 / problem_->weight(candidate.row);
  std::copy_n(a, size, z);

  const int active = static_cast<int>(active_.size());
  const double a_squared = candidate.length * candidate.length;
  double z_squared = a_squared;
  std::fill_n(d_.data(), active, 0.0);
  for (int pass = 0; pass < 2; ++pass) {
    const double before = z_squared;
    for (int j = 0; j < active; ++j) ratio_[j] = dot(size, q(j), z);
    for (int j = 0; j < active; ++j) {
      d_[j] += ratio_[j];
      add(size, -ratio_[j], q(j), z);
    }
    z_squared = dot(size, z, z);
    if (z_squared > kLittleLost * before) break;
  }
  std::copy_n(d_.data(), active, ratio_.data());
  for (int j = active - 1; j >= 0; --j) {
    ratio_[j] /= r(j)[j];
    add(j, -ratio_[j], r(j), ratio_.data());
  }
  return z_squared > kDependent * kDependent * a_squared ? z_squared : 0.0;
}

void DualMethod::append(const Active& entering, double z_squared) noexcept {
  const int j = static_cast<int>(active_.size());
  const int size = stride_ + used_slots_;
  const double length = std::sqrt(z_squared);
  for (int k = 0; k < size; ++k) q(j)[k] = z_[k] / length;
  std::fill(q(j) + size, q(j) + q_stride_, 0.0);
  std::copy_n(d_.data(), j, r(j));
  r(j)[j] = length;
  active_.push_back(entering);
  candidates_[entering.candidate].is_excluded = true;
}

// Releases the active row j: removes its column of R; rotations restore the triangle.
void DualMethod::remove(int j) noexcept {
  const int size = stride_ + used_slots_;
  const Active row = active_[j];
  active_.erase(active_.begin() + j);
  candidates_[row.candidate].is_excluded = false;
  const int active = static_cast<int>(active_.size());
  for (int k = j; k < active; ++k) {
    std::copy_n(r(k + 1), k + 2, r(k));
    // entry k + 1 of column k is rotated away
    const double a = r(k)[k];
    const double b = r(k)[k + 1];
    const double length = std::sqrt(a * a + b * b);
    const double c = a / length;
    const double s = b / length;
    r(k)[k] = length;
    for (int l = k + 2; l <= active; ++l) {
      const double upper = r(l)[k];
      const double lower = r(l)[k + 1];
      r(l)[k] = c * upper + s * lower;
      r(l)[k + 1] = c * lower - s * upper;
    }
    double* q0 = q(k);
    double* q1 = q(k + 1);
    for (int i = 0; i < size; ++i) {
      const double upper = q0[i];
      const double lower = q1[i];
      q0[i] = c * upper + s * lower;
      q1[i] = c * lower - s * upper;
    }
  }
  if (row.slot < 0) return;
  is_slot_used_[row.slot] = false;
  for (int k = 0; k < active; ++k) q(k)[stride_ + row.slot] = 0.0;
  u_[stride_ + row.slot] = 0.0;
}

// Finds the minimum of the program.
DualMethod::Outcome DualMethod::run(GaussElimination& direct) noexcept {
  while (true) {
    const int best = most_violated();
    if (best < 0) return Outcome::kOptimal;
    if (static_cast<int>(active_.size()) == max_active_) return Outcome::kGivenUp;
    Candidate& candidate = candidates_[best];
    if (candidate.slot < 0) reduce(best, direct);
    const Interval bounds = problem_->bounds(candidate.row);
    double rest = excess(bounds, dot(*problem_, candidate.row, x_.data()));
    entering_ = {
        .candidate = best, .sign = rest > 0.0 ? 1.0 : -1.0, .multiplier = 0.0, .slot = kNoSlot};
    rest = std::abs(rest);
    if (candidate.is_soft) {
      const auto free_slot =
          std::find(is_slot_used_.begin(), is_slot_used_.begin() + slots_, std::uint8_t{0});
      entering_.slot = static_cast<int>(free_slot - is_slot_used_.begin());
      if (entering_.slot == slots_) return Outcome::kGivenUp;
      is_slot_used_[entering_.slot] = true;
      used_slots_ = std::max(used_slots_, entering_.slot + 1);
    }

    bool is_full = false;
    while (!is_full && !candidate.is_excluded) {
      if (++changes_ > max_changes_) return Outcome::kGivenUp;
      const double z_squared = project(entering_);
      const int active = static_cast<int>(active_.size());
      double length = z_squared > 0.0 ? rest / z_squared : kInfinity;
      int leaving = -1;
      for (int j = 0; j < active; ++j) {
        if (!(ratio_[j] > kTurns)) continue;
        const double length_j = active_[j].multiplier / ratio_[j];
        if (length_j >= length) continue;
        length = length_j;
        leaving = j;
      }
      if (length == kInfinity) {
        contradiction_ = level_of_contradiction(direct);
        if (contradiction_ >= level_) return Outcome::kGivenUp;
        if (contradiction_ >= first_) return Outcome::kContradiction;
        candidate.is_excluded = true;  // settled levels contradict each other by rounding only
        continue;
      }
      if (z_squared > 0.0) {
        add(stride_ + used_slots_, -length, z_.data(), u_.data());
        rest -= length * z_squared;
      }
      for (int j = 0; j < active; ++j) active_[j].multiplier -= length * ratio_[j];
      entering_.multiplier += length;
      is_full = leaving < 0;
      if (is_full) {
        append(entering_, z_squared);
      } else {
        remove(leaving);
      }
    }
    find_point(direct);
  }
}

// The lowest level among the entering row, the active ones and the equalities that contradict it.
int DualMethod::level_of_contradiction(GaussElimination& direct) noexcept {
  const int n = problem_->variables();
  const Candidate& entering = candidates_[entering_.candidate];
  Eigen::VectorXd& rest = z_;
  rest.head(n).setZero();
  add_multiple(*problem_, entering.row, entering_.sign, rest.data());
  int lowest = problem_->level_of(entering.row);
  for (int j = 0; j < static_cast<int>(active_.size()); ++j) {
    const Candidate& candidate = candidates_[active_[j].candidate];
    if (std::abs(ratio_[j]) * candidate.length <= kTakesPart * entering.length) continue;
    add_multiple(*problem_, candidate.row, -ratio_[j] * active_[j].sign, rest.data());
    lowest = std::max(lowest, problem_->level_of(candidate.row));
  }
  const int first = rank_at_level_[first_];
  direct.find_multipliers(rest.data(), direct.rank(), first, a_.data());
  const double norm = problem_->norm(entering.row);
  for (int t = first; t < direct.rank(); ++t) {
    const int row = direct.pivot_row(t);
    if (std::abs(a_[t]) * problem_->norm(row) <= kTakesPart * norm) continue;
    lowest = std::max(lowest, problem_->level_of(row));
  }
  return lowest;
}

// Computes x from u_.
void DualMethod::find_point(GaussElimination& direct) noexcept {
  Eigen::VectorXd& y = z_;
  for (int j = 0; j < freedom_; ++j) y[j] = objective_rhs_[j] + u_[j];
  for (int j = freedom_ - 1; j >= 0; --j) {
    const double* column = objective_.data() + j * freedom_;
    y[j] /= column[j];
    add(j, -y[j], column, y.data());
  }
  for (int k = 0; k < freedom_; ++k) x_[free_[k]] = y[k];
  direct.complete(x_.data());
}

// Turns the result of level s into equalities, with the rows of positive multiplier.
void DualMethod::fix_level(GaussElimination& direct) noexcept {
  const bool is_norm = level_ == levels_;
  double scale = 0.0;
  double size = 0.0;
  if (is_norm) {
    scale = size = x_.head(problem_->variables()).norm();
  } else {
    for (int row = problem_->first_row(level_); row < problem_->end_row(level_); ++row) {
      const Interval bounds = problem_->bounds(row);
      const double norm = problem_->norm(row);
      const double value = dot(*problem_, row, x_.data());
      const double factor = problem_->weight(row) * problem_->weight(row) * norm;
      const double distance = excess(bounds, value);
      if (distance == 0.0) continue;
      scale += factor * std::abs(distance);
      size += factor * (norm * x_norm_ + std::abs(value - distance));
    }
  }
  const bool is_met = !has_objective_ || scale <= kMet * size;
  double x_free = 0.0;
  for (const int v : free_) x_free = std::max(x_free, std::abs(x_[v]));
  const double threshold = kPositive * scale + 10.0 * regularisation_ * regularisation_ * x_free;
  for (const Active& active : active_) {
    const Candidate& candidate = candidates_[active.candidate];
    const double multiplier = active.multiplier * problem_->norm(candidate.row);
    if (is_met || multiplier <= threshold) continue;
    if (!candidate.is_soft) has_positive_multiplier_[candidate.row] = true;
    side_[candidate.row] = active.sign > 0.0 ? 1 : -1;
    const Interval bounds = problem_->bounds(candidate.row);
    const double target = candidate.is_soft ? dot(*problem_, candidate.row, x_.data())
                                            : (active.sign > 0.0 ? bounds.ub : bounds.lb);
    direct.add_row(*problem_, {candidate.row, target}, options_->rank_tolerance);
  }
  if (is_norm) return;
  for (int row = problem_->first_row(level_); row < problem_->end_row(level_); ++row) {
    if (!is_equality(problem_->bounds(row)) || problem_->norm(row) == 0.0) continue;
    const double target = dot(*problem_, row, x_.data());
    direct.add_row(*problem_, {row, target}, options_->rank_tolerance);
  }
}

void DualMethod::write(std::vector<RowState>& guess) const noexcept {
  for (int level = 0; level < levels_; ++level) {
    for (int row = problem_->first_row(level); row < problem_->end_row(level); ++row) {
      const Interval bounds = problem_->bounds(row);
      RowState& state = guess[row];
      state = is_equality(bounds) ? RowState::kEqual : RowState::kInactive;
      if (state == RowState::kEqual || problem_->norm(row) == 0.0) continue;
      int side = side_[row];
      if (side == 0) {
        const double distance = excess(bounds, dot(*problem_, row, x_.data()));
        const double bound = distance > 0.0 ? bounds.ub : bounds.lb;
        const double tolerance =
            kViolated * (problem_->norm(row) * x_norm_ + (distance != 0.0 ? std::abs(bound) : 0.0));
        if (std::abs(distance) > tolerance) side = distance > 0.0 ? 1 : -1;
      }
      if (side != 0) state = side > 0 ? RowState::kUpper : RowState::kLower;
    }
  }
}

// The first level from first_ on that is expected to have violated inequalities.
int DualMethod::expected_level() const noexcept {
  int level = first_;
  while (level < levels_ && expected_violated_[level] == 0) ++level;
  return level;
}

bool DualMethod::find_guess(const Problem& problem, const SolverOptions& options, int levels,
                            int top, std::span<const std::uint8_t> expected_violated,
                            GaussElimination& direct, std::vector<RowState>& guess) noexcept {
  problem_ = &problem;
  options_ = &options;
  levels_ = levels;
  const int rows = levels > 0 ? problem.end_row(levels - 1) : 0;
  std::fill_n(side_.begin(), rows, std::int8_t{0});
  std::fill_n(has_positive_multiplier_.begin(), rows, std::uint8_t{0});
  first_ = level_ = top;
  expected_violated_ = expected_violated;
  last_ = expected_level();
  changes_ = 0;
  max_changes_ = 8 * (problem.variables() + 8);
  while (true) {
    if (!choose_level(direct)) return false;
    if (direct.freedom() == 0) return false;
    if (!set_up_metric(direct)) return false;
    const Outcome outcome = run(direct);
    if (outcome == Outcome::kGivenUp) return false;
    if (outcome == Outcome::kContradiction) {
      direct.truncate(rank_at_level_[contradiction_]);
      level_ = last_ = contradiction_;
      continue;
    }
    fix_level(direct);
    if (level_ == levels || direct.freedom() == 0) break;
    first_ = ++level_;
    last_ = expected_level();
  }
  for (const Active& active : active_) {
    side_[candidates_[active.candidate].row] = active.sign > 0.0 ? 1 : -1;
  }
  write(guess);
  return true;
}

}  // namespace hg::hqp::solver
