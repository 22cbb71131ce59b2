/// Memory of the solver, grouped by who computes it, and the terms shared by its parts.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"
#include "hg/hqp/solver/dual_method.h"
#include "hg/hqp/solver/gauss_elimination.h"
#include "hg/hqp/solver/householder_qr.h"
#include "hg/hqp/solver/nnls.h"
#include "hg/hqp/solver/rows.h"

namespace hg::hqp::solver {

// Vectors of the structs below have their largest size from the start, except lists, which are
// reserved.

/// A point with its row states and pivots.
struct Point {
  explicit Point(const Capacity& capacity);

  Eigen::VectorXd x;
  std::vector<RowState> state;  ///< state per row; before the point is computed: the guess
  /// Number of pivots of the levels above; last entry: of all levels
  std::vector<int> rank_at_level;
  std::vector<int> blocking_row;  ///< blocking row per level, -1 = none
};

/// The point under test, with what its tests need.
struct Iterate : Point {
  explicit Iterate(const Capacity& capacity);

  Point& point() noexcept { return *this; }

  /// Size of x that tolerances are relative to: at the point, or the largest since its start
  double x_norm = 0.0;
  std::vector<double> value;  ///< c x by row, see update_values()
};

/// Result of Gauss elimination for a level's active rows.
enum class Fit : std::uint8_t {
  kNoFreedom,     ///< levels above fix x
  kMet,           ///< targets met
  kLeastSquares,  ///< targets contradict, least squares
};

/// Factors of the active rows, level by level, by either method of elimination.
struct Factors {
  explicit Factors(const Capacity& capacity);

  HouseholderQr householder;
  GaussElimination gauss;
  bool is_gauss = false;  ///< pivots of the iterate are those of `gauss`
  int gauss_levels = 0;  ///< number of levels whose pivots in `gauss` fit the states of the iterate
  std::vector<int> gauss_rank_at_level;
  std::vector<Fit> fit;  ///< fit of the levels in `gauss`, and of the smallest norm

  int pivot_row(int t) const noexcept {
    return is_gauss ? gauss.pivot_row(t) : householder.pivot_row(t);
  }
};

/// Multipliers of the level under test.
struct Duals {
  explicit Duals(const Capacity& capacity);

  Eigen::VectorXd gradient;  ///< gradient of the level's objective; multipliers cancel it
  Eigen::VectorXd mu;        ///< multipliers, per pivot
  /// Per pivot: an inequality that some level surely needs, hence an equality for those below
  std::vector<std::uint8_t> is_fixed_pivot;
};

/// The active-set iteration: what it remembers from step to step.
struct Steps {
  explicit Steps(const Capacity& capacity);

  std::vector<double> last_value;  ///< c x per row at the point from which the next step starts
  int count = 0;                   ///< number of steps since that point was x = 0
  int released_row = -1;           ///< row released by the last step for the sign of its multiplier
  RowState released_state = RowState::kInactive;  ///< state of released_row before its release
  /// Per row: its multiplier is positive, however small, as the dual method or its release has
  /// shown
  std::vector<std::uint8_t> must_stay_active;
};

/// Levels with violated inequalities.
struct ViolatedLevels {
  explicit ViolatedLevels(const Capacity& capacity);

  std::vector<std::uint8_t> has_violated;       ///< per level, as found at the iterate
  std::vector<std::uint8_t> expected_violated;  ///< per level, for the dual method
};

/// What is known of the solve.
struct Outcome {
  bool is_last_guess = false;   ///< no step follows the guess
  int proven_levels = 0;        ///< number of levels for which the last guess's point is optimal
  bool has_dual_point = false;  ///< dual.point() belongs to this solve
};

/// A step of the level-by-level method.
struct LineSearch {
  explicit LineSearch(const Capacity& capacity);

  Eigen::VectorXd direction;
  std::vector<double> slope;                ///< c d by row, d the direction
  std::vector<std::uint8_t> is_fixed;       ///< per row: an equality for the levels below
  std::vector<std::uint8_t> skipped_sides;  ///< per row: sides that do not block a step
};

struct Workspace {
  explicit Workspace(const Capacity& capacity);

