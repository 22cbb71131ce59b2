// Properties of every solve. A failure shrinks to the smallest problem that shows it, which is
// printed as a problem file. RC_PARAMS="seed=1 max_success=100000" tries others and more.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/test/byte_problem.h"
#include "hg/hqp/test/certificate.h"
#include "hg/hqp/test/slow_solver.h"
#include "hg/hqp/text.h"

namespace hg::hqp {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Numbers = ByteProblem::Numbers;

constexpr int kCases = 400;          // of each property
constexpr int kMostRows = 40;        // of a problem
constexpr double kSameSlack = 1e-8;  // of 1 + slack
constexpr double kSamePoint = 1e-6;  // of 1 + |x|

// Bytes of a problem: whole rows are dropped when it shrinks, then bytes go to 0.
rc::Gen<Bytes> any_bytes(std::size_t head_bytes, std::size_t row_bytes) {
  const auto byte = rc::gen::cast<std::uint8_t>(rc::gen::inRange(0, 256));
  const auto row = rc::gen::container<Bytes>(row_bytes, byte);
  const auto head = rc::gen::container<Bytes>(head_bytes, byte);
  return rc::gen::apply(
      [](Bytes bytes, const std::vector<Bytes>& rows) {
        for (const Bytes& more : rows) bytes.insert(bytes.end(), more.begin(), more.end());
        return bytes;
      },
      head, rc::gen::container<std::vector<Bytes>>(row));
}

std::string text_of(const Problem& problem) {
  std::ostringstream text;
  write_problem(text, problem);
  return text.str();
}

// Checks `fault`, a function of bytes that returns what is wrong, on random ones. `problem_of`
// makes a problem of them, to be printed.
template <typename Fault, typename ProblemOf>
void expect_none(const Fault& fault, const rc::Gen<Bytes>& any, const ProblemOf& problem_of) {
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  if (std::getenv("RC_PARAMS") == nullptr) {
    params.seed = 1;
    params.maxSuccess = kCases;
  }
  params.maxSize = kMostRows;
  const auto result = rc::detail::checkTestable(
      [&] {
        const Bytes bytes = *any;
        const std::string found = fault(bytes);
        if (found.empty()) return;
        RC_LOG() << text_of(problem_of(bytes)) << found << '\n';
        RC_FAIL("the property does not hold");
      },
      rc::detail::TestMetadata{}, params);
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << "seed " << params.seed << '\n'
                                                               << message.str();
}

template <typename Fault>
void expect_none(const Fault& fault, Numbers numbers = Numbers::kTame) {
  expect_none(fault, any_bytes(ByteProblem::kHeadBytes, ByteProblem::kRowBytes),
              [&](const Bytes& bytes) { return ByteProblem(bytes, numbers).problem; });
}

constexpr Capacity kCapacity = {.variables = 30, .levels = kMaxLevels, .rows = 5 * kMostRows};

struct Solved {
  Solution solution{kCapacity};
  ActiveSet active;
  std::string fault;  ///< of the result, empty if none
};

Solved solve(const Problem& problem, const SolverOptions& options = {},
             const ActiveSet& guess = {}) {
  static Solver solver(kCapacity);
  Solved solved;
  solved.active = guess;
  solver.solve(problem, options, solved.active, solved.solution);
  solved.fault = fault_of(problem, options, solved.solution);
  if (solved.fault.empty() && solved.solution.status == Status::kNumericalFailure) {
    solved.fault = "a numerical failure";
  }
  return solved;
}

double slack_norm(const Solution& solution, int level) {
  return std::sqrt(solution.levels[level].slack_squared);
}

// How two results for the same problem differ, empty if not: in slacks, which are unique, and x. An
// ill-posed problem may have two.
std::string difference(const Problem& problem, const Solution& a, const Solution& b) {
  std::ostringstream text;
  for (int level = 0; level < problem.levels(); ++level) {
    const double slack = slack_norm(a, level);
    if (std::abs(slack - slack_norm(b, level)) <= kSameSlack * (1.0 + slack)) continue;
    text << "level " << level << ": slack " << slack << " or " << slack_norm(b, level) << '\n';
  }
  const Eigen::Map<const Eigen::VectorXd> x_a(a.x.data(), problem.variables());
  const Eigen::Map<const Eigen::VectorXd> x_b(b.x.data(), problem.variables());
  if ((x_a - x_b).norm() > kSamePoint * (1.0 + x_a.norm())) {
    text << "x = " << x_a.transpose() << " or " << x_b.transpose() << '\n';
  }
  if (text.str().empty() || !solve_slowly(problem, true).doubt.empty()) return "";
  return text.str();
}

// One row of a problem, to make another problem of.
struct Row {
  std::vector<double> coefficients;  ///< empty: a bound
  int variable;
  Interval bounds;
  double weight;
};

std::vector<std::vector<Row>> rows_of(const Problem& problem) {
  std::vector<std::vector<Row>> levels(problem.levels());
  for (int row = 0; row < problem.rows(); ++row) {
    const auto c = problem.coefficients(row);
    levels[problem.level_of(row)].push_back(
        {{c.begin(), c.end()}, problem.variable(row), problem.bounds(row), problem.weight(row)});
  }
  return levels;
}

Problem problem_of(int variables, const std::vector<std::vector<Row>>& levels) {
  Problem problem(kCapacity);
  problem.clear(variables);
  for (const auto& level : levels) {
    problem.add_level();
    for (const Row& row : level) {
      if (row.variable >= 0) {
        problem.add_bound(row.variable, row.bounds, row.weight);
      } else {
        problem.add_row(row.coefficients, row.bounds, row.weight);
      }
    }
  }
  return problem;
}

TEST(Property, EveryResultIsCertified) {
  expect_none([](const Bytes& bytes) {
    const ByteProblem made(bytes, Numbers::kTame);
    return solve(made.problem, made.options, made.guess).fault;
  });
}

TEST(Property, TheSlowSolverAgrees) {
  expect_none([](const Bytes& bytes) -> std::string {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    const SlowSolution slow = solve_slowly(problem, true);
    if (!slow.doubt.empty()) return "";
    const Solved fast = solve(problem);
    if (!fast.fault.empty()) return fast.fault;
    Solution other = fast.solution;
    other.x = slow.x;
    for (std::size_t p = 0; p < slow.slack_norms.size(); ++p) {
      other.levels[p].slack_squared = slow.slack_norms[p] * slow.slack_norms[p];
    }
    return difference(problem, fast.solution, other);
  });
}

TEST(Property, AnyGuessLeadsToTheSameResult) {
  expect_none([](const Bytes& bytes) {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    const Solved cold = solve(problem);
    if (!cold.fault.empty()) return cold.fault;
    for (int trial = 0; trial < 9; ++trial) {
      ActiveSet guess = cold.active;
      for (int row = 0; row < problem.rows(); ++row) {
        RowState& state = guess.state[row];
        const int step = trial == 7 ? row : bytes[row % bytes.size()];
        if (trial < 6) state = static_cast<RowState>(trial);  // all the same
        if (trial == 6 && state == RowState::kLower) state = RowState::kUpper;
        if (trial >= 7) state = static_cast<RowState>((static_cast<int>(state) + step) % 6);
      }
      const Solved warm = solve(problem, {}, guess);
      if (!warm.fault.empty()) return "trial " + std::to_string(trial) + ": " + warm.fault;
      const std::string found = difference(problem, cold.solution, warm.solution);
      if (!found.empty()) return "trial " + std::to_string(trial) + ": " + found;
    }
    return std::string();
  });
}

TEST(Property, AWeightIsAFactorOfTheRow) {
  expect_none([](const Bytes& bytes) {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    auto levels = rows_of(problem);
    for (auto& level : levels) {
      for (Row& row : level) {
        if (row.variable >= 0) continue;
        for (double& c : row.coefficients) c *= 3.0;
        row.bounds = {3.0 * row.bounds.lb, 3.0 * row.bounds.ub};
        row.weight /= 3.0;
      }
    }
    const Solved one = solve(problem);
    const Solved other = solve(problem_of(problem.variables(), levels));
    if (!other.fault.empty()) return other.fault;
    return difference(problem, one.solution, other.solution);
  });
}

TEST(Property, OrderWithinALevelDoesNotMatter) {
  expect_none([](const Bytes& bytes) {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    auto levels = rows_of(problem);
    for (auto& level : levels) std::reverse(level.begin(), level.end());
    const Solved one = solve(problem);
    const Solved other = solve(problem_of(problem.variables(), levels));
    if (!other.fault.empty()) return other.fault;
    return difference(problem, one.solution, other.solution);
  });
}

TEST(Property, ARepeatedLevelChangesNothing) {
  expect_none([](const Bytes& bytes) {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    std::vector<std::vector<Row>> levels;
    for (const auto& level : rows_of(problem)) levels.insert(levels.end(), 2, level);
    const Solved one = solve(problem);
    Solved other = solve(problem_of(problem.variables(), levels));
    if (!other.fault.empty()) return other.fault;
    for (int level = 0; level < problem.levels(); ++level) {
      std::swap(other.solution.levels[level], other.solution.levels[2 * level + 1]);
    }
    return difference(problem, one.solution, other.solution);
  });
}

TEST(Property, ARowThatIsWrittenTwiceCountsAsTwo) {
  expect_none([](const Bytes& bytes) {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    auto levels = rows_of(problem);
    for (auto& level : levels) {
      for (Row& row : level) row.weight *= std::sqrt(0.5);
      const auto again = level;
      level.insert(level.end(), again.begin(), again.end());
    }
    const Solved one = solve(problem);
    const Solved other = solve(problem_of(problem.variables(), levels));
    if (!other.fault.empty()) return other.fault;
    return difference(problem, one.solution, other.solution);
  });
}

// What a level gets, levels above being the same, can only become better when it loses a row.
TEST(Property, ALevelGetsNoLessWhenARowMovesDown) {
  expect_none([](const Bytes& bytes) -> std::string {
    const Problem problem = ByteProblem(bytes, Numbers::kTame).problem;
    if (problem.rows() == 0) return "";
    const int moved = bytes[1] % problem.rows();
    const int from = problem.level_of(moved);
    const Solved before = solve(problem);
    auto levels = rows_of(problem);
    auto& level = levels[from];
    const auto place = level.begin() + (moved - problem.first_row(from));
    levels.insert(levels.begin() + from + 1, std::vector<Row>{*place});
    auto& shorter = levels[from];
    shorter.erase(shorter.begin() + (moved - problem.first_row(from)));
    const Solved after = solve(problem_of(problem.variables(), levels));
    if (!after.fault.empty()) return after.fault;

    for (int above = 0; above < from; ++above) {
      const double slack = slack_norm(before.solution, above);
      if (std::abs(slack_norm(after.solution, above) - slack) > kSameSlack * (1.0 + slack)) {
        return "row " + std::to_string(moved) + " changes level " + std::to_string(above);
      }
    }
    const double slack = before.solution.slack[moved];
    const double weighted = problem.weight(moved) * slack;
    const double rest_squared = before.solution.levels[from].slack_squared - weighted * weighted;
    const double rest = std::sqrt(std::max(0.0, rest_squared));
    if (slack_norm(after.solution, from) > rest + 1e-7 * (1.0 + std::abs(weighted) + rest)) {
      return "level " + std::to_string(from) + " gets less without row " + std::to_string(moved);
    }
    return "";
  });
}

TEST(Property, AStoppedSolveIsUsable) {
  expect_none([](const Bytes& bytes) {
    const ByteProblem made(bytes, Numbers::kTame);
    const Solved full = solve(made.problem);
    for (const int cap : {1, 2, 5}) {
      SolverOptions options = made.options;
      options.max_iterations = cap;
      const Solved stopped = solve(made.problem, options, made.guess);
      if (!stopped.fault.empty()) return "cap " + std::to_string(cap) + ": " + stopped.fault;
      for (int level = 0; level < stopped.solution.completed_levels; ++level) {
        const double slack = slack_norm(full.solution, level);
        if (std::abs(slack_norm(stopped.solution, level) - slack) <= kSameSlack * (1.0 + slack)) {
          continue;
        }
        return "cap " + std::to_string(cap) + ": level " + std::to_string(level) +
               " is not complete";
      }
    }
    return std::string();
  });
}

TEST(Property, ASequenceIsSolvedFromTheActiveSetBefore) {
  expect_none([](const Bytes& bytes) {
    ByteProblem made(bytes, Numbers::kTame);
    Solved warm = solve(made.problem);
    for (int step = 0; step < ByteProblem::kChanges; ++step) {
      made.change(step);
      warm = solve(made.problem, {}, warm.active);
      if (!warm.fault.empty()) return text_of(made.problem) + warm.fault;
      const Solved cold = solve(made.problem);
      const std::string found = difference(made.problem, cold.solution, warm.solution);
      if (!found.empty()) return text_of(made.problem) + found;
    }
    return std::string();
  });
}

TEST(Property, SameArgumentsGiveTheSameBits) {
  expect_none([](const Bytes& bytes) {
    const ByteProblem made(bytes, Numbers::kScaled);
    const Solved one = solve(made.problem, made.options, made.guess);
    Solver fresh(kCapacity);
    ActiveSet active = made.guess;
    Solution other(kCapacity);
    fresh.solve(made.problem, made.options, active, other);
    const bool is_same = one.solution.x == other.x && one.active.state == active.state &&
                         one.solution.slack == other.slack &&
                         one.solution.iterations == other.iterations;
    return std::string(is_same ? "" : "another solver gives other bits");
  });
}

TEST(Property, ABadRowIsNamedAndTheLevelsAboveHold) {
  expect_none([](const Bytes& bytes) -> std::string {
    const Problem good = ByteProblem(bytes, Numbers::kTame).problem;
    if (good.rows() == 0) return "";
    const int row = bytes[1] % good.rows();
    const int level = good.level_of(row);
    const auto rows = rows_of(good);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int kind = 0; kind < 4; ++kind) {
      Problem problem = good;
      if (kind == 0) problem.set_bounds(row, {nan, good.bounds(row).ub});
      if (kind == 1) problem.set_weight(row, kind - 1.0);
      if (kind == 2) problem.set_bounds(row, {1.0, 0.5});
      if (kind == 3 && good.variable(row) >= 0) continue;
      if (kind == 3) {
        std::vector<double> c(good.variables(), kInfinity);
        problem.set_row(row, c);
      }
      const Solved bad = solve(problem);
      if (!bad.fault.empty()) return bad.fault;
      if (bad.solution.status != Status::kBadRow) return "a bad row is accepted";
      if (bad.solution.bad_row != row) return "another row is blamed";
      const Solved above =
          solve(problem_of(good.variables(), {rows.begin(), rows.begin() + level}));
      for (int p = 0; p < level; ++p) {
        const double slack = slack_norm(above.solution, p);
        if (std::abs(slack - slack_norm(bad.solution, p)) > kSameSlack * (1.0 + slack)) {
          return "levels above the bad row are not solved";
        }
      }
    }
    return "";
  });
}

