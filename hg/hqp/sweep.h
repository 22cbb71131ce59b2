/// One elimination for a guessed active set: the point it stands for, and whether it is the
/// optimum. As a sequence: an active-set method for all levels at once.
///
/// Every active row of a level, guessed to be held or violated, is a target of the level's least
/// squares. The last point and the new one make a step: the first inactive row in its way becomes
/// active, and the method stays there; without one, rows that the new point is inside of are let go
/// of, else the one whose multiplier pulls most. From x = 0 with the rows violated there, the
/// slacks fall lexicographically with every step of some length. D. Dimitrov, A. Sherikov, P.-B.
/// Wieber, Efficient resolution of potentially conflicting linear constraints in robotics, 2015.
#pragma once

#include <span>
#include <vector>

#include "hg/hqp/workspace.h"

namespace hg::hqp {

/// `guess` into `states`, made to fit the bounds: no row held at an infinite bound, equalities as
/// such. Returns whether it has active rows besides equalities.
bool load_guess(const Problem& problem, int levels, std::span<const RowState> guess,
                std::vector<RowState>& states) noexcept;

/// The guess whose active rows are the equalities and the rows that x = 0 violates.
void guess_from_zero(const Problem& problem, int levels, std::vector<RowState>& states) noexcept;
bool is_guess_from_zero(const Problem& problem, int levels,
                        const std::vector<RowState>& states) noexcept;

/// The last point is x = 0; nothing is known of work.point.state.
void start_from_zero(const Problem& problem, Workspace& work) noexcept;

/// The same with `guess`, which is exchanged for work.point.state: levels above the first one where
/// they differ keep their pivots.
void start_from_zero_with(const Problem& problem, std::vector<RowState>& guess,
                          Workspace& work) noexcept;

/// The same at the beginning of a solve.
void start_solve(const Problem& problem, Workspace& work) noexcept;

/// Levels that are expected to have violated inequalities, into work.gives_way: those of the last
/// solve, whose states are `last`; when it had none, those that the point tried last violates, but
/// for the first of them, where a row has become active since.
void expect_violated(const Problem& problem, const Options& options, int levels,
                     std::span<const RowState> last, Workspace& work) noexcept;
/// Those of the point tried last. Returns whether that is anything new.
bool expect_violated_now(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept;

/// The guess of the dual method into work.point.state, its point being the last one. False: it has
/// none, and work.point.state is as it was. Needs work.gives_way.
bool start_from_dual(const Problem& problem, const Options& options, int levels,
                     Workspace& work) noexcept;

/// After a last guess that was not proven: the better one of its point and that of the dual method,
/// level by level, into work.point. Returns the number of levels that it is optimal for.
int take_better_point(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept;

/// Levels that work.point is optimal for by its values alone, whatever has found it: what rows
/// above that are equalities, violated or at a bound leave of the gradient. work.gradient is that
/// of the first level that is not. Reads the states of all rows anew. levels + 1: |x| is the
/// smallest, too, or need not be.
int count_optimal_levels(const Problem& problem, const Options& options, int levels,
                         Workspace& work) noexcept;

enum class Judgement {
  kProven,     ///< work.point is optimal for each level
  kCorrected,  ///< it is not; work.point.state is the next guess
  kInDoubt,    ///< not finite, or rounding hides whether it is; another try would be the same
};

/// Solves the first `levels` levels with the active rows of work.point.state, by direct elimination
/// where that leaves no doubt, else by the orthogonal one (work.is_direct). Proven means that no
/// inactive row is violated, active ones are at their bound or outside, multipliers have the right
/// sign and cancel the gradient of each level. Leaves work.value of the point. The first
/// work.direct_levels levels are taken from the last guess. With work.is_last, the guess is not
/// corrected, and work.proven_levels tells how far its point is optimal.
Judgement solve_guess(const Problem& problem, const Options& options, int levels,
                      Workspace& work) noexcept;

}  // namespace hg::hqp
