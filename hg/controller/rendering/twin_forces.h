/// Internal forces of the twin: springs, profiles, closers, dampers, friction, locks.
///
/// Dampers enter the law with the velocity at the begin of a sample. A damper that is stiff for its
/// inertia and the period would make that ring or diverge. damping_torque() therefore takes
///   D' = (D^-1 + s dt M^-1)^-1,  s = max(0, 1 - 1 / trace(dt M^-1 D)),
/// the damper D in series with one that stops the inertia M within s^-1 samples: exactly D while
/// the trace is at most 1, and with all eigenvalues of dt M^-1 D' in [0, 1], so that damping alone
/// never reverses a velocity. One joint: d' = min(d, M / dt).
///
/// The torque of a profile is taken where the joint is in the middle of the sample at its present
/// speed. With the integration of the twin that is the leapfrog method (position Verlet): energy
/// swings to and fro between profile and motion, and none is gained over time.
///
/// No allocation, noexcept.
#pragma once

#include <array>
#include <cstdint>

#include "hg/controller/rendering/options.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/controller/rendering/twin_parameters.h"
#include "hg/core/types.h"
#include "hg/signals/state.h"

namespace hg::rendering {

struct LockState {
  bool is_engaged = false;  ///< All conditions hold
  /// Engaged, and the joint has reached the lock's position; with bounds paper as soon as engaged.
  bool is_locked = false;
  double edge = 0.0;  ///< While latched, or the tooth of a ratchet: the joint may not pass it
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const LockState& lock) {
  const auto& [is_engaged, is_locked, edge] = lock;
  hash.mix(std::uint64_t{is_engaged} | std::uint64_t{is_locked} << 1U, edge);
}

/// Part of the copyable state of a cycle.
struct TwinInnerState {
  std::array<LockState, kMaxLocks> locks{};
  std::array<bool, kMaxTwin> sticks{};  ///< Coulomb friction holds this degree of freedom
  TwinParameters parameters;
};

/// Words of the state hash, in its order: those of the first `dofs` degrees of freedom.
void hashed(auto& hash, const TwinInnerState& inner, int dofs) {
  const auto& [locks, sticks, parameters] = inner;
  hash.mix(locks);
  hash.mix_first(sticks, dofs);
  hashed(hash, parameters, dofs);
}

/// A joint counts as being at its lock within this distance, rad or m.
inline constexpr double kLockReached = 1e-4;

/// Engages, latches, passes teeth, locks and releases according to the joint positions. With bounds
/// paper a lock that engages locks at once, wherever its joint is, [HG] VII-C.
void advance_locks(const TwinModel& twin, Bounds bounds, const ConfigurationA& q_a,
                   TwinInnerState& inner) noexcept;

/// Causes that hold the two sides of a limit besides its own ratings; kNone = no such cause.
struct Holds {
  LimitCause lower = LimitCause::kNone;
  LimitCause upper = LimitCause::kNone;
};

/// The limits of a degree of freedom with its closer, conditional limits and locks. A speed limit
/// that holds towards one end only counts while the joint moves there. Never empty: where a lock is
/// outside the other limits the lock wins; where those contradict each other see limits::advanced.
/// Both are reported as LimitCause::kContradiction, a joint that is locked already as kLock.
struct EffectiveLimits {
  limits::JointLimits limits;
  Holds held_by;
};
EffectiveLimits effective_limits(const TwinModel& twin, int dof, double dq,
                                 const TwinInnerState& inner) noexcept;

/// Torques of springs, profiles and closers (n_a), of closers from the lower limit that holds now;
/// sign as in the budget.
VectorA spring_torque(const TwinModel& twin, const TwinState& state, double dt,
                      const TwinParameters& parameters) noexcept;
/// Coulomb friction of a degree of freedom where it is now, with that of its profile, Nm or N.
double friction_of(const TwinModel& twin, int dof, const ConfigurationA& q_a,
                   const TwinParameters& parameters) noexcept;
/// Writes the Cholesky factor of the mass matrix M into the lower triangle of `L` (n_a x n_a): M =
/// L L^T.
void factor_mass(const Eigen::MatrixXd& M, MatrixA& L) noexcept;
/// Torques of linear and quadratic dampers (n_a); sign as in the budget. `L` is the factor of M.
VectorA damping_torque(const MatrixA& L, const VectorA& dq_a, double dt,
                       const TwinValues& values) noexcept;

}  // namespace hg::rendering
