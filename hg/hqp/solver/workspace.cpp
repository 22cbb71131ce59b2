#include "hg/hqp/solver/workspace.h"

#include <cmath>

namespace hg::hqp::solver {
namespace {

constexpr double kRoundOff = 1e-14;  // error of c x relative to norm(c) |x|, with a margin of 50

}  // namespace

Point::Point(const Capacity& c)
    : x(c.variables), state(c.rows), rank_at_level(c.levels + 1), blocking_row(c.levels + 1) {}

Iterate::Iterate(const Capacity& c) : Point(c), value(c.rows) {}

Factors::Factors(const Capacity& c)
    : householder(c.variables, c.rows),
      gauss(c.variables, c.rows),
      gauss_rank_at_level(c.levels + 1),
      fit(c.levels + 1) {}

Duals::Duals(const Capacity& c)
    : gradient(c.variables), mu(c.variables), is_fixed_pivot(c.variables) {}

Steps::Steps(const Capacity& c) : last_value(c.rows), must_stay_active(c.rows) {}

ViolatedLevels::ViolatedLevels(const Capacity& c)
    : has_violated(c.levels + 1), expected_violated(c.levels + 1) {}

LineSearch::LineSearch(const Capacity& c)
    : direction(c.variables), slope(c.rows), is_fixed(c.rows), skipped_sides(c.rows) {}

Workspace::Workspace(const Capacity& c)
    : iterate(c),
      factors(c),
      duals(c),
      steps(c),
      levels(c),
      search(c),
      dual(c),
      nnls(c.variables, 2 * c.rows),
      saved(c),
      second_guess(c.rows) {
  targets.reserve(c.rows);
  rows_at_bounds.reserve(2 * c.rows);
  working_set.reserve(c.variables);
}

double tolerance(const Problem& problem, const SolverOptions& options, const Iterate& iterate,
                 int row, double bound) noexcept {
  return options.feasibility_tolerance * magnitude(problem.norm(row), bound, iterate.x_norm);
}

bool reaches(const Problem& problem, const SolverOptions& options, const Iterate& iterate, int row,
             double bound) noexcept {
  return std::isfinite(bound) &&
         std::abs(iterate.value[row] - bound) <= tolerance(problem, options, iterate, row, bound);
}

void update_values(const Problem& problem, int levels, Iterate& iterate) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) {
    iterate.value[row] = dot(problem, row, iterate.x.data());
  }
}

bool move(const Problem& problem, const Eigen::VectorXd& step, double length,
          Iterate& iterate) noexcept {
  const int n = problem.variables();
  const double norm = (iterate.x.head(n) + length * step.head(n)).norm();
  if (!std::isfinite(norm)) return false;
  iterate.x.head(n) += length * step.head(n);
  iterate.x_norm = std::max(iterate.x_norm, norm);
  return true;
}

void collect_targets(const Problem& problem, const SolverOptions& options, int level,
                     const Iterate& iterate, std::vector<TargetRow>& targets) noexcept {
  targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (problem.norm(row) == 0.0) continue;
    const double distance = violation(problem, options, iterate, row);
    const Interval bounds = problem.bounds(row);
    if (is_equality(bounds) || distance != 0.0) {
      targets.push_back({row, distance < 0.0 ? bounds.lb : bounds.ub});
    }
  }
}

void collect_rows_at_bounds(const Problem& problem, const SolverOptions& options, int level,
                            const Iterate& iterate, std::vector<RowAtBound>& rows) noexcept {
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const auto [lb, ub] = problem.bounds(row);
    if (problem.norm(row) == 0.0 || lb == ub) continue;
    if (reaches(problem, options, iterate, row, ub)) rows.push_back({row, 1.0});
    if (reaches(problem, options, iterate, row, lb)) rows.push_back({row, -1.0});
  }
}

double add_residual(const Problem& problem, int row, double bound, const Iterate& iterate,
                    Eigen::VectorXd& gradient, LevelGradient& size) noexcept {
  const double norm = problem.norm(row);
  const double distance = iterate.value[row] - bound;
  const double factor = problem.weight(row) * problem.weight(row);
  add_multiple(problem, row, factor * distance, gradient.data());
  size.scale += factor * norm * std::abs(distance);
  size.rounding += factor * norm * kRoundOff * magnitude(norm, bound, iterate.x_norm);
  return std::abs(distance);
}

LevelGradient level_gradient(const Problem& problem, const SolverOptions& options, int level,
                             const Iterate& iterate, Eigen::VectorXd& gradient) noexcept {
  const int n = problem.variables();
  if (level == problem.levels()) {
    gradient.head(n) = iterate.x.head(n);
    const double norm = iterate.x.head(n).norm();
    return {.is_zero = norm == 0.0, .scale = norm, .rounding = kRoundOff * iterate.x_norm};
  }

  LevelGradient result = {.is_zero = true, .scale = 0.0, .rounding = 0.0};
  gradient.head(n).setZero();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const double norm = problem.norm(row);
    const double distance = excess(problem.bounds(row), iterate.value[row]);
    if (distance == 0.0 || norm == 0.0) continue;
    if (violation(problem, options, iterate, row) != 0.0) result.is_zero = false;
    add_residual(problem, row, iterate.value[row] - distance, iterate, gradient, result);
  }
  return result;
}

}  // namespace hg::hqp::solver
