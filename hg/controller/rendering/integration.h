/// One sample of constant acceleration; [HG] sec. VI-E.
#pragma once

#include "hg/model/chain_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Integrates the reference: q += dt dq + dt^2/2 ddq, dq += dt ddq.
void integrate(ReferenceState& reference, double dt) noexcept;

/// Integrates the twin on its configuration space: orientations stay orientations.
void integrate(const model::ChainModel& chain, TwinState& twin, double dt) noexcept;

}  // namespace hg::rendering
