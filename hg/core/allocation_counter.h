/// Counts heap allocations of one thread: the control loop must make none.
///
/// Counts in programs that link hg/core/counting_malloc; in others, and in sanitizer builds, which
/// bring their own malloc, the count stays 0.
#pragma once

#include <cstdint>

namespace hg {

/// Counts from construction to destruction, on the calling thread only. Not to be nested.
class AllocationCounter {
 public:
  AllocationCounter() noexcept;
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  /// Allocations since construction.
  std::uint64_t count() const noexcept;
};

/// For malloc: one allocation of the calling thread.
void count_allocation() noexcept;

}  // namespace hg
