#include "hg/rendering/tasks.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hg/core/rotation.h"

namespace hg::rendering {
namespace {

hqp::Capacity capacity_of(const DeviceModel& device, const TwinModel& twin) {
  const int n_a = twin.chain.nv();
  const int frames = static_cast<int>(device.cartesian_limits.size());
  const int virtual_joints = static_cast<int>(device.virtual_joints.size());
  return {.variables = device.n_m + n_a,
          .levels = 5 + frames,
          .rows = 6 + device.n_m + virtual_joints + 3 * frames + 2 * n_a};
}

LimitRow make_row(const limits::JointLimits& limits, double margin, double dt) {
  LimitRow row;
  row.range = {limits.q_min, limits.q_max};
  row.limits = limits;
  row.limits.q_min += margin;
  row.limits.q_max -= margin;
  row.options = limits::recoverable_options(limits, dt, dt);
  row.rating = std::isfinite(limits.ddq_max) ? limits.ddq_max : 1.0;
  return row;
}

}  // namespace

Tasks::Tasks(const DeviceModel& device, const TwinModel& twin, const Options& options)
    : options_(options),
      n_m_(device.n_m),
      n_a_(twin.chain.nv()),
      problem_(capacity_of(device, twin)),
      coefficients_(static_cast<std::size_t>(n_m_ + n_a_), 0.0),
      L_(n_a_, n_a_) {
  problem_.clear(n_m_ + n_a_);
  const auto add_limit = [&](const limits::JointLimits& limits, int variable, double margin) {
    limit_rows_.push_back(make_row(limits, margin, options.dt));
    const double weight = 1.0 / limit_rows_.back().rating;
    if (variable >= 0) {
      problem_.add_bound(variable, {}, weight);
    } else {
      problem_.add_row(coefficients_, {}, weight);
    }
  };

  problem_.add_level();
  for (int i = 0; i < 6; ++i) problem_.add_row(coefficients_, {});
  problem_.add_level();
  for (int i = 0; i < n_m_; ++i) {
    add_limit(device.joint_limits[static_cast<std::size_t>(i)], i, 0.0);
  }
  problem_.add_level();
  for (const VirtualJoint& joint : device.virtual_joints) add_limit(joint.limits, -1, 0.0);
  for (const CartesianLimit& frame : device.cartesian_limits) {
    problem_.add_level();
    for (const auto& axis : frame.axes) add_limit(axis, -1, frame.margin);
  }
  problem_.add_level();
  for (int i = 0; i < n_a_; ++i) {
    add_limit(twin.dofs[static_cast<std::size_t>(i)].limits, n_m_ + i, 0.0);
  }
  problem_.add_level();
  for (int i = 0; i < n_a_; ++i) problem_.add_row(coefficients_, {});
}

void Tasks::fill(const DeviceModel& device, const TwinModel& twin,
                 const TaskInput& input) noexcept {
  fill_coupling(device, twin, input);
  fill_device_limits(device, input);
  fill_twin_limits(twin, input);
  fill_dynamics(twin, input);
}

// [HG] (12) with (11): J_m ddq_m - J_a ddq_a = s - J_p ddq_p - dJ dq + dJ_a dq_a
void Tasks::fill_coupling(const DeviceModel& device, const TwinModel& twin,
                          const TaskInput& input) noexcept {
  const Pose T_B_H = device.chain.pose(device.handle);
  const Pose T_B_E = twin.chain.pose(twin.end_effector);
  const Vector6 velocity_error =
      twin.chain.twist(twin.end_effector) - device.chain.twist(device.handle);
  s_.head<3>() =
      options_.kP_tran * (T_B_E.p - T_B_H.p) + options_.kD_tran * velocity_error.head<3>();
  s_.tail<3>() = options_.kP_rot * rotation_between(T_B_H.R, T_B_E.R) +
                 options_.kD_rot * velocity_error.tail<3>();

  const model::Jacobian J = device.chain.jacobian(device.handle);
  const model::Jacobian J_a = twin.chain.jacobian(twin.end_effector);
  const Vector6 known = s_ - J.leftCols(device.n_p) * input.robot.ddq_p -
                        device.chain.bias_acceleration(device.handle) +
                        twin.chain.bias_acceleration(twin.end_effector);
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), n_m_ + n_a_);
  for (int i = 0; i < 6; ++i) {
    row.head(n_m_) = J.row(i).segment(device.n_p, n_m_);
    row.tail(n_a_) = -J_a.row(i);
    problem_.set_row(i, coefficients_);
    problem_.set_bounds(i, {known[i], known[i]});
  }
}

