/// Counts heap allocations of one thread: the control loop must make none.
///
/// Counts in programs that link hg/core/counting_malloc; in others, and in sanitizer builds, which
/// bring their own malloc, the count stays 0.
#pragma once

#include <cstdint>

namespace hg {

/// Counts allocations of the calling thread from construction to destruction. Must not be nested.
class AllocationCounter {
 public:
  AllocationCounter() noexcept;
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  /// Allocations since construction.
  std::uint64_t count() const noexcept;
};

/// Adds one allocation of the calling thread; called by malloc.
void count_allocation() noexcept;

}  // namespace hg
