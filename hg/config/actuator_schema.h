/// Description of joints with series elastic actuators and of their control in device.yaml.
#pragma once

#include <array>
#include <cmath>

#include "hg/config/device_draft.h"
#include "hg/config/schema.h"
#include "hg/signals/presliding.h"

namespace hg::config {

inline constexpr std::array<Choice<tracking::Method>, 3> kMethods = {
    {{"modal", tracking::Method::kModal},
     {"motor_pd", tracking::Method::kMotorPd},
     {"drives", tracking::Method::kDrives}}};

template <class V>
void describe(V& v, ActuatorModel& actuator) {
  constexpr auto kNeeded = Need::kRequired;
  v.number("rotor_inertia_kg_m2", actuator.rotor_inertia, kPositive,
           "of motor and gear at the output: motor inertia times ratio squared", kNeeded);
  v.number("stiffness_Nm_per_rad", actuator.stiffness, kPositive, "of gear and torque sensor",
           kNeeded);
  v.number("damping_Nms_per_rad", actuator.damping, kNotNegative, "in parallel with the stiffness");
  v.number("coulomb_friction_Nm", actuator.coulomb_friction, kNotNegative, "of motor and gear");
  v.number("viscous_friction_Nms_per_rad", actuator.viscous_friction, kNotNegative,
           "of motor and gear");
  v.number("load_friction", actuator.load_friction, kShare,
           "further Coulomb friction per torque of the joint");
  v.number("stiction", actuator.stiction, kFromOne, "break-away torque over Coulomb friction");
  v.number("stribeck_rad_per_s", actuator.stribeck_speed, kPositive,
           "speed at which stiction has mostly gone");
  v.number("presliding_rad", actuator.presliding, {.lb = 0.0, .ub = 0.01},
           "way until dry friction slips, as its feedforward has it; 0 = at once, its sign changes "
           "over friction_speed_rad_per_s");
  v.number("presliding_elements", actuator.presliding_elements,
           {.lb = 1.0, .ub = static_cast<double>(kSlipElements)},
           "equal elements in which it begins to slip, one after the other");
  v.rule(actuator.presliding_elements == std::floor(actuator.presliding_elements),
         "presliding_elements", "must be a whole number",
         model::to_text(actuator.presliding_elements));
  v.number("torque_max_Nm", actuator.torque_max, kPositive, "peak torque", kNeeded);
  v.number("torque_rated_Nm", actuator.torque_rated, kPositive, "that it gives for ever", kNeeded);
  v.number("full_torque_to_rad_per_s", actuator.speed_full_torque, kPositive,
           "speed up to which there is peak torque", kNeeded);
  v.number("no_load_rad_per_s", actuator.speed_no_load, kPositive,
           "speed at which no torque is left", kNeeded);
  v.rule(actuator.speed_no_load > actuator.speed_full_torque, "no_load_rad_per_s",
         "must be above full_torque_to_rad_per_s", model::to_text(actuator.speed_no_load));
  v.rule(actuator.torque_rated <= actuator.torque_max, "torque_rated_Nm",
         "must not be above torque_max_Nm", model::to_text(actuator.torque_rated));
}

template <class V>
void describe(V& v, tracking::ControlConfig& config) {
  v.choice(
      "method", config.method, kMethods,
      "modal: all states of the arm in its modes; motor_pd: each motor for itself; drives: the "
      "drives follow positions, and the law keeps the torques of their motors");
  if (!v.covers(config.method != tracking::Method::kDrives)) return;
  v.number("latency_s", config.loop.latency, {.lb = 0.0, .ub = 0.64},
           "expected from a sample to the torque at the drive; the true one is measured");
  v.number("current_lag_s", config.loop.current_lag, kNotNegative, "time constant of the current");
  v.number("integral_1_per_s", config.integral_rate, kNotNegative,
           "modal: rate at which a remaining error goes");
  v.number("flatness_Hz", config.flatness_Hz, kPositive,
           "low-pass of the derivatives of the torques fed forward");
  v.number("wrench_lead_s", config.wrench_lead, {.lb = 0.0, .ub = 0.01},
           "modal: by which the user's wrench is fed forward early, for what sensor, filter and "
           "springs cost");
  v.number("lead_low_pass_Hz", config.lead_low_pass_Hz, {.lb = 1.0, .ub = 200.0},
           "modal: low-pass of the wrench's rate of change, which wrench_lead_s takes");
  v.number("stiff_low_pass_Hz", config.stiff_low_pass_Hz, kNotNegative,
           "modal: low-pass of what is fed forward to stiff modes, 0 = none");
  v.number("rotor_pole_rad_per_s", config.poles.w0, {.lb = 1.0, .ub = 250.0},
           "modal: natural frequency of the shaped rotor on its spring");
  v.number("link_pole_rad_per_s", config.poles.w1, kPositive,
           "modal: natural frequency with which the links follow");
  v.number("link_damping", config.poles.z1, {.lb = 0.1, .ub = 2.0}, "modal: damping ratio of that");
  v.number("spring_damping", config.poles.z2, {.lb = 0.01, .ub = 1.0},
           "modal: damping ratio of each mode's fast oscillation");
  v.number("motor_pole_rad_per_s", config.poles.w_motor, kPositive,
           "modal: double pole of modes that are controlled from the motor side alone");
  v.number("error_max_rad", config.error_max, kPositive,
           "the reference is never further ahead of the joint: a joint that is held back takes "
           "reference and twin with it");
  v.number("friction_share", config.friction_share, {.lb = 0.0, .ub = 2.0},
           "of the Coulomb friction that is fed forward");
  v.number("friction_speed_rad_per_s", config.friction_speed, kPositive,
           "speed over which it changes its sign");
  v.number("friction_learning_1_per_s", config.friction_learning, kNotNegative,
           "modal: rate at which the true friction is learnt, 0 = never");
}

template <class V>
void describe_control(V& v, DeviceDraft& d) {
  v.groups_by_name(
      "actuators", d.joint_names, "a joint of the URDF",
      [&](auto& child, int index) { describe(child, d.joints[index].actuator.emplace()); },
      "motors and gears of all joints of the manipulator, or of none: without them the drives "
      "follow positions, and the law does not know their torques");
  v.rule(v.is_given("actuators") || !v.is_given("control"), "control",
         "concerns 'actuators', and there are none");
  if (v.is_given("actuators")) {
    d.device.control.method = tracking::Method::kModal;
    d.device.control.error_max = 0.007;  // [C] 6: 5 to 10 mrad
  }
  v.group(
      "control",
      [&](auto& child) {
        describe(child, d.device.control);
        const double longest = tracking::kMostLatency / d.device.model.rate_Hz;
        child.rule(d.device.control.loop.latency <= longest, "latency_s",
                   "must be at most 64 periods, " + model::to_text(longest) + " s at this rate_Hz",
                   model::to_text(d.device.control.loop.latency));
        const double most = tracking::largest_flatness_Hz(d.device.model.rate_Hz);
        child.rule(d.device.control.flatness_Hz < most, "flatness_Hz",
                   "must be below " + model::to_text(std::floor(10.0 * most) / 10.0) +
                       ", or the torques fed forward oscillate at this rate_Hz",
                   model::to_text(d.device.control.flatness_Hz));
      },
      "how motor torques make the joints follow the reference");
  if (d.device.control.method == tracking::Method::kDrives) d.device.control.error_max = kInfinity;
}

}  // namespace hg::config
