/// Description of device.yaml, in the order of its reference page.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "hg/config/actuator_schema.h"
#include "hg/config/behaviour_schema.h"
#include "hg/config/device_draft.h"
#include "hg/config/schema.h"

namespace hg::config {

/// Whether start posture and gantry target have a closed form.
inline constexpr std::array<Choice<bool>, 2> kKinematics = {
    {{"haptic_giant", true}, {"generic", false}}};

template <class V>
void describe_chain(V& v, DeviceDraft& d) {
  v.words("name", d.device.name, "name of the device", Need::kRequired);
  v.path("urdf", d.device.urdf, "kinematics and inertia; its limits are the defaults of joints",
         Need::kRequired);
}

/// The end effector: what the user holds, either a link of the URDF or a tool.
template <class V>
void describe_tool(V& v, DeviceDraft& d) {
  v.path("tool", d.tool, "handle with its sensor, screwed onto the flange: a tool file");
  v.name("flange", d.flange, d.link_names, "a link of the URDF", "to which the tool is screwed");
  v.rule(v.is_given("tool") == v.is_given("flange"), "tool",
         "a tool needs 'flange', and a flange needs 'tool'");
  v.rule(!v.is_given("tool") || !v.is_given("handle"), "handle",
         "the tool brings the handle: give either 'handle' or 'tool'");
  v.rule(!v.is_given("tool") || !v.is_given("sensor"), "sensor",
         "the file of the tool says where the sensor is");
  v.rule(v.is_given("tool") || v.is_given("handle"), "",
         "a device needs 'handle' (a link of the URDF) or 'tool' with 'flange'");
}

template <class V>
void describe_structure(V& v, DeviceDraft& d) {
  const bool has_gantry = v.names("gantry", d.gantry, d.joint_names, "a joint of the URDF",
                                  "prepositioning joints, from the root on: at most 2, prismatic "
                                  "or revolute; without it there is no gantry") ||
                          !v.is_given("gantry");
  const bool has_manipulator =
      v.names("manipulator", d.manipulator, d.joint_names, "a joint of the URDF",
              "the joints after the gantry, to the tip", Need::kRequired);
  d.has_joints = has_gantry && has_manipulator;
  v.name("handle", d.device.model.handle, d.frame_names, "a link of the URDF",
         "frame H, held by the user; with a tool it has the name 'handle'");
  v.name("elbow", d.device.model.elbow, d.frame_names, "a link of the URDF",
         "frame to be recorded and shown");
  v.number("floor_z_m", d.device.floor_z, kAnyNumber,
           "height of the floor in B: drawn on the page and, if given, not to be hit");
  d.device.has_floor = v.is_given("floor_z_m");
  v.group(
      "sensor", [&](auto& child) { describe(child, d.sensor); },
      "force/torque sensor S in the handle frame H");
  v.path("simulation", d.device.simulation_file,
         "of the simulated device: its sensors, and how it differs from this file; without it "
         "nothing differs and the sensors are ideal");
  v.choice("kinematics", d.device.model.has_closed_form, kKinematics,
           "how the start posture and the gantry's target are found: in closed form or, for any "
           "device, numerically");
  v.number("rate_Hz", d.device.model.rate_Hz, {.lb = 100.0, .ub = 20000.0}, "cycles per second");
}

template <class V>
void describe(V& v, DeviceJoint& joint, bool is_gantry) {
  describe_positions(v, joint.limits, joint.unit);
  if (v.covers(!is_gantry)) describe_ratings(v, joint.limits, joint.unit, Need::kOptional);
}

template <class V>
void describe(V& v, VirtualJoint& joint, const std::vector<std::string>& names) {
  v.words("name", joint.name, "shown with the limit", Need::kRequired);
  joint.weights = per_joint(names.size(), 0.0);
  v.numbers_by_name(
      "weights", names, "a manipulator joint", {.lb = -1e3, .ub = 1e3},
      [&](int index, double weight) { set_joint(joint.weights, index, weight); },
      "factor of each revolute joint in the sum");
  const bool is_complete = !names.empty() && names.size() <= kMaxManipulator;
  v.rule(!is_complete || joint.weights.norm() > 0.0, "weights",
         "at least one joint must have a weight");
  describe_positions(v, joint.limits, JointUnit::kAngle);
  describe_ratings(v, joint.limits, JointUnit::kAngle, Need::kRequired);
}

template <class V>
void describe(V& v, CartesianLimit& limit, const std::vector<std::string>& frames) {
  v.words("name", limit.name, "shown with the limit", Need::kRequired);
  v.name("frame", limit.frame, frames, "a link of the URDF", "its origin is limited",
         Need::kRequired);
  limits::JointLimits ratings = {.dq_max = 1.5, .ddq_max = 5.0};  // [HANDBOOK] 3.7
  describe_ratings(v, ratings, JointUnit::kLength, Need::kOptional);
  v.number("margin_m", limit.margin, kNotNegative, "the rendered box is smaller on every side");
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    limits::JointLimits axis = ratings;
    const auto read = [&](auto& child) { describe_positions(child, axis, JointUnit::kLength); };
    if (!v.group(kAxes[i], read, "along this axis of B; without it there is no limit")) continue;
    v.rule(axis.q_max - axis.q_min > 2.0 * limit.margin, kAxes[i],
           "the margin must leave some of the range");
    limit.axes[i] = axis;
  }
}

template <class V>
void describe_limits(V& v, DeviceDraft& d) {
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the URDF",
      [&](auto& child, int index) {
        const bool is_gantry = std::ranges::find(d.gantry, index) != d.gantry.end();
        describe(child, d.joints[index], is_gantry);
      },
      "limits; what is not given is taken from the URDF");
  d.device.model.posture = per_joint(d.manipulator_names.size(), kNoDefault);
  v.numbers_by_name(
      "posture", d.manipulator_names, "a manipulator joint", kJointPosition,
      [&](int index, double goal) { set_joint(d.device.model.posture, index, goal); },
      "where these joints should be, rad or m: the gantry moves so that they are, a seventh joint "
      "goes there, and the start is chosen near it");
  v.list(
      "virtual_joints",
      [&](auto& child) {
        describe(child, d.device.model.virtual_joints.emplace_back(), d.manipulator_names);
      },
      "limits of sums of joints, for example near a singularity; at most 2");
  v.list(
      "cartesian_limits",
      [&](auto& child) {
        describe(child, d.device.model.cartesian_limits.emplace_back(), d.frame_names);
      },
      "boxes in B, highest priority first; at most 2");
  v.rule(d.device.model.virtual_joints.size() <= kMaxVirtualJoints, "virtual_joints",
         "at most 2 are possible");
  v.rule(d.device.model.cartesian_limits.size() <= kMaxCartesianFrames, "cartesian_limits",
         "at most 2 are possible");
}

}  // namespace hg::config
