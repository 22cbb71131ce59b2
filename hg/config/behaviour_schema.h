/// Description of gantry drive, law and safety in device.yaml.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hg/config/collision_schema.h"
#include "hg/config/device_draft.h"
#include "hg/config/estimation_schema.h"
#include "hg/config/law_names.h"
#include "hg/config/monitor_schema.h"
#include "hg/config/motion_schema.h"
#include "hg/config/schema.h"

namespace hg::config {

template <class V>
void describe_drive(V& v, DeviceDraft& d) {
  v.group(
      "drive",
      [&](auto& child) {
        child.number("dead_time_s", d.device.model.drive.dead_time, kNotNegative,
                     "until a command has effect");
        child.number("lag_s", d.device.model.drive.lag, kPositive, "time constant of the speed");
        child.joint_number(kSpeed, d.gantry_unit, d.device.model.drive.dq_max, kPositive,
                           "largest speed");
        child.joint_number(kAcceleration, d.gantry_unit, d.device.model.drive.ddq_max, kPositive,
                           "largest acceleration");
        child.rule(std::lround(d.device.model.drive.dead_time * d.device.model.rate_Hz) <=
                       CommandDelay::kMaxPeriods,
                   "dead_time_s", "must be shorter than 256 cycles",
                   model::to_text(d.device.model.drive.dead_time));
      },
      "how the gantry follows its velocity command");
  v.group(
      "synchronisation",
      [&](auto& child) {
        child.number("kP_tran_1_per_s2", d.device.rendering.kP_tran, kPositive, "position");
        child.number("kD_tran_1_per_s", d.device.rendering.kD_tran, kPositive, "velocity");
        child.number("kP_rot_1_per_s2", d.device.rendering.kP_rot, kPositive, "orientation");
        child.number("kD_rot_1_per_s", d.device.rendering.kD_rot, kPositive, "angular velocity");
      },
      "gains that pull the handle onto the twin, eq. (11)");
}

template <class V>
void describe_contact(V& v, DeviceDraft& d) {
  v.group(
      "passivity",
      [&](auto& child) {
        child.choice("reaction", d.device.passivity.reaction, kPassivityReactions,
                     "to hand and device shaking each other: nothing, a warning, or "
                     "more inertia and damping of the twin until the shaking ends");
        child.number("damping_Ns_per_m", d.device.passivity.damping, kPositive,
                     "of the handle while shaking is damped, besides that of the twin");
        child.number("least_mass_kg", d.device.passivity.least_mass, kPositive,
                     "that is felt at the handle while shaking is damped");
      },
      "energy and oscillation at the handle, docs/concepts/passivity.md");
  v.group(
      "compliance",
      [&](auto& child) {
        child.flag("is_on", d.device.compliance.is_on,
                   "arm and gantry give way to what touches the arm, before the device stops; only "
                   "with torque sensors in the joints");
      },
      "contact anywhere along the arm, docs/concepts/compliance.md");
}

template <class V>
void describe_safety(V& v, DeviceDraft& d) {
  v.group(
      "collision", [&](auto& child) { describe_collision(child, d); },
      "self-collision, from the collision elements of the URDF and the capsules given here; "
      "docs/concepts/collision.md");
  for (double* distance :
       {&d.device.monitor.stop_distance, &d.device.monitor.slide_stop_distance,
        &d.device.monitor.gantry_stop_distance, &d.device.monitor.turn_stop_distance}) {
    *distance = kNoDefault;  // from the ratings
  }
  v.group(
      "monitor", [&](auto& child) { describe(child, d.device.monitor); },
      "when the device is stopped by a fault, docs/concepts/safety.md");
  v.group(
      "sanitiser", [&](auto& child) { describe(child, d.device.sanitiser); },
      "what is taken out of commands near and beyond limits, docs/concepts/safety.md");
  v.group(
      "start_test", [&](auto& child) { describe(child, d.device.start_test); },
      "brakes and stop inputs before the first run of a day, docs/reference/start_test.md");
}

template <class V>
void describe_behaviour(V& v, DeviceDraft& d) {
  for (const char* key : {"drive", "prepositioning"}) {
    v.rule(!d.has_joints || !d.gantry.empty() || !v.is_given(key), key,
           "concerns the gantry, and there is none");
  }
  describe_drive(v, d);
  v.group(
      "rendering", [&](auto& child) { describe(child, d.device.rendering, d.manipulator.size()); },
      "the law, see docs/concepts/law.md");
  describe_prepositioning(v, d);
  describe_estimation(v, d);
  describe_contact(v, d);
  describe_safety(v, d);
}

}  // namespace hg::config
