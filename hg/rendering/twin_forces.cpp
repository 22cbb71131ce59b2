#include "hg/rendering/twin_forces.h"

#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

double coordinate(const TwinModel& twin, int dof, const ConfigurationA& q_a) noexcept {
  return q_a[twin.dofs[static_cast<std::size_t>(dof)].q_index];
}

bool holds(const TwinModel& twin, const Lock& lock, const ConfigurationA& q_a) noexcept {
  return std::all_of(lock.engaged_while.begin(), lock.engaged_while.end(),
                     [&](const auto& c) { return c.range.contains(coordinate(twin, c.dof, q_a)); });
}

}  // namespace

void advance_locks(const TwinModel& twin, const ConfigurationA& q_a,
                   TwinInnerState& inner) noexcept {
  for (std::size_t i = 0; i < twin.locks.size(); ++i) {
    const Lock& lock = twin.locks[i];
    LockState& state = inner.locks[i];
    if (!holds(twin, lock, q_a)) {
      state = {};
      continue;
    }
    const double q = coordinate(twin, lock.dof, q_a);
    if (!state.is_engaged) state = {.is_engaged = true, .is_locked = false, .edge = q};

    // the latch follows the joint towards the lock and never back
    const double side = q >= lock.position ? 1.0 : -1.0;
    if (side * (q - state.edge) < 0.0) state.edge = q;
    if (std::abs(q - lock.position) <= kLockReached) state.is_locked = true;
  }
}

EffectiveLimits effective_limits(const TwinModel& twin, int dof,
                                 const TwinInnerState& inner) noexcept {
  EffectiveLimits result{twin.dofs[static_cast<std::size_t>(dof)].limits, {}};
  for (std::size_t i = 0; i < twin.locks.size(); ++i) {
    const Lock& lock = twin.locks[i];
    const LockState& state = inner.locks[i];
    if (lock.dof != dof || !state.is_engaged) continue;
    if (state.is_locked) {
      result.limits.q_min = result.limits.q_max = lock.position;
      result.held_by = {LimitCause::kLock, LimitCause::kLock};
      return result;
    }
    // between the latch, which follows, and the lock, where the joint comes to rest
    if (state.edge >= lock.position) {
      result.limits.q_min = std::max(result.limits.q_min, lock.position);
      result.limits.q_max = std::min(result.limits.q_max, state.edge);
      result.held_by.upper = LimitCause::kLatch;
    } else {
      result.limits.q_min = std::max(result.limits.q_min, state.edge);
      result.limits.q_max = std::min(result.limits.q_max, lock.position);
      result.held_by.lower = LimitCause::kLatch;
    }
  }
  return result;
}

VectorA spring_torque(const TwinModel& twin, const ConfigurationA& q_a) noexcept {
  VectorA torque = VectorA::Zero(twin.chain.nv());
  for (int i = 0; i < twin.chain.nv(); ++i) {
    const TwinDof& dof = twin.dofs[static_cast<std::size_t>(i)];
    if (dof.q_index >= 0) {
      torque[i] = dof.preload + dof.stiffness * (q_a[dof.q_index] - dof.rest);
    }
  }
  return torque;
}

VectorA damping_torque(const TwinModel& twin, const VectorA& dq_a) noexcept {
  VectorA torque = dq_a;
  for (int i = 0; i < twin.chain.nv(); ++i) {
    torque[i] *= twin.dofs[static_cast<std::size_t>(i)].damping;
  }
  return torque;
}

}  // namespace hg::rendering
