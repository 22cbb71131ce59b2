/// Damping of a twin in directions of the handle in which the arm can hardly move.
///
/// Near a singular posture a small velocity of the handle needs a large one of the joints, so that
/// the noise of the force sensor alone would move them. With singular values s of the Jacobian
/// (lengths in m, rotations at 0.3 m), each direction with s < 0.05 is damped by
///   b = 0.1 Nms/rad / (1 + |dq| / 0.1 rad/s) (1 / s^2 - 1 / 0.05^2),  in Ns/m,
/// the friction of a joint with velocity dq = v / s, viscous while it is slow: it grows from zero,
/// dissipates only, and brakes no fast joint hard. Other directions stay as they are. No
/// allocation, noexcept.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

/// Torque on the twin that this damping takes, one entry per degree of freedom, opposed to the
/// motion; zero far from singular postures. `J_H` is the handle's Jacobian, whose last `n_m`
/// columns are those of the manipulator, `J_a` the end effector's by the twin's joints, M_a = L
/// L^T. The damping acts on the velocity at the end of a period of `dt` (s), which the torques
/// `tau` and the velocity `dq_a` lead to, so that it is stable however large it is.
VectorA lost_directions_torque(const model::Jacobian& J_H, int n_m, const model::Jacobian& J_a,
                               const MatrixA& L, const VectorA& dq_a, const VectorA& tau,
                               double dt) noexcept;

}  // namespace hg::rendering
