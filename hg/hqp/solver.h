/// Strictly lexicographic least squares with bounds, by elimination and active sets.
///
/// Source: [HG] (1)-(6): for p = 1..P minimise 1/2 |w_p|^2 + 1/2 |v_p|^2, keeping all earlier
/// optimal slacks; then, as an option, |x|. Differs from [HG]: no cascade of QPs. One elimination,
/// level after level in the null space (3)-(4) of those above, solves a guessed active set and
/// proves or corrects it; the remaining cases are solved by a primal method level by level. No
/// normal equations, no regularisation. Contract: solve() keeps nothing between calls except its
/// workspace and a count, is a pure function of its arguments, does not allocate, and tries at most
/// options.max_iterations active sets.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

namespace solver {
struct Workspace;
}

class Solver {
 public:
  /// Solves problems within `capacity`. Throws SetupError, see check_capacity().
  explicit Solver(const Capacity& capacity);
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Solves `problem`, starting from the guess `active`, which receives the final active set.
  /// `solution` is always filled and usable, whatever the status; aborts when solver or solution
  /// have less capacity than the problem needs.
  Status solve(const Problem& problem, const SolverOptions& options, ActiveSet& active,
               Solution& solution) noexcept;

  /// Number of solves since construction that the budget ended before proof of optimality.
  std::uint64_t budgets_spent() const noexcept;

  /// Lagrange multipliers of level `level` at `solution`, one per row of the problem, into `mu`
  /// (problem.rows() entries): with f = 1/2 sum (weight * slack)^2 over the level's rows,
  ///   grad f(x) + sum over rows of higher levels of mu_i c_i = 0,
  /// mu_i >= 0 where row i is at its upper bound, <= 0 at its lower bound, of any sign for
  /// equalities and violated rows, 0 elsewhere: the constraint pushes x along -mu_i c_i. Rows of
  /// the level itself receive their share of the gradient, weight^2 * (c x - nearest bound), so
  /// that the sum over all rows is zero. Duplicates: the one of highest priority takes all. Returns
  /// the norm of the remaining sum: near 0 exactly if the level is optimal.
  double multipliers(const Problem& problem, const SolverOptions& options, const Solution& solution,
                     int level, std::span<double> mu) noexcept;

 private:
  std::unique_ptr<solver::Workspace> workspace_;
};

}  // namespace hg::hqp
