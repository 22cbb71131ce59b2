#include "bench/problem_source.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <string>

#include "bench/solver_table.h"
#include "hg/core/error.h"

namespace hg::bench {
namespace {

namespace fs = std::filesystem;

// x0 <= wish (slack 0) and x1 >= 3 before x1 = 0 (slack 3); `guess` is a line of its own or empty.
std::string problem_text(double wish, const std::string& guess) {
  return "hqp 2 2\nlevel 0 2\n1 0 -inf " + std::to_string(wish) + "\n0 1 3 inf\nlevel 2 0\n1 0 " +
         std::to_string(wish + 1.0) + "\n0 1 0\n" + guess + "end\n";
}

// A folder with a set of files, removed at the end.
class Files {
 public:
  Files() : folder_(fs::temp_directory_path() / ("problem_source_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~Files() { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

 private:
  fs::path folder_;
};

std::string five_problems(const std::string& guess) {
  std::string text;
  for (int i = 0; i < 5; ++i) text += problem_text(1.0 + i, guess);
  return text;
}

// slack norms 0 and sqrt(1 + 9) by problem, after two variables
const std::string kFiveSolutions = [] {
  std::string text;
  for (int i = 0; i < 5; ++i) text += "0 0 0 10\n";
  return text;
}();

TEST(ProblemSource, SkipsTheIndexAtTheBeginOfALineOnly) {
  const Files files;
  const fs::path problems = files.write("set.hqp", five_problems(""));
  files.write("set.sol.gz", kFiveSolutions);
  files.write("set.skip", "3 1.16e-08 1\n\n4 suspect\n");
  const ProblemSource source(problems, 100);
  ASSERT_TRUE(source.has_reference());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(source.reference(i).empty(), i >= 3) << i;
}

TEST(ProblemSource, RefusesALineOfSkipWithoutAnIndex) {
  const Files files;
  const fs::path problems = files.write("set.hqp", five_problems(""));
  files.write("set.sol.gz", kFiveSolutions);
  for (const char* const word : {"5", "-1", "1e0", "suspect"}) {
    const fs::path skip = files.write("set.skip", std::string("0\n") + word + " 2\n");
    try {
      const ProblemSource source(problems, 100);
      ADD_FAILURE() << word;
    } catch (const SetupError& error) {
      EXPECT_EQ(error.what(),
                skip.string() + ":2: expected the index of a problem, 0..4, got '" + word + "'");
    }
  }
}

// Both limits act. From its own guess a problem takes one active set; from the one before it, which
// has the wrong guess in the first case, more.
TEST(ProblemSource, GivesTheGuessesOfAFile) {
  const Files files;
  const fs::path with = files.write("with.hqp", five_problems("guess ul==\n"));
  const fs::path without = files.write("without.hqp", five_problems(""));
  ProblemSource source(with, 100);
  ASSERT_NE(source.guess(4), nullptr);
  EXPECT_EQ(source.guess(4)->state[0], hqp::RowState::kUpper);
  EXPECT_EQ(source.guess(4)->state[1], hqp::RowState::kLower);
  EXPECT_EQ(ProblemSource(without, 100).guess(0), nullptr);
  const SolverSet set = measure_solvers(source, nullptr, 1);
  ASSERT_EQ(set.runs[0].solver, "warm");
  EXPECT_EQ(set.runs[0].iterations, 5.0);
  EXPECT_GT(set.runs[1].iterations, 5.0);  // cold

  std::string mixed = problem_text(1.0, "guess ul==\n");
  for (int i = 1; i < 5; ++i) mixed += problem_text(1.0 + i, "guess ..<<\n");
  ProblemSource wrong(files.write("mixed.hqp", mixed), 100);
  EXPECT_GT(measure_solvers(wrong, nullptr, 1).runs[0].iterations, 5.0);
}

}  // namespace
}  // namespace hg::bench
