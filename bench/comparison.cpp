#include "bench/comparison.h"

#include <algorithm>
#include <cmath>

namespace hg::bench {
namespace {

// Of 1 + norm: a level that is worse by more counts as a loss. Less than the cascade relaxes bounds
// by, 1e-9, which near dependent rows buys 1e-4 of a level below.
constexpr double kNothing = 1e-10;

double value_of(const hqp::Problem& problem, int row, std::span<const double> x) {
  if (problem.variable(row) >= 0) return x[problem.variable(row)];
  const std::span<const double> c = problem.coefficients(row);
  double value = 0.0;
  for (std::size_t i = 0; i < c.size(); ++i) value += c[i] * x[i];
  return value;
}

}  // namespace

std::vector<double> slack_norms(const hqp::Problem& problem, std::span<const double> x) {
  std::vector<double> norms;
  for (int level = 0; level < problem.levels(); ++level) {
    double sum = 0.0;
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const double value = value_of(problem, row, x);
      const Interval bounds = problem.bounds(row);
      const double slack = problem.weight(row) * (std::clamp(value, bounds.lb, bounds.ub) - value);
      sum += slack * slack;
    }
    norms.push_back(std::sqrt(sum));
  }
  return norms;
}

ComparisonVerdict compare(std::span<const double> norms, std::span<const double> reference) {
  bool gave_up = false;
  for (std::size_t level = 0; level < reference.size(); ++level) {
    const double difference = norms[level] - reference[level];
    const double unit = 1.0 + reference[level];
    if (!(std::abs(difference) <= kSlackError * unit)) {
      return difference < 0.0 && !gave_up ? ComparisonVerdict::kBetter : ComparisonVerdict::kWorse;
    }
    gave_up = gave_up || difference > kNothing * unit;
  }
  return ComparisonVerdict::kSame;
}

}  // namespace hg::bench
