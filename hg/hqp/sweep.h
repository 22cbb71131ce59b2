/// One elimination for a guessed active set: its point, and whether that is the optimum. Repeated,
/// this is an active-set method for all levels at once.
///
/// Every active row of a level, guessed to be held or violated, is a target of the level's least
/// squares. The last point and the new one make a step: the first inactive row in its way becomes
/// active, and the method stays there; without one, rows that the new point is inside of are
/// released, else the one whose multiplier pulls most. From x = 0 with the rows violated there, the
/// slacks fall lexicographically with every step of some length. D. Dimitrov, A. Sherikov, P.-B.
/// Wieber, Efficient resolution of potentially conflicting linear constraints in robotics, 2015.
#pragma once

#include <span>
#include <vector>

#include "hg/hqp/workspace.h"

namespace hg::hqp {

/// Copies `guess` into `states`, made to fit the bounds: no row held at an infinite bound,
/// equalities marked as such. Returns whether it has active rows besides equalities.
bool load_guess(const Problem& problem, int levels, std::span<const RowState> guess,
                std::vector<RowState>& states) noexcept;

/// Writes the guess whose active rows are the equalities and the rows that x = 0 violates.
void guess_from_zero(const Problem& problem, int levels, std::vector<RowState>& states) noexcept;
bool is_guess_from_zero(const Problem& problem, int levels,
                        const std::vector<RowState>& states) noexcept;

/// Sets the last point to x = 0; nothing is known of work.point.state.
void start_from_zero(const Problem& problem, Workspace& work) noexcept;

/// Starts from x = 0 with `guess`, which is exchanged for work.point.state: levels above the first
/// one where they differ keep their pivots.
void start_from_zero_with(const Problem& problem, std::vector<RowState>& guess,
                          Workspace& work) noexcept;

/// Starts from x = 0 at the beginning of a solve.
void start_solve(const Problem& problem, Workspace& work) noexcept;

/// Writes the levels expected to have violated inequalities into work.gives_way: those of the last
/// solve, whose states are `last`; when it had none, those that the point tried last violates, but
/// for the first of them, where a row has become active since.
void expect_violated(const Problem& problem, const Options& options, int levels,
                     std::span<const RowState> last, Workspace& work) noexcept;
/// Sets work.gives_way to the levels violated at the point tried last. Returns whether it changed.
bool expect_violated_now(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept;

/// Writes the guess of the dual method into work.point.state; its point becomes the last one. False
/// if there is none; work.point.state is then unchanged. Needs work.gives_way.
bool start_from_dual(const Problem& problem, const Options& options, int levels,
                     Workspace& work) noexcept;

/// Writes the better of two points into work.point, level by level: that of the last, unproven
/// guess and that of the dual method. Returns the number of levels that it is optimal for.
int take_better_point(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept;

/// Number of levels for which work.point is optimal, judged by its values alone: by the gradient
/// that remains after the rows above that are equalities, violated or at a bound. work.gradient is
/// that of the first level that is not. Reads the states of all rows anew. levels + 1: |x| is also
/// the smallest, or need not be.
int count_optimal_levels(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept;

enum class Judgement {
  kProven,     ///< work.point is optimal for each level
  kCorrected,  ///< work.point is not optimal; work.point.state is the next guess
  kInDoubt,    ///< not finite, or rounding hides optimality; another try would give the same
};

/// Solves the first `levels` levels with the active rows of work.point.state, by direct elimination
/// where that leaves no doubt, else by the orthogonal one (work.is_direct). Proven means that no
/// inactive row is violated, active ones are at their bound or outside, multipliers have the right
/// sign and cancel the gradient of each level. Sets work.value of the point. The first
/// work.direct_levels levels are taken from the last guess. With work.is_last, the guess is not
/// corrected, and work.proven_levels is the number of levels for which its point is optimal.
Judgement solve_guess(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept;

}  // namespace hg::hqp
