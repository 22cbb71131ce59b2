#include "hg/core/allocation_counter.h"

namespace hg {
namespace {

thread_local bool is_counting = false;
thread_local std::uint64_t allocations = 0;

}  // namespace

void count_allocation() noexcept {
  if (is_counting) ++allocations;
}

AllocationCounter::AllocationCounter() noexcept {
  allocations = 0;
  is_counting = true;
}

AllocationCounter::~AllocationCounter() { is_counting = false; }

std::uint64_t AllocationCounter::count() const noexcept { return allocations; }

}  // namespace hg
