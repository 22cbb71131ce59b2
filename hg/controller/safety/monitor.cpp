#include "hg/controller/safety/monitor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "hg/controller/safety/stopping.h"
#include "hg/core/first_not_finite.h"

namespace hg::safety {
namespace {

constexpr double kClockMemory = 0.02;       // share of the newest sample in the clock's mean error
constexpr double kClockErrorMax = 1e6;      // of one sample, periods: one wild stamp is forgotten
constexpr double kPullMemory_s = 0.2;       // time constant of forgetting shifts of the reference
constexpr double kRampMemory_s = 1.0;       // of a joint that is off its braking ramp
constexpr double kGapMemory_s = 2.0;        // time constant of forgetting errors of the drive model
constexpr double kDriftMemory_s = 60.0;     // the same for slow drift
constexpr double kDriveError = 0.005;       // allowed drift of a drive, share of its way
constexpr double kMotorMemory_s = 0.02;     // time constant of the motor torque observer
constexpr double kShakingPatience_s = 3.0;  // as in passivity/
constexpr double kTurn = 2.0 * std::numbers::pi;

Fault make_fault(FaultCode code, int index, double value, double limit) noexcept {
  return {code, static_cast<std::int16_t>(index), value, limit};
}

// angle wrapped to one turn about 0: encoders of joints without limits wrap
double turned(double angle) noexcept { return angle - kTurn * std::nearbyint(angle / kTurn); }

// Without power the range is `range` extended to `q`; with power it shrinks back to `range` with
// `q`.
void follow(const Interval& range, double q, bool is_powered, double& lowest,
            double& highest) noexcept {
  lowest = std::min(range.lb, is_powered ? std::max(lowest, q) : q);
  highest = std::max(range.ub, is_powered ? std::min(highest, q) : q);
}

std::uint16_t count_up(std::uint16_t count) noexcept {
  return count < UINT16_MAX ? static_cast<std::uint16_t>(count + 1) : count;
}

}  // namespace

bool is_wrench_in_range(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  return sensors.w_S.head<3>().norm() <= config.force_max &&
         sensors.w_S.tail<3>().norm() <= config.torque_max;
}

Fault check_sensors(const SensorFrame& sensors, std::uint64_t expected_sequence,
                    const Fault& values) noexcept {
  if (sensors.driver_fault != FaultCode::kNone) {
    return make_fault(sensors.driver_fault, -1, 0.0, 0.0);
  }
  if (sensors.sequence != expected_sequence) {
    return make_fault(FaultCode::kSequenceGap, -1, static_cast<double>(sensors.sequence),
                      static_cast<double>(expected_sequence));
  }
  return values;
}

Fault check_solution(SolverStatus status, const VectorM& ddq_m, const VectorA& ddq_a) noexcept {
  if (status != SolverStatus::kSolved && status != SolverStatus::kBudgetSpent) {
    return make_fault(FaultCode::kSolverFailed, -1, static_cast<double>(status), 0.0);
  }
  int index = first_not_finite(ddq_m);
  if (index < 0) index = first_not_finite(ddq_a);
  if (index >= 0) return make_fault(FaultCode::kReferenceNotFinite, index, NAN, 0.0);
  return {};
}

Monitor::Monitor(const MonitorConfig& config, const DeviceModel& device,
                 const MonitoredParts& parts)
    : config_(config),
      parts_(parts),
      n_p_(device.n_p),
      n_m_(device.n_m),
      dt_(device.dt()),
      lag_(drive_lag(device.follows_positions)),
      drive_(device.drive),
      gantry_range_(device.gantry_range),
      joint_limits_(device.joint_limits),
      actuators_(device.actuators),
      is_gantry_slide_(device.is_gantry_slide()),
      end_cartesian_(device.limit_count() - (device.keeps_apart ? 1 : 0)),
      first_cartesian_(device.first_cartesian()),
      shaking_(dt_, parts.twin_mass) {
  for (int i = 0; i < n_m_; ++i) is_slide_.push_back(device.is_slide(i));
  if (!parts.has_rated_bounds) config_.acceleration_tolerance = kInfinity;
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const Debounce& debounce = kRules[i].debounce;
    const int samples = static_cast<int>(std::ceil(debounce.seconds / dt_ - 1e-9));
    debounce_[i] = std::min(std::max(debounce.samples, samples), int{UINT16_MAX});
    fresh_[i] = {kRules[i].warn_from, 0.0, 0.0, -1};
  }
}

