/// Times and errors of our solver, cold and warm, and of the paper's cascade on the same problems.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/baseline.h"
#include "bench/problem_source.h"
#include "bench/times.h"

namespace hg::bench {

/// One solver on one set of problems.
struct SolverRun {
  std::string_view solver;  ///< solver and start: "warm", "cold" or "cascade"
  Times times;
  double iterations = 0.0;   ///< active sets tried, sum over the problems; cascade: 0
  std::size_t failures = 0;  ///< number of problems that the solver reports as unsolved
  /// Number of problems with differing slack norms; none = no reference
  std::optional<std::size_t> wrong;
};

/// Runs of several solvers on one set of problems, ours first. Warm is left out unless successive
/// problems are similar.
struct SolverSet {
  std::string name;
  int variables = 0, levels = 0;  ///< largest number of variables and levels
  std::size_t problems = 0;
  std::vector<SolverRun> runs;
};

/// Solves all problems of `source` `passes` times with each solver, warm from the guess of the
/// problem where its file has one, else from the problem before. `baseline` may be null, and is
/// left out unless successive problems are similar: on others it may never return. Each problem is
/// copied into place just before it is solved, as a cycle does. `wrong` compares with the reference
/// of the source; without one the cascade is compared with ours, and ours with the cascade: wrong
/// is then where the cascade is better.
SolverSet measure_solvers(ProblemSource& source, BaselineSolve baseline, int passes);

}  // namespace hg::bench
