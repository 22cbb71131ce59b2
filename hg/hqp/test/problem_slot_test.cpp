#include "hg/hqp/problem_slot.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "hg/core/allocation_counter.h"
#include "hg/hqp/solver.h"

namespace hg::hqp {
namespace {

constexpr Capacity kCapacity = {.variables = 5, .levels = 3, .rows = 8};

// Everything in it is `value`.
Problem problem_of(double value) {
  Problem problem(kCapacity);
  problem.add_level();
  problem.add_row(std::array{value, value, value, value, value}, {value, value}, value);
  problem.add_level();
  problem.add_bound(2, {-value, value}, value);
  return problem;
}

TEST(ProblemSlot, KeepsTheFirstUntilItIsTakenAndCountsAll) {
  ProblemSlot slot(kCapacity);
  EXPECT_EQ(slot.kept(), nullptr);
  Solution solution(kCapacity);
  solution.status = Status::kIterationLimit;
  solution.iterations = 9;
  ActiveSet guess;
  guess.state[1] = RowState::kUpper;
  const Options options = {.max_iterations = 9};
  slot.put(problem_of(1.0), options, guess, solution, 41);
  slot.put(problem_of(2.0), {}, {}, solution, 42);
  const KeptProblem* const kept = slot.kept();
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->cycle, 41U);
  EXPECT_EQ(kept->problem.coefficients(0)[4], 1.0);
  EXPECT_EQ(kept->problem.weight(1), 1.0);
  EXPECT_EQ(kept->problem.variable(1), 2);
  EXPECT_EQ(kept->problem.levels(), 2);
  EXPECT_EQ(kept->options.max_iterations, 9);
  EXPECT_EQ(kept->guess.state, guess.state);
  EXPECT_EQ(kept->status, Status::kIterationLimit);
  EXPECT_EQ(kept->iterations, 9);
  slot.clear();
  EXPECT_EQ(slot.kept(), nullptr);
  slot.put(problem_of(3.0), {}, {}, solution, 43);
  ASSERT_NE(slot.kept(), nullptr);
  EXPECT_EQ(slot.kept()->cycle, 43U);
  EXPECT_EQ(slot.count(), 3U);
}

TEST(ProblemSlot, DoesNotAllocate) {
  ProblemSlot slot(kCapacity);
  const Problem problem = problem_of(1.0);
  const Solution solution(kCapacity);
  AllocationCounter allocations;
  slot.put(problem, {}, {}, solution, 1);
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(ProblemSlot, NeverShowsHalfAProblem) {
  constexpr int kProblems = 20000;
  ProblemSlot slot(kCapacity);
  std::atomic<bool> is_over{false};
  std::thread loop([&] {
    Problem problem = problem_of(0.0);
    const Solution solution(kCapacity);
    for (int i = 1; i <= kProblems; ++i) {
      const double value = i;
      problem.set_row(0, std::array{value, value, value, value, value});
      problem.set_bounds(1, {-value, value});
      slot.put(problem, {}, {}, solution, static_cast<std::uint64_t>(i));
    }
    is_over = true;
  });
  int taken = 0;
  bool was_over = false;
  while (true) {
    const KeptProblem* const kept = slot.kept();
    if (kept == nullptr) {
      if (was_over) break;
      was_over = is_over;
      continue;
    }
    ++taken;
    const auto value = static_cast<double>(kept->cycle);
    EXPECT_EQ(kept->problem.coefficients(0)[0], value);
    EXPECT_EQ(kept->problem.coefficients(0)[4], value);
    EXPECT_EQ(kept->problem.bounds(1).lb, -value);
    slot.clear();
  }
  loop.join();
  EXPECT_GT(taken, 0);
  EXPECT_EQ(slot.count(), static_cast<std::uint64_t>(kProblems));
}

}  // namespace
}  // namespace hg::hqp
