/// Joint velocities for a wanted twist.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain.h"

namespace hg::rendering {

/// The shortest joint velocity (n_a) of those that come nearest to a twist, by the Jacobian (6 x
/// n_a) of the frame that is to move with it. Does not allocate.
VectorA shortest_velocity(const model::Jacobian& jacobian, const Vector6& twist) noexcept;

}  // namespace hg::rendering
