#include "hg/controller/rendering/twin_forces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

// the last tooth of a ratchet that a joint at q has passed
double tooth_behind(const Lock& lock, double q) noexcept {
  const double teeth = (q - lock.position) / lock.teeth;
  const double passed = lock.free == Way::kUpper ? std::floor(teeth) : std::ceil(teeth);
  return lock.position + passed * lock.teeth;
}

void advance_ratchet(const Lock& lock, double q, LockState& state) noexcept {
  const double tooth = tooth_behind(lock, q);
  if (!state.is_engaged) state = {.is_engaged = true, .is_locked = false, .edge = tooth};
  state.edge = lock.free == Way::kUpper ? std::max(state.edge, tooth) : std::min(state.edge, tooth);
}

// without locks
limits::JointLimits free_limits(const TwinModel& twin, int dof, double dq,
                                const TwinParameters& parameters) noexcept {
  limits::JointLimits limits = twin.dofs[dof].limits;
  limits.q_min = parameters.moving[dof].q.lb;
  limits.q_max = parameters.moving[dof].q.ub;
  limits.dq_max = parameters.now.dofs[dof].dq_max;
  if (dq < 0.0) limits.dq_max = std::min(limits.dq_max, twin.dofs[dof].closer.speed);
  for (std::size_t i = 0; i < twin.conditional_limits.size(); ++i) {
    const ConditionalLimit& limit = twin.conditional_limits[i];
    if (limit.dof != dof || !parameters.holds[i]) continue;
    limits.ddq_max = std::min(limits.ddq_max, limit.limits.ddq_max);
    const bool is_towards = limit.moving == Moving::kEitherWay ||
                            (limit.moving == Moving::kLower ? dq < 0.0 : dq > 0.0);
    if (is_towards) limits.dq_max = std::min(limits.dq_max, limit.limits.dq_max);
  }
  return limits;
}

// whether the latch is at the upper end of the way that it leaves
bool is_latched_above(const Lock& lock, const LockState& state) noexcept {
  return lock.teeth > 0.0 ? lock.free == Way::kLower : state.edge >= lock.position;
}

// between the latch, which follows, and the lock, where the joint comes to rest; of a ratchet
// without an end
Interval way_of(const Lock& lock, const LockState& state) noexcept {
  if (lock.teeth > 0.0) {
    return lock.free == Way::kUpper ? Interval{.lb = state.edge} : Interval{.ub = state.edge};
  }
  return {std::min(state.edge, lock.position), std::max(state.edge, lock.position)};
}

// Not less than |B|^2 (Frobenius) with L B = diag(d): forward substitution for the sums of |B_ij|
// over each row, with all signs alike
double norm_bound(const MatrixA& L, const VectorA& d) noexcept {
  VectorA sum = d;
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k) sum[i] += std::abs(L(i, k)) * sum[k];
    sum[i] /= L(i, i);
  }
  return sum.squaredNorm();
}

}  // namespace

void advance_locks(const TwinModel& twin, Bounds bounds, const ConfigurationA& q_a,
                   TwinInnerState& inner) noexcept {
  for (std::size_t i = 0; i < twin.locks.size(); ++i) {
    const Lock& lock = twin.locks[i];
    LockState& state = inner.locks[i];
    if (!are_true(twin, lock.engaged_while, q_a)) {
      state = {};
      continue;
    }
    const double q = position_of(twin, lock.dof, q_a);
    if (lock.teeth > 0.0) {
      advance_ratchet(lock, q, state);
      continue;
    }
    if (!state.is_engaged) state = {.is_engaged = true, .is_locked = false, .edge = q};

    // the latch follows the joint towards the lock only
    const double side = q >= lock.position ? 1.0 : -1.0;
    if (side * (q - state.edge) < 0.0) state.edge = q;
    const bool is_reached = std::abs(q - lock.position) <= kLockReached;
    if (is_reached || bounds == Bounds::kPaper) state.is_locked = true;
  }
}

