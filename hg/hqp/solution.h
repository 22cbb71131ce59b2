/// Inputs and results of a solve besides the problem: options, active set, solution.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::hqp {

enum class Status : std::uint8_t {
  kSolved,  ///< every level is optimal
  /// The first `completed_levels` are optimal; when all are, |x| may not be the smallest. Out of
  /// active sets, or rounding hides whether more is optimal.
  kIterationLimit,
  kBadRow,  ///< `bad_row` is not finite, has lb > ub or a weight <= 0; levels above it hold
  kNumericalFailure,  ///< overflow: x is the last finite point
};
const char* to_string(Status status) noexcept;

/// Place of a row relative to its interval.
enum class RowState : std::uint8_t {
  kInactive,  ///< inside, or at a bound without being active
  kLower,     ///< held at its lower bound by lower levels
  kUpper,     ///< held at its upper bound by lower levels
  kEqual,     ///< lb = ub and reached
  kBelow,     ///< violated: stays below its lower bound
  kAbove,     ///< violated: stays above its upper bound
};
constexpr bool is_at_bound(RowState s) noexcept {
  return s == RowState::kLower || s == RowState::kUpper;
}
constexpr bool is_violated(RowState s) noexcept {
  return s == RowState::kBelow || s == RowState::kAbove;
}

/// Two guesses of the row states, by row id. A plain value: copy, store and pass it on. The default
/// is a cold start; a wrong or outdated guess costs time, never correctness.
struct ActiveSet {
  std::array<RowState, kMaxRows> state{};
  /// Last states that differ from `state`, tried when `state` is wrong: limits that toggle every
  /// other cycle cost one try.
  std::array<RowState, kMaxRows> before{};
};

struct SolverOptions {
  /// A row that is a combination of others, up to this fraction of its own norm, is dependent.
  double rank_tolerance = 1e-9;
  /// A bound counts as met up to this fraction of |bound| + norm(row) |x|.
  double feasibility_tolerance = 1e-10;
  /// Active sets tried before the solver stops, > 0; a warm start mostly needs 1 or 2.
  int max_iterations = 1000;
  /// Active sets tried before the solve ends with the best known result; 0 = no such limit. Ending
  /// costs the dual method and one more active set.
  int budget = 0;
  /// Uses freedom left by the last level to minimise |x|; otherwise x is any optimal point.
  bool minimum_norm = true;
};

/// Throws SetupError, naming the field, unless 0 < tolerances <= 1e-3 max_iterations > 0 and
/// budget >= 0.
void check_solver_options(const SolverOptions& options);

struct LevelResult {
  double slack_squared;  ///< sum of (weight * slack)^2 over the level's rows
  int freedom;           ///< dimensions left to this level; 0 = levels above fix x
  int blocking_row;      ///< row of a higher level that costs this level most slack; -1 = none
};

/// Result of one solve. Vectors have the size of the problem; they never grow beyond `capacity`.
struct Solution {
  /// Throws SetupError, see check_capacity().
  explicit Solution(const Capacity& capacity);

  Status status = Status::kSolved;
  int iterations = 0;        ///< active sets tried
  int completed_levels = 0;  ///< levels known to be optimal, counted from the top
  int bad_level = -1;        ///< level of the row that caused kBadRow, else -1; its id is bad_row
  int bad_row = -1;
  std::vector<double> x;        ///< solution point, always finite
  std::vector<RowState> state;  ///< state per row id
  std::vector<double> slack;    ///< slack per row id: nearest bound - c x, 0 inside; not weighted
  std::vector<LevelResult> levels;  ///< result per level
};

}  // namespace hg::hqp
