#include "hg/rendering/reactions.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

// below this acceleration-energy norm a limit is not said to be felt, sqrt(J/s^2 kg) ~ 0.1 N on 1
// kg
constexpr double kFeltMin = 0.1;

hqp::Capacity capacity_for(int limits, int n_a) {
  return {.variables = limits, .levels = 3, .rows = 2 * limits + n_a};
}

int limit_count(const DeviceModel& device) {
  return device.n_m + static_cast<int>(device.virtual_joints.size()) +
         3 * static_cast<int>(device.cartesian_limits.size());
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

// which of the conditions behind recoverable_bounds gives the bound that acts
LimitCause cause_of(const LimitRow& row, hqp::RowState state, double reaction, double dt) noexcept {
  if (state == hqp::RowState::kInactive) return LimitCause::kNone;
  const bool is_upper = is_upper_side(state, reaction);
  const LimitCause held_by = is_upper ? row.held_by.upper : row.held_by.lower;
  const double sign = is_upper ? 1.0 : -1.0;
  const Interval ddq = limits::recoverable_bounds(row.limits, row.options, row.q, row.dq, dt);
  const double bound = is_upper ? ddq.ub : -ddq.lb;
  const auto is_bound = [&](double value) {
    return std::abs(bound - value) <= 1e-9 * (1.0 + std::abs(bound));
  };
  const bool holds_always = held_by == LimitCause::kLock || held_by == LimitCause::kFriction;
  if (holds_always) return held_by;
  if (is_bound((row.limits.dq_max - sign * row.dq) / dt)) return LimitCause::kVelocity;
  if (is_bound(row.limits.ddq_max)) return LimitCause::kAcceleration;
  return held_by == LimitCause::kNone ? LimitCause::kPosition : held_by;
}

}  // namespace

Reactions::Reactions(const DeviceModel& device, const TwinModel& twin)
    : n_m_(device.n_m),
      n_a_(twin.chain.nv()),
      device_limits_(limit_count(device)),
      direction_(n_a_, kMaxLimits),
      wrench_(6, kMaxLimits),
      problem_(capacity_for(device_limits_ + n_a_, n_a_)),
      solver_(problem_.capacity()),
      solution_(problem_.capacity()) {}

void Reactions::find_active(const DeviceModel& device, const TwinModel& twin, const Tasks& tasks,
                            const hqp::Solution& solution) noexcept {
  active_count_ = 0;
  for (int limit = 0; limit < device_limits_ + n_a_; ++limit) {
    const auto row = static_cast<std::size_t>(tasks.first_limit_row() + limit);
    if (solution.state[row] == hqp::RowState::kInactive) continue;
    active_[static_cast<std::size_t>(active_count_++)] = limit;
  }
  if (active_count_ == 0) return;

  // [HG] (21), (24): a device row C ddq_m pushes the handle with y, J_m^T y = C^T
  const model::Jacobian J = device.chain.jacobian(device.handle);
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxManipulator, 6>>
      J_m_T(J.middleCols(device.n_p, n_m_).transpose());
  const model::Jacobian J_a = twin.chain.jacobian(twin.end_effector);
  for (int j = 0; j < active_count_; ++j) {
    const int limit = active_[static_cast<std::size_t>(j)];
    if (limit >= device_limits_) {
      wrench_.col(j).setZero();
      direction_.col(j).setZero();
      direction_(limit - device_limits_, j) = 1.0;
      continue;
    }
    VectorM C = VectorM::Zero(n_m_);
    if (limit < n_m_) {
      C[limit] = 1.0;
    } else {
      const auto row = tasks.problem().coefficients(tasks.first_limit_row() + limit);
      C = Eigen::Map<const Eigen::VectorXd>(row.data(), n_m_);
    }
    const Vector6 y = J_m_T.solve(C);
    wrench_.col(j) = y;
    direction_.col(j).noalias() = J_a.transpose() * y;
  }
}

