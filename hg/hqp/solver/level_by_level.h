/// Primal method that always terminates: level by level, from one feasible point to a better one.
#pragma once

#include "hg/hqp/solver/workspace.h"

namespace hg::hqp::solver {

enum class LevelOutcome { kOptimal, kIterationLimit, kNotFinite };

/// Solves the first `levels` levels, starting from the point of the dual method, else from x = 0.
/// Each step minimises the level's objective on the rows with positive multipliers (Nnls), searches
/// along it exactly and never leaves the optimal set of the levels above. Adds to `iterations`,
/// stops at options.max_iterations; `completed` receives the number of optimal levels.
/// work.iterate.x and work.iterate.state always hold the last point.
LevelOutcome solve_level_by_level(const Problem& problem, const SolverOptions& options, int levels,
                                  int& iterations, int& completed, Workspace& work) noexcept;

}  // namespace hg::hqp::solver
