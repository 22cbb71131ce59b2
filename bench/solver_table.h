/// Times and mistakes of our solver, cold and warm, and of the paper's cascade on the same
/// problems.
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
  std::string_view solver;  ///< "warm", "cold" or "cascade"
  Times times;
  double iterations = 0.0;           ///< active sets tried, sum over the problems; cascade: 0
  std::size_t failures = 0;          ///< problems that the solver says it has not solved
  std::optional<std::size_t> wrong;  ///< problems with other slack norms; none: nothing to compare
};

/// Ours first. Warm is left out where neighbours are not alike.
struct SolverSet {
  std::string name;
  int variables = 0, levels = 0;  ///< largest
  std::size_t problems = 0;
  std::vector<SolverRun> runs;
};

/// Solves all problems of `source` `passes` times with each solver, warm from the guess of the
/// problem where its file has one, else from the problem before. `baseline` may be null, and is
/// left out where neighbours are not alike: on such problems it may never return. Each
/// problem is copied into place just before it is solved, as a cycle does. `wrong` compares with
/// the reference of the source; without one the cascade is compared with ours, and ours with the
/// cascade: wrong is then where the cascade is better.
SolverSet measure_solvers(ProblemSource& source, BaselineSolve baseline, int passes);

std::string solver_header();
std::string to_text(const SolverSet& set);
/// A flat row per solver.
nlohmann::ordered_json to_json(const SolverSet& set);

}  // namespace hg::bench
