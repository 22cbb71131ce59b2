/// State of the rendering law from cycle to cycle.
#pragma once

#include "hg/controller/rendering/paper_law.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/controller/rendering/twin_forces.h"
#include "hg/core/types.h"
#include "hg/hqp/solution.h"
#include "hg/signals/added_impedance.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Part of the copyable state of a cycle.
struct RenderingState {
  ReferenceState reference;
  TwinState twin;
  TwinInnerState inner;
  AddedImpedance added;  ///< In the next step; see hg/controller/safety/passivity
  /// Wrench on the handle that stands for a contact of the arm, in the next step.
  Vector6 touch = Vector6::Zero();
  hqp::ActiveSet active_set;
  TouchedEnds touched;  ///< Limit ends touched by the last result; law paper only
  VectorP ddq_p;        ///< Gantry acceleration demanded by the last result; empty: none
  /// Motor torques demanded by the last result, Nm or N; empty: none, or not known.
  VectorM motor_torque;
  surfaces::EnvironmentState contact;
};

/// Words of the state hash, in its order; `rows` of the active set are in use. `touch` is hashed by
/// the cycle, where contacts of the arm are detected.
void hashed(auto& hash, const RenderingState& state, int rows) {
  const auto& [reference, twin, inner, added, touch, active_set, touched, ddq_p, motor_torque,
               contact] = state;
  hash.mix(reference, twin);
  hashed(hash, inner, static_cast<int>(twin.dq_a.size()));
  hash.mix_first(active_set.state, rows);
  hash.mix_first(active_set.before, rows);
  hash.mix(touched, added, contact, motor_torque, ddq_p);
}

}  // namespace hg::rendering