TEST(Property, AnyNumbersGiveAFiniteAnswer) {
  expect_none(
      [](const Bytes& bytes) {
        const ByteProblem made(bytes, Numbers::kSpecial);
        Solver solver(kCapacity);
        Solution solution(kCapacity);
        ActiveSet active = made.guess;
        solver.solve(made.problem, made.options, active, solution);
        return fault_of(made.problem, made.options, solution, made.is_tame ? 1e-6 : kInfinity);
      },
      Numbers::kSpecial);
}

// A problem of 2 to 30 joints whose levels cannot all be met: couplings, 3 levels of limits,
// wishes.
class Conflict {
 public:
  static constexpr std::size_t kHeadBytes = 3;
  static constexpr std::size_t kRowBytes = 4;

  explicit Conflict(const Bytes& bytes) : n_(2 + bytes[0] % 29), levels_(5) {
    for (int i = 0; i < bytes[1] % (n_ / 3 + 1); ++i) add(0, random_row(i), {0.0, 0.0});
    for (std::size_t k = kHeadBytes; k + kRowBytes <= bytes.size(); k += kRowBytes) {
      add_kind(bytes[k] % 7, bytes[k + 1], bytes[k + 2], 0.01 * bytes[k + 3]);
    }
    for (int i = 0; i < n_; ++i) {
      const double wish = random_row(bytes[2])[i];
      levels_[4].push_back({{}, i, {wish, wish}, 1.0});
    }
  }
  Problem problem() const { return problem_of(n_, levels_); }