EffectiveLimits effective_limits(const TwinModel& twin, int dof, double dq,
                                 const TwinInnerState& inner) noexcept {
  EffectiveLimits result{free_limits(twin, dof, dq, inner.parameters), {}};
  constexpr Holds kContradiction = {LimitCause::kContradiction, LimitCause::kContradiction};
  if (inner.parameters.moving[dof].is_crossed) {
    result.held_by = kContradiction;
  }
  for (std::size_t i = 0; i < twin.locks.size(); ++i) {
    const Lock& lock = twin.locks[i];
    const LockState& state = inner.locks[i];
    if (lock.dof != dof || !state.is_engaged) continue;
    if (state.is_locked) {
      result.limits.q_min = result.limits.q_max = lock.position;
      result.held_by = {LimitCause::kLock, LimitCause::kLock};
      return result;
    }
    const bool is_above = is_latched_above(lock, state);
    const Interval way = way_of(lock, state);
    const Interval range = {result.limits.q_min, result.limits.q_max};
    const Interval merged = moved_into(range, way);
    result.limits.q_min = merged.lb;
    result.limits.q_max = merged.ub;
    (is_above ? result.held_by.upper : result.held_by.lower) = LimitCause::kLatch;
    if (intersect(range, way).empty()) result.held_by = kContradiction;
  }
  return result;
}

VectorA spring_torque(const TwinModel& twin, const TwinState& state, double dt,
                      const TwinParameters& parameters) noexcept {
  VectorA torque = VectorA::Zero(twin.chain.nv());
  for (int i = 0; i < twin.chain.nv(); ++i) {
    const TwinDof& dof = twin.dofs[i];
    if (dof.q_index < 0) continue;
    const DofValues& spring = parameters.now.dofs[i];
    const double q = state.q_a[dof.q_index];
    torque[i] = spring.preload + spring.stiffness * (q - spring.rest) + dof.closer.torque;
    if (dof.closer.stiffness > 0.0) {
      torque[i] += dof.closer.stiffness * (q - parameters.moving[i].q.lb);
    }
    if (!dof.profile.empty()) torque[i] += dof.profile.torque(q + 0.5 * dt * state.dq_a[i]);
  }
  return torque;
}

double friction_of(const TwinModel& twin, int dof, const ConfigurationA& q_a,
                   const TwinParameters& parameters) noexcept {
  const double friction = parameters.now.dofs[dof].friction;
  const Profile& profile = twin.dofs[dof].profile;
  return profile.empty() ? friction : friction + profile.friction(position_of(twin, dof, q_a));
}

void factor_mass(const Eigen::MatrixXd& M, MatrixA& L) noexcept {
  L = M;
  const Eigen::LLT<Eigen::Ref<MatrixA>> cholesky(L);
}

VectorA damping_torque(const MatrixA& L, const VectorA& dq_a, double dt,
                       const TwinValues& values) noexcept {
  const Eigen::Index n = dq_a.size();
  VectorA D(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const DofValues& dof = values.dofs[i];
    D[i] = dof.damping + dof.quadratic_damping * std::abs(dq_a[i]);
  }
  VectorA torque = D.cwiseProduct(dq_a);
  if (D.isZero(0.0)) return torque;

  // B^T B = dt D^1/2 M^-1 D^1/2; most dampers are so far from stiff that no B is needed to see it
  const VectorA root = D.cwiseSqrt();
  const VectorA diagonal = std::sqrt(dt) * root;
  if (norm_bound(L, diagonal) < 0.5) return torque;
  // B is lower triangular, and of B^T B the lower triangle is enough
  MatrixA B(n, n);
  double trace = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index rest = n - i;
    auto column = B.col(i).tail(rest);
    column.setZero();
    column[0] = diagonal[i];
    L.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>().solveInPlace(column);
    trace += column.squaredNorm();
  }
  if (trace <= 1.0) return torque;

  // D' = D^1/2 (1 + s B^T B)^-1 D^1/2
  const double s = 1.0 - 1.0 / trace;
  MatrixA series(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      series(i, j) = s * B.col(i).tail(n - i).dot(B.col(j).tail(n - i));
    }
    series(j, j) += 1.0;
  }
  Eigen::LLT<Eigen::Ref<MatrixA>> series_cholesky(series);
  torque = root.cwiseProduct(dq_a);
  series_cholesky.solveInPlace(torque);
  return root.cwiseProduct(torque);
}

}  // namespace hg::rendering
