#include "hg/simulator/plant/position_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::simulator {

DriveReference DriveInterpolator::commanded() const noexcept {
  const double late = age_ - period_;
  return {command_.q + late * command_.dq + 0.5 * late * late * command_.ddq,
          command_.dq + late * command_.ddq, command_.ddq};
}

// The difference fades along the polynomial of fifth degree from its value, rate and acceleration
// to zero.
DriveReference DriveInterpolator::present() const noexcept {
  DriveReference now = commanded();
  if (gap_.q.size() == 0 || since_ >= kCatchUp_s) return now;
  const double T = kCatchUp_s, s = since_ / T;
  const double r = 1.0 - s, r2 = r * r, s2 = s * s;
  const double a = r2 * r * (1.0 + 3.0 * s + 6.0 * s2), da = -30.0 * s2 * r2;
  const double b = r2 * r * s * (1.0 + 3.0 * s), db = r2 * (1.0 + 2.0 * s - 15.0 * s2);
  const double c = 0.5 * r2 * r * s2, dc = 0.5 * s * r2 * (2.0 - 5.0 * s);
  const double dda = -60.0 * s * r * (1.0 - 2.0 * s);
  const double ddb = s * r * (-36.0 + 60.0 * s);
  const double ddc = r * (1.0 - 8.0 * s + 10.0 * s2);
  now.q += a * gap_.q + T * (b * gap_.dq + T * c * gap_.ddq);
  now.dq += da / T * gap_.q + db * gap_.dq + T * dc * gap_.ddq;
  now.ddq += dda / (T * T) * gap_.q + ddb / T * gap_.dq + ddc * gap_.ddq;
  return now;
}

void DriveInterpolator::take(const DriveReference& command) noexcept {
  const bool is_in_time = command_.q.size() == 0 || age_ < 1.5 * period_;
  if (is_in_time) {
    command_ = command;
    age_ = 0.0;
    return;
  }
  const DriveReference before = present();
  command_ = command;
  age_ = since_ = 0.0;
  const DriveReference after = commanded();
  gap_ = {before.q - after.q, before.dq - after.dq, before.ddq - after.ddq};
}

DriveReference DriveInterpolator::advance(double step) noexcept {
  age_ += step;
  since_ += step;
  return present();
}

PositionLoop::PositionLoop(const PositionLoopConfig& config, double step) noexcept
    : w_q_(2.0 * std::numbers::pi * config.position_Hz),
      w_v_(2.0 * std::numbers::pi * config.speed_Hz),
      step_(step) {}

VectorM PositionLoop::torque(const DriveReference& reference, const VectorM& theta,
                             const VectorM& dtheta, const VectorM& inertia,
                             const VectorM& tau_known, const VectorM& torque_max) noexcept {
  const Eigen::Index n = theta.size();
  if (integral_.size() != n) integral_ = VectorM::Zero(n);
  VectorM tau(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double error = reference.dq[i] + w_q_ * (reference.q[i] - theta[i]) - dtheta[i];
    const double driving = tau_known[i] + inertia[i] * (reference.ddq[i] + w_v_ * error);
    const double held = inertia[i] * 0.1 * w_v_ * w_v_ * integral_[i];
    tau[i] = std::clamp(driving + held, -torque_max[i], torque_max[i]);
    const bool is_saturated = tau[i] != driving + held;
    if (!is_saturated) integral_[i] += step_ * error;
  }
  return tau;
}

}  // namespace hg::simulator
