/// Primal method that always terminates: level by level, from one feasible point to a better one.
#pragma once

#include "hg/hqp/workspace.h"

namespace hg::hqp {

enum class PrimalOutcome { kOptimal, kIterationLimit, kNotFinite };

/// Solves the first `levels` levels, starting from the point of the dual method, else from x = 0.
/// Each step minimises the level's objective on the rows that push (Cone), searches along it
/// exactly and never leaves the optimal set of the levels above. Adds to `iterations`, stops at
/// options.max_iterations; `completed` receives the number of optimal levels. work.point.x and
/// work.point.state always hold the last point.
PrimalOutcome solve_level_by_level(const Problem& problem, const Options& options, int levels,
                                   int& iterations, int& completed, Workspace& work) noexcept;

}  // namespace hg::hqp
