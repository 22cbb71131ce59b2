/// Values of a twin that may change while it runs, and their change without a jump.
///
/// A change sets a target. Every cycle the values in use approach their targets with a time
/// constant of 0.1 s (a reference wrench that ends: 0.02 s), more slowly where the user would feel
/// a blow (hg/controller/rendering/value_steps.h), and are exactly there when they differ by a
/// billionth. Position limits travel (limits::advanced) instead, no faster than bounds R bring
/// the joint back under all speed limits that hold. A speed limit that appears begins at the speed
/// of the joint; one that disappears is removed at once.
///
/// Part of the copyable state of a cycle; no allocation, noexcept. SI units.
#pragma once

#include <array>

#include "hg/controller/rendering/twin_model.h"
#include "hg/limits/moving_limits.h"
#include "hg/model/chain_data.h"
#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Values of one degree of freedom; see TwinDof.
struct DofValues {
  double stiffness = 0.0, rest = 0.0, preload = 0.0;
  double damping = 0.0, quadratic_damping = 0.0, friction = 0.0;
  double dq_max = kInfinity;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const DofValues& values) {
  const auto& [stiffness, rest, preload, damping, quadratic_damping, friction, dq_max] = values;
  hash.mix(stiffness, rest, preload, damping, quadratic_damping, friction, dq_max);
}

struct TwinValues {
  std::array<DofValues, kMaxTwin> dofs{};
  Vector6 w_ref = Vector6::Zero();
  model::Loads loads;
  Vector6 felt_scale = Vector6::Ones();  ///< See TwinModel
};

/// Words of the state hash, in its order: those of the first `count` degrees of freedom, and the
/// scales where there are any.
void hashed(auto& hash, const TwinValues& values, int count) {
  const auto& [dofs, w_ref, loads, felt_scale] = values;
  hash.mix_first(dofs, count);
  hash.mix(w_ref, loads.mass, loads.gravity);
  if (felt_scale != Vector6::Ones()) hash.mix(felt_scale);
}

struct TwinParameters {
  TwinValues now;                          ///< Values in use
  TwinValues target;                       ///< Values that are approached
  std::array<Interval, kMaxTwin> range{};  ///< Position ranges, as set up or changed
  /// Position limits in use: `range` and the conditional limits that hold, travelling.
  std::array<limits::MovingLimits, kMaxTwin> moving{};
  /// Whether each conditional limit holds in this cycle.
  std::array<bool, kMaxConditionalLimits> holds{};
  /// Limits that were changed or have conditions: a joint may be found beyond them.
  std::array<bool, kMaxTwin> may_be_overrun{};
  /// Largest share that changes of values took in the last cycle of the rate of force that they
  /// may have; above 1 where they take long (hg/controller/rendering/value_steps.h).
  double pace = 0.0;
};

/// Words of the state hash, in its order: those of the first `dofs` degrees of freedom.
void hashed(auto& hash, const TwinParameters& parameters, int dofs) {
  const auto& [now, target, range, moving, holds, may_be_overrun, pace] = parameters;
  hashed(hash, now, dofs);
  hashed(hash, target, dofs);
  for (int i = 0; i < dofs; ++i) {
    hash.mix(range[i], moving[i].q, moving[i].is_crossed);
  }
  hash.mix(holds);
  hash.mix_first(may_be_overrun, dofs);
  if (pace > 0.0) hash.mix(pace);
}

/// Parameters as the twin was set up, nothing changing.
TwinParameters initial_parameters(const TwinModel& twin) noexcept;

/// Sets `change` as a target, or refuses it and changes nothing: unknown parameter or index, a
/// value outside the range of its Parameter, limits that would cross, no lower limit
/// where a closer measures from it.
[[nodiscard]] ChangeStatus apply(const TwinModel& twin, const ParameterChange& change,
                                 TwinParameters& parameters) noexcept;

/// Whether values are on their way whose change the user may feel, reference wrench and limits
/// aside.
bool is_changing(const TwinModel& twin, const TwinParameters& parameters) noexcept;

/// What decides how much of a change of values the user feels.
struct FeltBy {
  model::Jacobian J_a;  ///< Jacobian of the end effector
  VectorA motion;       ///< M_a ddq_a + c_a without weight, at the masses in use, Nm or N
  VectorA weight;       ///< Torques of the whole weight at the masses in use, Nm or N
  Vector6 w_H;          ///< Wrench of the user
};

/// Advances by one period: values approach their targets, limits travel, conditions are evaluated.
/// `felt` counts only while is_changing().
void advance_parameters(const TwinModel& twin, const TwinState& state, double dt,
                        const FeltBy& felt, TwinParameters& parameters) noexcept;

}  // namespace hg::rendering
