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

#include "hg/controller/safety/monitor_config.h"
#include "hg/controller/safety/monitor_state.h"
#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/shaking.h"
#include "hg/controller/safety/transitions.h"
#include "hg/core/fields.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::safety {

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
  std::span<const double> passing = {};  ///< LawResult::passing; empty = none
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

struct MonitorResult {
  Fault fault;  ///< Broken rule with the hardest reaction, or kNone
  /// Shaking of hand and device, or the rule nearest to its threshold beyond its warning level.
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
  void check_limits(const Rendered& rendered, const Watched& watched) noexcept;
  Fault look_for_shaking(const SensorFrame& sensors, const Rendered& rendered,
                         const Watched& watched, MonitorState& state) noexcept;
  void check_clocks(const SensorFrame& sensors, const Watched& watched,
                    MonitorState& state) noexcept;
  MonitorResult judge(MonitorState& state) const noexcept;

  MonitorConfig config_;
  MonitoredParts parts_;
  int n_p_, n_m_;
  double dt_;         ///< Period, s
  double lag_;        ///< Time by which drives that follow positions are behind their reference, s
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
