// Wishes with priorities: x0 <= 1 at any rate, then x0 + x1 = 3, then both close to zero.
#include <array>
#include <cstdio>

#include "hg/hqp/solver.h"

int main() {
  hg::hqp::Problem problem({.variables = 2, .levels = 3, .rows = 4});
  problem.add_level();
  problem.add_bound(0, {.ub = 1.0});
  problem.add_level();
  problem.add_row(std::array{1.0, 1.0}, {3.0, 3.0});
  problem.add_level();
  for (int i : {0, 1}) problem.add_bound(i, {0.0, 0.0});

  hg::hqp::Solver solver(problem.capacity());
  hg::hqp::Solution solution(problem.capacity());
  hg::hqp::ActiveSet active;  // keep it: the next solve starts from it
  const hg::hqp::Status status = solver.solve(problem, {}, active, solution);
  std::printf("%s: x = (%g, %g)\n", to_string(status), solution.x[0], solution.x[1]);
}