// A threshold of zero is passed by any value above it, every threshold by NaN: a value that could
// not be computed is no proof that a limit holds.
template <FaultCode kCode>
void Monitor::look(int index, double value, double limit) noexcept {
  constexpr std::size_t kRule = rule_index(kCode);
  static_assert(kRule < kRuleCount);
  Worst& worst = worst_[kRule];
  const bool is_known = !std::isnan(value);
  if (is_known && !(value > worst.share * limit)) return;
  worst = {is_known && limit > 0.0 ? value / limit : kInfinity, value, limit, index};
}

bool Monitor::has_jumped(const SensorFrame& sensors, const MonitorState& state) const noexcept {
  if (!state.has_sample) return false;
  const double far = config_.jump_factor * dt_;
  for (int i = 0; i < n_m_; ++i) {
    const double moved = std::abs(turned(sensors.q_m[i] - state.q_m[i]));
    if (!(moved <= far * joint_limits_[i].dq_max)) return true;
  }
  return !((sensors.q_p - state.q_p).array().abs() <= far * drive_.dq_max).all();
}

MonitorResult Monitor::watch(const SensorFrame& sensors, const Rendered& rendered,
                             const Watched& watched, MonitorState& state) noexcept {
  worst_ = fresh_;
  if (state.lowest.size() != n_m_) {
    state.lowest = state.highest = rendered.robot.q_m;
    state.lowest_p = state.highest_p = rendered.robot.q_p;
    state.pulled_back = VectorM::Zero(n_m_);
    state.dq_p_model = state.gantry_gap = VectorP::Zero(n_p_);
    state.gantry_drift = state.gantry_way = VectorP::Zero(n_p_);
  }
  for (int i = 0; i < n_m_; ++i) check_joint(i, rendered, watched, state);
  check_motors(rendered.robot, watched, state);
  check_torques(watched);
  check_inertial_unit(watched);
  check_gantry(sensors, rendered, watched, state);
  check_braking(rendered, watched, state);
  check_limits(rendered, watched);
  check_clocks(sensors, watched, state);
  check_sensor_values(sensors, state);
  const Fault shaking = look_for_shaking(sensors, rendered, watched, state);
  MonitorResult verdict = judge(state);
  if (shaking.code != FaultCode::kNone) verdict.warning = shaking;
  state.is_broken = verdict.fault.code != FaultCode::kNone;
  return verdict;
}

void Monitor::check_joint(int joint, const Rendered& rendered, const Watched& watched,
                          MonitorState& state) noexcept {
  const double q = rendered.robot.q_m[joint], dq = rendered.robot.dq_m[joint];
  const bool is_on = is_powered(watched.state);
  const limits::JointLimits& limits = joint_limits_[joint];
  follow({limits.q_min, limits.q_max}, q, is_on, state.lowest[joint], state.highest[joint]);
  double& pulled = state.pulled_back[joint];
  const bool is_pulled = watched.pulled_back.size() > 0 && watched.pulled_back[joint] != 0.0;
  pulled = is_pulled ? pulled + watched.pulled_back[joint] : pulled * (1.0 - dt_ / kPullMemory_s);
  if (!is_on) {
    pulled = 0.0;
    return;
  }
  const bool is_slide = is_slide_[joint];
  const double beyond = is_slide ? config_.slide_tolerance : config_.position_tolerance;
  const double apart = is_slide ? config_.slide_tracking_tolerance : config_.tracking_tolerance;
  const double fastest = config_.speed_tolerance * joint_limits_[joint].dq_max;
  const ReferenceState& reference = rendered.reference;
  const double q_r = reference.q_m[joint];
  look<FaultCode::kLimitExceeded>(joint,
                                  std::max({q - state.highest[joint], state.lowest[joint] - q,
                                            q_r - state.highest[joint], state.lowest[joint] - q_r}),
                                  beyond);
  look<FaultCode::kSpeedExceeded>(joint, std::abs(dq), fastest);
  look<FaultCode::kSpeedExceeded>(joint, std::abs(reference.dq_m[joint]), fastest);
  look<FaultCode::kAccelerationExceeded>(
      joint, std::abs(reference.ddq_m[joint]),
      config_.acceleration_tolerance * joint_limits_[joint].ddq_max);
  look<FaultCode::kTrackingLost>(joint, std::abs(q_r - q + pulled), apart);
}

