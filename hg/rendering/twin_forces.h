/// What acts inside the twin besides the user: springs, dampers, friction, locks.
///
/// No allocation, noexcept.
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/rendering/twin_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

struct LockState {
  bool is_engaged = false;  ///< all conditions hold
  bool is_locked = false;   ///< engaged, and the joint has reached the lock's position
  double edge = 0.0;        ///< while latched: the joint may not go beyond it
};

/// Part of the copyable state of a cycle.
struct TwinInnerState {
  std::array<LockState, kMaxLocks> locks{};
  std::array<bool, kMaxTwin> sticks{};  ///< Coulomb friction holds this degree of freedom
};

/// A joint counts as being at its lock within this distance, rad or m.
inline constexpr double kLockReached = 1e-4;

/// Engages, latches, locks and releases according to the joint positions.
void advance_locks(const TwinModel& twin, const ConfigurationA& q_a,
                   TwinInnerState& inner) noexcept;

/// What holds the two sides of a limit besides its own ratings; kNone where nothing does.
struct Holds {
  LimitCause lower = LimitCause::kNone;
  LimitCause upper = LimitCause::kNone;
};

/// The limits of a degree of freedom under the locks that hold it.
struct EffectiveLimits {
  limits::JointLimits limits;
  Holds held_by;
};
EffectiveLimits effective_limits(const TwinModel& twin, int dof,
                                 const TwinInnerState& inner) noexcept;

/// Torques of springs and dampers (n_a each); signs as in the budget.
VectorA spring_torque(const TwinModel& twin, const ConfigurationA& q_a) noexcept;
VectorA damping_torque(const TwinModel& twin, const VectorA& dq_a) noexcept;

}  // namespace hg::rendering
