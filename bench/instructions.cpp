/// Runs one part of the benchmark under callgrind: instruction counts without noise.
///
///   bench_instructions cycle SCENARIO         Cycle::step, law gauss, bounds recoverable
///   bench_instructions warm|cold SET          the solver
///
/// on the first 500 cycles that render or problems. SET is a problem file, or SCENARIO:gauss,
/// SCENARIO:paper as in `hapticgiant bench`. Only counted() is to be counted
/// (--toggle-collect=counted); prints how many times it was called.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "bench/player.h"
#include "bench/problem_source.h"
#include "bench/scenario.h"
#include "hg/core/error.h"
#include "hg/hqp/solver.h"

namespace {

using namespace hg;
constexpr std::size_t kCount = 500;

struct Work {
  bench::Player* player = nullptr;  ///< a cycle, or
  hqp::Solver* solver = nullptr;    ///< a solve
  const hqp::Problem* problem = nullptr;
  hqp::ActiveSet* active = nullptr;
  hqp::Solution* solution = nullptr;
};

}  // namespace

extern "C" [[gnu::noipa]] void counted(const Work& work) {
  if (work.player != nullptr) {
    work.player->run();
  } else {
    work.solver->solve(*work.problem, {}, *work.active, *work.solution);
  }
}

namespace {

config::Scenario load(const std::string& name, rendering::Law law, rendering::Bounds bounds) {
  return bench::with_law(bench::bench_scenario(name), law, bounds);
}

std::size_t run_cycles(const std::string& name) {
  const config::Scenario scenario =
      load(name, rendering::Law::kGauss, rendering::Bounds::kRecoverable);
  bench::Player player(scenario);
  std::size_t done = 0;
  bool has_more = true;
  while (has_more && done < kCount) {
    player.begin();
    if (player.is_running()) {
      counted({.player = &player});
      ++done;
    } else {
      player.run();
    }
    has_more = player.end();
  }
  return done;
}

std::size_t solve(bench::ProblemSource& source, bool is_warm) {
  const std::span<const hqp::Problem> problems = source.next();
  const hqp::Capacity capacity = {
      .variables = hqp::kMaxVariables, .levels = hqp::kMaxLevels, .rows = hqp::kMaxRows};
  hqp::Solver solver(capacity);
  hqp::Solution solution(capacity);
  hqp::ActiveSet active;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const hqp::ActiveSet* const guess = source.guess(i);
    if (!is_warm) active = {};
    if (is_warm && guess != nullptr) active = *guess;
    counted({.solver = &solver, .problem = &problems[i], .active = &active, .solution = &solution});
  }
  return problems.size();
}

std::size_t solve(const std::string& set, bool is_warm) {
  const std::size_t colon = set.find(':');
  if (colon == std::string::npos) {
    bench::ProblemSource source(set, kCount);
    return solve(source, is_warm);
  }
  const bool is_gauss = set.substr(colon + 1) == "gauss";
  const config::Scenario scenario =
      is_gauss ? load(set.substr(0, colon), rendering::Law::kGauss, rendering::Bounds::kRecoverable)
               : load(set.substr(0, colon), rendering::Law::kPaper, rendering::Bounds::kPaper);
  bench::ProblemSource source(set, scenario, kCount);
  return solve(source, is_warm);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  try {
    if (what == "cycle") {
      std::printf("%zu\n", run_cycles(argv[2]));
    } else if (what == "warm" || what == "cold") {
      std::printf("%zu\n", solve(argv[2], what == "warm"));
    } else {
      std::fprintf(stderr, "usage: bench_instructions cycle|warm|cold SCENARIO|SET\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
