#include "hg/core/allocation_counter.h"

#include <cerrno>
#include <cstddef>

namespace {

thread_local bool is_counting = false;
thread_local std::uint64_t allocations = 0;

}  // namespace

#ifndef HG_SANITIZED

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  if (is_counting) ++allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  if (is_counting) ++allocations;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  if (is_counting) ++allocations;
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  if (is_counting) ++allocations;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (is_counting) ++allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  if (is_counting) ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}

}  // extern "C"

#endif

namespace hg {

AllocationCounter::AllocationCounter() noexcept {
  allocations = 0;
  is_counting = true;
}

AllocationCounter::~AllocationCounter() { is_counting = false; }

std::uint64_t AllocationCounter::count() const noexcept { return allocations; }

}  // namespace hg
