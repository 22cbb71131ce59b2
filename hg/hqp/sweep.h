/// One elimination for a guessed active set: the point it stands for, and whether it is the
/// optimum.
#pragma once

#include "hg/hqp/workspace.h"

namespace hg::hqp {

/// Makes work.point.state fit the bounds: no row held at an infinite bound, equalities as such.
void make_consistent(const Problem& problem, int levels, Workspace& work) noexcept;

/// Solves the first `levels` levels with equality, violated and held rows as work.point.state says.
/// Returns true when the result, work.point, is proven optimal for each of them: no other row is
/// violated, violated rows are, and multipliers have the right sign. Otherwise the states become
/// the next guess. First one row at a time is corrected: held when it turned out violated, violated
/// when it was held and cannot be reached. When all fit their values, rows that pull are released.
bool solve_guess(const Problem& problem, const Options& options, int levels,
                 Workspace& work) noexcept;

}  // namespace hg::hqp
