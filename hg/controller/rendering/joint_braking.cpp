#include "hg/controller/rendering/joint_braking.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hg::rendering {
namespace {

constexpr double kReactionTime = 0.02;  // s, from the demand until the motors brake
constexpr double kShortest = 0.01;      // s of remaining way; nearer ends count as this far
constexpr double kNear = 0.3;  // share of ddq_max; a smaller need leaves room to accelerate
constexpr double kFar = 0.1;   // share of ddq_max; no braking while all needs are smaller

}  // namespace

Approach approach(const limits::JointLimits& limits, const limits::RecoverableOptions& options,
                  double q, double dq, double dt) noexcept {
  limits::JointLimits careful = limits;
  careful.ddq_max *= kNear;
  const Interval room = limits::recoverable_bounds(careful, options, q, dq, dt);
  Approach result{.room = {std::min(room.lb, 0.0), std::max(room.ub, 0.0)}};
  const double distance = dq > 0.0 ? limits.q_max - q : q - limits.q_min;
  const double speed = std::abs(dq);
  if (speed == 0.0 || !std::isfinite(distance)) return result;
  const double left = std::max(distance - kReactionTime * speed, kShortest * speed);
  result.need = 0.5 * speed * dq / left;
  return result;
}

bool is_near(const Approach& approach, const limits::JointLimits& limits) noexcept {
  return std::abs(approach.need) > kFar * limits.ddq_max;
}

Interval braking_bounds(const Approach& approach, double reserve, Interval bounds,
                        const limits::JointLimits& limits,
                        const limits::RecoverableOptions& options, double dq) noexcept {
  // The speed may still grow until the reserve is used up. Continuous where braking begins.
  const double growth = std::max(std::sqrt(reserve / kLeastReserve) - 1.0, 0.0);
  const double grows = growth * std::abs(dq) / options.tau_onset;
  const double hardest = options.ddq_rec_factor * limits.ddq_max;
  if (approach.need > 0.0) {
    const double ub = std::max(approach.room.ub - approach.need + grows, -hardest);
    bounds.ub = std::max(bounds.lb, std::min(bounds.ub, ub));
  } else if (approach.need < 0.0) {
    const double lb = std::min(approach.room.lb - approach.need - grows, hardest);
    bounds.lb = std::min(bounds.ub, std::max(bounds.lb, lb));
  }
  return bounds;
}

JointBraking::JointBraking(const hqp::Problem& tasks, int fixed, std::vector<int> rows,
                           int first_motor, int motors)
    : fixed_(fixed),
      rows_(std::move(rows)),
      first_motor_(first_motor),
      motors_(motors),
      problem_({.variables = tasks.variables() + 1,
                .levels = 4,
                .rows = fixed + static_cast<int>(rows_.size()) + 1}),
      solver_(problem_.capacity()),
      solution_(problem_.capacity()),
      coefficients_(problem_.capacity().variables, 0.0) {
  problem_.clear(problem_.capacity().variables);
  problem_.add_level();
  for (int i = 0; i < fixed; ++i) problem_.add_row(coefficients_, {});
  problem_.add_level();
  for (int i = 0; i < motors; ++i) problem_.add_row(coefficients_, {});
  problem_.add_level();
  for (std::size_t i = motors; i < rows_.size(); ++i) problem_.add_row(coefficients_, {});
  problem_.add_level();
  problem_.add_bound(tasks.variables(), {.lb = kMostReserve});
}

// row `from` of `tasks` with `need` as coefficient of the reserve
void JointBraking::copy(const hqp::Problem& tasks, int from, int to, double need) noexcept {
  const std::span<const double> row = tasks.coefficients(from);
  if (row.empty()) {
    std::ranges::fill(coefficients_, 0.0);
    coefficients_[tasks.variable(from)] = 1.0;
  } else {
    std::ranges::copy(row, coefficients_.begin());
  }
  coefficients_.back() = need;
  problem_.set_row(to, coefficients_);
}

double JointBraking::reserve(const hqp::Problem& tasks, std::span<const Interval> torque,
                             std::span<const Approach> approaches,
                             std::span<const Interval> joint_room) noexcept {
  for (int i = 0; i < fixed_; ++i) {
    copy(tasks, i, i, 0.0);
    problem_.set_bounds(i, tasks.bounds(i));
  }
  int motor_row = fixed_, row = fixed_ + motors_;
  for (int limit = 0; limit < static_cast<int>(rows_.size()); ++limit) {
    const int motor = limit - first_motor_;
    if (motor >= 0 && motor < motors_) {
      copy(tasks, rows_[limit], motor_row, 0.0);
      problem_.set_bounds(motor_row++, torque[motor]);
      continue;
    }
    const Approach& approach = approaches[limit];
    copy(tasks, rows_[limit], row, approach.need);
    const Interval room = limit < first_motor_ ? joint_room[limit] : approach.room;
    problem_.set_bounds(row++, {room.lb - approach.known, room.ub - approach.known});
  }
  hqp::ActiveSet active;
  solver_.solve(problem_, {}, active, solution_);
  return std::max(solution_.x.back(), 0.0);
}

}  // namespace hg::rendering
