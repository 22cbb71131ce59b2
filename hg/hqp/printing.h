/// Problems and solutions as readable text.
///
/// Numbers are rounded to six digits; rows and levels are counted from 0, as everywhere.
/// Set-up code: allocates.
#pragma once

#include <span>
#include <string>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

const char* to_string(RowState state) noexcept;

/// One row: id, level, content, weight unless 1. Example:
/// "row 3 (level 1): 0.5 x0 - 2 x4 in [-1, 1], weight 0.1". Long rows end in "...".
std::string to_string(const Problem& problem, int row);

/// Tolerances and limits, one line.
std::string to_string(const SolverOptions& options);

/// Report on the solve of `problem`, several lines: how the solve ended; a line per level with the
/// number of its rows, equalities that are met, rows held at a bound and violated ones, its
/// freedom, its slack (square root of slack_squared) and the row that blocks it; a line per row
/// that is held or violated. `solution` must be one of `problem`.
std::string to_string(const Problem& problem, const Solution& solution);

/// Report on the result of Solver::multipliers() for `level`: a line per row with a multiplier, and
/// `remainder`, its return value.
std::string to_string(const Problem& problem, int level, std::span<const double> multipliers,
                      double remainder);

}  // namespace hg::hqp
