#include "bench/growth.h"

#include "hg/hqp/solver.h"

namespace hg::bench {
namespace {

constexpr double kDrift = 1e-3;
constexpr std::uint32_t kSeeds = 5;
constexpr std::size_t kSteps = 4;

hqp::Capacity capacity_of(int n, int levels) {
  return {.variables = n, .levels = levels, .rows = 5 * n / 2};
}

std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

}  // namespace

GrowingProblem::GrowingProblem(int n, int levels, std::uint32_t seed)
    : random_(seed), problem_(capacity_of(n, levels)) {
  const auto width = [this] { return random_.between(0.1, 1.0); };
  point_ = Eigen::VectorXd::NullaryExpr(n, [&] { return random_.between(-1.0, 1.0); });
  wish_ = Eigen::VectorXd::NullaryExpr(n, [&] { return random_.normal(); });
  for (int i = 0; i < n / 2; ++i) {
    rows_.push_back({-1, random_direction(), 0.0, 0.0});
    rows_.push_back({2 * i, {}, width(), width()});
    rows_.push_back({-1, random_direction(), width(), width()});
  }
  add_rows();
  set_bounds();
}

Eigen::VectorXd GrowingProblem::random_direction() {
  return Eigen::VectorXd::NullaryExpr(point_.size(), [&] { return random_.normal(); }).normalized();
}

// Rows are dealt out evenly, in order.
void GrowingProblem::add_rows() {
  const int levels = problem_.capacity().levels, count = static_cast<int>(rows_.size());
  for (int level = 0; level < levels; ++level) {
    problem_.add_level();
    for (int i = level * count / levels; i < (level + 1) * count / levels; ++i) {
      const Row& row = rows_[i];
      if (row.variable >= 0) {
        problem_.add_bound(row.variable, {0.0, 0.0});
      } else {
        problem_.add_row(span_of(row.direction), {0.0, 0.0});
      }
    }
  }
  for (int i = 0; i < problem_.variables(); ++i) problem_.add_bound(i, {0.0, 0.0});
}

void GrowingProblem::set_bounds() {
  for (int id = 0; id < first_wish(); ++id) {
    const Row& row = rows_[id];
    const double at = row.variable >= 0 ? point_[row.variable] : row.direction.dot(point_);
    if (row.variable < 0) problem_.set_row(id, span_of(row.direction));
    problem_.set_bounds(id, {at - row.below, at + row.above});
  }
  for (int i = 0; i < problem_.variables(); ++i) {
    const double at = point_[i] + wish_[i];
    problem_.set_bounds(first_wish() + i, {at, at});
  }
}

void GrowingProblem::step() {
  for (Row& row : rows_) {
    if (row.variable >= 0) continue;
    row.direction = (row.direction + kDrift * random_direction()).normalized();
  }
  for (double& p : point_) p += kDrift * random_.normal();
  for (double& w : wish_) w += kDrift * random_.normal();
  set_bounds();
}

GrowthRow measure_growth(int variables, int levels, int passes) {
  const hqp::Capacity capacity = capacity_of(variables, levels);
  hqp::Solver solver(capacity);
  hqp::Solution solution(capacity);
  GrowthRow row = {.variables = variables, .levels = levels, .rows = capacity.rows};
  const auto solve = [&](const hqp::Problem& problem, hqp::ActiveSet& active) {
    const Clock::time_point begin = Clock::now();
    row.failures += solver.solve(problem, {}, active, solution) != hqp::Status::kSolved;
    return microseconds_since(begin);
  };
  for (int pass = 0; pass < passes; ++pass) {
    row.failures = 0;
    row.cold_iterations = row.warm_iterations = 0.0;
    std::size_t index = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      GrowingProblem growing(variables, levels, seed);
      hqp::ActiveSet active;
      solve(growing.problem(), active);
      for (std::size_t step = 0; step < kSteps; ++step, ++index) {
        growing.step();
        row.warm.add(index, solve(growing.problem(), active));
        row.warm_iterations += solution.iterations;
        hqp::ActiveSet none;
        row.cold.add(index, solve(growing.problem(), none));
        row.cold_iterations += solution.iterations;
      }
    }
    row.cold_iterations /= static_cast<double>(index);
    row.warm_iterations /= static_cast<double>(index);
  }
  return row;
}

}  // namespace hg::bench
