#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/text.h"

namespace hg::hqp {
namespace {

constexpr double kSlackError = 1e-6;  // of 1 + norm of the level's slack
constexpr double kPointError = 1e-5;  // of 1 + largest |x_i|
constexpr double kOptimal = 1e-6;     // gap of a level relative to its gradient
constexpr Capacity kCapacity = {.variables = kMaxVariables, .levels = kMaxLevels, .rows = kMaxRows};

std::filesystem::path folder() {
  const char* folder = std::getenv("HG_REFERENCE_DATA");
  return folder != nullptr ? folder : "tests/reference";
}

// Names of all sets: NAME of every NAME.hqp.gz.
std::vector<std::string> set_names() {
  const std::string ending = ".hqp.gz";
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(folder())) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(ending)) names.push_back(file.substr(0, file.size() - ending.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::vector<double>> read_numbers(const std::filesystem::path& file) {
  std::vector<std::vector<double>> lines;
  std::istringstream text(read_text(file.string()));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(std::stod(word));
  }
  return lines;
}

struct ReferenceSet {
  std::vector<Problem> problems;
  std::vector<std::vector<double>> solutions;
  std::set<int> skipped;
  bool is_recorded_sequence;  ///< neighbours are alike, and x is unique
};

ReferenceSet read_set(const std::string& name) {
  ReferenceSet set;
  set.problems = read_problems((folder() / (name + ".hqp.gz")).string());
  set.solutions = read_numbers(folder() / (name + ".sol.gz"));
  set.is_recorded_sequence = !name.starts_with("random");
  const std::filesystem::path skip = folder() / (name + ".skip");
  if (std::filesystem::exists(skip)) {
    // the first word of a line is the index of a problem; what follows says why
    std::istringstream text(read_text(skip.string()));
    for (std::string line; std::getline(text, line);) {
      int index = 0;
      if (std::istringstream(line) >> index) set.skipped.insert(index);
    }
  }
  return set;
}

void expect_reference(const Problem& problem, const Solution& solution,
                      const std::vector<double>& expected, bool is_x_unique) {
  const std::size_t n = problem.variables();
  ASSERT_EQ(expected.size(), n + solution.levels.size());
  for (std::size_t level = 0; level < solution.levels.size(); ++level) {
    const double norm = std::sqrt(expected[n + level]);
    ASSERT_NEAR(std::sqrt(solution.levels[level].slack_squared), norm, kSlackError * (1.0 + norm))
        << "level " << level;
  }
  if (!is_x_unique) return;
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, std::abs(expected[i]));
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_NEAR(solution.x[i], expected[i], kPointError * (1.0 + largest)) << "variable " << i;
  }
}

void expect_set_solved(const std::string& name, bool is_warm, bool is_certified) {
  const ReferenceSet set = read_set(name);
  ASSERT_EQ(set.problems.size(), set.solutions.size());
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  ActiveSet active;
  for (std::size_t i = 0; i < set.problems.size(); ++i) {
    SCOPED_TRACE("problem " + std::to_string(i));
    const int index = static_cast<int>(i);
    if (!is_warm) active = ActiveSet{};
    ASSERT_EQ(solver.solve(set.problems[i], SolverOptions{}, active, solution), Status::kSolved);
    if (set.skipped.count(index) > 0) continue;
    const bool is_x_unique = set.is_recorded_sequence || index % 2 == 0;
    expect_reference(set.problems[i], solution, set.solutions[i], is_x_unique);
    if (is_certified) {
      ASSERT_LT(largest_gap(set.problems[i], solution.x), kOptimal);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

class ReferenceSets : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceSets, AreSolvedFromAColdStart) { expect_set_solved(GetParam(), false, true); }

TEST_P(ReferenceSets, AreSolvedFromThePreviousActiveSet) {
  expect_set_solved(GetParam(), true, false);
}

INSTANTIATE_TEST_SUITE_P(, ReferenceSets, testing::ValuesIn(set_names()),
                         [](const auto& name) { return name.param; });

TEST(ReferenceData, IsThere) { EXPECT_FALSE(set_names().empty()) << folder(); }

}  // namespace
}  // namespace hg::hqp
