#include "bench/growth.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

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
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

GrowingProblem::GrowingProblem(int n, int levels, std::uint32_t seed)
    : random_(seed), problem_(capacity_of(n, levels)) {
  std::uniform_real_distribution<double> inside(-1.0, 1.0), width(0.1, 1.0);
  point_ = Eigen::VectorXd::NullaryExpr(n, [&] { return inside(random_); });
  wish_ = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(); });
  for (int i = 0; i < n / 2; ++i) {
    rows_.push_back({-1, random_direction(), 0.0, 0.0});
    rows_.push_back({2 * i, {}, width(random_), width(random_)});
    rows_.push_back({-1, random_direction(), width(random_), width(random_)});
  }
  add_rows();
  set_bounds();
}

Eigen::VectorXd GrowingProblem::random_direction() {
  return Eigen::VectorXd::NullaryExpr(point_.size(), [&] { return normal(); }).normalized();
}

// Rows are dealt out evenly, in order.
void GrowingProblem::add_rows() {
  const int levels = problem_.capacity().levels, count = static_cast<int>(rows_.size());
  for (int level = 0; level < levels; ++level) {
    problem_.add_level();
    for (int i = level * count / levels; i < (level + 1) * count / levels; ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
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
    const Row& row = rows_[static_cast<std::size_t>(id)];
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
  for (double& p : point_) p += kDrift * normal();
  for (double& w : wish_) w += kDrift * normal();
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

namespace {

// Slope of log y over log x.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]), v = std::log(std::max(y[i], 1e-3));
    sum_x += u;
    sum_y += v;
    sum_xx += u * u;
    sum_xy += u * v;
  }
  return (count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
}

// Over `size` of the rows whose `kept` is `value`; nothing for a single one.
void add_exponent(std::span<const GrowthRow> rows, int GrowthRow::*size, int GrowthRow::*kept,
                  int value, GrowthExponent exponent, std::vector<GrowthExponent>& exponents) {
  std::vector<double> x, cold, warm;
  for (const GrowthRow& row : rows) {
    if (row.*kept != value) continue;
    x.push_back(row.*size);
    cold.push_back(row.cold.distribution().median);
    warm.push_back(row.warm.distribution().median);
  }
  if (x.size() < 2) return;
  exponent.cold = slope(x, cold);
  exponent.warm = slope(x, warm);
  exponents.push_back(exponent);
}

constexpr const char* kLine = "{:>5} {:>7} {:>6} {:>11} {:>11} {:>8} {:>11} {:>11} {:>8} {:>7}\n";

}  // namespace

std::vector<GrowthExponent> fit(std::span<const GrowthRow> rows) {
  std::set<int> levels;
  int most = 0;
  for (const GrowthRow& row : rows) {
    levels.insert(row.levels);
    most = std::max(most, row.variables);
  }
  std::vector<GrowthExponent> exponents;
  for (const int count : levels) {
    add_exponent(rows, &GrowthRow::variables, &GrowthRow::levels, count,
                 {"variables", fmt::format("{} levels", count)}, exponents);
  }
  add_exponent(rows, &GrowthRow::levels, &GrowthRow::variables, most,
               {"levels", fmt::format("{} variables", most)}, exponents);
  return exponents;
}

std::string growth_header() {
  return fmt::format(kLine, "", "", "", "cold", "cold", "cold", "warm", "warm", "warm", "") +
         fmt::format(kLine, "n", "levels", "rows", "median", "max", "tried", "median", "max",
                     "tried", "failed");
}

std::string to_text(const GrowthRow& row) {
  const analysis::Distribution cold = row.cold.distribution(), warm = row.warm.distribution();
  return fmt::format(kLine, row.variables, row.levels, row.rows, fmt::format("{:.1f}", cold.median),
                     fmt::format("{:.1f}", cold.max), fmt::format("{:.1f}", row.cold_iterations),
                     fmt::format("{:.1f}", warm.median), fmt::format("{:.1f}", warm.max),
                     fmt::format("{:.1f}", row.warm_iterations), row.failures);
}

std::string to_text(std::span<const GrowthExponent> exponents) {
  std::string text;
  for (const GrowthExponent& e : exponents) {
    text += fmt::format("median ~ {}^k at {}: k = {:.2f} cold, {:.2f} warm\n", e.with, e.at, e.cold,
                        e.warm);
  }
  return text;
}

nlohmann::ordered_json to_json(const GrowthRow& row) {
  const analysis::Distribution cold = row.cold.distribution(), warm = row.warm.distribution();
  return {{"variables", row.variables},
          {"levels", row.levels},
          {"rows", row.rows},
          {"cold_median_us", cold.median},
          {"cold_max_us", cold.max},
          {"cold_active_sets_tried", row.cold_iterations},
          {"warm_median_us", warm.median},
          {"warm_max_us", warm.max},
          {"warm_active_sets_tried", row.warm_iterations},
          {"failed", row.failures}};
}

nlohmann::ordered_json to_json(const GrowthExponent& exponent) {
  return {{"with", exponent.with},
          {"at", exponent.at},
          {"cold", exponent.cold},
          {"warm", exponent.warm}};
}

}  // namespace hg::bench
