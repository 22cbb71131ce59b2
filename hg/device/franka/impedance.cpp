#include "hg/device/franka/impedance.h"

#include <algorithm>

#include "hg/device/franka/protocol.h"

namespace hg::franka {
namespace {

constexpr double kTorqueRate = 1000.0 - 1e-3;  // Nm/s, libfranka's rate_limiting.h

}  // namespace

Impedance::Impedance(const model::ChainModel& chain, const ImpedanceGains& gains)
    : chain_(chain), gains_(gains), torque_max_(chain.nv()) {
  for (int i = 0; i < chain.nv(); ++i) torque_max_[i] = chain.joints()[i].effort_max;
}

VectorM Impedance::torques(const CommandFrame& command, const VectorM& q,
                           const VectorM& dq) noexcept {
  chain_.update(q, dq);
  const VectorM error = command.q_m - q, rate = command.dq_m - dq;
  VectorM tau = chain_.c() - chain_.gravity();
  tau.noalias() += chain_.M().lazyProduct(command.ddq_m);
  tau += gains_.stiffness.cwiseProduct(error) + gains_.damping.cwiseProduct(rate);
  return tau.cwiseMax(-torque_max_).cwiseMin(torque_max_);
}

VectorM Impedance::weight(const VectorM& q) noexcept {
  const VectorM at_rest = VectorM::Zero(q.size());
  chain_.update(q, at_rest);
  return chain_.gravity();
}

VectorM rate_limited(const VectorM& wanted, const VectorM& last) noexcept {
  constexpr double kStep = kTorqueRate * kPeriod_s;
  return last + (wanted - last).cwiseMax(-kStep).cwiseMin(kStep);
}

}  // namespace hg::franka
