#include "hg/simulator/plant/friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hg/core/allocation_counter.h"
#include "hg/core/interval.h"

namespace hg::simulator {
namespace {

// Rates are sums of up to 14 products of order 1..100.
constexpr double kRounding = 1e-10;

// Frictions, brakes, stops and rows without any force, at rest or in motion.
BoxProblem random_problem(std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> size(1, kMaxBoxRows), kind(0, 5);
  const int n = size(random);
  BoxProblem problem;
  MatrixBox B(n, n);
  for (double& x : B.reshaped()) x = normal(random);
  problem.A = B * B.transpose() + 0.01 * MatrixBox::Identity(n, n);
  problem.w_free = problem.lb = problem.ub = VectorBox(n);
  for (int i = 0; i < n; ++i) {
    problem.w_free[i] = 3.0 * normal(random);
    problem.ub[i] = std::abs(normal(random));
    problem.lb[i] = -problem.ub[i];
    switch (kind(random)) {
      case 0:
        problem.ub[i] = kInfinity;
        problem.lb[i] = -kInfinity;
        break;
      case 1:
        problem.ub[i] = kInfinity;
        problem.lb[i] = 0.0;
        break;
      case 2:
        problem.lb[i] = problem.ub[i] = 0.0;
        break;
      default:
        break;
    }
  }
  return problem;
}

void random_start(std::mt19937& random, BoxSolution& solution) {
  std::uniform_int_distribution<int> state(0, 2);
  for (BoxState& s : solution.state) s = static_cast<BoxState>(state(random));
}

void expect_solved(const BoxProblem& problem, const BoxSolution& s) {
  ASSERT_TRUE(s.is_exact);
  const VectorBox w = problem.A * s.f + problem.w_free;
  for (int i = 0; i < s.f.size(); ++i) {
    ASSERT_NEAR(s.w[i], w[i], kRounding * (1.0 + s.f.norm())) << "row " << i;
    ASSERT_GE(s.f[i], problem.lb[i]) << "row " << i;
    ASSERT_LE(s.f[i], problem.ub[i]) << "row " << i;
    if (s.w[i] > 0.0) {
      ASSERT_EQ(s.f[i], problem.lb[i]) << "row " << i;
    }
    if (s.w[i] < 0.0) {
      ASSERT_EQ(s.f[i], problem.ub[i]) << "row " << i;
    }
  }
}

// The slow way: each row in turn does its best until nothing moves.
VectorBox relaxed_forces(const BoxProblem& problem) {
  VectorBox f = VectorBox::Zero(problem.w_free.size());
  for (int sweep = 0; sweep < 200'000; ++sweep) {
    double moved = 0.0;
    for (int i = 0; i < f.size(); ++i) {
      const double w = problem.A.row(i) * f + problem.w_free[i];
      const double next = std::clamp(f[i] - w / problem.A(i, i), problem.lb[i], problem.ub[i]);
      moved = std::max(moved, std::abs(next - f[i]));
      f[i] = next;
    }
    if (moved < 1e-14) break;
  }
  return f;
}

TEST(Friction, BoxAndComplementarityHoldExactlyFromAnyStart) {
  for (unsigned seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const BoxProblem problem = random_problem(random);
    BoxSolution solution;
    random_start(random, solution);
    solve(problem, solution);
    ASSERT_NO_FATAL_FAILURE(expect_solved(problem, solution));
    ASSERT_LE(solution.tries, 60);

    // the same again takes one try and gives the same bits
    BoxSolution again = solution;
    solve(problem, again);
    ASSERT_EQ(again.tries, 1);
    ASSERT_EQ(again.f, solution.f);
  }
}

TEST(Friction, IsWhatRelaxingEachRowInTurnConvergesTo) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const BoxProblem problem = random_problem(random);
    BoxSolution solution;
    solve(problem, solution);
    ASSERT_LT((solution.f - relaxed_forces(problem)).norm(), 1e-8 * (1.0 + solution.f.norm()));
  }
}

TEST(Friction, EndsWhereRowsAreAtTheirBoundsAndAtRestAtOnce) {
  for (unsigned seed = 0; seed < 5'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    BoxProblem problem = random_problem(random);
    VectorBox f(problem.w_free.size());
    for (int i = 0; i < f.size(); ++i) f[i] = std::clamp(1e9, problem.lb[i], problem.ub[i]);
    for (double& x : f) x = std::isinf(x) || x == 1e9 ? 0.5 : x;
    problem.w_free = -problem.A * f;
    BoxSolution solution;
    random_start(random, solution);
    solve(problem, solution);
    ASSERT_NO_FATAL_FAILURE(expect_solved(problem, solution));
    ASSERT_LT((solution.f - f).norm(), 1e-7 * (1.0 + f.norm()));
  }
}

TEST(Friction, OneMotorSticksSlidesAndTurns) {
  BoxProblem problem;
  problem.A = MatrixBox::Constant(1, 1, 0.25);
  problem.ub = VectorBox::Constant(1, 4.0);
  problem.lb = -problem.ub;
  BoxSolution solution;
  for (const auto& [w_free, f, w] : {std::array{0.75, -3.0, 0.0}, std::array{1.5, -4.0, 0.5},
                                     std::array{-1.5, 4.0, -0.5}, std::array{0.0, 0.0, 0.0}}) {
    problem.w_free = VectorBox::Constant(1, w_free);
    solve(problem, solution);
    EXPECT_EQ(solution.f[0], f);
    EXPECT_EQ(solution.w[0], w);
  }
}

TEST(Friction, NonFiniteInputEndsToo) {
  BoxProblem problem;
  problem.A = MatrixBox::Identity(3, 3);
  problem.ub = VectorBox::Constant(3, 1.0);
  problem.lb = -problem.ub;
  problem.w_free = VectorBox::Constant(3, std::nan(""));
  BoxSolution solution;
  AllocationCounter counter;
  solve(problem, solution);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_LE(solution.tries, kMaxTries);
}

}  // namespace
}  // namespace hg::simulator
