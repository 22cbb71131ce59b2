#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/random_problem.h"

// Counts every allocation of the process while asked to; operator new ends up here as well.
// Sanitizers bring their own malloc.
#if defined(__GLIBC__) && !defined(HG_SANITIZED)

namespace {
std::atomic<bool> is_counting{false};
std::atomic<int> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);

void* malloc(std::size_t size) noexcept {
  if (is_counting) ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  if (is_counting) ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) noexcept {
  if (is_counting) ++allocations;
  return __libc_realloc(pointer, size);
}
}

namespace hg::hqp {
namespace {

constexpr Capacity kCapacity = {.variables = 60, .levels = 20, .rows = 600};

TEST(Allocation, IsCounted) {
  allocations = 0;
  is_counting = true;
  std::vector<double> v(100);
  is_counting = false;
  EXPECT_GE(allocations, 1) << v.size();
}

TEST(Allocation, DoesNotHappenAfterConstruction) {
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  std::vector<double> mu(600);
  int iterations = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const RandomKind kind = {.max_variables = 60, .max_levels = 16, .max_rows_per_level = 30};
    Problem problem = random_problem(seed, kind);
    ActiveSet active;
    allocations = 0;
    is_counting = true;
    solver.solve(problem, Options{}, active, solution);
    for (int level = 0; level < problem.levels(); ++level) {
      solver.multipliers(problem, Options{}, solution, level,
                         {mu.data(), static_cast<std::size_t>(problem.rows())});
    }
    for (int row = 0; row < problem.rows(); ++row) {
      problem.set_bounds(row, {-1.0, 1.0});
      if (problem.variable(row) < 0) {
        problem.set_row(row, {solution.x.data(), solution.x.size()});
      }
    }
    is_counting = false;
    ASSERT_EQ(allocations, 0) << "seed " << seed;
    iterations = std::max(iterations, solution.iterations);
  }
  EXPECT_GT(iterations, 50);  // the level-by-level method has been at work too
}

}  // namespace
}  // namespace hg::hqp

#endif
