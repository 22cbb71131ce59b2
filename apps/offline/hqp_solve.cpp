#include "apps/offline/hqp_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/report.h"
#include "apps/offline/subcommand.h"
#include "hg/core/error.h"
#include "hg/hqp/printing.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"

namespace hg::apps {
namespace {

constexpr int kRuns = 5;  // of each problem when timing; the fastest counts

using Problems = std::vector<hqp::RecordedProblem>;

// Solver and what it needs, for all problems of a file in turn.
struct Player {
  explicit Player(const Problems& problems)
      : solver(hqp::capacity_for(problems)), solution(hqp::capacity_for(problems)) {}

  hqp::Solver solver;
  hqp::Solution solution;
  hqp::ActiveSet active = {};
};

bool report(std::size_t index, const hqp::Problem& problem, const hqp::Solution& solution) {
  if (solution.status == hqp::Status::kSolved) return true;
  std::string text = fmt::format("problem {}: {}", index, hqp::to_string(solution.status));
  if (solution.status == hqp::Status::kBadRow) {
    text += fmt::format(", {}: {}", hqp::to_string(problem, solution.bad_row),
                        hqp::broken_rule(problem, solution.bad_row));
  }
  print_error("{}\n", text);
  return false;
}

void print_numbers(const hqp::Solution& solution) {
  std::string line;
  for (const double x : solution.x) line += fmt::format("{} ", x);
  for (const hqp::LevelResult& level : solution.levels) {
    line += fmt::format("{} ", level.slack_squared);
  }
  line.back() = '\n';
  print_out(line);
}

void explain(std::size_t index, const hqp::RecordedProblem& recorded,
             const std::optional<int>& level, Player& player) {
  const auto& [problem, options, guess, name] = recorded;
  print_out("problem {}{}{}\noptions: {}\n", index, name.empty() ? "" : ", ", name,
            hqp::to_string(options));
  print_out("{}", hqp::to_string(problem, player.solution));
  std::string x;
  for (const double value : player.solution.x) x += fmt::format(" {}", value);
  print_out("x ={}\n", x);
  if (!level) return;
  if (*level >= problem.levels()) {
    throw SetupError(fmt::format("--level: problem {} has the levels 0..{}, got {}", index,
                                 problem.levels() - 1, *level));
  }
  std::vector<double> mu(problem.rows());
  const double remainder = player.solver.multipliers(problem, options, player.solution, *level, mu);
  print_out("{}", hqp::to_string(problem, *level, mu, remainder));
}

bool print_solutions(const Problems& problems, std::size_t first,
                     const HqpSolveArguments& arguments) {
  Player player(problems);
  bool are_settled = true;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const auto& [problem, options, guess, name] = problems[i];
    if (guess) player.active = *guess;
    player.solver.solve(problem, options, player.active, player.solution);
    are_settled &= report(first + i, problem, player.solution);
    if (arguments.explains || arguments.level) {
      explain(first + i, problems[i], arguments.level, player);
    } else {
      print_numbers(player.solution);
    }
  }
  return are_settled;
}

// Fastest of kRuns, in ns; player.active receives the final active set.
std::int64_t time_of(const hqp::RecordedProblem& recorded, Player& player) {
  using Clock = std::chrono::steady_clock;
  const hqp::ActiveSet guess = player.active;
  std::chrono::nanoseconds fastest = std::chrono::nanoseconds::max();
  for (int run = 0; run < kRuns; ++run) {
    player.active = guess;
    const Clock::time_point begin = Clock::now();
    player.solver.solve(recorded.problem, recorded.options, player.active, player.solution);
    fastest = std::min(fastest, std::chrono::nanoseconds(Clock::now() - begin));
  }
  return fastest.count();
}

// Of each problem, in ns. `are_settled` becomes false where one is not solved.
std::vector<std::int64_t> times_of(const Problems& problems, std::size_t first, bool is_warm,
                                   bool& are_settled) {
  Player player(problems);
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!is_warm) player.active = hqp::ActiveSet{};
    if (is_warm && problems[i].guess) player.active = *problems[i].guess;
    times.push_back(time_of(problems[i], player));
    are_settled &= report(first + i, problems[i].problem, player.solution);
  }
  return times;
}

// The selected problems; `first` becomes the index of the first one.
Problems read(const HqpSolveArguments& arguments, std::size_t& first) {
  Problems problems = hqp::read_recorded_problems(arguments.file);
  first = 0;
  if (!arguments.problem) return problems;
  first = *arguments.problem;
  if (first >= problems.size()) {
    throw SetupError(fmt::format("--problem: {} has the problems 0..{}, got {}", arguments.file,
                                 problems.size() - 1, first));
  }
  return {problems[first]};
}

}  // namespace

int run_hqp_solve(const HqpSolveArguments& arguments) {
  if (arguments.has_timing && (arguments.explains || arguments.level)) {
    const char* const other = arguments.explains ? "--explain" : "--level";
    throw SetupError(fmt::format(
        "--timing shows times only: leave out {0}, or --timing to see what {0} shows", other));
  }
  std::size_t first = 0;
  const Problems problems = read(arguments, first);
  if (!arguments.has_timing) return print_solutions(problems, first, arguments) ? 0 : 1;

  check_report_program();
  nlohmann::ordered_json results = {{"kind", "hqp"}};
  bool are_settled = true;
  results["cold"] = times_of(problems, first, false, are_settled);
  results["warm"] = times_of(problems, first, true, are_settled);
  return become_reports({{.results = results, .exit_code = are_settled ? 0 : 1}});
}

void add_hqp(Command app, int& exit_code) {
  const auto arguments = std::make_shared<HqpSolveArguments>();
  const Command hqp = add_offline(app, "hqp");
  hqp.require_subcommand(1);
  const Command solve = hqp.add_subcommand("solve", "Solve the problems of a file (plain or .gz).");
  solve.footer(
      "Examples:\n"
      "  hapticgiant hqp solve tests/reference/exc_two.hqp.gz --timing\n"
      "  hapticgiant hqp solve tests/reference/exc_two.hqp.gz --problem 7 --explain");
  solve.add_option("file", arguments->file, "problem file, format in docs/concepts/hqp.md")
      .required();
  solve.add_option("--problem", arguments->problem, "only this problem, counted from 0")
      .check(at_least(0));
  solve.add_flag("--explain", arguments->explains, "levels, rows that act and why, in words");
  solve.add_option("--level", arguments->level, "as --explain, with the multipliers of this level")
      .check(at_least(0));
  solve.add_flag("--timing", arguments->has_timing, "microseconds, cold and warm");
  solve.callback([arguments, &exit_code] { exit_code = run_hqp_solve(*arguments); });
}

}  // namespace hg::apps
