/// Thresholds of the monitor.
#pragma once

namespace hg::safety {

/// Set-up data. Values from [HANDBOOK] 6.2 unless noted; differences are explained in
/// docs/concepts/safety.md.
struct MonitorConfig {
  double force_max = 150.0;  ///< Largest force of the user, N
  double torque_max = 14.0;  ///< Largest torque of the user, Nm; the sensor's range ends at 15
  bool has_dead_man = true;  ///< false: the handle counts as held all the time
  double position_tolerance = 0.03;   ///< Tolerance beyond the limit of a revolute joint, rad
  double slide_tolerance = 0.03;      ///< Tolerance beyond the limit of a prismatic joint, m
  double virtual_tolerance = 0.05;    ///< Tolerance beyond the limit of a sum of joints, rad or m
  double cartesian_tolerance = 0.03;  ///< Tolerance outside a Cartesian limit, m
  double speed_tolerance = 1.1;       ///< Largest speed of a joint or gantry axis, times the rating
  /// Largest acceleration, times the rating; bounds may use 1.5 of it.
  double acceleration_tolerance = 2.0;
  double torque_tolerance = 1.0;  ///< Largest joint torque, times the peak torque
  double motor_tolerance = 0.15;  ///< Motor torque off command and friction, times the peak torque
  double unexplained_tolerance = 0.1;      ///< Unexplained joint torque, times the peak torque
  double tracking_tolerance = 0.08;        ///< Largest reference minus measured joint, rad
  double slide_tracking_tolerance = 0.02;  ///< Largest reference minus measured prismatic joint, m
  double sync_tolerance = 0.02;            ///< Largest distance between handle and twin, m
  double plausibility = 0.02;  ///< Largest motor side minus spring minus link side, rad or m
  double gyroscope_tolerance = 0.015;  ///< Largest rotation of the gyroscope off the encoders, rad
  double accelerometer_tolerance = 0.15;  ///< Handle speed by accelerometer off the encoders, m/s
  double tilt_tolerance = 0.1;            ///< Angle of gravity off the posture when armed, rad
  double jump_factor = 3.0;               ///< Largest step in a sample, times that at rated speed
  double clock_tolerance = 0.2;           ///< Largest mean error of the clock, periods per sample
  double temperature_max = 90.0;          ///< Largest motor temperature, degrees Celsius
  double gantry_tolerance = 0.02;  ///< Tolerance beyond the range of a prismatic gantry axis, m
  double turn_tolerance = 0.03;    ///< Tolerance beyond the range of a revolute gantry axis, rad
  double gantry_deviation = 0.25;  ///< Prismatic gantry axis: speed off the drive model, m/s
  double turn_deviation = 0.25;    ///< Revolute gantry axis: speed off the drive model, rad/s
  double gantry_gap = 0.03;        ///< Prismatic gantry axis: position off the drive model, m
  double turn_gap = 0.03;          ///< Revolute gantry axis: position off the drive model, rad
  /// Like gantry_gap, within a minute, besides 0.5 % of the axis' way, m.
  double gantry_drift = 0.06;
  /// Like turn_gap, within a minute, besides 0.5 % of the axis' way, rad.
  double turn_drift = 0.06;
  double safe_speed = 0.25;    ///< Largest speed of handle and gantry in autonomous operation, m/s
  double stop_time = 1.0;      ///< Longest duration of a controlled stop, s
  double stop_distance = 0.8;  ///< Largest travel of a revolute joint in a stop, rad
  double slide_stop_distance = 0.6;   ///< Largest travel of a prismatic joint in a stop, m
  double gantry_stop_distance = 0.6;  ///< Largest travel of a prismatic gantry axis in a stop, m
  double turn_stop_distance = 0.8;    ///< Largest travel of a revolute gantry axis in a stop, rad
  double braking_gap = 0.025;         ///< Revolute joint: position off the braking ramp, rad
  double slide_braking_gap = 0.02;    ///< Prismatic joint: position off the braking ramp, m
  double braking_deviation = 0.25;    ///< Revolute joint: speed off the braking ramp, rad/s
  double slide_braking_deviation = 0.25;  ///< Prismatic joint: speed off the braking ramp, m/s
  // limits of brakes.h
  double brake_slip = 0.1;         ///< Slip tolerance of a revolute axis with closed brake, rad
  double slide_brake_slip = 0.05;  ///< Slip tolerance of a prismatic axis with closed brake, m
  double frozen_samples = 0;       ///< Samples allowed with the same bits; 0: sensors have no noise
  double overruns_in_a_row = 2;    ///< Consecutive late cycles allowed
  double overruns_per_s = 5;       ///< Long-term rate of late cycles allowed, 1/s

  /// Largest travel of a manipulator joint in a stop, rad or m.
  double stop_distance_of_joint(bool is_slide) const noexcept {
    return is_slide ? slide_stop_distance : stop_distance;
  }
  /// Largest travel of any gantry axis in a stop, m or rad.
  double stop_distance_of_gantry(bool is_slide) const noexcept {
    return is_slide ? gantry_stop_distance : turn_stop_distance;
  }
};

}  // namespace hg::safety
