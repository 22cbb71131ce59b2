/// Time of the lexicographic solver: on the reference sets (folder HG_REFERENCE_DATA, default
/// tests/reference) and on a synthetic run of the law `gauss` (12 variables, 7 levels), from a cold
/// start and from the active set of the problem before.
///
/// One benchmark iteration is one whole set. The columns are microseconds per problem; `max_us` is
/// the largest of the per-problem minima over all passes, so that interruptions by the system do
/// not show. `iterations` is the mean number of active sets tried.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"

namespace hg::hqp {
namespace {

constexpr Capacity kCapacity = {.variables = kMaxVariables, .levels = kMaxLevels, .rows = kMaxRows};

void run(benchmark::State& state, const std::vector<Problem>& problems, bool is_warm) {
  using Clock = std::chrono::steady_clock;
  Solver solver(kCapacity);
  Solution solution(kCapacity);
  std::vector<double> fastest(problems.size(), INFINITY);
  double iterations = 0.0;
  int failures = 0;
  for (auto _ : state) {
    ActiveSet active;
    iterations = 0.0;
    for (std::size_t i = 0; i < problems.size(); ++i) {
      if (!is_warm) active = ActiveSet{};
      const Clock::time_point begin = Clock::now();
      failures += solver.solve(problems[i], Options{}, active, solution) != Status::kSolved;
      const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
      fastest[i] = std::min(fastest[i], time.count());
      iterations += solution.iterations;
    }
  }
  std::sort(fastest.begin(), fastest.end());
  state.counters["median_us"] = fastest[fastest.size() / 2];
  state.counters["p99_us"] = fastest[fastest.size() * 99 / 100];
  state.counters["p99.9_us"] = fastest[fastest.size() * 999 / 1000];
  state.counters["max_us"] = fastest.back();
  state.counters["iterations"] = iterations / static_cast<double>(problems.size());
  state.counters["failures"] = failures;
}

Eigen::MatrixXd random_matrix(std::mt19937& random, int rows, int cols) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); });
}

void add_rows(Problem& problem, const Eigen::MatrixXd& A, const Eigen::VectorXd& lb,
              const Eigen::VectorXd& ub) {
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Eigen::VectorXd c = A.row(i);
    problem.add_row({c.data(), static_cast<std::size_t>(c.size())}, {lb[i], ub[i]});
  }
}

// Problems shaped as those of the law `gauss` for a 6-DOF twin. Everything turns slowly, so that
// limits come and go one by one; `tightness` is the size of the wish relative to the limits.
std::vector<Problem> gauss_run(double tightness) {
  constexpr int kCycles = 2000;
  std::mt19937 random(11);
  const Eigen::MatrixXd J_m = random_matrix(random, 6, 6) + 3.0 * Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd dJ_m = random_matrix(random, 6, 6);
  const Eigen::MatrixXd C = random_matrix(random, 7, 6);
  const Eigen::MatrixXd B = random_matrix(random, 6, 6);
  const Eigen::MatrixXd L = (B * B.transpose() + Eigen::MatrixXd::Identity(6, 6)).llt().matrixL();
  const Eigen::MatrixXd wishes = random_matrix(random, 6, 3);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(6);

  std::vector<Problem> problems;
  for (int k = 0; k < kCycles; ++k) {
    const double t = 2.0 * M_PI * k / kCycles;
    const Eigen::Vector3d waves(std::sin(t), std::cos(3.0 * t), std::sin(7.0 * t));
    const Eigen::VectorXd wish = tightness * wishes * waves;
    Eigen::MatrixXd coupling(6, 12);
    coupling << -(J_m + 0.3 * std::sin(t) * dJ_m), Eigen::MatrixXd::Identity(6, 6);
    Eigen::MatrixXd cartesian = Eigen::MatrixXd::Zero(7, 12);
    cartesian.leftCols(6) = C;
    Eigen::MatrixXd dynamics = Eigen::MatrixXd::Zero(6, 12);
    dynamics.rightCols(6) = L.transpose();
    const Eigen::VectorXd tau = L.transpose() * wish;

    Problem problem({.variables = 12, .levels = 7, .rows = 31});
    problem.add_level();
    add_rows(problem, coupling, 0.1 * std::cos(t) * one, 0.1 * std::cos(t) * one);
    problem.add_level();
    for (int i = 0; i < 6; ++i) problem.add_bound(i, {-1.0, 1.0});
    const Eigen::VectorXd limit = Eigen::VectorXd::Constant(7, 2.0);
    for (const auto& [first, count] : {std::pair{0, 1}, std::pair{1, 3}, std::pair{4, 3}}) {
      problem.add_level();
      add_rows(problem, cartesian.middleRows(first, count), -limit.head(count), limit.head(count));
    }
    problem.add_level();
    for (int i = 6; i < 12; ++i) problem.add_bound(i, {-4.0, 4.0});
    problem.add_level();
    add_rows(problem, dynamics, tau, tau);
    problems.push_back(std::move(problem));
  }
  return problems;
}

void add(const std::string& name, const std::vector<Problem>& problems) {
  for (const bool is_warm : {false, true}) {
    benchmark::RegisterBenchmark(
        (name + (is_warm ? "/warm" : "/cold")).c_str(),
        [problems, is_warm](benchmark::State& state) { run(state, problems, is_warm); })
        ->Unit(benchmark::kMillisecond);
  }
}

// Rows of one variable lose what they are when a weight is multiplied into them; gives it back.
Problem with_weighted_bounds(const Problem& read) {
  Problem problem(read.capacity());
  problem.clear(read.variables());
  for (int level = 0; level < read.levels(); ++level) {
    problem.add_level();
    for (int row = read.first_row(level); row < read.end_row(level); ++row) {
      const auto c = read.coefficients(row);
      const auto variable = std::find_if(c.begin(), c.end(), [](double k) { return k != 0.0; });
      const auto [lb, ub] = read.bounds(row);
      if (read.variable(row) >= 0) {
        problem.add_bound(read.variable(row), {lb, ub});
      } else if (variable != c.end() && *variable > 0.0 &&
                 std::count(c.begin(), c.end(), 0.0) + 1 == std::ssize(c)) {
        problem.add_bound(static_cast<int>(variable - c.begin()), {lb / *variable, ub / *variable},
                          *variable);
      } else {
        problem.add_row(c, {lb, ub});
      }
    }
  }
  return problem;
}

std::vector<Problem> read_set(const std::string& file) {
  std::vector<Problem> problems;
  for (const Problem& problem : read_problems(file)) {
    problems.push_back(with_weighted_bounds(problem));
  }
  return problems;
}

void add_reference_sets() {
  const char* variable = std::getenv("HG_REFERENCE_DATA");
  const std::filesystem::path folder = variable != nullptr ? variable : "tests/reference";
  std::vector<std::string> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string file = entry.path().string();
      if (file.ends_with(".hqp.gz") || file.ends_with(".hqp")) files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).filename().string();
    add(name.substr(0, name.find('.')), read_set(file));
  }
}

}  // namespace
}  // namespace hg::hqp

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  hg::hqp::add("gauss_free", hg::hqp::gauss_run(0.3));
  hg::hqp::add("gauss_limits", hg::hqp::gauss_run(3.0));
  hg::hqp::add("gauss_many_limits", hg::hqp::gauss_run(10.0));
  hg::hqp::add_reference_sets();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
