/// Description of the forces of a joint in twin.yaml.
#pragma once

#include <cmath>
#include <vector>

#include "hg/config/parameter_schema.h"
#include "hg/config/schema.h"
#include "hg/config/twin_draft.h"

namespace hg::config {

/// Spring, dampers and friction of a scalar joint.
template <class V>
void describe_forces(V& v, rendering::TwinDof& dof, JointUnit unit) {
  describe_parameter(v, Parameter::kStiffness, dof.stiffness, unit);
  describe_parameter(v, Parameter::kRest, dof.rest, unit);
  describe_parameter(v, Parameter::kPreload, dof.preload, unit);
  describe_parameter(v, Parameter::kDamping, dof.damping, unit);
  describe_parameter(v, Parameter::kQuadraticDamping, dof.quadratic_damping, unit);
  describe_parameter(v, Parameter::kFriction, dof.friction, unit);
}

template <class V>
void describe(V& v, rendering::Closer& closer, const limits::JointLimits& limits, JointUnit unit) {
  v.joint_number({"torque_Nm", "force_N"}, unit, closer.torque, kNotNegative,
                 "pull at the lower limit");
  v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, unit, closer.stiffness,
                 kNotNegative, "how much more it pulls away from there");
  v.joint_number({"speed_rad_per_s", "speed_m_per_s"}, unit, closer.speed, kPositiveOrNone,
                 "largest speed towards the lower limit");
  v.rule(std::isfinite(limits.q_min), "", "a closer needs a joint with a lower limit");
}

/// Torque and friction over position.
template <class V>
void describe(V& v, rendering::Profile& profile, JointUnit unit) {
  std::vector<rendering::ProfilePoint> points;
  double repeat = kInfinity;
  v.joint_number({"repeat_rad", "repeat_m"}, unit, repeat, kPositiveOrNone,
                 "the points begin again after this distance; without it the torque beyond them is "
                 "that of the nearest one");
  v.list(
      "points",
      [&](auto& child) {
        rendering::ProfilePoint& point = points.emplace_back();
        child.joint_number({"at_rad", "at_m"}, unit, point.q, kAnyNumber, "position",
                           Need::kRequired);
        child.joint_number({"torque_Nm", "force_N"}, unit, point.torque, kAnyNumber,
                           "pull towards smaller positions there");
        child.joint_number({"friction_Nm", "friction_N"}, unit, point.friction, kNotNegative,
                           "Coulomb friction there, besides that of the joint");
      },
      "2 .. 100, by position; between them smooth, and never beyond the two neighbours",
      Need::kRequired);
  const std::string fault = rendering::profile_fault(points, repeat);
  v.rule(fault.empty(), "points", fault);
  if (fault.empty()) profile = rendering::Profile(points, repeat);
}

}  // namespace hg::config
