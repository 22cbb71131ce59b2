#include "hg/hqp/text.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

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
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 1\n"),
            "x.hqp:2: expected a row of an inequality, got the end of the file");
  EXPECT_EQ(message_of("hqp 1 2\nlevel 0 0\nend\n"), "x.hqp:3: expected 'level', got 'end'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 0\nlevel 0 0\n"),
            "x.hqp:3: expected 'guess' or 'end', got 'level', nearest is 'end'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 0 0\n"), "x.hqp:2: expected 'end', got the end of the file");
}

TEST(ParseProblems, NamesTheRuleThatARowBreaks) {
  const std::string head = "hqp 2 1\nlevel 1 1\n1 2 3\n";
  const std::string tail = "; a deliberately invalid row ends in 'bad'";
  const std::string coefficients = "x.hqp:4: coefficients and their norm must be finite" + tail;
  EXPECT_EQ(message_of(head + "1 nan 3 4\n"), coefficients);
  EXPECT_EQ(message_of(head + "-inf 1 3 4\n"), coefficients);
  EXPECT_EQ(message_of(head + "1e200 1 3 4\n"), coefficients);
  EXPECT_EQ(message_of(head + "1 2 2.5 1\n"), "x.hqp:4: lb must not be above ub" + tail);
  EXPECT_EQ(message_of(head + "1 2 0 nan\n"), "x.hqp:4: lb must not be above ub" + tail);
  EXPECT_EQ(message_of(head + "1 2 inf inf\n"),
            "x.hqp:4: bounds must be met by some number" + tail);
  EXPECT_EQ(message_of(head + "1 2 0 1 weight 0\n"),
            "x.hqp:4: the weight must be positive and finite" + tail);
}

TEST(ParseProblems, NamesTheNearestKeyword) {
  EXPECT_EQ(message_of("hqp 1 1\nlevl 0 0\nend\n"),
            "x.hqp:2: expected 'name', 'options' or 'level', got 'levl', nearest is 'level'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2 weigth 3\n"),
            "x.hqp:3: expected 'weight', 'dense', 'bad' or the end of the line, got 'weigth', "
            "nearest is 'weight'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2 3\n"),
            "x.hqp:3: expected 'weight', 'dense', 'bad' or the end of the line, got '3'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2 weight\n"),
            "x.hqp:3: expected a weight, got the end of the line");
  EXPECT_EQ(message_of("hqp 1 1\noptions max_iteration 3\n"),
            "x.hqp:2: expected 'max_iterations', 'budget', 'minimum_norm', 'rank_tolerance', "
            "'feasibility_tolerance' or the end of the line, got 'max_iteration', nearest is "
            "'max_iterations'");
  EXPECT_EQ(message_of("hqp 1 1\noptions max_iterations 0\n"),
            "x.hqp:2: expected max_iterations of 1..2147483647, got '0'");
  EXPECT_EQ(message_of("hqp 1 1\noptions rank_tolerance nan\n"),
            "x.hqp:2: rank_tolerance must be in 0 .. 1e-3, above 0");
  EXPECT_EQ(message_of("hqp 1 1\noptions feasibility_tolerance 0.1\n"),
            "x.hqp:2: feasibility_tolerance must be in 0 .. 1e-3, above 0");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 2 0\n1 2\n1 3\nguess =\nend\n"),
            "x.hqp:5: expected a letter of .lu=<> for each of the 2 rows, got '='");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2\nguess x\nend\n"),
            "x.hqp:4: expected a letter of .lu=<> for each of the 1 rows, got 'x'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2\nguess . ..\nend\n"),
            "x.hqp:4: expected a letter of .lu=<> for each of the 1 rows, got '..'");
  EXPECT_EQ(message_of("hqp 1 1\nlevel 1 0\n1 2\nguess . . .\nend\n"),
            "x.hqp:4: expected the end of the line, got '.'");
}

