/// Description of the changes of the twin in a scenario.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/twin_schema.h"
#include "hg/signals/timed_changes.h"

namespace hg::config {

/// A joint of the twin, as needed to check changes.
struct ChangeJoint {
  JointUnit unit = JointUnit::kEither;
  bool is_floating = false;
  int dof = 0;     ///< index of its first degree of freedom
  Interval range;  ///< range of its positions, after the changes so far
};

/// Content of the list `changes`.
struct ChangesDraft {
  std::vector<std::string> joint_names;
  std::vector<ChangeJoint> joints;
  std::vector<TimedChange> changes;

  /// Whether a remote machine is concerned.
  bool concern_remote() const {
    return std::ranges::any_of(changes, [](const TimedChange& timed) {
      return facts_of(timed.change.parameter).owner == ParameterOwner::kRemote;
    });
  }
  void add(double at_s, Parameter parameter, int index, double value) {
    if (std::isnan(value)) return;
    changes.push_back({at_s, {parameter, static_cast<std::int16_t>(index), value}});
  }
};

/// Draft for the joints of `twin`, without changes.
inline ChangesDraft changes_of(const rendering::TwinModel& twin) {
  ChangesDraft draft;
  for (const model::Joint& joint : twin.chain.joints()) {
    const limits::JointLimits& limits = twin.dofs[joint.v_index].limits;
    draft.joint_names.push_back(joint.name);
    draft.joints.push_back({.unit = unit_of(joint.type),
                            .is_floating = joint.type == model::JointType::kFloating,
                            .dof = joint.v_index,
                            .range = {limits.q_min, limits.q_max}});
  }
  return draft;
}

template <class V>
void describe_change(V& v, ChangesDraft& d, double at_s, ChangeJoint& joint) {
  constexpr auto kNumber = [](Parameter parameter) { return index(parameter); };
  std::array<double, kParameters.size() + 1> values;  // by number of the parameter
  values.fill(kNoDefault);
  for (const ParameterFacts& facts : kParameters) {
    const bool is_of_joint =
        facts.owner == ParameterOwner::kDof || facts.owner == ParameterOwner::kJoint;
    if (!is_of_joint) continue;
    describe_parameter(v, facts.parameter, values[kNumber(facts.parameter)], joint.unit);
    const bool is_end =
        facts.parameter == Parameter::kLowerLimit || facts.parameter == Parameter::kUpperLimit;
    if (!is_end) d.add(at_s, facts.parameter, joint.dof, values[kNumber(facts.parameter)]);
  }

  // one end after the other, so that the range is never empty
  const double q_min = values[kNumber(Parameter::kLowerLimit)];
  const double q_max = values[kNumber(Parameter::kUpperLimit)];
  if (q_min > joint.range.ub) d.add(at_s, Parameter::kUpperLimit, joint.dof, q_max);
  d.add(at_s, Parameter::kLowerLimit, joint.dof, q_min);
  if (!(q_min > joint.range.ub)) d.add(at_s, Parameter::kUpperLimit, joint.dof, q_max);
  if (!std::isnan(q_min)) joint.range.lb = q_min;
  if (!std::isnan(q_max)) joint.range.ub = q_max;
  v.rule(!joint.range.empty(), key_of(facts_of(Parameter::kUpperLimit)).of(joint.unit),
         "q_max must not be below q_min",
         model::to_text(joint.range.ub) + " with q_min " + model::to_text(joint.range.lb));
}

template <class V>
void describe_floating_change(V& v, ChangesDraft& d, double at_s, int dof) {
  FloatingPart part;
  part.values.fill(kNoDefault);
  describe_forces(v, part);
  for (std::size_t k = 0; k < kFloatingParameters.size(); ++k) {
    const FloatingParameter& key = kFloatingParameters[k];
    for (int i = 0; i < 3; ++i) {
      d.add(at_s, key.parameter, dof + key.first_dof + i, part.values[k]);
    }
  }
}

template <class V>
void describe_wrench_change(V& v, ChangesDraft& d, double at_s, Parameter parameter) {
  Eigen::Vector3d force = Eigen::Vector3d::Constant(kNoDefault), torque = force;
  describe_wrench(v, parameter, force, torque);
  for (int i = 0; i < 3; ++i) d.add(at_s, parameter, i, force[i]);
  for (int i = 0; i < 3; ++i) d.add(at_s, parameter, 3 + i, torque[i]);
}

template <class V>
void describe_remote_change(V& v, ChangesDraft& d, double at_s, Parameter parameter) {
  const ParameterFacts& facts = facts_of(parameter);
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(kNoDefault);
  v.vector(facts.key, scale, {.lb = facts.range.lb, .ub = facts.range.ub},
           "of a teleoperation that leads a tool: " + std::string(facts.help));
  for (int i = 0; i < 3; ++i) d.add(at_s, parameter, i, scale[i]);
}

template <class V>
void describe(V& v, ChangesDraft& d) {
  const double last_s = d.changes.empty() ? 0.0 : d.changes.back().at_s;
  const std::size_t before = d.changes.size();
  double at_s = last_s, mass_scale = kNoDefault;
  v.number("at_s", at_s, kNotNegative, "when the change begins", Need::kRequired);
  v.rule(at_s >= last_s, "at_s", "changes must be in the order of their times");
  int index = 0;
  v.name("joint", index, d.joint_names, "a joint of the twin",
         "whose values change; the other keys are those of twin.yaml");
  ChangeJoint& joint = d.joints[index];
  const bool has_joint = v.is_given("joint");
  if (v.covers(has_joint && !joint.is_floating)) describe_change(v, d, at_s, joint);
  if (v.covers(has_joint && joint.is_floating)) describe_floating_change(v, d, at_s, joint.dof);

  describe_wrench_change(v, d, at_s, Parameter::kReferenceWrench);
  bool gravity = false;
  if (v.flag(facts_of(Parameter::kGravity).key, gravity, facts_of(Parameter::kGravity).help)) {
    d.add(at_s, Parameter::kGravity, -1, gravity ? 1.0 : 0.0);
  }
  describe_mass_scale(v, mass_scale);
  d.add(at_s, Parameter::kMassScale, -1, mass_scale);
  describe_wrench_change(v, d, at_s, Parameter::kFeltScale);
  describe_remote_change(v, d, at_s, Parameter::kMotionScale);
  describe_remote_change(v, d, at_s, Parameter::kForceScale);
  v.rule(d.changes.size() > before, "", "a change needs at least one value");
}

template <class V>
void describe_changes(V& v, ChangesDraft& d) {
  v.list(
      "changes", [&](auto& child) { describe(child, d); },
      "values of the twin that change during the run; changes that the hand feels are slow, up to "
      "some seconds");
}

}  // namespace hg::config
