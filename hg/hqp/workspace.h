/// Memory of the solver and the terms shared by its parts.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "hg/hqp/cone.h"
#include "hg/hqp/direct_elimination.h"
#include "hg/hqp/dual.h"
#include "hg/hqp/elimination.h"
#include "hg/hqp/problem.h"
#include "hg/hqp/rows.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

/// A point with its row states and pivots. Vectors have their largest size.
struct Point {
  explicit Point(const Capacity& capacity);

  Eigen::VectorXd x;
  std::vector<RowState> state;  ///< state per row
  /// Number of pivots of the levels above; last entry: of all levels
  std::vector<int> rank_at_level;
  std::vector<int> blocking_row;  ///< blocking row per level, -1 = none
};

/// Result of direct elimination for a level's active rows.
enum class Fit : std::uint8_t {
  kFrozen,        ///< no freedom: levels above fix x
  kMet,           ///< targets met
  kLeastSquares,  ///< targets contradict, least squares
};

/// The point under test and everything needed to judge it. Vectors have their largest size from the
/// start, except the lists, which are reserved.
struct Workspace {
  explicit Workspace(const Capacity& capacity);

  Elimination elimination;
  DirectElimination direct;
  DualMethod dual;
  Cone cone;

  std::uint64_t budgets_spent = 0;

  Point point;
  Point saved;  ///< saved copy of a point
  std::vector<RowState> second_guess;
  /// Size of x that tolerances are relative to: at the point, or the largest on the way to it
  double x_norm = 0.0;
  std::vector<double> value;       ///< c x by row
  std::vector<double> last_value;  ///< c x per row at the point from which the next step starts
  int steps = 0;                   ///< number of steps since that point was x = 0
  std::vector<std::uint8_t> is_frozen;  ///< per pivot: a held row that a level pushed against
  int released_row = -1;  ///< row released by the last step because it pulled; its state follows
  RowState released_state = RowState::kInactive;
  /// Per row: pushes, however little, as the dual method or its release has shown
  std::vector<std::uint8_t> is_needed;
  bool is_last = false;         ///< no step follows the guess
  int proven_levels = 0;        ///< number of levels for which the last guess's point is optimal
  bool has_dual_point = false;  ///< dual.point() belongs to this solve
  bool is_direct = false;       ///< the pivots of `point` are those of `direct`
  int direct_levels = 0;        ///< number of levels whose pivots in `direct` fit point.state
  std::vector<int> direct_rank_at_level;
  std::vector<std::uint8_t> has_violated;  ///< per level, as found at the point
  std::vector<std::uint8_t> gives_way;     ///< per level: expected to have violated inequalities
  std::vector<Fit> fit;  ///< fit of the levels in `direct`, and of the smallest norm

  std::vector<TargetRow> targets;
  std::vector<TouchedRow> touched;
  std::vector<TouchedRow> held;  ///< pivots of the level-by-level method, after the fixed ones
  Eigen::VectorXd mu;            ///< multipliers, per pivot
  std::vector<double> slope;     ///< c d by row, d the search direction
  std::vector<std::uint8_t> is_fixed;       ///< per row: permanently eliminated
  std::vector<std::uint8_t> skipped_sides;  ///< per row: sides that do not block a step
  Eigen::VectorXd gradient;
  Eigen::VectorXd direction;
};

/// Gradient of a level's objective at a point; the vector itself is work.gradient.
struct LevelGradient {
  bool is_zero;     ///< every row of the level is met within its tolerance
  double scale;     ///< sum of the norms of the gradient's terms
  double rounding;  ///< the part of it that rounding may have made up

  /// Size of mu norm(c) from which a held row surely belongs to the optimum, and from which, with
  /// the wrong sign, it surely does not. In between a row is held, but may be released by lower
  /// levels.
  double surely_pushing() const noexcept { return 1e-8 * scale + rounding; }
  double surely_pulling() const noexcept { return 1e-12 * scale + rounding; }
};

/// Number of rows of the first `levels` levels.
inline int rows_of(const Problem& problem, int levels) noexcept {
  return levels > 0 ? problem.end_row(levels - 1) : 0;
}

/// Guess for a row state: a violated row becomes held at the bound it does not reach.
inline RowState as_guess(RowState state) noexcept {
  if (state == RowState::kBelow) return RowState::kLower;
  return state == RowState::kAbove ? RowState::kUpper : state;
}

/// Distance from the bound below which the row counts as being at it.
double tolerance(const Problem& problem, const Options& options, const Workspace& work, int row,
                 double bound) noexcept;

/// Signed distance of c x = work.value[row] from its bounds, as excess(); 0 within the tolerance.
inline double violation(const Problem& problem, const Options& options, const Workspace& work,
                        int row) noexcept {
  const Interval bounds = problem.bounds(row);
  const double distance = excess(bounds, work.value[at(row)]);
  if (distance == 0.0) return 0.0;
  const double bound = distance > 0.0 ? bounds.ub : bounds.lb;
  return std::abs(distance) > tolerance(problem, options, work, row, bound) ? distance : 0.0;
}

/// Whether work.value[row] is at `bound`, within the tolerance.
bool touches(const Problem& problem, const Options& options, const Workspace& work, int row,
             double bound) noexcept;

/// Sets work.value of the rows of the first `levels` levels.
void update_values(const Problem& problem, int levels, Workspace& work) noexcept;

/// Computes x += length * step; false, leaving x unchanged, if the result would not be finite.
[[nodiscard]] bool move(const Problem& problem, const Eigen::VectorXd& step, double length,
                        Workspace& work) noexcept;

/// Collects the level's equality and violated rows into work.targets: the quadratic piece of the
/// level's objective that x is on. Needs work.value.
void collect_targets(const Problem& problem, const Options& options, int level,
                     Workspace& work) noexcept;

/// Appends the level's inequality rows that x is at a bound of to work.touched. Needs work.value.
void collect_touched(const Problem& problem, const Options& options, int level,
                     Workspace& work) noexcept;

/// Adds the pull of the row towards `bound` to work.gradient; returns its distance from there.
double add_pull(const Problem& problem, int row, double bound, Workspace& work,
                LevelGradient& result) noexcept;

/// Gradient of `level`, of 1/2 |x|^2 for level == problem.levels(); needs work.value.
LevelGradient level_gradient(const Problem& problem, const Options& options, int level,
                             Workspace& work) noexcept;

}  // namespace hg::hqp