TEST(ParseProblems, ReadsOptionalPartsBesidesRows) {
  const auto problems = parse_recorded_problems(
      "hqp 2 1\nname  cycle 7, a test \r\noptions minimum_norm 0 rank_tolerance 1e-8\n"
      "level 1 3\n0 1 4 weight 0.5\n2 0 0 1\n0 1 0 1 dense\nnan 0 2 1 bad weight -1\n"
      "guess =.u<\nend\nhqp 1 1\nlevel 0 0\nguess\nend\n",
      "x.hqp");
  ASSERT_EQ(problems.size(), 2U);
  const auto& [problem, options, guess, name] = problems[0];
  EXPECT_EQ(name, "cycle 7, a test");
  EXPECT_FALSE(options.minimum_norm);
  EXPECT_EQ(options.rank_tolerance, 1e-8);
  EXPECT_EQ(options.feasibility_tolerance, SolverOptions().feasibility_tolerance);
  EXPECT_EQ(problem.weight(0), 0.5);
  EXPECT_EQ(problem.variable(0), 1);
  EXPECT_EQ(problem.variable(1), -1);  // 2 x0 is not x0
  EXPECT_EQ(problem.variable(2), -1);
  EXPECT_EQ(problem.weight(3), -1.0);
  EXPECT_EQ(problem.bounds(3).lb, 2.0);
  ASSERT_TRUE(guess.has_value());
  EXPECT_EQ(guess->state[0], RowState::kEqual);
  EXPECT_EQ(guess->state[1], RowState::kInactive);
  EXPECT_EQ(guess->state[2], RowState::kUpper);
  EXPECT_EQ(guess->state[3], RowState::kBelow);
  EXPECT_TRUE(problems[1].guess.has_value());
}

TEST(ReadProblems, ReportsWhichFileCannotBeRead) {
  try {
    read_problems("no/such/file.hqp");
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(), "no/such/file.hqp: cannot be read: No such file or directory");
  }
  EXPECT_THROW(read_problems("tests"), SetupError);  // a folder
}

// The bits, so that 0 and -0 differ and not-a-numbers compare.
std::vector<std::uint64_t> bits_of(std::span<const double> values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

std::string to_text(const RecordedProblem& recorded) {
  std::ostringstream text;
  write_problem(text, recorded);
  return text.str();
}

TEST(WriteProblem, OldFilesStayAsTheyAre) {
  const std::string text = "hqp 2 2\nlevel 1 2\n1 2 3\n0 1 -inf 0.4\n2 0 1 1\nlevel 0 0\nend\n";
  std::ostringstream written;
  write_problem(written, parse_problems(text, "x.hqp")[0]);
  EXPECT_EQ(written.str(), text);
}

TEST(WriteProblem, EverythingIsReadBackBitForBit) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RecordedProblem original = {random_problem(seed, {}), {}, ActiveSet{}, "a name"};
    Problem& problem = original.problem;
    original.options.max_iterations = 1 + static_cast<int>(seed % 7);
    original.options.rank_tolerance = 1e-9 * (1.0 + seed / 3.0);
    for (int row = 0; row < problem.rows(); ++row) {
      original.guess->state[row] =
          static_cast<RowState>((static_cast<std::uint32_t>(row) + seed) % 6);
      original.guess->before[row] =
          static_cast<RowState>((static_cast<std::uint32_t>(row) + seed / 2) % 6);
    }
    if (problem.rows() > 3) problem.set_bounds(2, {-0.0, 0.0});
    if (problem.rows() > 3 && seed % 2 == 0) problem.set_bounds(3, {std::nan(""), 1.0});

    const auto read = parse_recorded_problems(to_text(original), "x.hqp");
    ASSERT_EQ(read.size(), 1U);
    const RecordedProblem& copy = read[0];
    EXPECT_EQ(copy.name, original.name);
    EXPECT_EQ(copy.options.max_iterations, original.options.max_iterations);
    EXPECT_EQ(copy.options.rank_tolerance, original.options.rank_tolerance);
    EXPECT_EQ(copy.guess->state, original.guess->state);
    EXPECT_EQ(copy.guess->before, original.guess->before);
    ASSERT_EQ(copy.problem.rows(), problem.rows());
    ASSERT_EQ(copy.problem.levels(), problem.levels());
    for (int row = 0; row < problem.rows(); ++row) {
      SCOPED_TRACE("row " + std::to_string(row));
      const auto [lb, ub] = problem.bounds(row);
      const auto [copied_lb, copied_ub] = copy.problem.bounds(row);
      ASSERT_EQ(bits_of(std::array{copied_lb, copied_ub}), bits_of(std::array{lb, ub}));
      ASSERT_EQ(copy.problem.weight(row), problem.weight(row));
      ASSERT_EQ(copy.problem.variable(row), problem.variable(row));
      ASSERT_EQ(copy.problem.level_of(row), problem.level_of(row));
      ASSERT_EQ(bits_of(copy.problem.coefficients(row)), bits_of(problem.coefficients(row)));
    }
  }
}

