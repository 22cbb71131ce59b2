/// Problems of a control loop that failed or were slow, for a thread that writes them.
///
/// Keeps the first ones and counts the rest; slow ones leave room for those that failed. One thread
/// puts, one reads. put() copies into memory that the constructor allocates: no allocation, lock or
/// system call.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

/// A problem with everything that its solve depends on, and how that ended.
struct KeptProblem {
  Problem problem;
  Options options = {};
  ActiveSet guess = {};  ///< that the solve began with
  Status status = Status::kSolved;
  int iterations = 0;
  std::uint64_t cycle = 0;     ///< of the loop
  double cycle_time_us = 0.0;  ///< 0: it is not the time of the cycle that it is kept for
};

class KeptProblems {
 public:
  static constexpr std::size_t kMost = 10;
  static constexpr std::size_t kMostSolved = 5;  ///< of these, slow ones that were solved

  /// For problems of this very capacity. Throws SetupError, see check(Capacity).
  explicit KeptProblems(const Capacity& capacity);

  /// Loop only. Copies while there is room; of each cycle only one problem.
  void put(const Problem& problem, const Options& options, const ActiveSet& guess,
           const Solution& solution, std::uint64_t cycle, double cycle_time_us = 0.0) noexcept;

  /// How many are kept. They never change again.
  std::size_t size() const noexcept { return size_.load(std::memory_order_acquire); }
  /// In the order of the cycles; i < size().
  const KeptProblem& operator[](std::size_t i) const noexcept { return problems_[i]; }

  /// Cycles that put() was called for. From any thread.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

 private:
  std::vector<KeptProblem> problems_;
  std::optional<std::uint64_t> last_cycle_;  ///< of put()
  std::size_t solved_ = 0;                   ///< of those that are kept
  std::atomic<std::size_t> size_{0};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace hg::hqp
