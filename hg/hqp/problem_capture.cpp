#include "hg/hqp/problem_capture.h"

#include <cassert>

namespace hg::hqp {

ProblemCapture::ProblemCapture(const Capacity& capacity) {
  problems_.reserve(kMost);  // a copied problem would have no room for rows
  for (std::size_t i = 0; i < kMost; ++i) problems_.push_back({.problem = Problem(capacity)});
}

void ProblemCapture::capture(const Problem& problem, const SolverOptions& options,
                             const ActiveSet& guess, const Solution& solution, std::uint64_t cycle,
                             double cycle_time_us) noexcept {
  if (last_cycle_ != cycle) count_.fetch_add(1, std::memory_order_relaxed);
  last_cycle_ = cycle;
  const std::size_t size = size_.load(std::memory_order_relaxed);
  const bool is_solved = solution.status == Status::kSolved;
  const bool has_room = size < kMost && !(is_solved && solved_ == kMostSolved);
  if (!has_room || (size > 0 && problems_[size - 1].cycle == cycle)) return;
  if (is_solved) ++solved_;
  CapturedProblem& captured = problems_[size];
  assert(problem.capacity().variables == captured.problem.capacity().variables);
  assert(problem.capacity().levels == captured.problem.capacity().levels);
  assert(problem.capacity().rows == captured.problem.capacity().rows);
  captured.problem = problem;  // equal capacities: the vectors have room
  captured.options = options;
  captured.guess = guess;
  captured.status = solution.status;
  captured.iterations = solution.iterations;
  captured.cycle = cycle;
  captured.cycle_time_us = cycle_time_us;
  size_.store(size + 1, std::memory_order_release);
}

}  // namespace hg::hqp
