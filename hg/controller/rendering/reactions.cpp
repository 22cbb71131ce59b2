#include "hg/controller/rendering/reactions.h"

#include <algorithm>
#include <cmath>

#include "hg/controller/rendering/bearing_wrench.h"

namespace hg::rendering {
namespace {

// below this acceleration-energy norm a limit is not said to be felt, sqrt(J/s^2 kg) ~ 0.1 N on 1
// kg
constexpr double kFeltMin = 0.1;
// share of the largest torque that limits have on a joint, up to which they do not reach another
constexpr double kReach = 1e-6;

hqp::Capacity capacity_for(int limits, int n_a) {
  return {.variables = limits, .levels = 4, .rows = 2 * limits + 1 + n_a};
}

LimitState limit_state(hqp::RowState state, double reaction) noexcept {
  switch (state) {
    case hqp::RowState::kInactive:
      return LimitState::kInactive;
    case hqp::RowState::kLower:
      return LimitState::kLower;
    case hqp::RowState::kUpper:
      return LimitState::kUpper;
    case hqp::RowState::kEqual:
      return reaction > 0.0 ? LimitState::kLower : LimitState::kUpper;
    case hqp::RowState::kBelow:
    case hqp::RowState::kAbove:
      return LimitState::kViolated;
  }
  return LimitState::kInactive;
}

bool is_upper_side(hqp::RowState state, double reaction) noexcept {
  switch (state) {
    case hqp::RowState::kUpper:
    case hqp::RowState::kAbove:
      return true;
    case hqp::RowState::kEqual:
      return reaction <= 0.0;
    case hqp::RowState::kInactive:
    case hqp::RowState::kLower:
    case hqp::RowState::kBelow:
      return false;
  }
  return false;
}

// a bound on the torque is approached; `row.q` is the torque
LimitCause cause_of_motor(const LimitRow& row, bool is_upper) noexcept {
  constexpr double kNear = 0.05;  // of the whole range
  if (row.is_slowed) return LimitCause::kVelocity;
  const double left = is_upper ? row.torque.ub - row.q : row.q - row.torque.lb;
  const bool is_at_end = left <= kNear * (row.torque.ub - row.torque.lb);
  return is_at_end ? LimitCause::kTorque : LimitCause::kTorqueRate;
}

// whether it comes nearer to the end at which it acts; one that stands there does not brake
bool moves_outward(const LimitRow& row, bool is_upper) noexcept {
  constexpr double kMoves = 0.02;  // rad/s or m/s
  return (is_upper ? row.dq : -row.dq) > kMoves;
}

// rating of the limited quantity that gives the acting bound
LimitCause cause_of(const LimitRow& row, int acting_row, Interval ddq, hqp::RowState state,
                    double reaction, double dt) noexcept {
  if (state == hqp::RowState::kInactive) return LimitCause::kNone;
  const bool is_upper = is_upper_side(state, reaction);
  if (row.is_motor) return cause_of_motor(row, is_upper);
  const LimitCause held_by = is_upper ? row.held_by.upper : row.held_by.lower;
  const bool holds_always = held_by == LimitCause::kLock || held_by == LimitCause::kFriction;
  if (holds_always) return held_by;
  const bool is_early = row.brakes_together || acting_row == row.stop_row;
  if (is_early && moves_outward(row, is_upper)) return LimitCause::kBraking;
  const double sign = is_upper ? 1.0 : -1.0;
  const double bound = is_upper ? ddq.ub : -ddq.lb;
  const auto is_bound = [&](double value) {
    return std::abs(bound - value) <= 1e-9 * (1.0 + std::abs(bound));
  };
  const double onset = std::max(row.options.tau_onset, dt);
  if (is_bound((row.limits.dq_max - sign * row.dq) / onset)) return LimitCause::kVelocity;
  if (is_bound(row.limits.ddq_max)) return LimitCause::kAcceleration;
  return held_by == LimitCause::kNone ? LimitCause::kPosition : held_by;
}

}  // namespace

Reactions::Reactions(const DeviceModel& device, const TwinModel& twin, int stops)
    : n_m_(device.n_m),
      n_a_(twin.chain.nv()),
      device_limits_(device.limit_count()),
      count_(device_limits_ + n_a_ + stops),
      columns_(n_a_, count_),
      stop_torque_(n_a_, stops),
      rest_(VectorA::Zero(n_a_)),
      directions_(device, twin),
      problem_(capacity_for(count_, n_a_)),
      solver_(problem_.capacity()),
      solution_(problem_.capacity()) {}

// torque of a unit reaction on the twin
VectorA Reactions::torque(int limit) const noexcept {
  if (limit < device_limits_) return directions_.torque(limit);
  const int dof = limit - device_limits_;
  return dof < n_a_ ? VectorA(VectorA::Unit(n_a_, dof)) : VectorA(stop_torque_.col(dof - n_a_));
}

VectorA Reactions::torque_of_device() const noexcept {
  VectorA sum = VectorA::Zero(n_a_);
  for (const int limit : active()) {
    if (limit < device_limits_) sum += torque(limit) * of(limit);
  }
  return sum;
}

void Reactions::find_active(const Tasks& tasks, const hqp::Solution& solution) noexcept {
  active_count_ = 0;
  for (int i = 0; i < stop_torque_.cols(); ++i) {
    const int row = tasks.limit_rows()[device_limits_ + n_a_ + i].row;
    stop_torque_.col(i) =
        Eigen::Map<const Eigen::VectorXd>(tasks.problem().coefficients(row).data(), n_m_ + n_a_)
            .tail(n_a_);
  }
  for (int limit = 0; limit < count_; ++limit) {
    const bool acts = solution.state[tasks.acting_row(limit, solution)] != hqp::RowState::kInactive;
    if (acts || of(limit) != 0.0) active_[active_count_++] = limit;
  }
  for (const int limit : active()) {
    if (limit >= device_limits_) break;
    directions_.find(tasks.problem(), tasks.acting_row(limit, solution), limit);
  }
}

void Reactions::split(const Tasks& tasks, const hqp::Solution& solution,
                      const VectorA& tau_constraint) noexcept {
  value_.fill(0.0);
  rest_.setZero();
  const bool is_paper = tasks.alpha(0) >= 0;
  for (int limit = 0; is_paper && limit < device_limits_ + n_a_; ++limit) {
    value_[limit] = solution.x[tasks.alpha(limit)];
  }
  find_active(tasks, solution);
  if (!is_paper && active_count_ > 0) split_active(tasks, solution, tau_constraint);
  if (!is_paper && solution.status == hqp::Status::kSolved) return;
  rest_ = tau_constraint;
  for (const int limit : active()) rest_ -= torque(limit) * of(limit);
}

void Reactions::split_active(const Tasks& tasks, const hqp::Solution& solution,
                             const VectorA& tau_constraint) noexcept {
  problem_.clear(active_count_);
  add_signs(tasks, solution);
  add_sum(tau_constraint);
  problem_.add_level();
  for (int j = 0; j < active_count_; ++j) {
    const int row = tasks.acting_row(active_[j], solution);
    if (hqp::is_violated(solution.state[row])) problem_.add_bound(j, {0.0, 0.0});
  }
  std::fill_n(active_set_.state.begin(), problem_.rows(), hqp::RowState::kInactive);
  std::fill_n(active_set_.before.begin(), problem_.rows(), hqp::RowState::kInactive);
  solver_.solve(problem_, {}, active_set_, solution_);
  for (std::size_t j = 0; j < active().size(); ++j) {
    value_[active_[j]] = solution_.x[j] * scale_[j];
  }
}

void Reactions::add_signs(const Tasks& tasks, const hqp::Solution& solution) noexcept {
  const auto state_of = [&](int limit) {
    return solution.state[tasks.acting_row(limit, solution)];
  };
  // a row above one that could not be met may be held for that row's sake, against its own sign
  int last_violated = -1;
  for (const int limit : active()) {
    if (hqp::is_violated(state_of(limit))) last_violated = limit;
  }
  problem_.add_level();
  for (int j = 0; j < active_count_; ++j) {
    const int limit = active_[j];
    scale_[j] = 1.0 / tasks.limit_rows()[limit].rating;
    const hqp::RowState state = state_of(limit);
    const bool has_sign = limit > last_violated;
    Interval sign;
    if (has_sign && state == hqp::RowState::kLower) sign.lb = 0.0;
    if (has_sign && state == hqp::RowState::kUpper) sign.ub = 0.0;
    problem_.add_bound(j, sign);
  }
}

// no push against idle motion of the manipulator, and the torques on the twin add up
void Reactions::add_sum(const VectorA& tau_constraint) noexcept {
  std::array<double, kMaxReactions> row{};
  const auto coefficients = std::span<const double>(row).first(active().size());
  problem_.add_level();
  if (n_m_ > 6) {
    for (std::size_t j = 0; j < coefficients.size(); ++j) {
      row[j] = active_[j] < device_limits_ ? directions_.idle(active_[j]) * scale_[j] : 0.0;
    }
    problem_.add_row(coefficients, {0.0, 0.0});
  }
  problem_.add_level();
  double largest = 0.0;
  for (int j = 0; j < active_count_; ++j) {
    columns_.col(j) = torque(active_[j]) * scale_[j];
    largest = std::max(largest, columns_.col(j).cwiseAbs().maxCoeff());
  }
  for (int i = 0; i < n_a_; ++i) {
    double largest_in_row = 0.0;
    for (std::size_t j = 0; j < coefficients.size(); ++j) {
      row[j] = columns_(i, static_cast<Eigen::Index>(j));
      largest_in_row = std::max(largest_in_row, std::abs(row[j]));
    }
    // near singular postures, the residual of a joint that no limit reaches must not decide
    if (largest_in_row < kReach * largest) row.fill(0.0);
    problem_.add_row(coefficients, {tau_constraint[i], tau_constraint[i]});
  }
}

namespace {

// Distance outside its range that a quantity reaches within kLookAhead, if it keeps missing its
// bound `ddq` by as much: at the end, or where it turns before. 0 for one that meets its bound.
double passing(const LimitRow& row, const Interval& ddq, hqp::RowState state,
               double slack) noexcept {
  if (!hqp::is_violated(state) || row.is_motor) return 0.0;
  const bool is_upper = state == hqp::RowState::kAbove;
  const double outside = is_upper ? row.q - row.range.ub : row.range.lb - row.q;
  const double speed = is_upper ? row.dq : -row.dq;
  const double a = (is_upper ? ddq.ub : -ddq.lb) + std::abs(slack);
  if (!(speed > 0.0)) return 0.0;
  const double time = a < 0.0 ? std::min(kLookAhead, -speed / a) : kLookAhead;
  const double reached = outside + speed * time + 0.5 * a * time * time;
  return std::isfinite(reached) ? std::max(0.0, reached) : 0.0;
}

}  // namespace

void Reactions::report(const Tasks& tasks, const hqp::Solution& solution, const Felt& felt,
                       LawResult& result) const noexcept {
  const auto& rows = tasks.limit_rows();
  result.limit_count = device_limits_ + n_a_;
  for (int limit = 0; limit < result.limit_count; ++limit) {
    const int acting_row = tasks.acting_row(limit, solution);
    const bool is_first = acting_row == rows[limit].row;
    const Interval ddq = is_first ? rows[limit].ddq : tasks.problem().bounds(acting_row);
    LimitReport& report = result.limits[limit];
    report.state = limit_state(solution.state[acting_row], value_[limit]);
    report.cause = acting_row == rows[limit].holding_row
                       ? LimitCause::kWeight
                       : cause_of(rows[limit], acting_row, ddq, solution.state[acting_row],
                                  value_[limit], felt.dt);
    report.position = rows[limit].q;
    report.to_lower = rows[limit].q - rows[limit].limits.q_min;
    report.to_upper = rows[limit].limits.q_max - rows[limit].q;
    report.excess =
        std::max({0.0, rows[limit].q - rows[limit].range.ub, rows[limit].range.lb - rows[limit].q});
    report.slack = solution.slack[acting_row];
    result.passing[limit] = passing(rows[limit], ddq, solution.state[acting_row], report.slack);
    report.reaction = value_[limit];
  }
  report_felt(felt.L, result);
  result.budget.structure = bearing_wrench(felt.J_a, felt.w);
}

// The limit felt most takes most of the acceleration, in the metric of M_a, that the user's wrench
// demands; a stop that only carries a spring is not felt.
void Reactions::report_felt(const MatrixA& L, LawResult& result) const noexcept {
  Budget& budget = result.budget;
  budget.limits = VectorA::Zero(n_a_);
  budget.conflict = -rest_;
  result.felt_limit = -1;
  result.w_felt.setZero();
  const auto factor = L.triangularView<Eigen::Lower>();
  VectorA pushed = result.tau_a;
  factor.solveInPlace(pushed);
  double most = kFeltMin * kFeltMin;
  for (const int limit : active()) {
    const double value = of(limit);
    VectorA tau = torque(limit) * value;
    if (limit >= result.limit_count) {
      budget.surface -= tau;
      continue;
    }
    if (result.limits[limit].state == LimitState::kViolated) {
      budget.conflict -= tau;
    } else {
      budget.limits -= tau;
    }
    factor.solveInPlace(tau);
    const double opposed = -tau.dot(pushed);
    if (opposed > most) {
      most = opposed;
      result.felt_limit = limit;
      result.w_felt.setZero();
      if (limit < device_limits_) result.w_felt = directions_.wrench(limit) * value;
    }
  }
}

}  // namespace hg::rendering
