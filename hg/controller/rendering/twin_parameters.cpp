#include "hg/controller/rendering/twin_parameters.h"

#include <algorithm>
#include <cmath>

#include "hg/controller/rendering/value_steps.h"
#include "hg/core/index.h"
#include "hg/signals/twin_parameter.h"

namespace hg::rendering {
namespace {

constexpr double kEnd = 0.02;  // s; of a reference wrench that ends: its source may be gone

void approach_speed_limit(double& now, double target, double speed, double share) noexcept {
  if (std::isinf(target)) now = target;
  if (std::isinf(now)) now = std::max(target, speed);
  approach(now, target, share);
}

DofValues values_of(const TwinDof& dof) noexcept {
  return {.stiffness = dof.stiffness,
          .rest = dof.rest,
          .preload = dof.preload,
          .damping = dof.damping,
          .quadratic_damping = dof.quadratic_damping,
          .friction = dof.friction,
          .dq_max = dof.limits.dq_max};
}

// location of the value of `parameter`; nullptr for limits of position and unknown parameters
double* place_of(Parameter parameter, std::size_t index, TwinValues& values) noexcept {
  DofValues& dof = values.dofs[std::min(index, values.dofs.size() - 1)];
  switch (parameter) {
    case Parameter::kStiffness:
      return &dof.stiffness;
    case Parameter::kRest:
      return &dof.rest;
    case Parameter::kPreload:
      return &dof.preload;
    case Parameter::kDamping:
      return &dof.damping;
    case Parameter::kQuadraticDamping:
      return &dof.quadratic_damping;
    case Parameter::kFriction:
      return &dof.friction;
    case Parameter::kSpeedLimit:
      return &dof.dq_max;
    case Parameter::kReferenceWrench:
      return &values.w_ref[std::min<std::size_t>(index, 5)];
    case Parameter::kGravity:
      return &values.loads.gravity;
    case Parameter::kMassScale:
      return &values.loads.mass;
    case Parameter::kFeltScale:
      return &values.felt_scale[std::min<std::size_t>(index, 5)];
    case Parameter::kNone:
    case Parameter::kLowerLimit:
    case Parameter::kUpperLimit:
    case Parameter::kMotionScale:
    case Parameter::kForceScale:
      return nullptr;
  }
  return nullptr;
}

// whether the twin has such a parameter
bool is_index(const TwinModel& twin, const ParameterChange& change) noexcept {
  const int count = static_cast<int>(twin.dofs.size());
  const bool is_dof = change.index >= 0 && change.index < count;
  switch (facts_of(change.parameter).owner) {
    case ParameterOwner::kDof:
      return is_dof;
    case ParameterOwner::kJoint:
      return is_dof && twin.dofs[change.index].q_index >= 0;
    case ParameterOwner::kWrench:
      return change.index >= 0 && change.index < 6;
    case ParameterOwner::kTwin:
      return true;
    case ParameterOwner::kRemote:
      return change.index >= 0 && change.index < 3;
  }
  return false;
}

// the range of a joint and of the conditional limits that hold
Interval target_range(const TwinModel& twin, int dof, const TwinParameters& parameters) noexcept {
  Interval range = parameters.range[dof];
  for (std::size_t i = 0; i < twin.conditional_limits.size(); ++i) {
    const ConditionalLimit& limit = twin.conditional_limits[i];
    if (limit.dof != dof || !parameters.holds[i]) continue;
    range.lb = std::max(range.lb, limit.limits.q_min);
    range.ub = std::min(range.ub, limit.limits.q_max);
  }
  return range;
}

// the smallest speed limit that holds now, in whichever direction
double slowest(const TwinModel& twin, int dof, const TwinParameters& parameters) noexcept {
  double speed = std::min(parameters.now.dofs[dof].dq_max, twin.dofs[dof].closer.speed);
  for (std::size_t i = 0; i < twin.conditional_limits.size(); ++i) {
    const ConditionalLimit& limit = twin.conditional_limits[i];
    if (limit.dof != dof || !parameters.holds[i]) continue;
    speed = std::min(speed, limit.limits.dq_max);
  }
  return speed;
}

}  // namespace

TwinParameters initial_parameters(const TwinModel& twin) noexcept {
  TwinParameters parameters;
  for (std::size_t i = 0; i < twin.dofs.size(); ++i) {
    const TwinDof& dof = twin.dofs[i];
    parameters.target.dofs[i] = values_of(dof);
    parameters.range[i] = {dof.limits.q_min, dof.limits.q_max};
    parameters.moving[i].q = parameters.range[i];
  }
  for (const ConditionalLimit& limit : twin.conditional_limits) {
    parameters.may_be_overrun[limit.dof] = true;
  }
  parameters.target.w_ref = twin.w_ref;
  parameters.target.felt_scale = twin.felt_scale;
  parameters.target.loads = {.mass = twin.mass_scale,
                             .gravity = twin.chain.default_loads().gravity};
  parameters.now = parameters.target;
  return parameters;
}

ChangeStatus apply(const TwinModel& twin, const ParameterChange& change,
                   TwinParameters& parameters) noexcept {
  if (change.parameter == Parameter::kNone) return ChangeStatus::kNone;
  const bool is_known = index(change.parameter) <= kParameters.size();
  if (!is_known || !is_index(twin, change) || !allows(facts_of(change.parameter), change.value)) {
    return ChangeStatus::kRefused;
  }
  if (facts_of(change.parameter).owner == ParameterOwner::kRemote) return ChangeStatus::kTaken;
  const std::size_t index = std::max<int>(change.index, 0);
  if (double* place = place_of(change.parameter, index, parameters.target)) {
    *place = change.value;
    if (change.parameter == Parameter::kSpeedLimit) parameters.may_be_overrun[index] = true;
    return ChangeStatus::kTaken;
  }
  Interval range = parameters.range[index];
  (change.parameter == Parameter::kLowerLimit ? range.lb : range.ub) = change.value;
  const bool is_rest_of_closer = twin.dofs[index].closer.stiffness > 0.0;
  if (range.empty() || (is_rest_of_closer && std::isinf(range.lb))) return ChangeStatus::kRefused;
  parameters.range[index] = range;
  parameters.may_be_overrun[index] = true;
  return ChangeStatus::kTaken;
}

bool is_changing(const TwinModel& twin, const TwinParameters& parameters) noexcept {
  const TwinValues& now = parameters.now;
  const TwinValues& target = parameters.target;
  const auto is_there = [](const DofValues& a, const DofValues& b) {
    return a.stiffness == b.stiffness && a.rest == b.rest && a.preload == b.preload &&
           a.damping == b.damping && a.quadratic_damping == b.quadratic_damping &&
           a.friction == b.friction;
  };
  return now.loads.mass != target.loads.mass || now.loads.gravity != target.loads.gravity ||
         now.felt_scale != target.felt_scale ||
         !std::equal(now.dofs.begin(), now.dofs.begin() + twin.dofs.size(), target.dofs.begin(),
                     is_there);
}

void advance_parameters(const TwinModel& twin, const TwinState& state, double dt,
                        const FeltBy& felt, TwinParameters& parameters) noexcept {
  const double share = share_of_step(dt, kApproach);
  TwinValues& now = parameters.now;
  const TwinValues& target = parameters.target;
  for (std::size_t i = 0; i < twin.conditional_limits.size(); ++i) {
    parameters.holds[i] = are_true(twin, twin.conditional_limits[i].conditions, state.q_a);
  }
  for (std::size_t i = 0; i < twin.dofs.size(); ++i) {
    const int dof = static_cast<int>(i);
    approach_speed_limit(now.dofs[i].dq_max, target.dofs[i].dq_max, std::abs(state.dq_a[dof]),
                         share);

    if (twin.dofs[i].q_index < 0) continue;
    limits::JointLimits rated = twin.dofs[i].limits;
    rated.dq_max = slowest(twin, dof, parameters);
    const double v_rec = limits::recoverable_options(rated, dt, dt).v_rec;
    parameters.moving[i] =
        limits::advanced(parameters.moving[i], target_range(twin, dof, parameters),
                         position_of(twin, dof, state.q_a), v_rec, dt);
  }
  const double wrench_share = target.w_ref.isZero(0.0) ? share_of_step(dt, kEnd) : share;
  for (int i = 0; i < 6; ++i) approach(now.w_ref[i], target.w_ref[i], wrench_share);
  if (is_changing(twin, parameters)) approach_targets(twin, state, dt, felt, parameters);
}

}  // namespace hg::rendering
