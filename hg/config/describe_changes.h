/// Description of scenario.yaml, second part: changes of the twin while it runs.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/describe_twin.h"
#include "hg/config/describe_twin_joints.h"
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

  void add(double at_s, Parameter parameter, int index, double value) {
    if (std::isnan(value)) return;
    changes.push_back({at_s, {parameter, static_cast<std::int16_t>(index), value}});
  }
};

/// Draft for the joints of `twin`, without changes.
inline ChangesDraft changes_of(const rendering::TwinModel& twin) {
  ChangesDraft draft;
  for (const model::Joint& joint : twin.chain.joints()) {
    const limits::JointLimits& limits = twin.dofs[static_cast<std::size_t>(joint.v_index)].limits;
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
  rendering::TwinDof dof;
  dof.stiffness = dof.rest = dof.preload = kNoDefault;
  dof.damping = dof.quadratic_damping = dof.friction = kNoDefault;
  limits::JointLimits limits = {kNoDefault, kNoDefault, kNoDefault, kNoDefault};
  describe_forces(v, dof, joint.unit);
  v.joint_number(kLowest, joint.unit, limits.q_min, kUnlimited, "lowest position");
  v.joint_number(kHighest, joint.unit, limits.q_max, kUnlimited, "highest position");
  v.joint_number(kSpeed, joint.unit, limits.dq_max, kPositiveOrNone, "largest speed");

  d.add(at_s, Parameter::kStiffness, joint.dof, dof.stiffness);
  d.add(at_s, Parameter::kRest, joint.dof, dof.rest);
  d.add(at_s, Parameter::kPreload, joint.dof, dof.preload);
  d.add(at_s, Parameter::kDamping, joint.dof, dof.damping);
  d.add(at_s, Parameter::kQuadraticDamping, joint.dof, dof.quadratic_damping);
  d.add(at_s, Parameter::kFriction, joint.dof, dof.friction);
  d.add(at_s, Parameter::kSpeedLimit, joint.dof, limits.dq_max);

  // one end after the other, so that the range is never empty
  if (limits.q_min > joint.range.ub) d.add(at_s, Parameter::kUpperLimit, joint.dof, limits.q_max);
  d.add(at_s, Parameter::kLowerLimit, joint.dof, limits.q_min);
  if (!(limits.q_min > joint.range.ub)) {
    d.add(at_s, Parameter::kUpperLimit, joint.dof, limits.q_max);
  }
  if (!std::isnan(limits.q_min)) joint.range.lb = limits.q_min;
  if (!std::isnan(limits.q_max)) joint.range.ub = limits.q_max;
  v.rule(!joint.range.empty(), kHighest.of(joint.unit), "q_max must not be below q_min",
         model::to_text(joint.range.ub) + " with q_min " + model::to_text(joint.range.lb));
}

template <class V>
void describe_floating_change(V& v, ChangesDraft& d, double at_s, int dof) {
  FloatingPart part = {kNoDefault, kNoDefault, kNoDefault, kNoDefault, {}};
  describe_forces(v, part);
  for (int i = 0; i < 3; ++i) {
    d.add(at_s, Parameter::kDamping, dof + i, part.damping);
    d.add(at_s, Parameter::kDamping, dof + 3 + i, part.angular_damping);
    d.add(at_s, Parameter::kFriction, dof + i, part.friction);
    d.add(at_s, Parameter::kFriction, dof + 3 + i, part.angular_friction);
  }
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
  ChangeJoint& joint = d.joints[static_cast<std::size_t>(index)];
  const bool has_joint = v.is_given("joint");
  if (v.covers(has_joint && !joint.is_floating)) describe_change(v, d, at_s, joint);
  if (v.covers(has_joint && joint.is_floating)) describe_floating_change(v, d, at_s, joint.dof);

  Eigen::Vector3d force = Eigen::Vector3d::Constant(kNoDefault), torque = force;
  describe_reference_wrench(v, force, torque);
  for (int i = 0; i < 3; ++i) d.add(at_s, Parameter::kReferenceWrench, i, force[i]);
  for (int i = 0; i < 3; ++i) d.add(at_s, Parameter::kReferenceWrench, 3 + i, torque[i]);
  bool gravity = false;
  if (v.flag("gravity", gravity, "whether the twin's links have weight")) {
    d.add(at_s, Parameter::kGravity, -1, gravity ? 1.0 : 0.0);
  }
  v.number("mass_scale", mass_scale,
           {.lb = rendering::kMassScale.lb, .ub = rendering::kMassScale.ub},
           "all masses and inertias times this");
  d.add(at_s, Parameter::kMassScale, -1, mass_scale);
  v.rule(d.changes.size() > before, "", "a change needs at least one value");
}

template <class V>
void describe_changes(V& v, ChangesDraft& d) {
  v.list(
      "changes", [&](auto& child) { describe(child, d); },
      "values of the twin that change during the run, approached within a second");
}

}  // namespace hg::config
