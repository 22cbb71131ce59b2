#include "apps/hapticgiant/hqp_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"

namespace hg::apps {
namespace {

constexpr int kRuns = 5;  // of each problem when timing; the fastest counts

// The smallest capacity that takes all problems.
hqp::Capacity capacity_of(const std::vector<hqp::Problem>& problems) {
  hqp::Capacity capacity = {.variables = 1, .levels = 1, .rows = 1};
  for (const hqp::Problem& problem : problems) {
    capacity.variables = std::max(capacity.variables, problem.variables());
    capacity.levels = std::max(capacity.levels, problem.levels());
    capacity.rows = std::max(capacity.rows, problem.rows());
  }
  return capacity;
}

bool report(std::size_t index, hqp::Status status) {
  if (status == hqp::Status::kSolved) return true;
  fmt::print(stderr, "problem {}: {}\n", index, hqp::to_string(status));
  return false;
}

bool print_solutions(const std::vector<hqp::Problem>& problems) {
  hqp::Solver solver(capacity_of(problems));
  hqp::Solution solution(capacity_of(problems));
  hqp::ActiveSet active;
  bool are_settled = true;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    are_settled &= report(i, solver.solve(problems[i], hqp::Options{}, active, solution));
    std::string line;
    for (const double x : solution.x) line += fmt::format("{} ", x);
    for (const hqp::LevelResult& level : solution.levels) {
      line += fmt::format("{} ", level.slack_squared);
    }
    line.back() = '\n';
    std::fputs(line.c_str(), stdout);
  }
  return are_settled;
}

// Fastest of kRuns, in microseconds; `active` receives the final active set.
double time_of(hqp::Solver& solver, const hqp::Problem& problem, hqp::ActiveSet& active,
               hqp::Solution& solution) {
  using Clock = std::chrono::steady_clock;
  const hqp::ActiveSet guess = active;
  double fastest = INFINITY;
  for (int run = 0; run < kRuns; ++run) {
    active = guess;
    const Clock::time_point begin = Clock::now();
    solver.solve(problem, hqp::Options{}, active, solution);
    const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
    fastest = std::min(fastest, time.count());
  }
  return fastest;
}

bool print_times(const std::vector<hqp::Problem>& problems, bool is_warm) {
  hqp::Solver solver(capacity_of(problems));
  hqp::Solution solution(capacity_of(problems));
  hqp::ActiveSet active;
  std::vector<double> times;
  double sum = 0.0;
  bool are_settled = true;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!is_warm) active = hqp::ActiveSet{};
    times.push_back(time_of(solver, problems[i], active, solution));
    sum += times.back();
    are_settled &= report(i, solution.status);
  }

  std::sort(times.begin(), times.end());
  const auto count = static_cast<double>(times.size());
  const auto rank = [&](double share) {
    const auto index = static_cast<std::size_t>(std::ceil(share * count)) - 1;
    return times[std::min(index, times.size() - 1)];
  };
  fmt::print("{:5} {:9.2f} {:9.2f} {:9.2f} {:9.2f}\n", is_warm ? "warm" : "cold", rank(0.5),
             sum / count, rank(0.999), times.back());
  return are_settled;
}

}  // namespace

int run_hqp_solve(const std::string& file, bool timing) {
  const std::vector<hqp::Problem> problems = hqp::read_problems(file);
  if (!timing) return print_solutions(problems) ? 0 : 1;

  fmt::print("{} problems, microseconds per problem\n", problems.size());
  fmt::print("{:5} {:>9} {:>9} {:>9} {:>9}\n", "start", "median", "mean", "99.9 %", "max");
  const bool is_cold_settled = print_times(problems, false);
  const bool is_warm_settled = print_times(problems, true);
  return is_cold_settled && is_warm_settled ? 0 : 1;
}

}  // namespace hg::apps
