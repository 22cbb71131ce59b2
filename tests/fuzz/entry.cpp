// Hands libFuzzer's inputs to HG_FUZZ_TARGET, and counts its allocations for AllocationCounter.
#include <sanitizer/allocator_interface.h>

#include <cstddef>
#include <cstdint>

#include "hg/core/allocation_counter.h"
#include "tests/fuzz/targets.h"

namespace {

void on_malloc(const volatile void*, std::size_t) { hg::count_allocation(); }
void on_free(const volatile void*) {}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hg::fuzz::HG_FUZZ_TARGET({data, size});
  return 0;
}