// Motor torque that command, spring and inertia do not explain, observed from the momentum without
// accelerations. Beyond friction, the motor does not follow its command.
void Monitor::check_motors(const RobotState& robot, const Watched& watched,
                           MonitorState& state) noexcept {
  const bool is_known = watched.tau_m.size() == n_m_ && robot.dtheta_m.size() == n_m_ &&
                        robot.tau_m.size() == n_m_ && !actuators_.empty();
  if (!is_known || !is_powered(watched.state)) {
    state.momentum.resize(0);
    return;
  }
  const bool is_new = state.momentum.size() != n_m_;
  if (is_new) state.momentum.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    const double dtheta = robot.dtheta_m[i], tau_J = robot.tau_m[i];
    const double p = actuator.rotor_inertia * dtheta;
    if (is_new) state.momentum[i] = p;
    const double unexplained = (state.momentum[i] - p) / kMotorMemory_s;
    const double most = torque_available(actuator, watched.tau_m[i] * dtheta > 0.0 ? dtheta : 0.0);
    const double commanded = std::clamp(watched.tau_m[i], -most, most);
    state.momentum[i] += dt_ * (commanded - tau_J - unexplained);
    const double friction =
        coulomb_torque(actuator, 0.0, tau_J) + actuator.viscous_friction * std::abs(dtheta);
    look<FaultCode::kMotorDeviates>(i, std::abs(unexplained) - friction,
                                    config_.motor_tolerance * actuator.torque_max);
  }
}

// Joint torque that neither motion nor the user's wrench explains: contact with the arm, or force
// sensor and joint torques contradict each other. Running only: a stop need not brake exactly.
void Monitor::check_torques(const Watched& watched) noexcept {
  if (mode_of(watched.state) != Mode::kRunning || watched.unexplained.size() != n_m_) return;
  for (int i = 0; i < n_m_ && !actuators_.empty(); ++i) {
    look<FaultCode::kTorqueUnexplained>(i, std::abs(watched.unexplained[i]),
                                        config_.unexplained_tolerance * actuators_[i].torque_max);
  }
}

// Compares the inertial unit at the handle with the encoders.
void Monitor::check_inertial_unit(const Watched& watched) noexcept {
  if (!is_powered(watched.state)) return;
  look<FaultCode::kTurnUnexplained>(-1, watched.turn,
                                    config_.gyroscope_tolerance + watched.turn_uncertainty);
  look<FaultCode::kMotionUnexplained>(-1, watched.slip,
                                      config_.accelerometer_tolerance + watched.slip_uncertainty);
}

