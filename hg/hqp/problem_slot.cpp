#include "hg/hqp/problem_slot.h"

#include <cassert>

namespace hg::hqp {

void ProblemSlot::put(const Problem& problem, const Options& options, const ActiveSet& guess,
                      const Solution& solution, std::uint64_t cycle) noexcept {
  assert(problem.capacity().variables == kept_.problem.capacity().variables);
  assert(problem.capacity().levels == kept_.problem.capacity().levels);
  assert(problem.capacity().rows == kept_.problem.capacity().rows);
  count_.fetch_add(1, std::memory_order_relaxed);
  if (is_full_.load(std::memory_order_acquire)) return;
  kept_.problem = problem;  // equal capacities: the vectors have room
  kept_.options = options;
  kept_.guess = guess;
  kept_.status = solution.status;
  kept_.iterations = solution.iterations;
  kept_.cycle = cycle;
  is_full_.store(true, std::memory_order_release);
}

}  // namespace hg::hqp