 private:
  using Coefficients = std::vector<double>;

  Coefficients random_row(int seed) const {
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    std::normal_distribution<double> number;
    Coefficients row(n_);
    for (double& c : row) c = number(random);
    return row;
  }
  void add(int level, const Coefficients& row, Interval bounds) {
    levels_[level].push_back({row, -1, bounds, 1.0});
    last_ = row;
  }
  void add_kind(int kind, int seed, int level, double number) {
    const Coefficients row = random_row(seed);
    const int limits = 1 + level % 3;
    if (kind == 0 || kind == 1) {  // a contradiction: of two levels, or of three
      Coefficients sum = row;
      add(1, row, {-kInfinity, number});
      if (kind == 1) {
        const Coefficients other = random_row(seed + 1);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
        add(2, other, {-kInfinity, number});
      }
      add(2 + kind, sum, {2.0 * number + 0.5, 3.0 * number + 1.0});
    } else if (kind == 2) {
      add(limits, row, {-number, number});
    } else if (kind == 3) {  // lb = ub
      add(limits, row, {number, number});
    } else if (kind == 4) {  // limits that meet at x = 0
      levels_[limits].push_back({{}, level % n_, {-kInfinity, 0.0}, 1.0});
    } else if (!last_.empty()) {  // the last row again, exactly or nearly
      Coefficients again = last_;
      for (std::size_t i = 0; i < row.size() && kind == 6; ++i) again[i] += 1e-5 * row[i];
      add(limits, again, {-number, kInfinity});
    }
  }

