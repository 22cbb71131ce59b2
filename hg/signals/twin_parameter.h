/// The parameters of a twin that may change while it runs: one table for twin.yaml, the changes of
/// a scenario, the form of the page, and the check in the control loop. The form offers a smaller,
/// usual range of each.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "hg/core/index.h"
#include "hg/core/interval.h"
#include "hg/signals/frames.h"

namespace hg {

/// What a parameter belongs to; says which ParameterChange::index is valid.
enum class ParameterOwner {
  kDof,     ///< any degree of freedom
  kJoint,   ///< a joint that is not floating: floating joints have neither springs nor limits
  kWrench,  ///< component 0..5: force x y z, torque x y z
  kTwin,    ///< the whole twin; the index does not matter
  kRemote   ///< axis 0..2 of the tool of a remote machine
};

struct ParameterFacts {
  Parameter parameter;
  ParameterOwner owner;
  std::string_view key;         ///< key in twin.yaml; of a joint, that of a revolute joint
  std::string_view length_key;  ///< key of a prismatic joint; empty for other owners
  std::string_view label;       ///< short name for a form
  std::string_view help;        ///< line on the reference page
  Interval range;               ///< allowed numbers, in the unit of the key
  bool excludes_lb = false;     ///< range.lb itself is not allowed
  double no_limit = 0.0;        ///< infinity that stands for "no limit"; 0 = none is allowed
};

/// Largest magnitude of a parameter that has no range of its own: keeps products finite.
inline constexpr double kLargestParameter = 1e9;
inline constexpr Interval kAnyValue = {-kLargestParameter, kLargestParameter};
inline constexpr Interval kFromZero = {0.0, kLargestParameter};
inline constexpr Interval kFactor = {0.1, 10.0};
inline constexpr Interval kRemoteFactor = {0.01, 100.0};

inline constexpr std::array<ParameterFacts, 15> kParameters = {{
    {Parameter::kStiffness, ParameterOwner::kJoint, "stiffness_Nm_per_rad", "stiffness_N_per_m",
     "stiffness", "spring", kFromZero},
    {Parameter::kRest, ParameterOwner::kJoint, "rest_rad", "rest_m", "rest",
     "where the spring is relaxed", kAnyValue},
    {Parameter::kPreload, ParameterOwner::kJoint, "preload_Nm", "preload_N", "preload",
     "constant pull towards smaller positions", kAnyValue},
    {Parameter::kDamping, ParameterOwner::kDof, "damping_Nms_per_rad", "damping_Ns_per_m",
     "damping", "viscous", kFromZero},
    {Parameter::kQuadraticDamping, ParameterOwner::kDof, "quadratic_damping_Nms2_per_rad2",
     "quadratic_damping_Ns2_per_m2", "quadratic damping",
     "force grows with the square of the speed", kFromZero},
    {Parameter::kFriction, ParameterOwner::kDof, "friction_Nm", "friction_N", "friction", "Coulomb",
     kFromZero},
    {Parameter::kLowerLimit, ParameterOwner::kJoint, "q_min_rad", "q_min_m", "lowest position",
     "lowest position", kAnyValue, false, -kInfinity},
    {Parameter::kUpperLimit, ParameterOwner::kJoint, "q_max_rad", "q_max_m", "highest position",
     "highest position", kAnyValue, false, kInfinity},
    {Parameter::kSpeedLimit, ParameterOwner::kJoint, "dq_max_rad_per_s", "dq_max_m_per_s",
     "largest speed", "largest speed", kFromZero, true, kInfinity},
    {Parameter::kReferenceWrench, ParameterOwner::kWrench, "reference_wrench", "",
     "reference wrench",
     "the wrench of the user at which the twin rests: what the user feels from it is the opposite",
     kAnyValue},
    {Parameter::kGravity,
     ParameterOwner::kTwin,
     "gravity",
     "",
     "gravity",
     "whether the twin's links have weight",
     {0.0, 1.0}},
    {Parameter::kMassScale, ParameterOwner::kTwin, "mass_scale", "", "mass scale",
     "all masses and inertias times this", kFactor},
    {Parameter::kFeltScale, ParameterOwner::kWrench, "felt_scale", "", "felt scale",
     "factors of the user's wrench on the twin: what the twin does is felt divided by them",
     kFactor},
    {Parameter::kMotionScale, ParameterOwner::kRemote, "motion_scale", "", "motion scale",
     "motion of the remote tool over that of the leader, along its axes", kRemoteFactor},
    {Parameter::kForceScale, ParameterOwner::kRemote, "force_scale", "", "force scale",
     "force on the leader over that on the remote tool, along its axes", kRemoteFactor},
}};

/// Facts of a parameter other than kNone.
constexpr const ParameterFacts& facts_of(Parameter parameter) noexcept {
  return kParameters[index(parameter) - 1];
}

/// Whether the table has the order of the enumeration, as facts_of() needs it.
constexpr bool is_in_order() noexcept {
  for (std::size_t i = 0; i < kParameters.size(); ++i) {
    if (index(kParameters[i].parameter) != i + 1) return false;
  }
  return true;
}
static_assert(is_in_order());

/// Whether `value` is a number of the range or stands for "no limit"; false for NaN.
constexpr bool allows(const ParameterFacts& facts, double value) noexcept {
  if (value == kInfinity || value == -kInfinity) return value == facts.no_limit;
  return facts.range.contains(value) && !(facts.excludes_lb && value == facts.range.lb);
}

/// One key of a floating joint, which sets a parameter of three degrees of freedom.
struct FloatingParameter {
  Parameter parameter;
  int first_dof;  ///< 0 = linear, 3 = angular
  std::string_view key, label, help;
};

inline constexpr std::array<FloatingParameter, 4> kFloatingParameters = {{
    {Parameter::kDamping, 0, "damping_Ns_per_m", "damping", "floating joint, linear"},
    {Parameter::kDamping, 3, "angular_damping_Nms_per_rad", "angular damping",
     "floating joint, angular"},
    {Parameter::kFriction, 0, "friction_N", "friction", "floating joint, linear Coulomb friction"},
    {Parameter::kFriction, 3, "angular_friction_Nm", "angular friction",
     "floating joint, angular Coulomb friction"},
}};

/// Force and torque of the reference wrench.
struct WrenchParameter {
  int first_component;
  std::string_view key, label, help;
};

inline constexpr std::array<WrenchParameter, 2> kWrenchParameters = {{
    {0, "force_N", "force", "at the end effector, along x, y, z of B"},
    {3, "torque_Nm", "torque", "about x, y, z of B"},
}};

/// The same of the scale of the felt wrench.
inline constexpr std::array<WrenchParameter, 2> kScaleParameters = {{
    {0, "force", "felt scale, force", "of forces along x, y, z of B"},
    {3, "torque", "felt scale, torque", "of torques about x, y, z of B"},
}};

/// Those of a parameter with six components.
constexpr const std::array<WrenchParameter, 2>& parts_of(Parameter parameter) noexcept {
  return parameter == Parameter::kFeltScale ? kScaleParameters : kWrenchParameters;
}

}  // namespace hg
