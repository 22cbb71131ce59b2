#include "hg/hqp/problem_capture.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <thread>

#include "hg/core/allocation_counter.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/test/random_problem.h"
#include "hg/hqp/text.h"

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

TEST(ProblemCapture, KeepsTheFirstOnesAndCountsAll) {
  ProblemCapture problems(kCapacity);
  EXPECT_EQ(problems.size(), 0U);
  Solution solution(kCapacity);
  solution.status = Status::kIterationLimit;
  solution.iterations = 9;
  ActiveSet guess;
  guess.state[1] = RowState::kUpper;
  const SolverOptions options = {.max_iterations = 9};
  problems.capture(problem_of(1.0), options, guess, solution, 41);
  problems.capture(problem_of(2.0), {}, {}, solution, 41);  // the same cycle again
  problems.capture(problem_of(3.0), {}, {}, solution, 42);
  ASSERT_EQ(problems.size(), 2U);
  const CapturedProblem& first = problems[0];
  EXPECT_EQ(first.cycle, 41U);
  EXPECT_EQ(first.problem.coefficients(0)[4], 1.0);
  EXPECT_EQ(first.problem.weight(1), 1.0);
  EXPECT_EQ(first.problem.variable(1), 2);
  EXPECT_EQ(first.problem.levels(), 2);
  EXPECT_EQ(first.options.max_iterations, 9);
  EXPECT_EQ(first.guess.state, guess.state);
  EXPECT_EQ(first.status, Status::kIterationLimit);
  EXPECT_EQ(first.iterations, 9);
  EXPECT_EQ(problems[1].cycle, 42U);
  EXPECT_EQ(problems[1].problem.weight(1), 3.0);
  for (std::uint64_t cycle = 43; cycle < 60; ++cycle) {
    problems.capture(problem_of(4.0), {}, {}, solution, cycle);
  }
  EXPECT_EQ(problems.size(), ProblemCapture::kMost);
  EXPECT_EQ(problems[ProblemCapture::kMost - 1].cycle, 41 + ProblemCapture::kMost - 1);
  EXPECT_EQ(problems.count(), 19U);
}

// What a run does with a problem that the solver gave up.
TEST(ProblemCapture, ThoseThatFailedFindRoomAfterSlowOnes) {
  ProblemCapture problems(kCapacity);
  Solution solution(kCapacity);
  std::uint64_t cycle = 0;
  while (++cycle <= 20) problems.capture(problem_of(1.0), {}, {}, solution, cycle);
  EXPECT_EQ(problems.size(), ProblemCapture::kMostSolved);
  problems.capture(problem_of(2.0), {}, {}, solution, cycle);
  solution.status = Status::kIterationLimit;
  problems.capture(problem_of(3.0), {}, {}, solution, cycle);  // in the cycle of a slow one
  ASSERT_EQ(problems.size(), ProblemCapture::kMostSolved + 1);
  EXPECT_EQ(problems[ProblemCapture::kMostSolved].problem.weight(1), 3.0);
  EXPECT_EQ(problems[ProblemCapture::kMostSolved].cycle, 21U);
  while (++cycle <= 40) problems.capture(problem_of(4.0), {}, {}, solution, cycle);
  EXPECT_EQ(problems.size(), ProblemCapture::kMost);
  EXPECT_EQ(problems.count(), 40U);
}

TEST(ProblemCapture, AFailedSolveIsWrittenReadAndFailsAgainBitForBit) {
  const Capacity capacity = {.variables = 60, .levels = 20, .rows = 600};
  Solver solver(capacity);
  Solution failed(capacity), again(capacity);
  int failures = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, {});
    const SolverOptions options = {.max_iterations = 1 + static_cast<int>(seed % 3)};
    ActiveSet guess;
    guess.state[0] = RowState::kAbove;
    ActiveSet active = guess;
    if (solver.solve(problem, options, active, failed) == Status::kSolved) continue;
    ++failures;
    ProblemCapture problems(problem.capacity());
    problems.capture(problem, options, guess, failed, 7);

    std::ostringstream text;
    const CapturedProblem& kept = problems[0];
    write_problem(text, {.problem = kept.problem, .options = kept.options, .guess = kept.guess});
    const auto read = parse_recorded_problems(text.str(), "x.hqp");
    ASSERT_EQ(read.size(), 1U);
    active = *read[0].guess;
    ASSERT_EQ(solver.solve(read[0].problem, read[0].options, active, again), kept.status);
    ASSERT_EQ(again.iterations, kept.iterations);
    ASSERT_EQ(again.completed_levels, failed.completed_levels);
    ASSERT_EQ(again.state, failed.state);
    ASSERT_EQ(0, std::memcmp(again.x.data(), failed.x.data(), sizeof(double) * failed.x.size()));
  }
  EXPECT_GT(failures, 10);
}

TEST(ProblemCapture, DoesNotAllocate) {
  ProblemCapture problems(kCapacity);
  const Problem problem = problem_of(1.0);
  const Solution solution(kCapacity);
  AllocationCounter allocations;
  for (std::uint64_t cycle = 0; cycle < 20; ++cycle)
    problems.capture(problem, {}, {}, solution, cycle);
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(ProblemCapture, NeverShowsHalfAProblem) {
  for (int repetition = 0; repetition < 100; ++repetition) {
    ProblemCapture problems(kCapacity);
    std::thread loop([&] {
      Solution solution(kCapacity);
      solution.status = Status::kIterationLimit;
      for (int cycle = 0; cycle < 12; ++cycle) {
        problems.capture(problem_of(1.0 + cycle), {}, {}, solution,
                         static_cast<std::uint64_t>(cycle));
      }
    });
    std::size_t seen = 0;
    while (seen < ProblemCapture::kMost) {
      if (problems.size() == seen) continue;
      const CapturedProblem& kept = problems[seen];
      const double value = 1.0 + static_cast<double>(seen++);
      EXPECT_EQ(kept.problem.coefficients(0)[0], value);
      EXPECT_EQ(kept.problem.coefficients(0)[4], value);
      EXPECT_EQ(kept.problem.bounds(1).lb, -value);
    }
    loop.join();
    EXPECT_EQ(problems.count(), 12U);
  }
}

}  // namespace
}  // namespace hg::hqp
