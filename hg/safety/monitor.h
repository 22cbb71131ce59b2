/// Watches what was measured and what the law wants, in every cycle, against the rules of rules.h.
///
/// Two parts: check_sensors() and check_solution() say at once what must not be used, watch() looks
/// at everything that has a threshold. Not a certified safety function. No allocation, noexcept
/// after set-up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hg/core/interval.h"
#include "hg/safety/rules.h"
#include "hg/safety/shaking.h"
#include "hg/safety/transitions.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Set-up data. [HANDBOOK] 6.2 where nothing else is said; docs/safety.md says where it differs.
struct MonitorConfig {
  double force_max = 150.0;                ///< of the user, N
  double torque_max = 14.0;                ///< Nm; the sensor ends at 15
  bool has_dead_man = true;                ///< false: the handle counts as held all the time
  bool has_imu = true;                     ///< false: nobody looks at what its fields hold
  double position_tolerance = 0.03;        ///< beyond the limit of a revolute joint, rad
  double slide_tolerance = 0.03;           ///< beyond the limit of a prismatic joint, m
  double virtual_tolerance = 0.05;         ///< beyond the limit of a sum of joints, rad or m
  double cartesian_tolerance = 0.03;       ///< outside a Cartesian limit, m
  double speed_tolerance = 1.1;            ///< times the rating
  double acceleration_tolerance = 2.0;     ///< times the rating; bounds may take 1.5 of it
  double torque_tolerance = 1.0;           ///< times the peak torque
  double motor_tolerance = 0.15;           ///< off its command and friction, times the peak torque
  double unexplained_tolerance = 0.1;      ///< joint torque, times the peak torque
  double tracking_tolerance = 0.08;        ///< reference minus measured joint, rad
  double slide_tracking_tolerance = 0.02;  ///< the same of a prismatic joint, m
  double sync_tolerance = 0.02;            ///< between handle and twin, m
  double plausibility = 0.02;              ///< motor side minus spring minus link side, rad or m
  double gyroscope_tolerance = 0.015;      ///< of the gyroscope from the encoders, rad
  double accelerometer_tolerance = 0.15;   ///< of the handle's speed from the encoders, m/s
  double tilt_tolerance = 0.1;             ///< of gravity from the posture when armed, rad
  double jump_factor = 3.0;                ///< times what the speed rating allows in a sample
  double clock_tolerance = 0.2;            ///< mean error of the clock, periods per sample
  double temperature_max = 90.0;           ///< of a motor, degrees Celsius
  double gantry_tolerance = 0.02;          ///< beyond the range of a prismatic axis, m
  double turn_tolerance = 0.03;            ///< beyond the range of a revolute axis, rad
  double gantry_deviation = 0.25;          ///< from the speed of the drive model, m/s
  double turn_deviation = 0.25;            ///< the same of a revolute axis, rad/s
  double gantry_gap = 0.03;                ///< from where its drive model takes it, m
  double turn_gap = 0.03;                  ///< the same of a revolute axis, rad
  double gantry_drift = 0.06;             ///< the same within a minute, besides 0.5 % of its way, m
  double turn_drift = 0.06;               ///< the same of a revolute axis, rad
  double safe_speed = 0.25;               ///< of handle and gantry with nobody at it, m/s
  double stop_time = 1.0;                 ///< that a controlled stop may take, s
  double stop_distance = 0.8;             ///< that a revolute joint may move in a stop, rad
  double slide_stop_distance = 0.6;       ///< the same of a prismatic joint, m
  double gantry_stop_distance = 0.6;      ///< of a prismatic axis of the gantry, m
  double turn_stop_distance = 0.8;        ///< of a revolute axis of the gantry, rad
  double braking_gap = 0.025;             ///< of a joint that is stopped from its reference, rad
  double slide_braking_gap = 0.02;        ///< the same of a prismatic joint, m
  double braking_deviation = 0.25;        ///< of its speed from the reference's, rad/s
  double slide_braking_deviation = 0.25;  ///< the same of a prismatic joint, m/s
  // of brakes.h
  double brake_slip = 0.1;         ///< of a revolute axis with its brake closed, rad
  double slide_brake_slip = 0.05;  ///< the same of a prismatic one, m
  double frozen_samples = 0;       ///< with the same bits; 0: sensors have no noise
  double overruns_in_a_row = 2;    ///< late cycles that may follow each other
  double overruns_per_s = 5;       ///< late cycles that may come again and again
  bool looks_for_shaking = true;   ///< hand and device shake each other: a warning
  bool stops_shaking = false;      ///< a stop, where it lasts

