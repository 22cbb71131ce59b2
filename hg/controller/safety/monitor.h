/// Checks measurements and results of the rendering law in every cycle against the rules of
/// rules.h.
///
/// Two parts: check_sensors() and check_solution() reject unusable data at once, watch() checks
/// everything that has a threshold. Not a certified safety function. No allocation, noexcept after
/// set-up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/shaking.h"
#include "hg/controller/safety/transitions.h"
#include "hg/core/fields.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

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

/// Properties of the other parts of a cycle on which the rules depend.
struct MonitoredParts {
  bool has_imu = true;  ///< false: the fields of the inertial unit are not checked
  /// false: the bounds of the law may ask for more than the rated accelerations.
  bool has_rated_bounds = true;
  bool looks_for_shaking = true;  ///< Warns when hand and device shake each other
  bool stops_shaking = false;     ///< Stops the device when the shaking lasts
  double twin_mass = 1.0;         ///< Largest mass of the twin felt at the handle, at the start, kg
};

/// Whether the handle is held, by the dead-man switch; always true without one.
inline bool is_held(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  return sensors.dead_man || !config.has_dead_man;
}

/// Whether force and torque at the handle are at most force_max and torque_max.
bool is_wrench_in_range(const MonitorConfig& config, const SensorFrame& sensors) noexcept;

/// First reason that makes a sample unusable, or kNone: the driver's own fault, a sample that is
/// not the next one, or `values`, the result of check_values().
Fault check_sensors(const SensorFrame& sensors, std::uint64_t expected_sequence,
                    const Fault& values) noexcept;

/// Fault that forbids integrating the accelerations that the law found, or kNone.
Fault check_solution(SolverStatus status, const VectorM& ddq_m, const VectorA& ddq_a) noexcept;

/// Results of estimation and rendering that the monitor compares.
struct Rendered {
  const RobotState& robot;
  /// Reference at the time of the sample, with the accelerations from there on.
  const ReferenceState& reference;
  std::span<const LimitReport> limits;   ///< Limits in the order of the catalogue
  double sync_error = 0.0;               ///< Distance of handle and twin, m
  const Eigen::Vector3d& v_H;            ///< Velocity of the handle at the reference, m/s
  const Eigen::Vector3d& contact_force;  ///< Force of virtual surfaces on the handle, N
  double oscillation = 0.0;              ///< PassivityReport::oscillation
};

/// Other monitored values of a cycle.
struct Watched {
  SafetyState state = SafetyState::kOff;  ///< State of the supervisor
  std::uint32_t late_cycles = 0;          ///< Late cycles since the last cycle
  VectorP dq_p_command;  ///< Velocity command that the gantry follows now, m/s or rad/s
  VectorM tau_m;         ///< Motor torques commanded a period ago, Nm; empty = none
  VectorM pulled_back;   ///< Shift of the reference back to the device, rad or m; empty = none
  /// Unexplained joint torques, TrackingReport::torque_unexplained; empty = none.
  VectorM unexplained;
  double turn = 0.0;              ///< Rotation of the gyroscope beyond the encoders', rad
  double turn_uncertainty = 0.0;  ///< Part of `turn` explained by the gyroscope's own errors, rad
  double slip = 0.0;              ///< Handle speed beyond the encoders', m/s
  double slip_uncertainty = 0.0;  ///< Part of `slip` explained by errors of level, m/s
};

/// Part of the copyable state of a cycle.
struct MonitorState {
  /// Consecutive samples in which each rule was broken.
  std::array<std::uint16_t, kRuleCount> broken{};
  bool is_broken = false;   ///< A rule was broken in the last cycle
  bool has_sample = false;  ///< The values below hold the last sample
  VectorM q_m, tau_m;
  VectorP q_p;
  Vector6 w_S = Vector6::Zero(), imu = Vector6::Zero();
  double time_s = 0.0;
  /// Consecutive samples with the same bits: joint torques, wrench and inertial unit.
  std::array<std::uint16_t, kMaxManipulator + 12> same{};
  double clock_error = 0.0;  ///< Mean error of the clock, periods per sample
  double late = 0.0;         ///< Late cycles minus those allowed since, >= 0
  int late_in_a_row = 0;
  VectorP dq_p_model;       ///< Gantry velocity by its drive model, m/s or rad/s
  VectorP gantry_gap;       ///< Gantry position off the drive model; fast forgetting
  VectorP gantry_drift;     ///< Gantry position off the drive model; slow forgetting
  VectorP gantry_way;       ///< Distance travelled by the model; slow forgetting
  VectorM pulled_back;      ///< Sum of the reference's shifts; forgotten after the last
  VectorM momentum;         ///< Motor momentum predicted from commands and springs, Nms
  VectorM lowest, highest;  ///< Allowed joint range: limits, extended to the position when armed
  VectorP lowest_p, highest_p;
  bool is_stopping = false;         ///< The values below belong to the present stop
  VectorM stop_from, braking_ramp;  ///< Joints: position at the start, position of the ramp
  VectorM ramp_speed;  ///< Joint speeds by the accelerations of the reference since the stop began
  /// Gantry: position at the start, position by the drive model.
  VectorP stop_from_p, braking_ramp_p;
  ShakingState shaking;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const MonitorState& state) {
  const auto& [broken, is_broken, has_sample, q_m, tau_m, q_p, w_S, imu, time_s, same, clock_error,
               late, late_in_a_row, dq_p_model, gantry_gap, gantry_drift, gantry_way, pulled_back,
               momentum, lowest, highest, lowest_p, highest_p, is_stopping, stop_from, braking_ramp,
               ramp_speed, stop_from_p, braking_ramp_p, shaking] = state;
  hash.mix(broken, same,
           static_cast<std::uint64_t>(late_in_a_row) | std::uint64_t{has_sample} << 62U |
               std::uint64_t{is_broken} << 63U,
           time_s, clock_error, late, w_S, imu, q_m, tau_m, pulled_back, momentum, lowest, highest,
           q_p, dq_p_model, gantry_gap, gantry_drift, gantry_way, lowest_p, highest_p, stop_from_p,
           braking_ramp_p, is_stopping, stop_from, braking_ramp, ramp_speed);
}

