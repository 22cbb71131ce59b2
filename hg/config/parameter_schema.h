/// Description of the changeable parameters of twins.
#pragma once

#include "hg/config/schema.h"
#include "hg/signals/twin_parameter.h"

namespace hg::config {

/// Range of a parameter in the terms of the descriptions.
constexpr Range range_of(const ParameterFacts& facts) {
  return {.lb = facts.range.lb,
          .ub = facts.range.ub,
          .excludes_lb = facts.excludes_lb,
          .allows_infinity = facts.no_limit != 0.0};
}

constexpr JointKey key_of(const ParameterFacts& facts) { return {facts.key, facts.length_key}; }

/// A changeable parameter of a scalar joint.
template <class V>
void describe_parameter(V& v, Parameter parameter, double& value, JointUnit unit) {
  const ParameterFacts& facts = facts_of(parameter);
  v.joint_number(key_of(facts), unit, value, range_of(facts), facts.help);
}

/// A parameter with six components.
template <class V>
void describe_wrench(V& v, Parameter parameter, Eigen::Vector3d& force, Eigen::Vector3d& torque) {
  const ParameterFacts& facts = facts_of(parameter);
  v.group(
      facts.key,
      [&](auto& child) {
        for (const WrenchParameter& part : parts_of(parameter)) {
          child.vector(part.key, part.first_component == 0 ? force : torque, range_of(facts),
                       part.help);
        }
      },
      facts.help);
}

template <class V>
void describe_mass_scale(V& v, double& mass_scale) {
  const ParameterFacts& facts = facts_of(Parameter::kMassScale);
  v.number(facts.key, mass_scale, range_of(facts), facts.help);
}

}  // namespace hg::config