  Iterate iterate;
  Factors factors;
  Duals duals;
  Steps steps;
  ViolatedLevels levels;
  Outcome outcome;
  LineSearch search;
  DualMethod dual;
  Nnls nnls;

  Point saved;                         ///< saved copy of the iterate's point
  std::vector<RowState> second_guess;  ///< another guess of the states
  std::vector<TargetRow> targets;
  std::vector<RowAtBound> rows_at_bounds;
  std::vector<RowAtBound>
      working_set;  ///< pivots of the level-by-level method, after the fixed ones

  std::uint64_t budgets_spent = 0;
};

/// Size of a gradient, for decisions on the signs of multipliers.
struct LevelGradient {
  bool is_zero;     ///< every row of the level is met within its tolerance
  double scale;     ///< sum of the norms of the gradient's terms
  double rounding;  ///< upper bound of the part of `scale` that is rounding error

  /// Multipliers mu norm(c) above this are positive: the row belongs to the optimum. Those below
  /// -surely_negative() are negative: it does not. A row in between stays active, but lower levels
  /// may release it.
  double surely_positive() const noexcept { return 1e-8 * scale + rounding; }
  double surely_negative() const noexcept { return 1e-12 * scale + rounding; }
};

/// Number of rows of the first `levels` levels.
inline int rows_of(const Problem& problem, int levels) noexcept {
  return levels > 0 ? problem.end_row(levels - 1) : 0;
}

/// Guess for a row state: a violated row becomes active at the bound it does not reach.
inline RowState as_guess(RowState state) noexcept {
  if (state == RowState::kBelow) return RowState::kLower;
  return state == RowState::kAbove ? RowState::kUpper : state;
}

/// Distance from the bound up to which the row counts as being at it.
double tolerance(const Problem& problem, const SolverOptions& options, const Iterate& iterate,
                 int row, double bound) noexcept;

/// Signed distance of the row's value from its bounds, as excess(); 0 within the tolerance.
inline double violation(const Problem& problem, const SolverOptions& options,
                        const Iterate& iterate, int row) noexcept {
  const Interval bounds = problem.bounds(row);
  const double distance = excess(bounds, iterate.value[row]);
  if (distance == 0.0) return 0.0;
  const double bound = distance > 0.0 ? bounds.ub : bounds.lb;
  return std::abs(distance) > tolerance(problem, options, iterate, row, bound) ? distance : 0.0;
}

/// Whether the row's value is at `bound`, within the tolerance.
bool reaches(const Problem& problem, const SolverOptions& options, const Iterate& iterate, int row,
             double bound) noexcept;

/// Computes the values of the rows of the first `levels` levels.
void update_values(const Problem& problem, int levels, Iterate& iterate) noexcept;

/// Computes x += length * step; false, leaving x unchanged, if the result would not be finite.
[[nodiscard]] bool move(const Problem& problem, const Eigen::VectorXd& step, double length,
                        Iterate& iterate) noexcept;

/// Writes the level's equality and violated rows into `targets`: the quadratic piece of the level's
/// objective at x.
void collect_targets(const Problem& problem, const SolverOptions& options, int level,
                     const Iterate& iterate, std::vector<TargetRow>& targets) noexcept;

/// Appends the level's inequality rows that are at a bound to `rows`.
void collect_rows_at_bounds(const Problem& problem, const SolverOptions& options, int level,
                            const Iterate& iterate, std::vector<RowAtBound>& rows) noexcept;

/// Adds the row's term of the gradient, weight^2 c^T (c x - bound), to `gradient` and its size to
/// `size`; returns |c x - bound|.
double add_residual(const Problem& problem, int row, double bound, const Iterate& iterate,
                    Eigen::VectorXd& gradient, LevelGradient& size) noexcept;

/// Writes the gradient of the objective of `level`, or of 1/2 |x|^2 for level == problem.levels().
LevelGradient level_gradient(const Problem& problem, const SolverOptions& options, int level,
                             const Iterate& iterate, Eigen::VectorXd& gradient) noexcept;

}  // namespace hg::hqp::solver
