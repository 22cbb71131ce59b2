/// `hapticgiant hqp solve FILE`: solves recorded or dumped problems of the lexicographic solver.
#pragma once

#include <string>

namespace hg::apps {

/// Solves every problem of FILE (text format of hg/hqp/text.h, plain or gzipped), each starting
/// from the active set of the one before, and prints one line per problem to stdout: x, then per
/// level the optimal squared slack norm, in the shortest form that reads back to the same number.
///
/// With `timing` a table takes the place of these lines: microseconds per problem, median, mean,
/// 99.9 % and maximum, from a cold start and from the active set of the problem before; each
/// problem counts with the fastest of several runs, so that interruptions by the system do not
/// show.
///
/// Problems that the solver does not settle are named on stderr with their status.
/// Returns the exit code: 0, or 1 when a problem was not settled. Throws SetupError with
/// "file:line: expected ..., got ..." when the file is not right.
int run_hqp_solve(const std::string& file, bool timing);

}  // namespace hg::apps
