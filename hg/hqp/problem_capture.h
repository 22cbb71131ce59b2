/// Captures problems of a control loop that failed or were slow, for a thread that writes them.
///
/// The first ones are captured, the others counted; slow ones leave room for failed ones. One
/// thread captures, one reads. capture() copies into memory that the constructor allocates: no
/// allocation, lock or system call.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

/// A problem with all inputs of its solve, and the result.
struct CapturedProblem {
  Problem problem;
  SolverOptions options = {};
  ActiveSet guess = {};  ///< initial guess of the solve
  Status status = Status::kSolved;
  int iterations = 0;
  std::uint64_t cycle = 0;     ///< cycle number of the loop
  double cycle_time_us = 0.0;  ///< cycle time; 0 = not the reason for the capture
};

class ProblemCapture {
 public:
  static constexpr std::size_t kMost = 10;
  static constexpr std::size_t kMostSolved = 5;  ///< most slow but solved problems

  /// Accepts problems of exactly this capacity. Throws SetupError, see check_capacity().
  explicit ProblemCapture(const Capacity& capacity);

  /// Copies the problem while there is room, one per cycle. To be called by the loop only.
  void capture(const Problem& problem, const SolverOptions& options, const ActiveSet& guess,
               const Solution& solution, std::uint64_t cycle, double cycle_time_us = 0.0) noexcept;

  /// Number of captured problems; these never change again.
  std::size_t size() const noexcept { return size_.load(std::memory_order_acquire); }
  /// Captured problem i < size(), in the order of the cycles.
  const CapturedProblem& operator[](std::size_t i) const noexcept { return problems_[i]; }

  /// Number of cycles for which capture() was called. Callable from any thread.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

 private:
  std::vector<CapturedProblem> problems_;
  std::optional<std::uint64_t> last_cycle_;  ///< last cycle passed to capture()
  std::size_t solved_ = 0;                   ///< number of captured problems that were solved
  std::atomic<std::size_t> size_{0};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace hg::hqp
