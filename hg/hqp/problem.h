/// A lexicographic least-squares problem: levels of rows, each row with its interval.
///
/// Source: [HG] (1). A level is one list of rows lb <= c x + v <= ub; an equality is a row with
/// lb = ub. Rows may be dependent, contradictory, duplicate or zero, ends may be infinite.
/// Rows are added once, at set-up, and keep their id; bounds, coefficients and weights then change
/// every cycle without allocation. Nothing is normalised or regularised.
/// Content is checked by Solver::solve(), which names the first bad row; set-up mistakes throw.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hg/core/interval.h"

namespace hg::hqp {

inline constexpr int kMaxVariables = 128;  ///< largest Capacity::variables
inline constexpr int kMaxLevels = 32;      ///< largest Capacity::levels
inline constexpr int kMaxRows = 1024;      ///< largest Capacity::rows; an ActiveSet has this size

/// Sizes fixed at construction: nothing allocates afterwards.
struct Capacity {
  int variables = 0;  ///< 1..kMaxVariables
  int levels = 0;     ///< 1..kMaxLevels
  int rows = 0;       ///< rows of all levels together, 1..kMaxRows
};

/// Throws SetupError, naming the field, unless every size is in its range.
void check_capacity(const Capacity& capacity);

class Problem {
 public:
  /// An empty problem of capacity.variables variables. Throws SetupError, see check_capacity().
  explicit Problem(const Capacity& capacity);

  /// Removes all levels and rows; the next ones are for `variables` (1..capacity) variables.
  void clear(int variables);

  /// Appends a level below all others and returns its index. Throws SetupError when full.
  int add_level();

  /// Appends a dense row to the last level and returns its id: 0, 1, ... in order of adding.
  /// `weight` multiplies the row's slack in the objective of its level.
  /// Throws SetupError when full, without a level, or unless there is a coefficient per variable.
  int add_row(std::span<const double> coefficients, Interval bounds, double weight = 1.0);

  /// Appends the row x[variable] to the last level, as add_row().
  int add_bound(int variable, Interval bounds, double weight = 1.0);

  /// New content of an existing row. set_row() is for dense rows, one coefficient per variable.
  void set_row(int row, std::span<const double> coefficients) noexcept;
  void set_bounds(int row, Interval bounds) noexcept;
  void set_weight(int row, double weight) noexcept;

  int variables() const noexcept { return variables_; }
  int levels() const noexcept { return static_cast<int>(first_row_.size()) - 1; }
  int rows() const noexcept { return static_cast<int>(rows_.size()); }
  const Capacity& capacity() const noexcept { return capacity_; }

  /// Rows of `level` have the ids first_row(level) .. end_row(level) - 1.
  int first_row(int level) const noexcept { return first_row_[level]; }
  int end_row(int level) const noexcept { return first_row_[level + 1]; }
  int level_of(int row) const noexcept;

  Interval bounds(int row) const noexcept { return rows_[row].bounds; }
  double weight(int row) const noexcept { return rows_[row].weight; }
  /// Index of the only variable of a row made by add_bound(), -1 for a dense row.
  int variable(int row) const noexcept { return rows_[row].variable; }
  /// Coefficients of a dense row, one per variable; valid until the problem is destroyed.
  std::span<const double> coefficients(int row) const noexcept {
    if (variable(row) >= 0) return {};
    return std::span(coefficients_.data() + row * capacity_.variables, variables_);
  }
  /// Euclidean norm of the row's coefficients; not finite when one of them is not.
  double norm(int row) const noexcept { return rows_[row].norm; }

 private:
  struct Row {
    Interval bounds;
    double weight;
    double norm;
    int variable;
  };

  int append(Interval bounds, double weight, int variable, double norm);

  Capacity capacity_;
  int variables_;
  std::vector<int> first_row_;  ///< first row of each level, and the total at the end
  std::vector<Row> rows_;
  std::vector<double> coefficients_;  ///< row after row, capacity.variables apart
};

/// Euclidean norm; not finite when one of the numbers is not.
double norm_of(std::span<const double> v) noexcept;

/// Rule broken by a row with this content; nullptr = none.
inline const char* broken_rule(Interval bounds, double weight, double norm) noexcept {
  if (!(norm < kInfinity)) return "coefficients and their norm must be finite";
  if (!(bounds.lb <= bounds.ub)) return "lb must not be above ub";
  if (bounds.lb == kInfinity || bounds.ub == -kInfinity) return "bounds must be met by some number";
  if (!(weight > 0.0 && weight < kInfinity)) return "the weight must be positive and finite";
  return nullptr;
}
inline const char* broken_rule(const Problem& problem, int row) noexcept {
  return broken_rule(problem.bounds(row), problem.weight(row), problem.norm(row));
}

}  // namespace hg::hqp