TEST(WriteProblem, ANameStaysOnItsLine) {
  Problem problem({.variables = 1, .levels = 1, .rows = 1});
  problem.add_level();
  const std::string name = "caf\xc3\xa9\nlevel 0 1\r\n\tx\v\f" + std::string(1, '\0') + "\x7fy";
  const auto read = parse_recorded_problems(to_text({.problem = problem, .name = name}), "x.hqp");
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].name, "caf\xc3\xa9 level 0 1   x    y");
  EXPECT_EQ(read[0].problem.rows(), 0);
  const std::string blank = to_text({.problem = problem, .name = "\n"});
  EXPECT_EQ(parse_recorded_problems(blank, "x.hqp")[0].name, "");
}

TEST(WriteProblem, RefusesOptionsThatCouldNotBeRead) {
  Problem problem({.variables = 1, .levels = 1, .rows = 1});
  problem.add_level();
  for (const SolverOptions& wrong :
       {SolverOptions{.rank_tolerance = 0.0}, SolverOptions{.feasibility_tolerance = std::nan("")},
        SolverOptions{.feasibility_tolerance = 1.0}, SolverOptions{.max_iterations = 0}}) {
    std::ostringstream text;
    EXPECT_THROW(write_problem(text, {.problem = problem, .options = wrong}), SetupError);
    EXPECT_EQ(text.str(), "");
  }
  const SolverOptions most = {.rank_tolerance = 1e-3,
                              .max_iterations = std::numeric_limits<int>::max()};
  const auto read = parse_recorded_problems(to_text({problem, most}), "x.hqp");
  EXPECT_EQ(read[0].options.max_iterations, most.max_iterations);
  EXPECT_EQ(read[0].options.rank_tolerance, most.rank_tolerance);
}

// Status, effort and every number of a solve.
void expect_same_solve(Solver& solver, const RecordedProblem& a, const RecordedProblem& b) {
  const Capacity capacity = {.variables = 60, .levels = 20, .rows = 600};
  Solution of_a(capacity), of_b(capacity);
  ActiveSet active_a = *a.guess, active_b = *b.guess;
  ASSERT_EQ(solver.solve(a.problem, a.options, active_a, of_a),
            solver.solve(b.problem, b.options, active_b, of_b));
  ASSERT_EQ(of_a.iterations, of_b.iterations);
  ASSERT_EQ(of_a.completed_levels, of_b.completed_levels);
  ASSERT_EQ(of_a.bad_row, of_b.bad_row);
  ASSERT_EQ(bits_of(of_a.x), bits_of(of_b.x));
  ASSERT_EQ(of_a.state, of_b.state);
}

TEST(WriteProblem, ASolveIsReproducedBitForBit) {
  const Capacity capacity = {.variables = 60, .levels = 20, .rows = 600};
  Solver solver(capacity);
  Solution solution(capacity);
  int failures = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RecordedProblem original = {random_problem(seed, {}), {}, ActiveSet{}, ""};
    Problem& problem = original.problem;
    if (seed % 3 == 0) original.options.max_iterations = 1;
    if (seed % 5 == 0 && problem.rows() > 3) problem.set_weight(3, -1.0);
    // two other problems' solutions as guesses
    solver.solve(random_problem(seed + 1, {}), {}, *original.guess, solution);
    solver.solve(random_problem(seed + 2, {}), {}, *original.guess, solution);

    const auto read = parse_recorded_problems(to_text(original), "x.hqp");
    ASSERT_EQ(read.size(), 1U);
    expect_same_solve(solver, original, read[0]);
    ActiveSet active = *original.guess;
    failures += solver.solve(problem, original.options, active, solution) != Status::kSolved;
  }
  EXPECT_GT(failures, 20);
}

}  // namespace
}  // namespace hg::hqp