  int n_;
  std::vector<std::vector<Row>> levels_;
  Coefficients last_;
};

template <typename Fault>
void expect_none_in_conflicts(const Fault& fault) {
  expect_none([&](const Bytes& bytes) { return fault(Conflict(bytes).problem()); },
              any_bytes(Conflict::kHeadBytes, Conflict::kRowBytes),
              [](const Bytes& bytes) { return Conflict(bytes).problem(); });
}

TEST(Property, ConflictsOfLevelsAreSolvedAndCertified) {
  expect_none_in_conflicts([](const Problem& problem) {
    const Solved solved = solve(problem);
    std::string fault = solved.fault;
    if (solved.solution.status != Status::kSolved) fault += "not solved";
    const bool is_ill_posed = !fault.empty() && !solve_slowly(problem, true).doubt.empty();
    return is_ill_posed ? "" : fault;
  });
}

TEST(Property, ConflictsOfLevelsEndTheSameFromAWrongGuess) {
  expect_none_in_conflicts([](const Problem& problem) {
    const Solved cold = solve(problem);
    ActiveSet guess = cold.active;
    std::rotate(guess.state.begin(), guess.state.begin() + 1, guess.state.begin() + problem.rows());
    const Solved warm = solve(problem, {}, guess);
    return difference(problem, cold.solution, warm.solution);
  });
}

TEST(Property, ConflictsOfLevelsGiveTheSameBits) {
  expect_none_in_conflicts([](const Problem& problem) {
    const Solved one = solve(problem);
    Solver fresh(kCapacity);
    Solution other(kCapacity);
    ActiveSet active;
    fresh.solve(problem, {}, active, other);
    const bool is_same = one.solution.x == other.x && one.active.state == active.state &&
                         one.solution.slack == other.slack &&
                         one.solution.iterations == other.iterations;
    return std::string(is_same ? "" : "another solver gives other bits");
  });
}

}  // namespace
}  // namespace hg::hqp
