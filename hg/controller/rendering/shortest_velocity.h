/// Joint velocities for a given twist.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

/// Shortest joint velocity (n_a) among those nearest to a twist, for the Jacobian (6 x n_a) of the
/// frame to be moved. Does not allocate.
VectorA shortest_velocity(const model::Jacobian& jacobian, const Vector6& twist) noexcept;

}  // namespace hg::rendering
