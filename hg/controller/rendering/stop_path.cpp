#include "hg/controller/rendering/stop_path.h"

#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

constexpr double kReaction = 0.05;       // s, until the motors brake
constexpr double kShare = 0.6;           // of the rating of a joint
constexpr double kWithoutRating = 10.0;  // rad/s^2 or m/s^2
constexpr double kLeastTorque = 0.1;     // of the allowed torque, to brake with
constexpr double kLongest = 0.5;         // s
constexpr double kRate = 20.0;           // 1/s, of the approach to an end
constexpr double kReturn = 0.1;          // m/s, from outside

double seventh(double x) noexcept {
  const double cube = x * x * x;
  return cube * cube * x;
}

}  // namespace

StopPath::StopPath(const DeviceModel& device)
    : reaction_(kReaction + device.dt()),
      deceleration_(device.n_m),
      rest_(device.chain),
      per_speed_(VectorM::Zero(device.n_m)) {
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[i];
    deceleration_[i] = kShare * (std::isfinite(limits.ddq_max) ? limits.ddq_max : kWithoutRating);
    ends_.push_back({limits.q_min, limits.q_max});
  }
}

double StopPath::reach() const noexcept { return reaction_ + 0.5 * std::min(time_, kLongest); }

// T = (sum of u^8)^(1/8) over the times u that single joints and motors need
void StopPath::update(const DeviceModel& device, const model::ChainData& now,
                      const ReferenceState& reference, std::span<const LimitRow> motors,
                      const VectorM& known) noexcept {
  const int n = device.n_m;
  const VectorM& dq = reference.dq_m;
  MatrixUpTo<kMaxManipulator, kMaxManipulator> inertia = now.M().bottomRightCorner(n, n);
  for (int i = 0; i < n; ++i) inertia(i, i) += device.motors()[i].rotor_inertia;
  const VectorM momentum = inertia.lazyProduct(dq);
  VectorM of_joint(n), of_motor(n), available(n);
  double sum = 0.0;
  motor_time_ = 0.0;
  for (int i = 0; i < n; ++i) {
    of_joint[i] = std::abs(dq[i]) / deceleration_[i];
    const Interval& torque = motors[i].torque;
    const double least = kLeastTorque * torque.ub;
    available[i] = momentum[i] > 0.0 ? std::max(known[i] - torque.lb, least)
                                     : std::max(torque.ub - known[i], least);
    of_motor[i] = std::abs(momentum[i]) / available[i];
    motor_time_ = std::max(motor_time_, of_motor[i]);
    sum += seventh(of_joint[i]) * of_joint[i] + seventh(of_motor[i]) * of_motor[i];
  }
  time_ = std::sqrt(std::sqrt(std::sqrt(sum)));
  per_speed_.setZero();
  if (!(time_ > 0.0) || time_ > kLongest) return;
  for (int i = 0; i < n; ++i) {
    per_speed_[i] += std::copysign(seventh(of_joint[i] / time_) / deceleration_[i], dq[i]);
    const double share = std::copysign(seventh(of_motor[i] / time_) / available[i], momentum[i]);
    per_speed_.noalias() += share * inertia.col(i);
  }
}

void StopPath::find_rest(const ReferenceState& reference) noexcept {
  VectorM q = reference.q_m + reach() * reference.dq_m;
  for (int i = 0; i < q.size(); ++i) q[i] = std::clamp(q[i], ends_[i].lb, ends_[i].ub);
  const VectorM still = VectorM::Zero(q.size());
  rest_.update_kinematics(q, still);
}

Interval StopPath::bound(int frame, int axis, const Interval& range,
                         const ReferenceState& reference, std::span<double> row) const noexcept {
  const VectorM J = rest_.jacobian(frame).row(axis).transpose();
  const double position = place(frame)[axis];
  const double rate = J.dot(reference.dq_m);
  Eigen::Map<VectorM>(row.data(), J.size()) = J + 0.5 * rate / reach() * per_speed_;
  const double up = std::max(kRate * (range.ub - position), -kReturn);
  const double down = std::max(kRate * (position - range.lb), -kReturn);
  return {(-down - rate) / reach(), (up - rate) / reach()};
}

}  // namespace hg::rendering
