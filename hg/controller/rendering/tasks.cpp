#include "hg/controller/rendering/tasks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/controller/rendering/motor_torque.h"
#include "hg/core/rotation.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {
namespace {

// where the law models the torques of the motors:
constexpr double kTrackingMargin = 1e-3;  // rad or m, of a joint behind its reference
constexpr double kDriveMargin = 3e-3;     // the same of a drive that follows positions
constexpr double kBrakingOnset = 25e-3;   // s, of the device in front of its limits
constexpr double kReturn = 0.3;           // s, of the device from beyond them
constexpr double kReturnWithin = 1.0;     // s, of a joint that is within, but too near to its end
constexpr double kJumped = 1.5;           // times the speed of a motor without load
constexpr double kTwinBrakingOnset = 10e-3;  // s, of the twin in front of its own

constexpr double kApartMargin = 3e-3;  // m, of shapes beyond the distance at which a stop begins

int led_axes(const DeviceModel& device, const RenderingOptions& options) noexcept {
  return leads_gantry(device, options) ? device.n_p : 0;
}

hqp::Capacity capacity_of(const DeviceModel& device, const TwinModel& twin,
                          const RenderingOptions& options, int stops) {
  const int n_m = device.n_m, n_a = twin.chain.nv();
  const int limits = device.limit_count() + n_a + stops;
  const int frames = static_cast<int>(device.cartesian_limits.size());
  hqp::Capacity capacity{.variables = n_m + n_a, .levels = 6 + frames, .rows = 6 + limits + n_a};
  if (options.bounds == Bounds::kPaper) {
    capacity.levels += 2;
    capacity.rows += n_m + n_a;
  }
  if (options.law == Law::kPaper) {
    capacity.variables += limits;
    capacity.levels += 3;
    capacity.rows += 2 * limits;
  } else {
    capacity.levels += 2;
    capacity.rows += 2 * n_m;
  }
  if (brakes_together(device, options)) {
    capacity.levels += 2;
    capacity.rows += n_m + 3 * frames;
  }
  if (const int led = led_axes(device, options); led > 0) {
    capacity.variables += led;
    capacity.levels += 2;
    capacity.rows += 2 * led;
  }
  return capacity;
}

// 0.2 rad, or where the range is small a tenth of it, away from the ends of joint `i` and of its
// speed; a goal of the device beyond that is within.
limits::JointLimits inner_range(const DeviceModel& device, int i) {
  constexpr double kMargin = 0.2, kShare = 0.1;  // rad or m; of the range
  constexpr double kSpeed = 0.8, kGentle = 0.5;  // of the joint's own
  limits::JointLimits limits = device.joint_limits[i];
  const double margin = std::min(kMargin, kShare * (limits.q_max - limits.q_min));
  limits.q_min += margin;
  limits.q_max -= margin;
  if (device.posture.size() > 0 && std::isfinite(device.posture[i])) {
    limits.q_min = std::min(limits.q_min, device.posture[i]);
    limits.q_max = std::max(limits.q_max, device.posture[i]);
  }
  limits.dq_max *= kSpeed;
  limits.ddq_max *= kGentle;
  return limits;
}

// Soft and late enough to be no jerk: an inner range may be left.
limits::RecoverableOptions inner_options(const limits::JointLimits& inner, double dt) {
  constexpr double kSoft = 0.1;  // s
  limits::RecoverableOptions options = limits::recoverable_options(inner, dt, dt);
  options.tau = options.tau_rec = options.tau_onset = std::max(kSoft, options.tau);
  options.is_capped = false;
  return options;
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

// Constant accelerations with which a joint is within its ends `time` s from now; holds 0.
Interval lasting_room(const LimitRow& row, double time) noexcept {
  const double drift = row.q + row.dq * time, share = 2.0 / (time * time);
  return {std::min(share * (row.limits.q_min - drift), 0.0),
          std::max(share * (row.limits.q_max - drift), 0.0)};
}

// Bounds `ddq` of a motor's row, narrowed so that it can stop in time what moves with `speed`,
// where it has the accelerations `lasting`.
Interval stoppable(Interval ddq, const Interval& lasting, double speed) noexcept {
  constexpr double kLongest = 0.3;  // s, of a stop
  constexpr double kRate = 20.0;    // 1/s
  constexpr double kFirm = 0.8;     // of what brakes
  if (speed > 0.0) {
    const double braking = std::max(-lasting.lb, 0.0);
    const double ub = std::max(kRate * (kLongest * braking - speed), -kFirm * braking);
    ddq.ub = std::max(std::min(ddq.ub, ub), ddq.lb);
  } else if (speed < 0.0) {
    const double braking = std::max(lasting.ub, 0.0);
    const double lb = std::min(kRate * (-kLongest * braking - speed), kFirm * braking);
    ddq.lb = std::min(std::max(ddq.lb, lb), ddq.ub);
  }
  return ddq;
}

// Accelerations of the manipulator's joints that move the handle as the twin without its limits.
// `coupling`: right side of [HG] (12).
VectorM free_motion(const DeviceModel& device, const TaskInput& input,
                    const Vector6& coupling) noexcept {
  constexpr double kDamping = 1e-6;  // m^2, for singular postures
  VectorA ddq_a = input.tau - input.twin_chain.c();
  input.L.triangularView<Eigen::Lower>().solveInPlace(ddq_a);
  input.L.transpose().triangularView<Eigen::Upper>().solveInPlace(ddq_a);
  const auto J = input.J_H.middleCols(device.n_p, device.n_m);
  const Vector6 a = coupling + input.J_a.lazyProduct(ddq_a);
  Eigen::Matrix<double, 6, 6> JJ = J.lazyProduct(J.transpose());
  JJ.diagonal().array() += kDamping;
  const Vector6 f = JJ.llt().solve(a);
  return J.transpose().lazyProduct(f);
}

// Deceleration of a joint in a stop: with `rate`, but no more than lets all joints brake on one
// line in the time `line` (s), with a gantry no more than a share of its rating, either; without
// such a line, of a stretched arm, a smaller share.
double deceleration_in_stop(double speed, double ddq_max, double rate, double line,
                            int n_p) noexcept {
  constexpr double kShare = 0.6, kWithoutLine = 0.3;
  const double most = std::min(rate * speed, line > 0.0 ? speed / line : kWithoutLine * ddq_max);
  return n_p > 0 ? std::min(most, kShare * ddq_max) : most;
}

// Torque up to which the torque of `motor` builds up fast, Nm or N. All of it where the twin is
// braked (stops, contacts of the arm, a tool that nothing touches), among virtual surfaces, which a
// light body would enter too far, and without a gantry, where arms hold their weight and stop on
// their line by heavy torques.
double light_torque(const DeviceModel& device, const ActuatorModel& motor,
                    const TaskInput& input) noexcept {
  const bool is_fast = device.n_p == 0 || input.is_braked || input.has_surfaces;
  return (is_fast ? 1.0 : kLightShare) * motor.torque_max;
}

}  // namespace

double stop_rating(const DeviceModel& device) {
  double rating = kInfinity;
  for (const limits::JointLimits& axis : handle_limits(device)) {
    rating = std::min(rating, axis.ddq_max);
  }
  return rating;
}

bool leads_gantry(const DeviceModel& device, const RenderingOptions& options) noexcept {
  return options.gantry == Gantry::kLaw && options.law == Law::kGauss && device.n_p > 0;
}

bool brakes_together(const DeviceModel& device, const RenderingOptions& options) noexcept {
  return options.braking == Braking::kTogether && options.law == Law::kGauss &&
         options.bounds == Bounds::kRecoverable && !device.motors().empty();
}

Tasks::Tasks(const DeviceModel& device, const TwinModel& twin, const RenderingOptions& options,
             int stops)
    : options_(options),
      dt_(device.dt()),
      n_m_(device.n_m),
      n_a_(twin.chain.nv()),
      n_g_(led_axes(device, options)),
      stop_count_(stops),
      has_torques_(!device.motors().empty()),
      first_motor_(n_m_ + static_cast<int>(device.virtual_joints.size())),
      problem_(capacity_of(device, twin, options, stop_count_)),
      coefficients_(problem_.capacity().variables, 0.0) {
  if (options.law == Law::kPaper) paper_.emplace(device, twin);
  if (brakes_together(device, options)) {
    holding_.emplace(device);
    stop_path_.emplace(device);
  }
  problem_.clear(problem_.capacity().variables);
  add_levels(device, twin);
}

void Tasks::add_levels(const DeviceModel& device, const TwinModel& twin) {
  if (n_g_ > 0) {
    problem_.add_level();
    for (int i = 0; i < n_g_; ++i) problem_.add_bound(n_m_ + n_a_ + i, {});
  }
  problem_.add_level();
  coupling_row_ = problem_.rows();
  for (int i = 0; i < 6; ++i) problem_.add_row(coefficients_, {});
  add_device_limits(device);
  add_twin_limits(device, twin);
  limit_row_count_ = problem_.rows() - first_limit_row();
  if (brakes_together(device, options_)) {
    std::vector<int> rows;
    for (int i = 0; i < static_cast<int>(limit_rows_.size()) - stop_count_; ++i) {
      if (device.keeps_apart && i == device.limit_count() - 1) continue;
      braking_.push_back(i);
      rows.push_back(limit_rows_[i].row);
    }
    lasting_.resize(device.motors().size());
    joint_braking_.emplace(problem_, first_limit_row(), std::move(rows), first_motor_, n_m_);
    approaches_.resize(braking_.size());
    joint_room_.resize(first_motor_);
  }
  if (paper_) {
    paper_->add_levels(problem_);
  } else {
    add_gauss(device);
  }
}

void Tasks::add_device_limits(const DeviceModel& device) {
  const double behind = device.follows_positions ? kDriveMargin : kTrackingMargin;
  const double margin = has_torques_ ? behind : 0.0;
  problem_.add_level();
  for (int i = 0; i < n_m_; ++i) {
    add_limit(device.joint_limits[i], i, margin);
  }
  problem_.add_level();
  for (const VirtualJoint& joint : device.virtual_joints) {
    add_limit(joint.limits, -1, margin * joint.weights.lpNorm<1>());
  }
  if (has_torques_) {
    problem_.add_level();
    for (int i = 0; i < n_m_; ++i) {
      add_limit({.ddq_max = device.joint_limits[i].ddq_max}, -1, 0.0);
      limit_rows_.back().is_motor = true;
    }
  }
  if (holding_) {
    problem_.add_level();
    for (int i = 0; i < n_m_; ++i) {
      LimitRow& motor = limit_rows_[first_motor_ + i];
      motor.holding_row = problem_.add_row(coefficients_, {}, weight_of(motor));
    }
  }
  for (const CartesianLimit& frame : device.cartesian_limits) {
    problem_.add_level();
    for (const auto& axis : frame.axes) add_limit(axis, -1, frame.margin);
  }
  const bool stops_inside = stop_path_ && device.n_p == 0;
  if (stops_inside) problem_.add_level();
  for (std::size_t i = first_motor_ + n_m_; stops_inside && i < limit_rows_.size(); ++i) {
    limit_rows_[i].stop_row = problem_.add_row(coefficients_, {}, weight_of(limit_rows_[i]));
  }
  if (device.keeps_apart) {
    constexpr double kRating = 10.0;  // m/s^2; scales the row
    if (!stops_inside) problem_.add_level();
    add_limit({.q_min = kApartMargin, .ddq_max = kRating}, -1, 0.0);
    limit_rows_.back().range = {};  // what is foreseen is not left
  }
  if (has_torques_) {
    for (LimitRow& row : limit_rows_) {
      row.options.is_capped = device.has_rated_accelerations();
      row.options.tau_onset = kBrakingOnset;
      row.options.tau_rec = kReturn;
    }
  }
}

void Tasks::add_twin_limits(const DeviceModel& device, const TwinModel& twin) {
  problem_.add_level();
  for (int i = 0; i < n_a_; ++i) {
    add_limit(twin.dofs[i].limits, n_m_ + i, 0.0);
  }
  for (int i = 0; i < stop_count_; ++i) {
    add_limit({.q_min = 0.0, .ddq_max = stop_rating(device)}, -1, 0.0);
    if (has_torques_) limit_rows_.back().options.tau_onset = kTwinBrakingOnset;
    limit_rows_.back().options.is_capped = false;
  }
  if (options_.bounds == Bounds::kPaper) {
    problem_.add_level();
    for (int i = 0; i < n_m_; ++i) add_rating(i, i);
    problem_.add_level();
    for (int i = 0; i < n_a_; ++i) add_rating(device.limit_count() + i, n_m_ + i);
  }
}

// Gauss' principle, the gantry, and what a joint to spare leaves free.
void Tasks::add_gauss(const DeviceModel& device) {
  problem_.add_level();
  dynamics_row_ = problem_.rows();
  for (int i = 0; i < n_a_; ++i) problem_.add_row(coefficients_, {});
  if (n_g_ > 0) problem_.add_level();
  for (int i = 0; i < n_g_; ++i) problem_.add_bound(n_m_ + n_a_ + i, {});
  if (n_m_ > 6) add_posture(device);
}

// The motion that a joint to spare leaves free keeps all joints away from their ends, and follows
// its goals. What these rows ask for is below the twin, and no force. They share a level: a joint
// that the free motion hardly moves would take all of it, at any speed, if its row came first.
void Tasks::add_posture(const DeviceModel& device) {
  constexpr double kFirm = 5.0;  // beside the goals
  problem_.add_level();
  posture_row_ = problem_.rows();
  for (int i = 0; i < n_m_; ++i) {
    const limits::JointLimits inner = inner_range(device, i);
    inner_.push_back({inner, inner_options(inner, dt_)});
    problem_.add_bound(i, {}, kFirm);
  }
  for (int i = 0; i < n_m_; ++i) problem_.add_bound(i, {});
}

int Tasks::acting_row(int limit, const hqp::Solution& solution) const noexcept {
  const LimitRow& row = limit_rows_[limit];
  for (const int candidate : {row.row, row.rating_row, row.holding_row, row.stop_row}) {
    if (candidate >= 0 && solution.state[candidate] != hqp::RowState::kInactive) return candidate;
  }
  return row.row;
}

double Tasks::weight_of(const LimitRow& row) const noexcept {
  return options_.law == Law::kPaper ? 1.0 : 1.0 / row.rating;
}

void Tasks::add_limit(const limits::JointLimits& limits, int variable, double margin) {
  limit_rows_.push_back(make_row(limits, margin, dt_));
  limit_rows_.back().is_recoverable = options_.bounds == Bounds::kRecoverable;
  const double weight = weight_of(limit_rows_.back());
  limit_rows_.back().row = variable >= 0 ? problem_.add_bound(variable, {}, weight)
                                         : problem_.add_row(coefficients_, {}, weight);
}

void Tasks::add_rating(int limit, int variable) {
  LimitRow& row = limit_rows_[limit];
  row.rating_row = problem_.add_bound(variable, {}, weight_of(row));
}

void Tasks::fill(const DeviceModel& device, const TwinModel& twin,
                 const TaskInput& input) noexcept {
  ddq_p_ = input.robot.ddq_p;
  if (n_g_ > 0) fill_gantry(input);
  fill_coupling(device, twin, input);
  fill_device_limits(device, input);
  if (has_torques_) fill_motors(device, input);
  fill_twin_limits(twin, input);
  if (joint_braking_) brake_together();
  if (holding_) keep_holding(device, input);
  if (stop_path_) stop_inside(device, input);
  if (device.keeps_apart) keep_apart(device, input.collision);
  if (stop_count_ > 0) fill_stops(input);

  const VectorA tau = input.tau - input.twin_chain.c();
  if (paper_) {
    paper_->fill(input.L, tau, first_limit_row(), input.directions, problem_);
    fill_ranges(input);
  } else {
    fill_dynamics(input.L, tau);
    if (n_m_ > 6) fill_posture(device, input);
  }
}

// [HG] (12) with (11): J_m ddq_m - J_a ddq_a = s - J_p ddq_p - dJ dq + dJ_a dq_a
void Tasks::fill_coupling(const DeviceModel& device, const TwinModel& twin,
                          const TaskInput& input) noexcept {
  const model::ChainData &device_now = input.device_chain, &twin_now = input.twin_chain;
  const Pose& T_B_H = device_now.pose(device.handle);
  const Pose& T_B_E = twin_now.pose(twin.end_effector);
  const Vector6 velocity_error =
      twin_now.twist(twin.end_effector) - device_now.twist(device.handle);
  s_.head<3>() =
      options_.kP_tran * (T_B_E.p - T_B_H.p) + options_.kD_tran * velocity_error.head<3>();
  s_.tail<3>() = options_.kP_rot * rotation_between(T_B_H.R, T_B_E.R) +
                 options_.kD_rot * velocity_error.tail<3>();

  const model::Jacobian& J = input.J_H;
  const Vector6 known = s_ - J.leftCols(device.n_p).lazyProduct(ddq_p_) -
                        device_now.bias_acceleration(device.handle) +
                        twin_now.bias_acceleration(twin.end_effector);
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (int i = 0; i < 6; ++i) {
    row.head(n_m_) = J.row(i).segment(device.n_p, n_m_);
    row.segment(n_m_, n_a_) = -input.J_a.row(i);
    row.tail(n_g_) = J.row(i).head(n_g_);
    problem_.set_row(coupling_row_ + i, coefficients_);
    problem_.set_bounds(coupling_row_ + i, {known[i], known[i]});
  }
}

void Tasks::set_limit(int limit, const limits::JointLimits& limits, double q, double dq,
                      double known_acceleration) noexcept {
  LimitRow& row = limit_rows_[limit];
  row.limits = limits;
  row.q = q;
  row.dq = dq;
  row.known = known_acceleration;
  row.brakes_together = false;
  if (row.is_recoverable) {
    row.ddq = limits::recoverable_bounds(limits, row.options, q, dq, dt_);
    if (row.rating_row >= 0) problem_.set_bounds(row.rating_row, {});
  } else if (row.rating_row >= 0) {
    row.ddq = limits::bounds_A(limits, q, dq, dt_);
    problem_.set_bounds(row.rating_row, limits::bounds_B(limits, q, dq, dt_));
  } else {
    row.ddq = limits::bounds_C(limits, q, dq, options_.T_C);
  }
  problem_.set_bounds(limit_rows_[limit].row,
                      {row.ddq.lb - known_acceleration, row.ddq.ub - known_acceleration});
}

// a joint that is held by a lock or by friction
void Tasks::hold(int limit, double ddq) noexcept {
  LimitRow& row = limit_rows_[limit];
  row.ddq = {ddq, ddq};
  problem_.set_bounds(limit_rows_[limit].row, row.ddq);
  if (row.rating_row >= 0) problem_.set_bounds(row.rating_row, row.ddq);
}

void Tasks::fill_device_limits(const DeviceModel& device, const TaskInput& input) noexcept {
  const ReferenceState& reference = input.reference;
  double line = 0.0;
  if (stop_path_) line = device.n_p > 0 ? stop_path_->motor_time() : stop_path_->time();
  int limit = 0;
  for (; limit < n_m_; ++limit) {
    limits::JointLimits limits = limit_rows_[limit].limits;
    limits.dq_max = device.joint_limits[limit].dq_max;
    if (input.joint_braking_rate > 0.0) {
      constexpr double kAtRest = 1e-4;  // rad/s or m/s
      const double speed = std::abs(reference.dq_m[limit]);
      const double braking =
          deceleration_in_stop(speed, limits.ddq_max, input.joint_braking_rate, line, device.n_p);
      const double onward = std::copysign(1.0, reference.dq_m[limit]) * reference.ddq_m[limit];
      // an arm without gantry gets a rate that grows as the forces fade
      const double kept = device.n_p > 0 ? onward + braking : onward;
      const double ddq = input.kept_acceleration * std::max(0.0, kept) - braking;
      // speeds below the largest one are approached with the time constant of the onset
      const double onset = std::max(limit_rows_[limit].options.tau_onset, dt_);
      const double most = speed + (ddq > 0.0 ? onset : dt_) * ddq;
      limits.dq_max = std::min(limits.dq_max, std::max(most, kAtRest));
    }
    LimitRow& row = limit_rows_[limit];
    const bool is_within = row.range.contains(reference.q_m[limit]);
    if (has_torques_) row.options.tau_rec = is_within ? kReturnWithin : kReturn;
    set_limit(limit, limits, reference.q_m[limit], reference.dq_m[limit], 0.0);
  }

  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (const VirtualJoint& joint : device.virtual_joints) {
    row.head(n_m_) = joint.weights;
    problem_.set_row(limit_rows_[limit].row, coefficients_);
    set_limit(limit, limit_rows_[limit].limits, joint.weights.dot(reference.q_m),
              joint.weights.dot(reference.dq_m), 0.0);
    ++limit;
  }

  limit += static_cast<int>(device.motors().size());

  // [HG] (15)-(16)
  for (const CartesianLimit& frame : device.cartesian_limits) {
    const model::Jacobian& J = input.device_chain.jacobian(frame.frame);
    const Vector6 known = J.leftCols(device.n_p).lazyProduct(ddq_p_) +
                          input.device_chain.bias_acceleration(frame.frame);
    const Eigen::Vector3d& position = input.device_chain.pose(frame.frame).p;
    const Vector6& twist = input.device_chain.twist(frame.frame);
    for (int axis = 0; axis < 3; ++axis) {
      row.head(n_m_) = J.row(axis).segment(device.n_p, n_m_);
      row.tail(n_g_) = J.row(axis).head(n_g_);
      problem_.set_row(limit_rows_[limit].row, coefficients_);
      limits::JointLimits limits = limit_rows_[limit].limits;
      limits.dq_max = frame.axes[axis].dq_max;
      if (frame.frame == device.handle) limits.dq_max = std::min(limits.dq_max, input.handle_speed);
      set_limit(limit, limits, position[axis], twist[axis], known[axis]);
      ++limit;
    }
  }
}

// What each motor can give, as an acceleration of its joint: row and bounds are divided by the
// inertia that the motor moves while all other joints keep their speed.
void Tasks::fill_motors(const DeviceModel& device, const TaskInput& input) noexcept {
  const auto M = input.device_chain.M().bottomRows(n_m_);
  VectorM& known = known_torque_;
  known = input.device_chain.c().tail(n_m_);
  known.noalias() += M.leftCols(device.n_p) * ddq_p_;
  known.noalias() -= input.J_H.middleCols(device.n_p, n_m_).transpose() * input.robot.w_H;

  // a joint faster than any motor has jumped: its torques are unknown
  are_torques_known_ = known.allFinite();
  for (int i = 0; i < n_m_; ++i) {
    const double fastest = kJumped * device.motors()[i].speed_no_load;
    if (std::abs(input.reference.dq_m[i]) > fastest) are_torques_known_ = false;
  }

  VectorM led;  // computed for the first motor that would have to be relieved
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (int i = 0; i < n_m_; ++i) {
    if (!are_torques_known_) {
      problem_.set_bounds(limit_rows_[first_motor_ + i].row, {});
      continue;
    }
    const ActuatorModel& motor = device.motors()[i];
    const double dq = input.reference.dq_m[i];
    const double inertia = M(i, device.n_p + i) + motor.rotor_inertia;
    row.head(n_m_) = M.row(i).segment(device.n_p, n_m_) / inertia;
    row[i] = 1.0;
    row.tail(n_g_) = M.row(i).head(n_g_) / inertia;
    problem_.set_row(limit_rows_[first_motor_ + i].row, coefficients_);
    Interval torque = allowed_torque(motor, dq);
    if (joint_braking_) {
      lasting_[i] = {(torque.lb - known[i]) / inertia, (torque.ub - known[i]) / inertia};
    }
    LimitRow& limit = limit_rows_[first_motor_ + i];
    limit.torque = torque;
    if (input.motor_torque.size() > 0) {
      const double light = light_torque(device, motor, input);
      torque = reached_torque(torque, light, input.motor_torque[i], dt_);
      if (is_loaded(motor.torque_max, known[i]) && !torque.contains(known[i])) {
        if (led.size() == 0) {
          Vector6 coupling;
          for (int k = 0; k < 6; ++k) coupling[k] = problem_.bounds(coupling_row_ + k).lb;
          led = free_motion(device, input, coupling);
        }
        torque =
            eased_torque(torque, motor.torque_max, light, known[i],
                         known[i] + inertia * row.head(n_m_).dot(led), input.motor_torque[i], dt_);
      }
    }
    limit.dq = dq;
    limit.ddq = {(torque.lb - known[i]) / inertia, (torque.ub - known[i]) / inertia};
    if (stop_path_ && device.n_p == 0) {
      const Interval before = limit.ddq;
      limit.ddq = stoppable(before, lasting_[i], row.head(n_m_).dot(input.reference.dq_m));
      limit.is_slowed = limit.ddq.lb != before.lb || limit.ddq.ub != before.ub;
    }
    limit.inertia = inertia;
    problem_.set_bounds(limit_rows_[first_motor_ + i].row, limit.ddq);
  }
}

// Makes the limits of the device that need it brake together, early enough, and with what the twin
// needs for its own. The twin brakes with its ratings, which are accelerations that a device can
// brake that has no limit near.
void Tasks::brake_together() noexcept {
  constexpr double kFirm = 0.25;  // share of the rating with which far walls are assumed to be met
  braking_reserve_ = kMostReserve;
  const int first_twin = static_cast<int>(limit_rows_.size()) - n_a_ - stop_count_;
  bool has_near = false;
  double horizon = 0.0;  // s, until the device stands in front of the walls that are near
  for (std::size_t i = 0; i < braking_.size(); ++i) {
    const LimitRow& row = limit_rows_[braking_[i]];
    if (row.is_motor) continue;
    approaches_[i] = approach(row.limits, row.options, row.q, row.dq, dt_);
    approaches_[i].known = row.known;
    if (braking_[i] >= first_twin || !is_near(approaches_[i], row.limits)) continue;
    has_near = true;
    const bool is_wall = static_cast<int>(i) >= first_motor_ + n_m_;
    if (!is_wall) continue;
    const double deceleration = std::max(std::abs(approaches_[i].need), kFirm * row.limits.ddq_max);
    horizon = std::max(horizon, std::abs(row.dq) / deceleration);
  }
  if (!has_near || !are_torques_known_) return;
  for (int i = 0; i < first_motor_; ++i) {
    joint_room_[i] = approaches_[i].room;
    if (horizon > 0.0)
      joint_room_[i] = intersect(joint_room_[i], lasting_room(limit_rows_[i], horizon));
  }
  braking_reserve_ = joint_braking_->reserve(problem_, lasting_, approaches_, joint_room_);
  for (std::size_t i = 0; i < braking_.size() && braking_[i] < first_twin; ++i) {
    LimitRow& row = limit_rows_[braking_[i]];
    if (row.is_motor) continue;
    const Interval alone = row.ddq;
    row.ddq =
        braking_bounds(approaches_[i], braking_reserve_, row.ddq, row.limits, row.options, row.dq);
    row.brakes_together = row.ddq.lb != alone.lb || row.ddq.ub != alone.ub;
    problem_.set_bounds(row.row, {row.ddq.lb - row.known, row.ddq.ub - row.known});
  }
}

// Keeps the device where its motors can hold its weight, and a hand besides: the weight on a motor
// approaches its share of the torque as d exp(-t / kHoldingTime). Beyond it nothing moves outward.
void Tasks::keep_holding(const DeviceModel& device, const TaskInput& input) noexcept {
  constexpr double kShare = 0.7;          // of the allowed torque; the rest is for hand and braking
  constexpr double kNear = 0.6;           // of that; with less the row is not needed
  constexpr double kHoldingTime = 0.1;    // s
  constexpr double kOnset = 0.03;         // s, in which the rate is reached
  constexpr double kLeastGradient = 1.0;  // Nm/rad; below it no posture is easier to hold
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (int i = 0; i < n_m_; ++i) {
    const int holding_row = limit_rows_[first_motor_ + i].holding_row;
    const double most = kShare * allowed_torque(device.motors()[i], 0.0).ub;
    const double weight = input.device_chain.gravity()[device.n_p + i];
    problem_.set_bounds(holding_row, {});
    if (!are_torques_known_ || std::abs(weight) < kNear * most) continue;
    const VectorM gradient =
        holding_->gradient(stacked(input.robot.q_p, input.reference.q_m), input.device_chain, i);
    const double scale = gradient.norm();
    if (scale < kLeastGradient) continue;
    row.head(n_m_) = gradient / scale;
    problem_.set_row(holding_row, coefficients_);
    const double rate = gradient.dot(input.reference.dq_m);
    const auto rate_max = [](double d) { return std::max(d, 0.0) / kHoldingTime; };
    problem_.set_bounds(holding_row, {(-rate_max(most + weight) - rate) / (kOnset * scale),
                                      (rate_max(most - weight) - rate) / (kOnset * scale)});
  }
}

// Finds how fast the joints can stop, and keeps the place where an arm without gantry comes to rest
// within its walls.
void Tasks::stop_inside(const DeviceModel& device, const TaskInput& input) noexcept {
  constexpr double kAround = 0.05;  // m, beside the way: walls that are farther away do not matter
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  bool is_found = false;
  const bool is_stopping = input.joint_braking_rate > 0.0;
  if (are_torques_known_ && (device.n_p == 0 || is_stopping)) {
    const std::span motors = std::span(limit_rows_).subspan(first_motor_, n_m_);
    stop_path_->update(device, input.device_chain, input.reference, motors, known_torque_);
  }
  if (device.n_p > 0) return;
  int limit = first_motor_ + n_m_;
  for (const CartesianLimit& frame : device.cartesian_limits) {
    for (int axis = 0; axis < 3; ++axis, ++limit) {
      const LimitRow& wall = limit_rows_[limit];
      problem_.set_bounds(wall.stop_row, {});
      const double way = std::abs(wall.dq) * stop_path_->reach() + kAround;
      const bool is_far = wall.q + way < wall.limits.q_max && wall.q - way > wall.limits.q_min;
      if (is_far || !are_torques_known_) continue;
      if (!is_found) stop_path_->find_rest(input.reference);
      is_found = true;
      const Interval ddq =
          stop_path_->bound(frame.frame, axis, {wall.limits.q_min, wall.limits.q_max},
                            input.reference, coefficients_);
      problem_.set_row(wall.stop_row, coefficients_);
      problem_.set_bounds(wall.stop_row, ddq);
    }
  }
}

// Keeps the device where braking joint by joint does not bring its shapes too near each other: the
// smallest distance on that way shrinks by at most kApartRate times what is left of it. Braking
// itself never shrinks it, so that joints within their ratings can always meet this row.
void Tasks::keep_apart(const DeviceModel& device, const CollisionTask& task) noexcept {
  constexpr double kApartRate = 20.0;  // 1/s
  constexpr double kLeast = 1e-3;      // s m/rad; a smaller change does not depend on accelerations
  LimitRow& limit = limit_rows_[device.limit_count() - 1];
  limit.q = task.distance;
  limit.dq = task.rate;
  limit.ddq = {};
  problem_.set_bounds(limit.row, {});
  if (paper_ || !std::isfinite(task.distance)) return;
  const double scale = task.per_acceleration.lpNorm<Eigen::Infinity>();
  if (!(scale > kLeast)) return;
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  row.head(n_m_) = task.per_acceleration.tail(n_m_) / scale;
  row.tail(n_g_) = task.per_acceleration.head(n_g_) / scale;
  problem_.set_row(limit.row, coefficients_);
  limit.known = task.per_acceleration.head(device.n_p).dot(ddq_p_) / scale;
  limit.ddq.lb = (-kApartRate * (task.distance - limit.limits.q_min) - task.rate) / scale;
  problem_.set_bounds(limit.row, {.lb = limit.ddq.lb - limit.known});
}

void Tasks::fill_twin_limits(const TwinModel& twin, const TaskInput& input) noexcept {
  const int first = static_cast<int>(limit_rows_.size()) - n_a_ - stop_count_;
  for (int i = 0; i < n_a_; ++i) {
    const TwinDof& dof = twin.dofs[i];
    const double q = dof.q_index >= 0 ? input.twin.q_a[dof.q_index] : 0.0;
    const double dq = input.twin.dq_a[i];
    EffectiveLimits effective = effective_limits(twin, i, dq, input.inner);
    LimitRow& row = limit_rows_[first + i];
    row.held_by = effective.held_by;
    const bool is_locked = row.held_by.upper == LimitCause::kLock;
    if (is_locked && options_.bounds == Bounds::kPaper) {
      effective.limits.q_min = effective.limits.q_max = q;
    }
    row.range = input.inner.parameters.moving[i].q;
    row.options = limits::recoverable_options(effective.limits, dt_, dt_);
    if (has_torques_) row.options.tau_onset = kTwinBrakingOnset;
    const bool is_held =
        row.held_by.lower != LimitCause::kNone || row.held_by.upper != LimitCause::kNone;
    row.is_recoverable = options_.bounds == Bounds::kRecoverable || is_held ||
                         input.inner.parameters.may_be_overrun[i];
    set_limit(first + i, effective.limits, q, dq, 0.0);

    // [HG] (31): a lock of bounds paper stops the joint, as fast as its rating allows
    double ddq_stop = -dq / dt_;
    if (options_.bounds == Bounds::kPaper) {
      const double ddq_max = effective.limits.ddq_max;
      ddq_stop = std::clamp(ddq_stop, -ddq_max, ddq_max);
      if (is_locked) hold(first + i, ddq_stop);
    } else if (is_locked) {
      // one value: between two that differ by rounding the lock would seem to let go
      hold(first + i, 0.5 * (row.ddq.lb + row.ddq.ub));
    }

    // stick: the joint stands still at the end of the sample, as far as its limits allow
    if (input.inner.sticks[i] && !is_locked) {
      hold(first + i, std::clamp(ddq_stop, row.ddq.lb, row.ddq.ub));
      row.held_by = {LimitCause::kFriction, LimitCause::kFriction};
    }
  }
}

// The law assumes that the gantry follows at once. It follows after the dead time of its drives;
// deviations until then show in the next samples.
void Tasks::fill_gantry(const TaskInput& input) noexcept {
  const GantryTask& task = input.gantry;
  const bool is_led = task.ddq.size() == n_g_;
  for (int i = 0; i < n_g_; ++i) {
    const double aim = is_led ? task.ddq[i] : input.robot.ddq_p[i];
    problem_.set_bounds(i,
                        is_led ? Interval{task.ddq_min[i], task.ddq_max[i]} : Interval{aim, aim});
    problem_.set_bounds(dynamics_row_ + n_a_ + i, {aim, aim});
    ddq_p_[i] = is_led ? task.unexplained[i] : 0.0;
  }
}

// The distance d of a point to a plane in front of it, d'' = row ddq_a + bias (stops.h): the solid
// curves away from its plane, so that this is the least.
void Tasks::fill_stops(const TaskInput& input) noexcept {
  const int first = static_cast<int>(limit_rows_.size()) - stop_count_;
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (int i = 0; i < stop_count_; ++i) {
    const Stop& stop = input.stops[i];
    if (stop.surface < 0) {
      limit_rows_[first + i].ddq = {};
      problem_.set_bounds(limit_rows_[first + i].row, {});
      continue;
    }
    row.segment(n_m_, n_a_) = stop.row;
    problem_.set_row(limit_rows_[first + i].row, coefficients_);
    limits::JointLimits limits = limit_rows_[first + i].limits;
    limits.ddq_max = stop.rating;
    set_limit(first + i, limits, stop.distance, stop.speed, stop.bias);
  }
}

// Gauss: minimise |L^T ddq_a - L^-1 (tau - c)|^2 = (ddq_a - ddq_free)^T M (ddq_a - ddq_free)
void Tasks::fill_dynamics(const MatrixA& L, const VectorA& tau) noexcept {
  VectorA b = tau;
  L.triangularView<Eigen::Lower>().solveInPlace(b);
  Eigen::Map<Eigen::VectorXd> row(coefficients_.data(), problem_.variables());
  row.setZero();
  for (int i = 0; i < n_a_; ++i) {
    row.segment(n_m_, i).setZero();
    row.segment(n_m_ + i, n_a_ - i) = L.col(i).tail(n_a_ - i);
    problem_.set_row(dynamics_row_ + i, coefficients_);
    problem_.set_bounds(dynamics_row_ + i, {b[i], b[i]});
  }
}

// A joint to spare moves towards its goal like a damped spring; without a goal, and while the twin
// is braked, it comes to rest.
void Tasks::fill_posture(const DeviceModel& device, const TaskInput& input) noexcept {
  const ReferenceState& reference = input.reference;
  const bool has_goals = device.posture.size() > 0 && !input.is_braked;
  for (int i = 0; i < n_m_; ++i) {
    const InnerRange& inner = inner_[i];
    const Interval gently = limits::recoverable_bounds(inner.limits, inner.options,
                                                       reference.q_m[i], reference.dq_m[i], dt_);
    problem_.set_bounds(posture_row_ + i, input.is_braked ? Interval{} : gently);
    const bool has_goal = has_goals && std::isfinite(device.posture[i]);
    const double error = has_goal ? device.posture[i] - reference.q_m[i] : 0.0;
    const double ddq = options_.kP_posture * error - options_.kD_posture * reference.dq_m[i];
    problem_.set_bounds(posture_row_ + n_m_ + i, {ddq, ddq});
  }
}

void Tasks::fill_ranges(const TaskInput& input) noexcept {
  for (std::size_t i = 0; i < limit_rows_.size(); ++i) {
    const LimitCause held_by = limit_rows_[i].held_by.upper;
    const bool is_locked = held_by == LimitCause::kLock || held_by == LimitCause::kFriction;
    paper_->set_range(static_cast<int>(i), input.touched.lower[i], input.touched.upper[i],
                      is_locked, problem_);
  }
}

void Tasks::find_motor_torques(const hqp::Solution& solution) noexcept {
  motor_torque_.resize(0);
  if (!has_torques_ || !are_torques_known_) return;
  const Eigen::Map<const Eigen::VectorXd> x(solution.x.data(), problem_.variables());
  motor_torque_.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    LimitRow& limit = limit_rows_[first_motor_ + i];
    const std::span<const double> row = problem_.coefficients(limit_rows_[first_motor_ + i].row);
    const double ddq = Eigen::Map<const Eigen::VectorXd>(row.data(), problem_.variables()).dot(x);
    limit.q = motor_torque_[i] = known_torque_[i] + limit.inertia * ddq;
  }
}

