#include "hg/hqp/problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "hg/core/error.h"

namespace hg::hqp {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Problem, GivesIdsInOrderAndKeepsThem) {
  Problem problem({.variables = 3, .levels = 3, .rows = 4});
  EXPECT_EQ(problem.add_level(), 0);
  EXPECT_EQ(problem.add_bound(2, {0.0, 1.0}), 0);
  EXPECT_EQ(problem.add_row(std::vector{3.0, 0.0, 4.0}, {2.0, 2.0}, 0.5), 1);
  EXPECT_EQ(problem.add_level(), 1);
  EXPECT_EQ(problem.add_level(), 2);
  EXPECT_EQ(problem.add_bound(0, {}), 2);

  EXPECT_EQ(problem.level_of(0), 0);
  EXPECT_EQ(problem.level_of(1), 0);
  EXPECT_EQ(problem.level_of(2), 2);
  EXPECT_EQ(problem.first_row(1), 2);
  EXPECT_EQ(problem.end_row(1), 2);
  EXPECT_EQ(problem.norm(1), 5.0);
  EXPECT_EQ(problem.norm(2), 1.0);
  EXPECT_EQ(problem.weight(1), 0.5);
  EXPECT_EQ(problem.coefficients(1)[2], 4.0);
  EXPECT_TRUE(problem.coefficients(0).empty());

  problem.set_row(1, std::vector{0.0, 2.0, 0.0});
  problem.set_bounds(1, {-1.0, kInfinity});
  problem.set_weight(1, 3.0);
  EXPECT_EQ(problem.norm(1), 2.0);
  EXPECT_EQ(problem.bounds(1).lb, -1.0);
  EXPECT_EQ(problem.weight(1), 3.0);

  problem.clear(2);
  EXPECT_EQ(problem.levels(), 0);
  EXPECT_EQ(problem.rows(), 0);
  problem.add_level();
  EXPECT_EQ(problem.add_row(std::vector{1.0, 1.0}, {}), 0);
}

TEST(Problem, RefusesWhatDoesNotFit) {
  Problem problem({.variables = 2, .levels = 1, .rows = 1});
  EXPECT_EQ(message_of([&] { problem.add_bound(0, {}); }),
            "hqp problem: add a level before its first row");
  problem.add_level();
  EXPECT_EQ(message_of([&] { problem.add_bound(2, {}); }),
            "hqp bound: variable: must be 0..1, got 2");
  EXPECT_EQ(message_of([&] { problem.add_row(std::vector{1.0}, {}); }),
            "hqp row: number of coefficients: must be 2..2, got 1");
  problem.add_bound(0, {});
  EXPECT_EQ(message_of([&] { problem.add_bound(1, {}); }),
            "hqp problem: rows: must be 1..1, got 2");
  EXPECT_EQ(message_of([&] { problem.add_level(); }), "hqp problem: levels: must be 1..1, got 2");
  EXPECT_EQ(message_of([&] { problem.clear(3); }), "hqp problem: variables: must be 1..2, got 3");
}

TEST(Problem, KeepsNonFiniteRowsForTheSolverToName) {
  Problem problem({.variables = 1, .levels = 1, .rows = 1});
  problem.add_level();
  problem.add_row(std::vector{std::numeric_limits<double>::quiet_NaN()}, {});
  EXPECT_FALSE(std::isfinite(problem.norm(0)));
}

}  // namespace
}  // namespace hg::hqp