void Tasks::set_limit(int limit, const limits::JointLimits& limits, double q, double dq,
                      double known_acceleration) noexcept {
  LimitRow& row = limit_rows_[static_cast<std::size_t>(limit)];
  row.limits = limits;
  row.q = q;
  row.dq = dq;
  const Interval ddq = limits::recoverable_bounds(limits, row.options, q, dq, options_.dt);
  problem_.set_bounds(first_limit_row() + limit,
                      {ddq.lb - known_acceleration, ddq.ub - known_acceleration});
}

void Tasks::fill_device_limits(const DeviceModel& device, const TaskInput& input) noexcept {
  const ReferenceState& reference = input.reference;
  int limit = 0;
  for (; limit < n_m_; ++limit) {
    set_limit(limit, limit_rows_[static_cast<std::size_t>(limit)].limits, reference.q_m[limit],
              reference.dq_m[limit], 0.0);
  }

  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), n_m_ + n_a_);
  row.setZero();
  for (const VirtualJoint& joint : device.virtual_joints) {
    row.head(n_m_) = joint.weights;
    problem_.set_row(first_limit_row() + limit, coefficients_);
    set_limit(limit, joint.limits, joint.weights.dot(reference.q_m),
              joint.weights.dot(reference.dq_m), 0.0);
    ++limit;
  }

  // [HG] (15)-(16)
  for (const CartesianLimit& frame : device.cartesian_limits) {
    const model::Jacobian J = device.chain.jacobian(frame.frame);
    const Vector6 known =
        J.leftCols(device.n_p) * input.robot.ddq_p + device.chain.bias_acceleration(frame.frame);
    const Eigen::Vector3d position = device.chain.pose(frame.frame).p;
    const Vector6 twist = device.chain.twist(frame.frame);
    for (int axis = 0; axis < 3; ++axis) {
      row.head(n_m_) = J.row(axis).segment(device.n_p, n_m_);
      problem_.set_row(first_limit_row() + limit, coefficients_);
      set_limit(limit, limit_rows_[static_cast<std::size_t>(limit)].limits, position[axis],
                twist[axis], known[axis]);
      ++limit;
    }
  }
}

void Tasks::fill_twin_limits(const TwinModel& twin, const TaskInput& input) noexcept {
  const int first = static_cast<int>(limit_rows_.size()) - n_a_;
  for (int i = 0; i < n_a_; ++i) {
    const TwinDof& dof = twin.dofs[static_cast<std::size_t>(i)];
    const EffectiveLimits effective = effective_limits(twin, i, input.inner);
    const double q = dof.q_index >= 0 ? input.twin.q_a[dof.q_index] : 0.0;
    const double dq = input.twin.dq_a[i];
    LimitRow& row = limit_rows_[static_cast<std::size_t>(first + i)];
    row.held_by = effective.held_by;
    set_limit(first + i, effective.limits, q, dq, 0.0);

    // stick: the joint stands still at the end of the sample, as far as its limits allow
    if (input.inner.sticks[static_cast<std::size_t>(i)] && row.held_by.upper != LimitCause::kLock) {
      const Interval bounds = problem_.bounds(first_limit_row() + first + i);
      const double ddq_stop = std::clamp(-dq / options_.dt, bounds.lb, bounds.ub);
      problem_.set_bounds(first_limit_row() + first + i, {ddq_stop, ddq_stop});
      row.held_by = {LimitCause::kFriction, LimitCause::kFriction};
    }
  }
}

// Gauss: minimise |L^T ddq_a - L^-1 (tau - c)|^2 = (ddq_a - ddq_free)^T M (ddq_a - ddq_free)
void Tasks::fill_dynamics(const TwinModel& twin, const TaskInput& input) noexcept {
  L_ = twin.chain.M();
  Eigen::LLT<Eigen::Ref<MatrixUpTo<kMaxTwin, kMaxTwin>>> cholesky(L_);
  VectorA b = input.tau - twin.chain.c();
  L_.triangularView<Eigen::Lower>().solveInPlace(b);

  const int first = problem_.rows() - n_a_;
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), n_m_ + n_a_);
  row.setZero();
  for (int i = 0; i < n_a_; ++i) {
    row.segment(n_m_, i).setZero();
    row.segment(n_m_ + i, n_a_ - i) = L_.col(i).tail(n_a_ - i);
    problem_.set_row(first + i, coefficients_);
    problem_.set_bounds(first + i, {b[i], b[i]});
  }
}

}  // namespace hg::rendering