struct MonitorResult {
  Fault fault;  ///< Broken rule with the hardest reaction, or kNone
  /// Shaking of hand and device, if detected; otherwise the rule nearest to its threshold, once
  /// beyond its warning level. kNone without either.
  Fault warning;
};

class Monitor {
 public:
  Monitor(const MonitorConfig& config, const DeviceModel& device, const MonitoredParts& parts = {});

  const MonitorConfig& config() const noexcept { return config_; }

  /// Checks a cycle with usable sensors; call once per cycle, after the rendering. With unusable
  /// sensors call forget() instead.
  MonitorResult watch(const SensorFrame& sensors, const Rendered& rendered, const Watched& watched,
                      MonitorState& state) noexcept;

  /// Whether a position moved farther since the last sample than its rated speed and jump_factor
  /// allow.
  bool has_jumped(const SensorFrame& sensors, const MonitorState& state) const noexcept;

  /// Discards the last sample, so that the next one is not compared with it.
  static void forget(MonitorState& state) noexcept { state.has_sample = false; }

 private:
  // The largest share of its threshold that a rule has reached in this cycle.
  struct Worst {
    double share, value, limit;
    int index;
  };

  template <FaultCode kCode>
  void look(int index, double value, double limit) noexcept;
  void check_joint(int joint, const Rendered& rendered, const Watched& watched,
                   MonitorState& state) noexcept;
  void check_sensor_values(const SensorFrame& sensors, MonitorState& state) noexcept;
  void check_torques(const Watched& watched) noexcept;
  void check_inertial_unit(const Watched& watched) noexcept;
  void check_motors(const RobotState& robot, const Watched& watched, MonitorState& state) noexcept;
  void check_noise(const SensorFrame& sensors, MonitorState& state) noexcept;
  void check_gantry(const SensorFrame& sensors, const Rendered& rendered, const Watched& watched,
                    MonitorState& state) noexcept;
  void check_braking(const Rendered& rendered, const Watched& watched,
                     MonitorState& state) noexcept;
  void check_frames(const Rendered& rendered, const Watched& watched) noexcept;
  Fault look_for_shaking(const SensorFrame& sensors, const Rendered& rendered,
                         const Watched& watched, MonitorState& state) noexcept;
  void check_clocks(const SensorFrame& sensors, const Watched& watched,
                    MonitorState& state) noexcept;
  MonitorResult judge(MonitorState& state) const noexcept;

  MonitorConfig config_;
  MonitoredParts parts_;
  int n_p_, n_m_;
  double dt_;         ///< Period, s
  DriveModel drive_;  ///< Drive of every gantry axis
  std::vector<Interval> gantry_range_;
  std::vector<limits::JointLimits> joint_limits_;
  std::vector<ActuatorModel> actuators_;  ///< Actuators of the joints; empty: none
  std::vector<bool> is_slide_;            ///< Whether each joint is prismatic
  bool is_gantry_slide_;                  ///< Gantry axes are prismatic
  int end_cartesian_;    ///< Index one past the last Cartesian limit in the catalogue
  int first_cartesian_;  ///< Index of the first one, after joints, sums of joints and motors
  ShakingWatch shaking_;
  std::array<int, kRuleCount> debounce_{};  // samples
  std::array<Worst, kRuleCount> fresh_{};   // initial values of a cycle
  std::array<Worst, kRuleCount> worst_{};
};

}  // namespace hg::safety
