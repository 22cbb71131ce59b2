#include "hg/hqp/text.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "hg/core/error.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/test/random_problem.h"

namespace hg::hqp {
namespace {

std::string message_of(const std::string& text) {
  try {
    parse_problems(text, "x.hqp");
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseProblems, ReadsLevelsRowsAndInfinities) {
  const auto problems = parse_problems(
      "hqp 2 2\nlevel 1 1\n1 2 3\n0 1 -inf 4e-1\n\nlevel 0 0\r\nend\nhqp 1 1\nlevel 0 0\nend\n",
      "x.hqp");
  ASSERT_EQ(problems.size(), 2U);
  const Problem& problem = problems[0];
  EXPECT_EQ(problem.variables(), 2);
  EXPECT_EQ(problem.levels(), 2);
  ASSERT_EQ(problem.rows(), 2);
  EXPECT_EQ(problem.end_row(0), 2);
  EXPECT_EQ(problem.variable(0), -1);
  EXPECT_EQ(problem.coefficients(0)[1], 2.0);
  EXPECT_EQ(problem.bounds(0).lb, 3.0);
  EXPECT_EQ(problem.bounds(0).ub, 3.0);
  EXPECT_EQ(problem.variable(1), 1);
  EXPECT_EQ(problem.bounds(1).lb, -kInfinity);
  EXPECT_EQ(problem.bounds(1).ub, 0.4);
  EXPECT_EQ(problems[1].rows(), 0);
}

TEST(ParseProblems, NamesLineAndExpectationOfWhatIsWrong) {
  EXPECT_EQ(message_of(""), "x.hqp:0: expected 'hqp', got an empty file");
  EXPECT_EQ(message_of("\nhpq 2 1\n"), "x.hqp:2: expected 'hqp', got 'hpq'");
  EXPECT_EQ(message_of("hqp 0 1\n"), "x.hqp:1: expected a number of variables of 1..128, got '0'");
  EXPECT_EQ(message_of("hqp 2\n"),
            "x.hqp:1: expected a number of levels of 1..32, got the end of the line");
  EXPECT_EQ(message_of("hqp 2 1 7\n"), "x.hqp:1: expected the end of the line, got '7'");
  EXPECT_EQ(message_of("hqp 2 1\nlevel -1 0\n"),
            "x.hqp:2: expected a number of equalities of 0..1024, got '-1'");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1000 25\n"),
            "x.hqp:2: expected a number of inequalities of 0..24, got '25'");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1 0\n1 2\n"),
            "x.hqp:3: expected number 3 of 3, got the end of the line");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1 0\n1 x 2\n"), "x.hqp:3: expected number 2 of 3, got 'x'");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1 0\n1 2 nan\n"),
            "x.hqp:3: expected number 3 of 3, got 'nan'");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1 0\n1 inf 3\n"),
            "x.hqp:3: expected a finite coefficient, got an infinite one");
  EXPECT_EQ(message_of("hqp 2 1\nlevel 1 0\n1 2 3 4\n"),
            "x.hqp:3: expected the end of the line, got '4'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 1\n1 2.5 1\n"),
            "x.hqp:3: expected lb <= ub, got 2.500000 > 1.000000");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 1\n1 inf inf\n"),
            "x.hqp:3: expected a bound that can be met, got one at infinity");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 1\n"),
            "x.hqp:2: expected a row of an inequality, got the end of the file");
  EXPECT_EQ(message_of("hqp 1 2\nlevel 0 0\nend\n"), "x.hqp:3: expected 'level', got 'end'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 0\nlevel 0 0\n"), "x.hqp:3: expected 'end', got 'level'");
}

TEST(ReadProblems, SaysWhichFileCannotBeRead) {
  try {
    read_problems("no/such/file.hqp");
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(), "no/such/file.hqp: cannot be opened for reading");
  }
  EXPECT_THROW(read_problems("tests"), SetupError);  // a folder
}

TEST(WriteProblem, IsReadBackToTheSameOptimum) {
  const Capacity capacity = {.variables = 60, .levels = 20, .rows = 600};
  Solver solver(capacity);
  Solution original(capacity);
  Solution copy(capacity);
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Problem problem = random_problem(seed, {});
    std::ostringstream text;
    write_problem(text, problem);
    const auto read = parse_problems(text.str(), "x.hqp");
    ASSERT_EQ(read.size(), 1U);
    ASSERT_EQ(read[0].rows(), problem.rows());

    ActiveSet active;
    solver.solve(problem, Options{}, active, original);
    solver.solve(read[0], Options{}, active, copy);
    for (int level = 0; level < problem.levels(); ++level) {
      const auto p = static_cast<std::size_t>(level);
      ASSERT_EQ(read[0].first_row(level), problem.first_row(level));
      ASSERT_NEAR(copy.levels[p].slack_squared, original.levels[p].slack_squared,
                  1e-9 * (1.0 + original.levels[p].slack_squared));
    }
  }
}

}  // namespace
}  // namespace hg::hqp
