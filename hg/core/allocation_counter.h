/// Counts heap allocations of one thread: the control loop must make none.
///
/// Linking this file replaces malloc and its relatives by versions that count and call the C
/// library. Sanitizer builds, which bring their own, count nothing.
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

}  // namespace hg