  // what device and twin are
  double twin_mass = 1.0;                  ///< felt at the handle where most, at the start, kg
  double dt = 1e-3;                        ///< period, s
  double gantry_speed_max = 1.5;           ///< of commands, m/s or rad/s
  DriveModel drive;                        ///< of every gantry axis
  bool is_gantry_slide = true;             ///< its axes are prismatic
  std::vector<Interval> gantry_range;      ///< of the axes
  std::vector<Interval> joint_range;       ///< of the manipulator joints
  std::vector<bool> is_slide;              ///< joints that are prismatic; empty = none
  std::vector<double> joint_speed_max;     ///< rad/s or m/s
  std::vector<double> joint_acceleration;  ///< ratings; empty = none
  std::vector<ActuatorModel> actuators;    ///< of the joints; empty: drives follow positions
  int first_cartesian = 0;  ///< Cartesian limits in the catalogue: first and one past the last;
  int end_cartesian = 0;    ///< sums of joints stand between them and the joints

  /// How far a manipulator joint may move in a stop, rad or m.
  double stop_distance_of_joint(int joint) const noexcept {
    const auto i = static_cast<std::size_t>(joint);
    return i < is_slide.size() && is_slide[i] ? slide_stop_distance : stop_distance;
  }
  /// The same of any axis of the gantry, m or rad.
  double stop_distance_of_gantry() const noexcept {
    return is_gantry_slide ? gantry_stop_distance : turn_stop_distance;
  }
};

/// Whether somebody holds the handle, as far as the device can tell.
inline bool is_held(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  return sensors.dead_man || !config.has_dead_man;
}

/// Whether every measured value is a number: others must not reach the estimation.
bool is_finite(const MonitorConfig& config, const SensorFrame& sensors) noexcept;

/// Whether force and torque at the handle are below those that stop the device.
bool is_wrench_in_range(const MonitorConfig& config, const SensorFrame& sensors) noexcept;

/// The first thing that makes a sample unusable, or kNone.
Fault check_sensors(const MonitorConfig& config, const SensorFrame& sensors,
                    std::uint64_t expected_sequence) noexcept;

/// Whether the rendering gave a solution that may be integrated; the fault, or kNone.
Fault check_solution(const CycleRecord& record) noexcept;

/// What of a cycle is watched, besides sensors and record.
struct Watched {
  State state = State::kOff;      ///< of the supervisor
  std::uint32_t late_cycles = 0;  ///< since the last cycle
  VectorP dq_p_command;           ///< that the gantry follows now
  VectorM tau_m;                  ///< that the motors were told a period ago; empty = none
  VectorM pulled_back;  ///< by how much the reference had to come back to the device; empty = not
  VectorM unexplained;  ///< joint torques, TrackingReport::torque_unexplained; empty = none
  double turn = 0.0;    ///< of the gyroscope beyond what the encoders say, rad
  double turn_uncertainty = 0.0;  ///< of it, by the gyroscope's own errors, rad
  double slip = 0.0;              ///< speed of the handle beyond what the encoders say, m/s
  double slip_uncertainty = 0.0;  ///< of it, by what is off level, m/s
};

