/// One elimination for a guessed active set: the point it stands for, and whether it is the
/// optimum.
#pragma once

#include "hg/hqp/workspace.h"

namespace hg::hqp {

/// Makes work.point.state fit the bounds: no row held at an infinite bound, equalities as such.
void make_consistent(const Problem& problem, int levels, Workspace& work) noexcept;

/// Solves the first `levels` levels with equality, violated and held rows as work.point.state says,
/// by direct elimination where that leaves no doubt, else by the orthogonal one (work.is_direct).
/// Returns true when the result, work.point, is proven optimal for each of them: no other row is
/// violated, violated rows are, and multipliers have the right sign. Otherwise one state is
/// corrected for the next guess: the first, level after level, of a row that is not where the guess
/// has it, or of one that pulls; when there is none, the row that is violated most gets held.
/// Leaves work.value of the point. The first work.direct_levels levels are taken from the last guess.
bool solve_guess(const Problem& problem, const Options& options, int levels,
                 Workspace& work) noexcept;

}  // namespace hg::hqp
