/// Description of the joints in twin.yaml.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/force_schema.h"
#include "hg/config/parameter_schema.h"
#include "hg/config/schema.h"
#include "hg/config/suspected_unit.h"
#include "hg/config/twin_draft.h"

namespace hg::config {

inline constexpr JointKey kStart = {"start_rad", "start_m"};

/// Damping and friction of a floating joint.
template <class V>
void describe_forces(V& v, FloatingPart& part) {
  for (std::size_t i = 0; i < kFloatingParameters.size(); ++i) {
    const FloatingParameter& key = kFloatingParameters[i];
    v.number(key.key, part.values[i], range_of(facts_of(key.parameter)), key.help);
  }
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
    v.group(
        "profile", [&](auto& child) { describe(child, dof.profile, joint.unit); },
        "torque and friction over the position of the joint, besides the others: detents, gas "
        "springs, latches");
    v.joint_number(kStart, joint.unit, joint.start, kAnyNumber,
                   "position at the start; without it the allowed one nearest to 0");
    v.rule(std::isnan(joint.start) ||
               (dof.limits.q_min <= joint.start && joint.start <= dof.limits.q_max),
           kStart.of(joint.unit), "the start must be within the limits",
           with_suspected_degrees(joint.start, dof.limits, joint.unit));
  }
  if (v.covers(is_floating)) describe(v, joint.floating);
}

template <class V>
void describe(V& v, rendering::CollisionSphere& sphere, const std::vector<std::string>& links) {
  v.name("link", sphere.frame, links, "a link of the URDF", "the link that carries it",
         Need::kRequired);
  v.vector("centre_m", sphere.p, kAnyNumber, "in the frame of the link");
  v.number("radius_m", sphere.radius, kNotNegative, "of the sphere; 0 is a corner");
}

template <class V>
void describe_joints(V& v, TwinDraft& d) {
  v.name("end_effector", d.end_effector, d.frame_names, "a link of the URDF",
         "frame E, held by the user", Need::kRequired);
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the twin",
      [&](auto& child, int index) { describe(child, d.joints[index]); },
      "limits, forces and start; limits, damping and friction that are not given are taken from "
      "the URDF");
  v.list(
      "collision_spheres",
      [&](auto& child) { describe(child, d.spheres.emplace_back(), d.frame_names); },
      "spheres on links of the twin that surfaces with 'contact: stop' keep out, as they keep the "
      "end effector out; at most 8");
  v.rule(d.spheres.size() <= rendering::kMaxSpheres, "collision_spheres", "at most 8 are possible");
  describe_wrench(v, Parameter::kReferenceWrench, d.force_ref, d.torque_ref);
  describe_mass_scale(v, d.mass_scale);
  describe_wrench(v, Parameter::kFeltScale, d.force_scale, d.torque_scale);
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
