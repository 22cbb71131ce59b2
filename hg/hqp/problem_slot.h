/// Hands problems that failed or were slow from a control loop to a thread that writes them.
///
/// Room for one: what comes while it is taken is counted only. One thread puts, one takes. put()
/// copies into memory that the constructor allocates: no allocation, lock or system call.
#pragma once

#include <atomic>
#include <cstdint>

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
  std::uint64_t cycle = 0;  ///< of the loop
};

class ProblemSlot {
 public:
  /// For problems of this very capacity. Throws SetupError, see check(Capacity).
  explicit ProblemSlot(const Capacity& capacity) : kept_{.problem = Problem(capacity)} {}

  /// Loop only. Keeps a copy, unless the last one has not been taken yet.
  void put(const Problem& problem, const Options& options, const ActiveSet& guess,
           const Solution& solution, std::uint64_t cycle) noexcept;

  /// Other thread only: what is kept, nullptr when there is nothing; valid until clear().
  const KeptProblem* kept() const noexcept {
    return is_full_.load(std::memory_order_acquire) ? &kept_ : nullptr;
  }
  /// Other thread only: makes room for the next one.
  void clear() noexcept { is_full_.store(false, std::memory_order_release); }

  /// How often put() was called. From any thread.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

 private:
  KeptProblem kept_;
  std::atomic<bool> is_full_{false};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace hg::hqp