bool Tasks::keeps_limits_of_device(const hqp::Solution& solution) const noexcept {
  constexpr double kMet = 1e-6;  // rad/s^2 or m/s^2
  return keeps(solution, static_cast<int>(limit_rows_.size()) - n_a_ - stop_count_, kMet);
}

bool Tasks::keeps_joints(const hqp::Solution& solution) const noexcept {
  constexpr double kMet = 1e-3;  // rad/s^2: 1e-6 rad/s in a period of 1 ms
  return keeps(solution, first_motor_, kMet);
}

// the first `count` limits
bool Tasks::keeps(const hqp::Solution& solution, int count, double tolerance) const noexcept {
  for (int limit = 0; limit < count; ++limit) {
    for (const int row : {limit_rows_[limit].row, limit_rows_[limit].rating_row}) {
      if (row < 0 || problem_.level_of(row) < solution.completed_levels) continue;
      if (!(std::abs(solution.slack[row]) <= tolerance)) return false;
    }
  }
  return true;
}

TouchedEnds Tasks::touched_ends(const hqp::Solution& solution) const noexcept {
  TouchedEnds touched;
  for (std::size_t i = 0; i < limit_rows_.size(); ++i) {
    for (const int row : {limit_rows_[i].row, limit_rows_[i].rating_row}) {
      if (row < 0) continue;
      touched.lower[i] = touched.lower[i] || touches_lower(problem_, row, solution.x);
      touched.upper[i] = touched.upper[i] || touches_upper(problem_, row, solution.x);
    }
  }
  return touched;
}

}  // namespace hg::rendering