void Monitor::check_gantry(const SensorFrame& sensors, const Rendered& rendered,
                           const Watched& watched, MonitorState& state) noexcept {
  const RobotState& robot = rendered.robot;
  const bool is_on = is_powered(watched.state);
  const double beyond = is_gantry_slide_ ? config_.gantry_tolerance : config_.turn_tolerance;
  const double off = is_gantry_slide_ ? config_.gantry_deviation : config_.turn_deviation;
  const double gap = is_gantry_slide_ ? config_.gantry_gap : config_.turn_gap;
  const double drift = is_gantry_slide_ ? config_.gantry_drift : config_.turn_drift;
  const double kept = 1.0 - dt_ / kGapMemory_s;
  const double kept_long = 1.0 - dt_ / kDriftMemory_s;
  const double while_dead = drive_.dead_time * drive_.ddq_max;
  for (int axis = 0; axis < n_p_; ++axis) {
    const double q = robot.q_p[axis], dq = robot.dq_p[axis];
    double& model = state.dq_p_model[axis];
    follow(gantry_range_[axis], q, is_on, state.lowest_p[axis], state.highest_p[axis]);
    if (!is_on) {
      model = dq;
      state.gantry_gap[axis] = state.gantry_drift[axis] = state.gantry_way[axis] = 0.0;
      continue;
    }
    if (state.has_sample) {
      const double moved = sensors.q_p[axis] - state.q_p[axis];
      const double error = moved - dt_ * model;
      state.gantry_gap[axis] = kept * state.gantry_gap[axis] + error;
      state.gantry_drift[axis] = kept_long * state.gantry_drift[axis] + error;
      state.gantry_way[axis] = kept_long * state.gantry_way[axis] + dt_ * std::abs(model);
      // a drive that is as fast again as its model thinks is still no fault
      const double by_lag = drive_.lag * std::abs(model);
      look<FaultCode::kGantryDeviates>(axis, std::abs(state.gantry_gap[axis]), gap + by_lag);
      look<FaultCode::kGantryDeviates>(axis, std::abs(state.gantry_drift[axis]),
                                       drift + kDriveError * state.gantry_way[axis] + by_lag);
    }
    look<FaultCode::kGantryExceeded>(
        axis, std::max(q - state.highest_p[axis], state.lowest_p[axis] - q), beyond);
    look<FaultCode::kGantryExceeded>(axis, std::abs(dq), config_.speed_tolerance * drive_.dq_max);
    look<FaultCode::kGantryDeviates>(axis, std::abs(dq - model), off + while_dead);
    model += dt_ * drive_acceleration(drive_, model, watched.dq_p_command[axis]);
  }
}

// Checks every axis of a controlled stop against its ramp: a gantry axis against its drive model, a
// joint against the integrated accelerations of its reference (the reference itself is shifted back
// to a joint that does not follow). An axis that does not brake as commanded needs its brakes.
void Monitor::check_braking(const Rendered& rendered, const Watched& watched,
                            MonitorState& state) noexcept {
  const bool is_new = !state.is_stopping;
  state.is_stopping = mode_of(watched.state) == Mode::kStopping;
  if (!state.is_stopping) return;
  const RobotState& robot = rendered.robot;
  if (is_new) {
    state.stop_from = state.braking_ramp = robot.q_m;
    state.ramp_speed = rendered.reference.dq_m;
    state.stop_from_p = state.braking_ramp_p = robot.q_p;
  } else {
    // a joint that a hand held back for a moment, and that brakes since, is no fault
    state.braking_ramp += dt_ / kRampMemory_s * (robot.q_m - state.braking_ramp);
    state.braking_ramp_p += dt_ * state.dq_p_model;
  }
  for (int i = 0; i < n_m_; ++i) {
    const bool is_slide = is_slide_[i];
    const double gap = is_slide ? config_.slide_braking_gap : config_.braking_gap;
    const double off = is_slide ? config_.slide_braking_deviation : config_.braking_deviation;
    const limits::JointLimits& rated = joint_limits_[i];
    look<FaultCode::kBrakingPosition>(i, std::abs(robot.q_m[i] - state.braking_ramp[i]),
                                      gap + (lag_ > 0.0 ? lag_ * rated.dq_max : 0.0));
    look<FaultCode::kBrakingSpeed>(i, std::abs(robot.dq_m[i] - state.ramp_speed[i]),
                                   off + (lag_ > 0.0 ? lag_ * rated.ddq_max : 0.0));
    look<FaultCode::kStopTooFar>(i, std::abs(robot.q_m[i] - state.stop_from[i]),
                                 kUntilBrakes * config_.stop_distance_of_joint(is_slide));
  }
  const bool is_slide = is_gantry_slide_;
  const double gap = is_slide ? config_.gantry_gap : config_.turn_gap;
  const double off = is_slide ? config_.gantry_deviation : config_.turn_deviation;
  const double by_dead_time = drive_.dead_time * drive_.ddq_max;
  for (int i = 0; i < n_p_; ++i) {
    const double moved = std::abs(robot.q_p[i] - state.stop_from_p[i]);
    look<FaultCode::kBrakingPosition>(n_m_ + i, std::abs(robot.q_p[i] - state.braking_ramp_p[i]),
                                      gap);
    look<FaultCode::kBrakingSpeed>(n_m_ + i, std::abs(robot.dq_p[i] - state.dq_p_model[i]),
                                   off + by_dead_time);
    look<FaultCode::kStopTooFar>(n_m_ + i, moved,
                                 kUntilBrakes * config_.stop_distance_of_gantry(is_slide));
  }
  // to the next sample: this one shows nothing yet of the acceleration that it asks for
  const VectorM& ddq = rendered.reference.ddq_m;
  state.braking_ramp += dt_ * (state.ramp_speed + 0.5 * dt_ * ddq);
  state.ramp_speed += dt_ * ddq;
}

