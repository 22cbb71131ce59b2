/// Active-set iteration for all levels at once: one elimination gives the point of a guessed active
/// set, and a check whether it is the optimum.
///
/// Every active row of a level, at its bound or violated, is a target of the level's least
/// squares. The last point and the new one make a step: the first inactive row that blocks it
/// becomes active, and the next step starts there. Without a blocking row, rows that the new point
/// is inside of are released; without these, the row with the most negative multiplier. From x = 0
/// with the rows violated there, the slacks decrease lexicographically with every step of positive
/// length. D. Dimitrov, A. Sherikov, P.-B. Wieber, Efficient resolution of potentially conflicting
/// linear constraints in robotics, 2015.
#pragma once

#include <span>
#include <vector>

#include "hg/hqp/solver/workspace.h"

namespace hg::hqp::solver {

/// Copies `guess` into `states`, made to fit the bounds: no row active at an infinite bound,
/// equalities marked as such. Returns whether it has active rows besides equalities.
bool load_guess(const Problem& problem, int levels, std::span<const RowState> guess,
                std::vector<RowState>& states) noexcept;

/// Writes the guess whose active rows are the equalities and the rows that x = 0 violates.
void guess_from_zero(const Problem& problem, int levels, std::vector<RowState>& states) noexcept;

/// Sets the last point to x = 0; work.iterate.state may have any content.
void start_from_zero(const Problem& problem, Workspace& work) noexcept;

/// Starts from x = 0 with `guess`, which is exchanged for work.iterate.state: levels above the
/// first one where they differ keep their pivots.
void start_from_zero_with(const Problem& problem, std::vector<RowState>& guess,
                          Workspace& work) noexcept;

/// Starts from x = 0 at the beginning of a solve.
void start_solve(const Problem& problem, Workspace& work) noexcept;

/// Writes the levels expected to have violated inequalities into work.levels.expected_violated:
/// those of the last solve, whose states are `last`; when it had none, those that the point tried
/// last violates, but for the first of them, where a row has become active since.
void expect_violated(const Problem& problem, const SolverOptions& options, int levels,
                     std::span<const RowState> last, Workspace& work) noexcept;
/// Sets work.levels.expected_violated to the levels violated at the point tried last. Returns
/// whether it changed.
bool expect_violated_now(const Problem& problem, const SolverOptions& options, int levels,
                         Workspace& work) noexcept;

/// Writes the guess of the dual method into work.iterate.state; its point becomes the last one.
/// False if there is none; work.iterate.state is then unchanged. Needs
/// work.levels.expected_violated.
bool start_from_dual(const Problem& problem, const SolverOptions& options, int levels,
                     Workspace& work) noexcept;

/// Writes the better of two points into the iterate, level by level: that of the last,
/// unproven guess and that of the dual method. Returns the number of levels that it is optimal for.
int choose_better_point(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept;

/// Number of levels for which the iterate is optimal, by its values alone: by the
/// gradient that remains after the rows above that are equalities, violated or at a bound.
/// work.duals.gradient is that of the first level that is not optimal. Determines the states of all
/// rows from their values.
/// levels + 1: |x| is also the smallest, or need not be.
int count_optimal_levels(const Problem& problem, const SolverOptions& options, int levels,
                         Workspace& work) noexcept;

enum class GuessResult {
  kProven,     ///< the iterate is optimal for each level
  kCorrected,  ///< the iterate is not optimal; work.iterate.state is the next guess
  kInDoubt,    ///< not finite, or rounding hides optimality; another try would give the same
};

/// Solves the first `levels` levels with the active rows of work.iterate.state, by Gauss
/// elimination where that leaves no doubt, else by Householder QR (work.factors.is_gauss).
/// Proven means that no inactive row is violated, active ones are at their bound or outside,
/// multipliers have the right sign and cancel the gradient of each level. Computes
/// work.iterate.value. The first work.factors.gauss_levels levels keep their factors. With
/// work.outcome.is_last_guess, the guess is not corrected, and work.outcome.proven_levels is the
/// number of levels for which its point is optimal.
GuessResult solve_guess(const Problem& problem, const SolverOptions& options, int levels,
                        Workspace& work) noexcept;

}  // namespace hg::hqp::solver
