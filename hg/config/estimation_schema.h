/// Description of estimation and payload in device.yaml.
#pragma once

#include <algorithm>
#include <string>

#include "hg/config/device_draft.h"
#include "hg/config/schema.h"
#include "hg/controller/estimation/inertial_units.h"

namespace hg::config {

template <class V>
void describe(V& v, Payload& payload) {
  v.number("mass_kg", payload.mass, kNotNegative, "mass");
  v.vector("centre_of_mass_m", payload.com, kAnyNumber, "in the sensor's frame S");
  v.inertia("inertia_kg_m2", payload.inertia,
            "about the centre of mass, axes of S: [ixx, iyy, izz] or [ixx, iyy, izz, ixy, ixz, "
            "iyz]");
}

template <class V>
void describe_wrench(V& v, estimation::WrenchConfig& wrench) {
  v.number("wrench_low_pass_Hz", wrench.low_pass_Hz, kNotNegative,
           "first-order low-pass of the user's wrench, 0 = none; 50 for a noisy sensor");
  v.flag("has_imu", wrench.has_imu,
         "whether accelerometer and gyroscope in the sensor take part: then the payload's inertia "
         "is compensated, otherwise its weight alone, and they are compared with the "
         "encoders (rules 116, 117): they must be within 1 cm of the sensor's origin");
  v.number("angular_low_pass_Hz", wrench.alpha_low_pass_Hz, kNotNegative,
           "first-order low-pass of the gyroscope's differences, 0 = none");
  v.flag("needs_tare", wrench.tare.is_needed,
         "no arming before the force/torque sensor has been tared, with the handle not held");
  v.number("noise_N", wrench.tare.noise_force, kPositive,
           "rms of a force of the sensor: what varies more is not tared");
  v.number("noise_Nm", wrench.tare.noise_torque, kPositive, "rms of a torque of the sensor");
}

template <class V>
void describe_inertial_units(V& v, DeviceDraft& d) {
  estimation::InertialUnitsConfig& units = d.device.estimation.units;
  v.names("inertial_units", units.frames, d.frame_names, "a link of the chain",
          "links that carry an inertial unit, from root to tip; how it sits there is learnt");
  v.rule(units.frames.size() <= kMaxInertialUnits, "inertial_units",
         "at most " + std::to_string(kMaxInertialUnits) + " are possible",
         std::to_string(units.frames.size()));
  v.rule(std::ranges::is_sorted(units.frames), "inertial_units",
         "must be in the order from root to tip");
  v.number("inertial_delay_s", units.delay, kNotNegative,
           "from motion to reading; rounded to periods, at least one");
  const double longest = (estimation::InertialUnitsState::kPast - 2) / d.device.model.rate_Hz;
  v.rule(units.delay <= longest, "inertial_delay_s",
         "must be at most " + std::to_string(estimation::InertialUnitsState::kPast - 2) +
             " periods, here " + model::to_text(longest) + " s",
         model::to_text(units.delay));
  v.flag("inertial_feed_back", units.feeds_back,
         "true: the control uses what the units say; false: it is only recorded");
  const bool has_units = !units.frames.empty();
  for (const char* key : {"inertial_delay_s", "inertial_feed_back"}) {
    v.rule(has_units || !v.is_given(key), key, "concerns inertial_units, and there are none");
  }
}

template <class V>
void describe_estimation(V& v, DeviceDraft& d) {
  const bool has_gantry = !d.has_joints || !d.gantry.empty();
  v.group(
      "estimation",
      [&](auto& child) {
        child.number("observer_pole_Hz", d.device.estimation.observer_pole_Hz, kPositive,
                     "Kalman filter of the gantry: large trusts the encoder, small the drive");
        child.rule(has_gantry || !child.is_given("observer_pole_Hz"), "observer_pole_Hz",
                   "concerns the gantry, and there is none");
        child.number("link_pole_Hz", d.device.estimation.link_pole_Hz, kPositive,
                     "observer of the link side of elastic joints");
        child.number("motor_low_pass_Hz", d.device.estimation.motor_low_pass_Hz, kNotNegative,
                     "first-order low-pass of the motor side's speed, 0 = none");
        describe_wrench(child, d.device.estimation.wrench);
        describe_inertial_units(child, d);
      },
      "from sensors to state");
  v.group(
      "payload", [&](auto& child) { describe(child, d.device.estimation.wrench.payload); },
      "what hangs beyond the force/torque sensor, handle included; 'hapticgiant identify payload' "
      "measures it");
}

}  // namespace hg::config
