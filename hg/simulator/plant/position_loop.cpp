#include "hg/simulator/plant/position_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::simulator {

DriveReference interpolated(const DriveReference& command, double age, double period) noexcept {
  const double ahead = std::max(0.0, period - age);
  return {command.q - ahead * command.dq + 0.5 * ahead * ahead * command.ddq,
          command.dq - ahead * command.ddq, command.ddq};
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