/// Part of the copyable state of a cycle.
struct MonitorState {
  std::array<std::uint16_t, kRuleCount> broken{};  ///< samples in a row
  bool is_broken = false;                          ///< a rule was, in the last cycle
  bool has_sample = false;                         ///< what follows is the last one
  VectorM q_m, tau_m;
  VectorP q_p;
  Vector6 w_S = Vector6::Zero(), imu = Vector6::Zero();
  double time_s = 0.0;
  /// Samples with the same bits: of joint torques, wrench and inertial unit.
  std::array<std::uint16_t, kMaxManipulator + 12> same{};
  double clock_error = 0.0;  ///< mean, periods per sample
  double late = 0.0;         ///< late cycles, less what may come
  int late_in_a_row = 0;
  VectorP dq_p_model;       ///< of the gantry by its drive model
  VectorP gantry_gap;       ///< how far it is from where the model takes it; forgotten soon
  VectorP gantry_drift;     ///< the same, forgotten slowly
  VectorP gantry_way;       ///< that the model has made in that time
  VectorM pulled_back;      ///< in all, while it lasts
  VectorM momentum;         ///< of the motors, as their commands and springs make it, Nms
  VectorM lowest, highest;  ///< where joints may be: limits, or where they stood when armed
  VectorP lowest_p, highest_p;
  bool is_stopping = false;         ///< what follows is of the present stop
  VectorM stop_from, braking_ramp;  ///< joints: where it began, where the ramp has led
  VectorM ramp_speed;  ///< of the joints, by the accelerations of the reference since it began
  VectorP stop_from_p, braking_ramp_p;  ///< gantry: where it began, where the drive model has led
  ShakingState shaking;
};

struct Verdict {
  Fault fault;  ///< a broken rule, the one with the hardest reaction
  /// Hand and device shake each other; otherwise the rule nearest to its threshold, once beyond its
  /// warning.
  Fault warning;
};

class Monitor {
 public:
  /// Throws SetupError when a list has not one entry per joint or axis, or the period is not > 0.
  Monitor(const MonitorConfig& config, int n_p, int n_m);

  const MonitorConfig& config() const noexcept { return config_; }

  /// Once per cycle with usable sensors, after the rendering. Without them call forget().
  Verdict watch(const SensorFrame& sensors, const CycleRecord& record, const Watched& watched,
                MonitorState& state) noexcept;

  /// Whether a measured position has moved farther since the last sample than it can.
  bool has_jumped(const SensorFrame& sensors, const MonitorState& state) const noexcept;

  /// A sample could not be used: the next one is not compared with one before.
  static void forget(MonitorState& state) noexcept { state.has_sample = false; }

 private:
  // The largest share of its threshold that a rule has reached in this cycle.
  struct Worst {
    double share, value, limit;
    int index;
  };

  template <FaultCode code>
  void look(int index, double value, double limit) noexcept;
  void look_at_joint(int joint, const CycleRecord& record, const Watched& watched,
                     MonitorState& state) noexcept;
  void look_at_sensors(const SensorFrame& sensors, MonitorState& state) noexcept;
  void look_at_torques(const Watched& watched) noexcept;
  void look_at_inertial_unit(const Watched& watched) noexcept;
  void look_at_motors(const RobotState& robot, const Watched& watched,
                      MonitorState& state) noexcept;
  void look_at_noise(const SensorFrame& sensors, MonitorState& state) noexcept;
  void look_at_gantry(const SensorFrame& sensors, const CycleRecord& record, const Watched& watched,
                      MonitorState& state) noexcept;
  void look_at_braking(const CycleRecord& record, const Watched& watched,
                       MonitorState& state) noexcept;
  void look_at_frames(const CycleRecord& record, const Watched& watched) noexcept;
  Fault look_for_shaking(const SensorFrame& sensors, const CycleRecord& record,
                         const Watched& watched, MonitorState& state) noexcept;
  void look_at_clocks(const SensorFrame& sensors, const Watched& watched,
                      MonitorState& state) noexcept;
  Verdict judge(MonitorState& state) const noexcept;

  MonitorConfig config_;
  ShakingWatch shaking_;
  int n_p_, n_m_;
  std::array<int, kRuleCount> debounce_{};  // samples
  std::array<Worst, kRuleCount> fresh_{};   // before a cycle
  std::array<Worst, kRuleCount> worst_{};
};

}  // namespace hg::safety
