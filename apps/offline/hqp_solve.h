/// `hapticgiant hqp solve FILE`: solves recorded or dumped problems of the lexicographic solver.
#pragma once

#include <optional>
#include <string>

namespace hg::apps {

class Command;

struct HqpSolveArguments {
  std::string file;            ///< file in the text format of hg/hqp/text.h, plain or gzipped
  std::optional<int> problem;  ///< index of the only problem to solve; unset = all
  std::optional<int> level;    ///< level whose multipliers are shown
  bool explains = false;       ///< shows the solution in words instead of numbers
  bool has_timing = false;     ///< shows times instead of solutions; not with `level` or `explains`
};

/// Solves the problems of a file with their options. Each starts from its own guess; without one,
/// from the active set of the problem before.
///
/// Prints one line per problem to stdout: x, then per level the optimal squared slack norm, in the
/// shortest form that reads back to the same number. With `explains` or `level`: the solution in
/// words, hg/hqp/printing.h. With `has_timing` a table: microseconds per problem, median, mean,
/// 99.9 % and maximum, from a cold start and as above; each problem counts with the fastest of
/// several runs, so that interruptions by the system do not show.
///
/// Problems that the solver does not solve are reported on stderr with their status. Returns the
/// exit code: 0, or 1 when a problem was not solved. Throws SetupError with "file:line: ..." when
/// the file is invalid, when there is no such problem or level, and when times and explanations are
/// both requested.
int run_hqp_solve(const HqpSolveArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_hqp(Command app, int& exit_code);

}  // namespace hg::apps