void Reactions::split(const DeviceModel& device, const TwinModel& twin, const Tasks& tasks,
                      const hqp::Solution& solution, const VectorA& tau_constraint) noexcept {
  value_.fill(0.0);
  find_active(device, twin, tasks, solution);
  if (active_count_ == 0) return;

  // a row above one that could not be met may be held for that row's sake, against its own sign
  const auto state_of = [&](int limit) {
    return solution.state[static_cast<std::size_t>(tasks.first_limit_row() + limit)];
  };
  int last_violated = -1;
  for (int j = 0; j < active_count_; ++j) {
    const int limit = active_[static_cast<std::size_t>(j)];
    if (hqp::is_violated(state_of(limit))) last_violated = limit;
  }

  const auto& rows = tasks.limit_rows();
  std::array<double, kMaxLimits> scale{};
  problem_.clear(active_count_);
  problem_.add_level();
  for (int j = 0; j < active_count_; ++j) {
    const auto limit = static_cast<std::size_t>(active_[static_cast<std::size_t>(j)]);
    scale[static_cast<std::size_t>(j)] = 1.0 / rows[limit].rating;
    const hqp::RowState state = state_of(static_cast<int>(limit));
    const bool has_sign = static_cast<int>(limit) > last_violated;
    Interval sign;
    if (has_sign && state == hqp::RowState::kLower) sign.lb = 0.0;
    if (has_sign && state == hqp::RowState::kUpper) sign.ub = 0.0;
    problem_.add_bound(j, sign);
  }
  problem_.add_level();
  std::array<double, kMaxLimits> row{};
  for (int i = 0; i < n_a_; ++i) {
    for (int j = 0; j < active_count_; ++j) {
      row[static_cast<std::size_t>(j)] = direction_(i, j) * scale[static_cast<std::size_t>(j)];
    }
    problem_.add_row({row.data(), static_cast<std::size_t>(active_count_)},
                     {tau_constraint[i], tau_constraint[i]});
  }
  problem_.add_level();
  for (int j = 0; j < active_count_; ++j) {
    const auto limit = static_cast<std::size_t>(active_[static_cast<std::size_t>(j)]);
    const auto state = solution.state[static_cast<std::size_t>(tasks.first_limit_row()) + limit];
    if (hqp::is_violated(state)) problem_.add_bound(j, {0.0, 0.0});
  }
  active_set_ = {};
  solver_.solve(problem_, {}, active_set_, solution_);
  for (int j = 0; j < active_count_; ++j) {
    value_[static_cast<std::size_t>(active_[static_cast<std::size_t>(j)])] =
        solution_.x[static_cast<std::size_t>(j)] * scale[static_cast<std::size_t>(j)];
  }
}

void Reactions::report(const TwinModel& twin, const Tasks& tasks, const hqp::Solution& solution,
                       double dt, CycleRecord& record) const noexcept {
  const auto& rows = tasks.limit_rows();
  record.limit_count = device_limits_ + n_a_;
  for (int limit = 0; limit < record.limit_count; ++limit) {
    const auto i = static_cast<std::size_t>(limit);
    const std::size_t row = static_cast<std::size_t>(tasks.first_limit_row()) + i;
    LimitReport& report = record.limits[i];
    report.state = limit_state(solution.state[row], value_[i]);
    report.cause = cause_of(rows[i], solution.state[row], value_[i], dt);
    report.position = rows[i].q;
    report.to_lower = rows[i].q - rows[i].limits.q_min;
    report.to_upper = rows[i].limits.q_max - rows[i].q;
    report.excess = std::max({0.0, rows[i].q - rows[i].range.ub, rows[i].range.lb - rows[i].q});
    report.slack = solution.slack[row];
    report.reaction = value_[i];
  }

  // what is felt most: the limit that takes most of the acceleration, in the metric of M_a, which
  // the user's wrench asks for; a stop that only carries a spring is not felt
  Budget& budget = record.budget;
  budget.limits = VectorA::Zero(n_a_);
  budget.conflict = VectorA::Zero(n_a_);
  record.felt_limit = -1;
  record.w_felt.setZero();
  const auto L = tasks.L().triangularView<Eigen::Lower>();
  VectorA pushed = record.tau_a;
  L.solveInPlace(pushed);
  double most = kFeltMin * kFeltMin;
  for (int j = 0; j < active_count_; ++j) {
    const auto limit = static_cast<std::size_t>(active_[static_cast<std::size_t>(j)]);
    VectorA tau = direction_.col(j) * value_[limit];
    if (record.limits[limit].state == LimitState::kViolated) {
      budget.conflict -= tau;
    } else {
      budget.limits -= tau;
    }
    L.solveInPlace(tau);
    const double opposed = -tau.dot(pushed);
    if (opposed > most) {
      most = opposed;
      record.felt_limit = static_cast<int>(limit);
      record.w_felt = wrench_.col(j) * value_[limit];
    }
  }

  // part of the wrench that moves no joint of the twin
  const model::Jacobian J_a = twin.chain.jacobian(twin.end_effector);
  const Eigen::ColPivHouseholderQR<model::Jacobian> J_a_qr(J_a);
  Vector6 moving = J_a_qr.householderQ().adjoint() * record.robot.w_H;
  moving.tail(6 - J_a_qr.rank()).setZero();
  budget.structure = record.robot.w_H - J_a_qr.householderQ() * moving;
}

}  // namespace hg::rendering
