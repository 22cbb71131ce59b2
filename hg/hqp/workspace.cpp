#include "hg/hqp/workspace.h"

#include <cmath>

namespace hg::hqp {
namespace {

constexpr double kRoundOff = 1e-14;  // error of c x relative to norm(c) |x|, with a margin of 50

}  // namespace

Point::Point(const Capacity& c)
    : x(c.variables),
      state(at(c.rows)),
      rank_at_level(at(c.levels) + 1),
      blocking_row(at(c.levels) + 1) {}

Workspace::Workspace(const Capacity& c)
    : elimination(c.variables, c.rows),
      direct(c.variables, c.rows),
      dual(c),
      cone(c.variables, 2 * c.rows),
      point(c),
      saved(c),
      second_guess(at(c.rows)),
      value(at(c.rows)),
      last_value(at(c.rows)),
      is_frozen(at(c.variables)),
      is_needed(at(c.rows)),
      direct_rank_at_level(at(c.levels) + 1),
      has_violated(at(c.levels) + 1),
      gives_way(at(c.levels) + 1),
      fit(at(c.levels) + 1),
      mu(c.variables),
      slope(at(c.rows)),
      is_fixed(at(c.rows)),
      skipped_sides(at(c.rows)),
      gradient(c.variables),
      direction(c.variables) {
  targets.reserve(at(c.rows));
  touched.reserve(2 * at(c.rows));
  held.reserve(at(c.variables));
}

double tolerance(const Problem& problem, const Options& options, const Workspace& work, int row,
                 double bound) noexcept {
  return options.feasibility_tolerance * magnitude(problem.norm(row), bound, work.x_norm);
}

bool touches(const Problem& problem, const Options& options, const Workspace& work, int row,
             double bound) noexcept {
  return std::isfinite(bound) &&
         std::abs(work.value[at(row)] - bound) <= tolerance(problem, options, work, row, bound);
}

void update_values(const Problem& problem, int levels, Workspace& work) noexcept {
  const int rows = rows_of(problem, levels);
  for (int row = 0; row < rows; ++row) work.value[at(row)] = dot(problem, row, work.point.x.data());
}

bool move(const Problem& problem, const Eigen::VectorXd& step, double length,
          Workspace& work) noexcept {
  const int n = problem.variables();
  const double norm = (work.point.x.head(n) + length * step.head(n)).norm();
  if (!std::isfinite(norm)) return false;
  work.point.x.head(n) += length * step.head(n);
  work.x_norm = std::max(work.x_norm, norm);
  return true;
}

void collect_targets(const Problem& problem, const Options& options, int level,
                     Workspace& work) noexcept {
  work.targets.clear();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    if (problem.norm(row) == 0.0) continue;
    const double distance = violation(problem, options, work, row);
    const Interval bounds = problem.bounds(row);
    if (is_equality(bounds) || distance != 0.0) {
      work.targets.push_back({row, distance < 0.0 ? bounds.lb : bounds.ub});
    }
  }
}

void collect_touched(const Problem& problem, const Options& options, int level,
                     Workspace& work) noexcept {
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const auto [lb, ub] = problem.bounds(row);
    if (problem.norm(row) == 0.0 || lb == ub) continue;
    if (touches(problem, options, work, row, ub)) work.touched.push_back({row, 1.0});
    if (touches(problem, options, work, row, lb)) work.touched.push_back({row, -1.0});
  }
}

double add_pull(const Problem& problem, int row, double bound, Workspace& work,
                LevelGradient& result) noexcept {
  const double norm = problem.norm(row);
  const double distance = work.value[at(row)] - bound;
  const double factor = problem.weight(row) * problem.weight(row);
  add_multiple(problem, row, factor * distance, work.gradient.data());
  result.scale += factor * norm * std::abs(distance);
  result.rounding += factor * norm * kRoundOff * magnitude(norm, bound, work.x_norm);
  return std::abs(distance);
}

LevelGradient level_gradient(const Problem& problem, const Options& options, int level,
                             Workspace& work) noexcept {
  const int n = problem.variables();
  if (level == problem.levels()) {
    work.gradient.head(n) = work.point.x.head(n);
    const double norm = work.point.x.head(n).norm();
    return {.is_zero = norm == 0.0, .scale = norm, .rounding = kRoundOff * work.x_norm};
  }

  LevelGradient result = {.is_zero = true, .scale = 0.0, .rounding = 0.0};
  work.gradient.head(n).setZero();
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const double norm = problem.norm(row);
    const double distance = excess(problem.bounds(row), work.value[at(row)]);
    if (distance == 0.0 || norm == 0.0) continue;
    if (violation(problem, options, work, row) != 0.0) result.is_zero = false;
    add_pull(problem, row, work.value[at(row)] - distance, work, result);
  }
  return result;
}

}  // namespace hg::hqp