void Monitor::check_limits(const Rendered& rendered, const Watched& watched) noexcept {
  const Mode mode = mode_of(watched.state);
  if (mode != Mode::kRunning && mode != Mode::kStopping) return;
  for (int i = 0; i < end_cartesian_; ++i) {
    const double of_joint =
        i < n_m_ && is_slide_[i] ? config_.slide_tolerance : config_.position_tolerance;
    // joints, sums of joints, then motors, which have no range and so no excess, then frames
    const double tolerance = i < n_m_               ? of_joint
                             : i < first_cartesian_ ? config_.virtual_tolerance
                                                    : config_.cartesian_tolerance;
    if (i >= n_m_) look<FaultCode::kLimitExceeded>(i, rendered.limits[i].excess, tolerance);
    if (!rendered.passing.empty())
      look<FaultCode::kLimitNotHeld>(i, rendered.passing[i], tolerance);
  }
  look<FaultCode::kSyncLost>(-1, rendered.sync_error, config_.sync_tolerance);
  if (watched.state != SafetyState::kAutonomous) return;
  look<FaultCode::kSafeSpeedExceeded>(0, rendered.v_H.norm(), config_.safe_speed);
  if (!is_gantry_slide_) return;
  look<FaultCode::kSafeSpeedExceeded>(1, rendered.robot.dq_p.norm(), config_.safe_speed);
}

// Returns a warning. Oscillations of force, which added damping may end, are stopped by
// passivity/.
Fault Monitor::look_for_shaking(const SensorFrame& sensors, const Rendered& rendered,
                                const Watched& watched, MonitorState& state) noexcept {
  if (!parts_.looks_for_shaking || mode_of(watched.state) != Mode::kRunning) {
    state.shaking = {};
    return {};
  }
  const ShakingReport found = shaking_.step({.w_S = sensors.w_S,
                                             .w_H = rendered.robot.w_H,
                                             .v_H = rendered.v_H,
                                             .contact_force = rendered.contact_force,
                                             .oscillation = rendered.oscillation},
                                            state.shaking);
  if (found.what == Shaking::kNone) return {};
  const auto index = static_cast<int>(found.what);
  if (parts_.stops_shaking && found.what != Shaking::kForce) {
    look<FaultCode::kOscillation>(index, state.shaking.shakes_s, kShakingPatience_s);
  }
  return make_fault(FaultCode::kOscillation, index, found.index, 1.0);
}

void Monitor::check_clocks(const SensorFrame& sensors, const Watched& watched,
                           MonitorState& state) noexcept {
  if (state.has_sample) {
    const double error =
        std::clamp((sensors.time_s - state.time_s) / dt_ - 1.0, -kClockErrorMax, kClockErrorMax);
    state.clock_error += kClockMemory * (error - state.clock_error);
    look<FaultCode::kClockWrong>(-1, std::abs(state.clock_error), config_.clock_tolerance);
  }
  state.time_s = sensors.time_s;

  const auto late = static_cast<double>(watched.late_cycles);
  const bool is_on = is_powered(watched.state);
  state.late = is_on ? std::max(0.0, state.late - dt_ * config_.overruns_per_s) + late : 0.0;
  state.late_in_a_row = is_on && watched.late_cycles > 0
                            ? state.late_in_a_row + static_cast<int>(std::min(late, 1e6))
                            : 0;
  look<FaultCode::kCycleOverrun>(0, state.late_in_a_row, config_.overruns_in_a_row);
  look<FaultCode::kCycleOverrun>(1, state.late, config_.overruns_per_s);
}

