/// Values of a twin that may change while it runs, and their change without a jump.
///
/// A change sets a target. Every cycle the values in use approach their targets with a time
/// constant of 0.1 s and are exactly there when they differ by a billionth. Position limits travel
/// (limits::advanced) instead, no faster than bounds R bring the joint back under all speed limits
/// that hold. A speed limit that appears begins at the speed of the joint; one
/// that disappears is removed at once.
///
/// Part of the copyable state of a cycle; no allocation, noexcept. SI units.
#pragma once

#include <array>

#include "hg/controller/rendering/twin_model.h"
#include "hg/limits/moving_limits.h"
#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Values of one degree of freedom; see TwinDof.
struct DofValues {
  double stiffness = 0.0, rest = 0.0, preload = 0.0;
  double damping = 0.0, quadratic_damping = 0.0, friction = 0.0;
  double dq_max = kInfinity;
};

struct TwinValues {
  std::array<DofValues, kMaxTwin> dofs{};
  Vector6 w_ref = Vector6::Zero();
  model::Loads loads;
};

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
};

/// Parameters as the twin was set up, nothing changing.
TwinParameters initial_parameters(const TwinModel& twin);

/// Sets `change` as a target, or refuses it and changes nothing: unknown parameter or index, a
/// value outside the range of its Parameter, limits that would cross, no lower limit
/// where a closer measures from it.
[[nodiscard]] ChangeStatus apply(const TwinModel& twin, const ParameterChange& change,
                                 TwinParameters& parameters) noexcept;

/// Advances by one period: values approach their targets, limits travel, conditions are evaluated.
void advance_parameters(const TwinModel& twin, const TwinState& state, double dt,
                        TwinParameters& parameters) noexcept;

}  // namespace hg::rendering
