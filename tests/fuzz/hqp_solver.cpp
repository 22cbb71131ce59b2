#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "hg/core/allocation_counter.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/test/byte_problem.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/slow_solver.h"
#include "hg/hqp/text.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

using namespace hqp;

[[noreturn]] void fail(const std::string& what, const ByteProblem& made, const ActiveSet& guess) {
  std::ostringstream text;
  write_problem(text, {made.problem, made.options, guess, what});
  std::fprintf(stderr, "%s\n%s\n", text.str().c_str(), what.c_str());
  std::abort();
}

std::string fault_of_solve(const ByteProblem& made, ActiveSet& active) {
  static Solver solver(ByteProblem::kCapacity);
  static Solution solution(ByteProblem::kCapacity);
  static Solution again(ByteProblem::kCapacity);
  ActiveSet guess = active;
  const AllocationCounter allocations;
  solver.solve(made.problem, made.options, active, solution);
  const auto count = allocations.count();
  if (count > 0) return "allocations: " + std::to_string(count);

  const std::string fault =
      fault_of(made.problem, made.options, solution, made.is_tame ? 1e-6 : kInfinity);
  if (!fault.empty()) {
    const bool is_in_doubt =
        made.is_tame && !solve_slowly(made.problem, made.options.minimum_norm).doubt.empty();
    return is_in_doubt ? "" : fault;
  }
  solver.solve(made.problem, made.options, guess, again);
  const bool is_same = solution.x == again.x && guess.state == active.state;
  return is_same ? "" : "other bits when solved again";
}

}  // namespace

void hqp_solver(Bytes bytes) {
  ByteProblem made(bytes, ByteProblem::Numbers::kSpecial);
  ActiveSet active = made.guess;
  for (int step = 0; step <= ByteProblem::kChanges; ++step) {
    if (step > 0) made.change(step - 1);
    const ActiveSet guess = active;
    const std::string fault = fault_of_solve(made, active);
    if (!fault.empty()) fail(fault, made, guess);
  }
}

}  // namespace hg::fuzz
