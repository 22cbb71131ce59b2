/// Part of a wrench on a twin's end effector that moves none of its joints.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

/// Returns the part of `w` in the null space of J^T: its distance from all wrenches J u. J may have
/// any rank; a column counts as dependent when the others leave less than 1e-12 of the largest one.
Vector6 bearing_wrench(const model::Jacobian& J, const Vector6& w) noexcept;

}  // namespace hg::rendering
