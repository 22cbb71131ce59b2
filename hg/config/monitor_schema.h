/// Description of monitor, sanitiser and start test in device.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/start_test_schema.h"
#include "hg/controller/safety/monitor.h"
#include "hg/controller/safety/sanitiser.h"
#include "hg/signals/start_test_config.h"

namespace hg::config {

/// Tolerances of forces, positions, speeds and torques.
template <class V>
void describe_tolerances(V& v, safety::MonitorConfig& monitor) {
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
}

/// Tolerances of the checks of sensors.
template <class V>
void describe_sensor_checks(V& v, safety::MonitorConfig& monitor) {
  v.number("plausibility_rad", monitor.plausibility, kPositive,
           "motor side minus twist of the spring minus link side of a joint; m where prismatic");
  v.number("gyroscope_tolerance_rad", monitor.gyroscope_tolerance, kPositive,
           "by how much the gyroscope may turn otherwise than the encoders within some seconds, "
           "besides 1.5 % of how far it turns and 0.3 % of its way there and back");
  v.number("accelerometer_tolerance_m_per_s", monitor.accelerometer_tolerance, kPositive,
           "by how much the handle may get faster than the encoders say, within half a second");
  v.number(
      "tilt_tolerance_rad", monitor.tilt_tolerance, kPositive,
      "largest angle between measured gravity and gravity by the posture when the device is armed");
  v.number("jump_factor", monitor.jump_factor, kFromOne,
           "times what the largest speed allows in a sample, of a measured position");
  v.number("frozen_samples", monitor.frozen_samples, kCount,
           "in a row with the same bits of wrench, inertial unit or a joint torque; 0: these "
           "sensors have no noise and are not checked");
  v.number("clock_tolerance", monitor.clock_tolerance, kTolerance,
           "mean error of the device's clock, periods per sample");
  v.number("temperature_max_C", monitor.temperature_max, kPositive, "of a motor");
}

/// Tolerances of the gantry.
template <class V>
void describe_gantry_checks(V& v, safety::MonitorConfig& monitor) {
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
}

/// Tolerances of stops and brakes.
template <class V>
void describe_stops(V& v, safety::MonitorConfig& monitor) {
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
void describe(V& v, safety::MonitorConfig& monitor) {
  describe_tolerances(v, monitor);
  describe_sensor_checks(v, monitor);
  describe_gantry_checks(v, monitor);
  v.number("safe_speed_m_per_s", monitor.safe_speed, kPositive,
           "of handle and gantry while the handle is not held");
  v.number("overruns_in_a_row", monitor.overruns_in_a_row, kCount,
           "cycles that may be late one after the other");
  v.number("overruns_per_s", monitor.overruns_per_s, kNotNegative,
           "cycles that may be late again and again");
  describe_stops(v, monitor);
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

}  // namespace hg::config