void Monitor::check_sensor_values(const SensorFrame& sensors, MonitorState& state) noexcept {
  look<FaultCode::kWrenchTooLarge>(0, sensors.w_S.head<3>().norm(), config_.force_max);
  look<FaultCode::kWrenchTooLarge>(1, sensors.w_S.tail<3>().norm(), config_.torque_max);
  look<FaultCode::kBusErrors>(-1, sensors.bus_errors, 0.0);
  for (int i = 0; i < sensors.temperature_m.size(); ++i) {
    look<FaultCode::kTooHot>(i, sensors.temperature_m[i], config_.temperature_max);
  }
  for (int i = 0; i < sensors.tau_m.size(); ++i) {
    const double tau = sensors.tau_m[i];
    if (actuators_.empty()) break;
    const ActuatorModel& actuator = actuators_[i];
    look<FaultCode::kJointTorqueExceeded>(i, std::abs(tau),
                                          config_.torque_tolerance * actuator.torque_max);
    if (sensors.theta_m.size() == 0) continue;
    const double twist = turned(sensors.theta_m[i] - sensors.q_m[i]);
    look<FaultCode::kSensorImplausible>(i, std::abs(twist - tau / actuator.stiffness),
                                        config_.plausibility);
  }
  if (state.has_sample) {
    const double far = config_.jump_factor * dt_;
    for (int i = 0; i < n_m_; ++i) {
      look<FaultCode::kSensorJump>(i, std::abs(turned(sensors.q_m[i] - state.q_m[i])),
                                   far * joint_limits_[i].dq_max);
    }
    for (int i = 0; i < n_p_; ++i) {
      look<FaultCode::kSensorJump>(n_m_ + i, std::abs(sensors.q_p[i] - state.q_p[i]),
                                   far * drive_.dq_max);
    }
  }
  if (config_.frozen_samples > 0.0) check_noise(sensors, state);
  state.q_m = sensors.q_m;
  state.q_p = sensors.q_p;
  state.has_sample = true;
}

// joint torques by joint, then the components of wrench and inertial unit
void Monitor::check_noise(const SensorFrame& sensors, MonitorState& state) noexcept {
  const auto compare = [&](int first, const auto& now, const auto& before) {
    const bool can_compare = state.has_sample && now.size() == before.size();
    for (int i = 0; i < now.size(); ++i) {
      std::uint16_t& same = state.same[first + i];
      same = can_compare && now[i] == before[i] ? count_up(same) : std::uint16_t{0};
      look<FaultCode::kSensorFrozen>(first + i, same, config_.frozen_samples);
    }
  };
  compare(0, sensors.tau_m, state.tau_m);
  compare(n_m_, sensors.w_S, state.w_S);
  state.tau_m = sensors.tau_m;
  state.w_S = sensors.w_S;
  if (!parts_.has_imu) return;
  Vector6 imu;
  imu << sensors.a_S, sensors.omega_S;
  compare(n_m_ + 6, imu, state.imu);
  state.imu = imu;
}

// Of several rules that are broken the one with the hardest reaction, then the smallest number.
MonitorResult Monitor::judge(MonitorState& state) const noexcept {
  MonitorResult verdict;
  Stop hardest = Stop::kNone;
  double nearest = 0.0;
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const Worst& worst = worst_[i];
    if (worst.value <= 0.0) {  // far from the threshold
      state.broken[i] = 0;
      continue;
    }
    const Fault fault = make_fault(kRules[i].code, worst.index, worst.value, worst.limit);
    state.broken[i] = worst.share > 1.0 ? count_up(state.broken[i]) : std::uint16_t{0};
    if (state.broken[i] >= debounce_[i] && kRules[i].reaction > hardest) {
      verdict.fault = fault;
      hardest = kRules[i].reaction;
    }
    if (worst.share > nearest && kRules[i].warn_from < 1.0) {
      verdict.warning = fault;
      nearest = worst.share;
    }
  }
  return verdict;
}

}  // namespace hg::safety
