/// Description of device.yaml, second part: drive, gains, estimation, monitor.
#pragma once

#include <algorithm>
#include <cmath>

#include "hg/config/describe_device.h"
#include "hg/config/describe_estimation.h"
#include "hg/config/law_names.h"

namespace hg::config {

template <class V>
void describe(V& v, safety::MonitorConfig& monitor) {
  v.number("force_max_N", monitor.force_max, kPositive, "force of the user");
  v.number("torque_max_Nm", monitor.torque_max, kPositive, "torque of the user");
  v.number("position_tolerance_rad", monitor.position_tolerance, kPositive,
           "beyond the limit of a revolute joint");
  v.number("position_tolerance_m", monitor.slide_tolerance, kPositive,
           "beyond the limit of a prismatic joint");
  v.number("cartesian_tolerance_m", monitor.cartesian_tolerance, kPositive,
           "outside a Cartesian limit");
  v.number("speed_tolerance", monitor.speed_tolerance, kFromOne, "times the largest speed");
  v.number("virtual_tolerance_rad", monitor.virtual_tolerance, kPositive,
           "beyond the limit of a virtual joint; m where its joints are prismatic");
  v.number("acceleration_tolerance", monitor.acceleration_tolerance, kFromOne,
           "times the largest acceleration of a joint, of its reference");
  v.number("torque_tolerance", monitor.torque_tolerance, kTolerance,
           "times the peak torque of a joint");
  v.number("unexplained_tolerance", monitor.unexplained_tolerance, kTolerance,
           "joint torque that motion and user's wrench do not explain, times its peak torque");
  v.number("motor_tolerance", monitor.motor_tolerance, kTolerance,
           "torque of a motor off its command and friction, times its peak torque");
  v.number("sync_tolerance_m", monitor.sync_tolerance, kPositive, "between handle and twin");
  v.number("tracking_tolerance_rad", monitor.tracking_tolerance, kPositive,
           "between reference and measured position of a revolute joint");
  v.number("tracking_tolerance_m", monitor.slide_tracking_tolerance, kPositive,
           "the same of a prismatic joint");
  v.number("plausibility_rad", monitor.plausibility, kPositive,
           "motor side minus twist of the spring minus link side of a joint; m where prismatic");
  v.number("gyroscope_tolerance_rad", monitor.gyroscope_tolerance, kPositive,
           "by how much the gyroscope may turn otherwise than the encoders within some seconds, "
           "besides 1.5 % of how far it turns and 0.3 % of its way there and back");
  v.number("accelerometer_tolerance_m_per_s", monitor.accelerometer_tolerance, kPositive,
           "by how much the handle may get faster than the encoders say, within half a second");
  v.number(
      "tilt_tolerance_rad", monitor.tilt_tolerance, kPositive,
      "by how much gravity may point elsewhere than the posture says when the device is armed");
  v.number("jump_factor", monitor.jump_factor, kFromOne,
           "times what the largest speed allows in a sample, of a measured position");
  v.number("frozen_samples", monitor.frozen_samples, kCount,
           "in a row with the same bits of wrench, inertial unit or a joint torque; 0: these "
           "sensors have no noise, nobody can tell");
  v.number("clock_tolerance", monitor.clock_tolerance, kTolerance,
           "mean error of the device's clock, periods per sample");
  v.number("temperature_max_C", monitor.temperature_max, kPositive, "of a motor");
  v.number("gantry_tolerance_m", monitor.gantry_tolerance, kPositive,
           "beyond the range of a prismatic axis of the gantry");
  v.number("gantry_tolerance_rad", monitor.turn_tolerance, kPositive,
           "beyond the range of a revolute axis of the gantry");
  v.number("gantry_deviation_m_per_s", monitor.gantry_deviation, kPositive,
           "speed of a prismatic axis of the gantry from what its drive should do");
  v.number("gantry_deviation_rad_per_s", monitor.turn_deviation, kPositive,
           "the same of a revolute axis");
  v.number("gantry_gap_m", monitor.gantry_gap, kPositive,
           "of a prismatic axis of the gantry from where its drive should have taken it; an error "
           "is forgotten within two seconds");
  v.number("gantry_gap_rad", monitor.turn_gap, kPositive, "the same of a revolute axis");
  v.number("gantry_drift_m", monitor.gantry_drift, kPositive,
           "the same of a prismatic axis, besides 0.5 % of its way, where an error is forgotten "
           "within a minute: encoders that drift, drives that creep");
  v.number("gantry_drift_rad", monitor.turn_drift, kPositive, "the same of a revolute axis");
  v.number("safe_speed_m_per_s", monitor.safe_speed, kPositive,
           "of handle and gantry while nobody holds the handle");
  v.number("overruns_in_a_row", monitor.overruns_in_a_row, kCount,
           "cycles that may be late one after the other");
  v.number("overruns_per_s", monitor.overruns_per_s, kNotNegative,
           "cycles that may be late again and again");
  v.number("stop_time_s", monitor.stop_time, kPositive,
           "that a controlled stop may take before the drives are switched off");
  v.number(
      "stop_distance_rad", monitor.stop_distance, kPositive,
      "that a revolute joint may move in a stop; the brakes close at 90 % of it; not given: 1.25 "
      "times what a stop from full speed needs");
  v.number("stop_distance_m", monitor.slide_stop_distance, kPositive,
           "the same of a prismatic joint");
  v.number("gantry_stop_distance_m", monitor.gantry_stop_distance, kPositive,
           "the same of a prismatic axis of the gantry");
  v.number("gantry_stop_distance_rad", monitor.turn_stop_distance, kPositive,
           "the same of a revolute axis of the gantry");
  v.number("braking_gap_rad", monitor.braking_gap, kPositive,
           "of a revolute joint in a stop from where its reference has led");
  v.number("braking_gap_m", monitor.slide_braking_gap, kPositive, "the same of a prismatic joint");
  v.number("braking_deviation_rad_per_s", monitor.braking_deviation, kPositive,
           "of its speed from that of its reference");
  v.number("braking_deviation_m_per_s", monitor.slide_braking_deviation, kPositive,
           "the same of a prismatic joint");
  v.number("brake_slip_rad", monitor.brake_slip, kPositive,
           "that a revolute joint or axis may move at rest with its brake closed, once the device "
           "had power; a machine without brakes needs a large one");
  v.number("brake_slip_m", monitor.slide_brake_slip, kPositive, "the same of a prismatic one");
}

template <class V>
void describe(V& v, safety::SanitiserConfig& sanitiser) {
  v.flag("strict", sanitiser.is_strict,
         "cut torques to 0 instead of to the torque that holds the joint");
  v.number("margin_rad", sanitiser.margin, kNotNegative, "beyond the limit of a revolute joint");
  v.number("margin_m", sanitiser.slide_margin, kNotNegative,
           "beyond the limit of a prismatic joint");
  v.number("torque_rise_s", sanitiser.torque_rise, kPositive, "from no torque to the peak torque");
}

template <class V>
void describe(V& v, StartTestConfig& test, const std::vector<std::string>& input_names) {
  std::vector<int> inputs;
  if (v.names("inputs", inputs, input_names, "an input of the safety controller",
              "that this device has and a person operates in the test; without it all, but for the "
              "dead-man switch of a tool that has none")) {
    test.has_input.fill(false);
    for (const int input : inputs) test.has_input[static_cast<std::size_t>(input)] = true;
  }
  v.number("valid_for_s", test.valid_for_s, kPositive, "how long the result of a test counts");
  v.number("brake_motion_rad", test.brake_motion, kPositive,
           "that a braked revolute joint or axis may move under its load");
  v.number("brake_motion_m", test.slide_brake_motion, kPositive, "the same of a prismatic one");
  v.number("posture_rad", test.posture, kPositive,
           "that a revolute joint or axis may stand elsewhere than the last run has left it");
  v.number("posture_m", test.slide_posture, kPositive, "the same of a prismatic one");
}

template <class V>
void describe(V& v, rendering::Options& options, std::size_t manipulator_joints) {
  v.choice("law", options.law, kLaws, "how limits become forces; paper needs six joints");
  v.choice("bounds", options.bounds, kBounds, "how limits become bounds on accelerations");
  v.choice("gantry", options.gantry, kGantries,
           "what moves the gantry: with law gauss its accelerations can be unknowns of the law");
  v.choice("braking", options.braking, kBrakings,
           "how motors brake before limits: before each by itself, or before all that are near "
           "together, where law and bounds know the motors");
  v.number("T_C_s", options.T_C, kPositive,
           "bounds paper: time within which virtual joints and frames return, at least a period");
  v.number("solver_budget", options.solver_budget, kCount,
           "active sets after which the solver of a cycle ends with what it has, all limits of the "
           "device kept; 0: it goes on until its result is proven");
  v.rule(options.solver_budget == std::floor(options.solver_budget), "solver_budget",
         "must be a whole number", model::to_text(options.solver_budget));
  v.number("kP_posture_1_per_s2", options.kP_posture, kNotNegative,
           "of a seventh joint, towards its goal");
  v.number("kD_posture_1_per_s", options.kD_posture, kNotNegative, "of a seventh joint, damping");
  v.rule(options.law != rendering::Law::kPaper || manipulator_joints <= 6, "law",
         "paper needs six manipulator joints: use gauss", "'paper'");
}

template <class V>
void describe_prepositioning(V& v, DeviceDraft& d) {
  // values not given stay within the drive's limits
  d.prepositioning.dq_max = std::min(d.prepositioning.dq_max, d.drive.dq_max);
  d.prepositioning.drive.ddq_max = std::min(d.prepositioning.drive.ddq_max, d.drive.ddq_max);
  v.group(
      "prepositioning",
      [&](auto& child) {
        child.number("k_ppu_1_per_s", d.prepositioning.k_ppu, kPositive, "gain, eq. (27)");
        child.joint_number(kSpeed, d.gantry_unit, d.prepositioning.dq_max, kPositive,
                           "largest speed used, never above that of the drive");
        child.joint_number(
            kBrake, d.gantry_unit, d.prepositioning.drive.ddq_max, kPositive,
            "deceleration that can be relied on, never above the drive's acceleration");
        child.rule(d.prepositioning.dq_max <= d.drive.dq_max, kSpeed.of(d.gantry_unit),
                   "must not exceed the speed of the drive, " + model::to_text(d.drive.dq_max),
                   model::to_text(d.prepositioning.dq_max));
        child.rule(
            d.prepositioning.drive.ddq_max <= d.drive.ddq_max, kBrake.of(d.gantry_unit),
            "must not exceed the acceleration of the drive, " + model::to_text(d.drive.ddq_max),
            model::to_text(d.prepositioning.drive.ddq_max));
      },
      "how the gantry moves along with the hand");
}

template <class V>
void describe_behaviour(V& v, DeviceDraft& d) {
  for (const char* key : {"drive", "prepositioning"}) {
    v.rule(!d.has_joints || !d.gantry.empty() || !v.is_given(key), key,
           "concerns the gantry, and there is none");
  }
  v.group(
      "drive",
      [&](auto& child) {
        child.number("dead_time_s", d.drive.dead_time, kNotNegative, "until a command has effect");
        child.number("lag_s", d.drive.lag, kPositive, "time constant of the speed");
        child.joint_number(kSpeed, d.gantry_unit, d.drive.dq_max, kPositive, "largest speed");
        child.joint_number(kAcceleration, d.gantry_unit, d.drive.ddq_max, kPositive,
                           "largest acceleration");
        child.rule(std::lround(d.drive.dead_time * d.rate_Hz) <= CommandDelay::kMaxPeriods,
                   "dead_time_s", "must be shorter than 256 cycles",
                   model::to_text(d.drive.dead_time));
      },
      "how the gantry follows its velocity command");
  v.group(
      "synchronisation",
      [&](auto& child) {
        child.number("kP_tran_1_per_s2", d.rendering.kP_tran, kPositive, "position");
        child.number("kD_tran_1_per_s", d.rendering.kD_tran, kPositive, "velocity");
        child.number("kP_rot_1_per_s2", d.rendering.kP_rot, kPositive, "orientation");
        child.number("kD_rot_1_per_s", d.rendering.kD_rot, kPositive, "angular velocity");
      },
      "gains that pull the handle onto the twin, eq. (11)");
  v.group(
      "rendering", [&](auto& child) { describe(child, d.rendering, d.manipulator.size()); },
      "the law, see docs/concepts/law.md");
  describe_prepositioning(v, d);
  describe_estimation(v, d);
  v.group(
      "passivity",
      [&](auto& child) {
        child.choice("reaction", d.passivity.reaction, kPassivityReactions,
                     "to hand and device shaking each other: nothing, a warning, or "
                     "more inertia and damping of the twin until they are calm");
        child.number("damping_Ns_per_m", d.passivity.damping, kPositive,
                     "of the handle while it is calmed, besides that of the twin");
        child.number("least_mass_kg", d.passivity.least_mass, kPositive,
                     "that is felt at the handle while it is calmed");
      },
      "energy and oscillation at the handle, docs/concepts/passivity.md");
  v.group(
      "compliance",
      [&](auto& child) {
        child.flag("is_on", d.compliance.is_on,
                   "arm and gantry give way to what touches the arm, before the device stops; only "
                   "with torque sensors in the joints");
      },
      "contact anywhere along the arm, docs/concepts/compliance.md");
  v.group(
      "collision",
      [&](auto& child) {
        child.flag("is_watched", d.watches_collisions,
                   "stop before the device hits itself, its frame or the floor");
        child.number("safe_distance_m", d.safe_distance, kPositive,
                     "between any two parts while the device brakes");
      },
      "self-collision, from the collision elements of the URDF; docs/concepts/collision.md");
  for (double* distance : {&d.monitor.stop_distance, &d.monitor.slide_stop_distance,
                           &d.monitor.gantry_stop_distance, &d.monitor.turn_stop_distance}) {
    *distance = kNoDefault;  // from the ratings
  }
  v.group(
      "monitor", [&](auto& child) { describe(child, d.monitor); },
      "when the device is stopped by a fault, docs/concepts/safety.md");
  v.group(
      "sanitiser", [&](auto& child) { describe(child, d.sanitiser); },
      "what is taken out of commands near and beyond limits, docs/concepts/safety.md");
  v.group(
      "start_test", [&](auto& child) { describe(child, d.start_test, d.input_names); },
      "brakes and stop inputs before the first run of a day, docs/reference/start_test.md");
}

}  // namespace hg::config
