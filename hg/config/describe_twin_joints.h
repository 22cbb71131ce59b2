/// Description of twin.yaml, second part: joints and locks.
#pragma once

#include <cmath>

#include "hg/config/describe_twin.h"

namespace hg::config {

inline constexpr JointKey kStart = {"start_rad", "start_m"};
inline constexpr JointKey kLockPosition = {"position_rad", "position_m"};

template <class V>
void describe(V& v, FloatingPart& part) {
  v.number("damping_Ns_per_m", part.damping, kNotNegative, "floating joint, linear");
  v.number("angular_damping_Nms_per_rad", part.angular_damping, kNotNegative,
           "floating joint, angular");
  v.number("friction_N", part.friction, kNotNegative, "floating joint, linear Coulomb friction");
  v.number("angular_friction_Nm", part.angular_friction, kNotNegative,
           "floating joint, angular Coulomb friction");
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
    v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, joint.unit, dof.stiffness,
                   kNotNegative, "spring");
    v.joint_number({"rest_rad", "rest_m"}, joint.unit, dof.rest, kAnyNumber,
                   "where the spring is relaxed");
    v.joint_number({"preload_Nm", "preload_N"}, joint.unit, dof.preload, kAnyNumber,
                   "constant pull towards smaller positions");
    v.joint_number({"damping_Nms_per_rad", "damping_Ns_per_m"}, joint.unit, dof.damping,
                   kNotNegative, "viscous");
    v.joint_number({"friction_Nm", "friction_N"}, joint.unit, dof.friction, kNotNegative,
                   "Coulomb");
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
void describe(V& v, rendering::Lock& lock, const TwinDraft& d) {
  v.words("name", lock.name, "shown while it holds", Need::kRequired);
  int index = 0;
  v.name("joint", index, d.scalar_names, "a joint of the twin", "the joint that is held",
         Need::kRequired);
  const TwinJoint& joint = d.scalar_joint(index);
  lock.dof = joint.v_index;
  v.joint_number(kLockPosition, joint.unit, lock.position, kAnyNumber, "where it is held");
  v.rule(joint.dof.limits.q_min <= lock.position && lock.position <= joint.dof.limits.q_max,
         kLockPosition.of(joint.unit), "must be within the limits of the joint",
         model::to_text(lock.position));
  v.groups_by_name(
      "engaged_while", d.scalar_names, "a joint of the twin",
      [&](auto& child, int other) {
        const JointUnit unit = d.scalar_joint(other).unit;
        Interval range;
        child.joint_number({"above_rad", "above_m"}, unit, range.lb, kAnyNumber, "lower end");
        child.joint_number({"below_rad", "below_m"}, unit, range.ub, kAnyNumber, "upper end");
        child.rule(range.bounded() && !range.empty(), "",
                   "the condition needs 'above' or 'below', and something between them");
        lock.engaged_while.push_back({.dof = d.scalar_joint(other).v_index, .range = range});
      },
      "the lock holds while each of these joints is in its range; without it, always");
}

template <class V>
void describe_joints(V& v, TwinDraft& d) {
  v.name("end_effector", d.end_effector, d.frame_names, "a link of the URDF",
         "frame E, held by the user", Need::kRequired);
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the twin",
      [&](auto& child, int index) { describe(child, d.joints[static_cast<std::size_t>(index)]); },
      "limits, forces and start; limits that are not given are taken from the URDF");
  if (!v.covers(!d.scalar_joints.empty())) return;
  v.list(
      "locks", [&](auto& child) { describe(child, d.locks.emplace_back(), d); },
      "joints that are held under conditions; at most 4");
  v.rule(d.locks.size() <= rendering::kMaxLocks, "locks", "at most 4 are possible");
}

}  // namespace hg::config
