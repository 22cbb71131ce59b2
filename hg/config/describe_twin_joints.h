/// Description of twin.yaml, second part: joints.
#pragma once

#include <cmath>

#include "hg/config/describe_twin.h"
#include "hg/config/describe_twin_conditions.h"

namespace hg::config {

inline constexpr JointKey kStart = {"start_rad", "start_m"};

/// Spring, dampers and friction of a scalar joint.
template <class V>
void describe_forces(V& v, rendering::TwinDof& dof, JointUnit unit) {
  v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, unit, dof.stiffness, kNotNegative,
                 "spring");
  v.joint_number({"rest_rad", "rest_m"}, unit, dof.rest, kAnyNumber, "where the spring is relaxed");
  v.joint_number({"preload_Nm", "preload_N"}, unit, dof.preload, kAnyNumber,
                 "constant pull towards smaller positions");
  v.joint_number({"damping_Nms_per_rad", "damping_Ns_per_m"}, unit, dof.damping, kNotNegative,
                 "viscous");
  v.joint_number({"quadratic_damping_Nms2_per_rad2", "quadratic_damping_Ns2_per_m2"}, unit,
                 dof.quadratic_damping, kNotNegative, "force grows with the square of the speed");
  v.joint_number({"friction_Nm", "friction_N"}, unit, dof.friction, kNotNegative, "Coulomb");
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

/// Damping and friction of a floating joint.
template <class V>
void describe_forces(V& v, FloatingPart& part) {
  v.number("damping_Ns_per_m", part.damping, kNotNegative, "floating joint, linear");
  v.number("angular_damping_Nms_per_rad", part.angular_damping, kNotNegative,
           "floating joint, angular");
  v.number("friction_N", part.friction, kNotNegative, "floating joint, linear Coulomb friction");
  v.number("angular_friction_Nm", part.angular_friction, kNotNegative,
           "floating joint, angular Coulomb friction");
}

template <class V>
void describe(V& v, FloatingPart& part) {
  describe_forces(v, part);
  v.group(
      "start",
      [&](auto& child) {
        child.number("x_m", part.start.p.x(), kAnyNumber, "in B");
        child.number("y_m", part.start.p.y(), kAnyNumber, "in B");
        child.number("z_m", part.start.p.z(), kAnyNumber, "in B");
        child.number("azimuth_rad", part.start.azimuth, kAnyNumber, "about z of B, last");
        child.number("pitch_rad", part.start.pitch, kAnyNumber, "0 = hand axis down, pi = up");
        child.number("roll_rad", part.start.roll, kAnyNumber, "about the hand axis, first");
      },
      "floating joint, pose of the end effector at the start: Rz(azimuth) Ry(pi - pitch) "
      "Rz(pi + roll)");
}

template <class V>
void describe(V& v, TwinJoint& joint) {
  rendering::TwinDof& dof = joint.dof;
  const bool is_floating = joint.type == model::JointType::kFloating;
  if (v.covers(!is_floating)) {
    describe_positions(v, dof.limits, joint.unit);
    describe_ratings(v, dof.limits, joint.unit, Need::kOptional);
    describe_forces(v, dof, joint.unit);
    v.group(
        "closer", [&](auto& child) { describe(child, dof.closer, dof.limits, joint.unit); },
        "pulls the joint towards its lower limit, and lets it close slowly");
    v.joint_number(kStart, joint.unit, joint.start, kAnyNumber,
                   "position at the start; without it the allowed one nearest to 0");
    v.rule(std::isnan(joint.start) ||
               (dof.limits.q_min <= joint.start && joint.start <= dof.limits.q_max),
           kStart.of(joint.unit), "the start must be within the limits",
           model::to_text(joint.start));
  }
  if (v.covers(is_floating)) describe(v, joint.floating);
}

template <class V>
void describe_joints(V& v, TwinDraft& d) {
  v.name("end_effector", d.end_effector, d.frame_names, "a link of the URDF",
         "frame E, held by the user", Need::kRequired);
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the twin",
      [&](auto& child, int index) { describe(child, d.joints[static_cast<std::size_t>(index)]); },
      "limits, forces and start; limits that are not given are taken from the URDF");
  describe_reference_wrench(v, d.force_ref, d.torque_ref);
  v.number("mass_scale", d.mass_scale,
           {.lb = rendering::kMassScale.lb, .ub = rendering::kMassScale.ub},
           "all masses and inertias times this");
  if (!v.covers(!d.scalar_joints.empty())) return;
  v.list(
      "conditional_limits",
      [&](auto& child) { describe(child, d.conditional_limits.emplace_back(), d); },
      "limits that hold under conditions, in addition to those of the joint; at most 4");
  v.rule(d.conditional_limits.size() <= rendering::kMaxConditionalLimits, "conditional_limits",
         "at most 4 are possible");
  v.list(
      "locks", [&](auto& child) { describe(child, d.locks.emplace_back(), d); },
      "joints that are held under conditions; at most 4");
  v.rule(d.locks.size() <= rendering::kMaxLocks, "locks", "at most 4 are possible");
}

}  // namespace hg::config
