#include "hg/controller/estimation/estimation.h"

#include <cmath>

#include "hg/core/stacked.h"
#include "hg/model/haptic_giant.h"

namespace hg::estimation {

Estimation::Estimation(const EstimationConfig& config, const DeviceModel& device)
    : config_(config),
      chain_(device.chain),
      n_p_(device.n_p),
      n_m_(device.n_m),
      handle_(device.handle),
      dt_(device.dt()),
      T_H_S_(device.T_H_S),
      drive_(device.drive),
      dead_periods_(static_cast<int>(std::lround(drive_.dead_time / dt_))),
      gantry_gains_(gantry_gains(config.observer_pole_Hz, dt_)),
      link_pole_(low_pass_pole(config.link_pole_Hz, dt_)),
      motor_pole_(low_pass_pole(config.motor_low_pass_Hz, dt_)),
      units_(config.units, dt_, config.link_pole_Hz, config.observer_pole_Hz, device.chain, n_p_) {}

bool Estimation::turns_without_end(int joint) const noexcept {
  return chain_.model().joints()[joint].type == model::JointType::kContinuous;
}

double Estimation::unwrapped(int joint, double measured, double last) const noexcept {
  return turns_without_end(joint) ? model::haptic_giant::nearest_turn(measured, last) : measured;
}

void Estimation::tare(bool is_asked_for, bool is_at_rest, EstimationState& state) const noexcept {
  TareState& tare = state.wrench.tare;
  if (is_asked_for && tare.status != TareStatus::kUnderWay) begin(tare);
  if (tare.status == TareStatus::kUnderWay && !is_at_rest) {
    tare.status = TareStatus::kRefusedRunning;
  }
}

void Estimation::check_motion(const SensorFrame& sensors, bool is_on,
                              EstimationState& state) const noexcept {
  if (!config_.wrench.has_imu) return;
  const Pose T_B_S = chain_.pose(handle_) * T_H_S_;
  advance(dt_, {.R_B_S = T_B_S.R, .p_S = T_B_S.p, .omega_S = sensors.omega_S, .a_S = sensors.a_S},
          is_on, state.inertial);
}

void Estimation::watch_rest(RestInput input, EstimationState& state) const noexcept {
  const Eigen::Matrix3d R_B_S = chain_.pose(handle_).R * T_H_S_.R;
  input.w_S = state.wrench.w_S;
  input.up_S = R_B_S.row(2);
  input.is_free = input.is_free && is_tared(state);
  input.noise = config_.wrench.tare.noise_force;
  input.payload_mass = config_.wrench.payload.mass;
  if (!config_.wrench.has_imu) {
    const Eigen::Vector3d a = (input.v_H - state.rest.v_H) / dt_;
    input.inertia_S = -input.payload_mass * (R_B_S.transpose() * a);
  }
  state.rest.v_H = input.v_H;
  advance(dt_, input, state.rest);
}

RobotState Estimation::step(const SensorFrame& sensors, const VectorP& dq_p_cmd,
                            const VectorM& ddq_m_reference, EstimationState& state) noexcept {
  if (!state.is_started) start(sensors, state);
  RobotState robot;
  const VectorM q_m = observe_joints(sensors, ddq_m_reference, state, robot);
  const VectorP q_p = observe_gantry(sensors, dq_p_cmd, state, robot);
  if (units_.has_any()) {
    units_.step(sensors.inertial,
                {.measured = stacked(q_p, q_m),
                 .q = stacked(robot.q_p, robot.q_m),
                 .dq = stacked(robot.dq_p, robot.dq_m),
                 .ddq_expected = stacked(robot.ddq_p, ddq_m_reference)},
                state.units);
    units_.feed_back(state.units, robot);
  }
  observe_wrench(sensors, state, robot);
  return robot;
}

void Estimation::start(const SensorFrame& sensors, EstimationState& state) const noexcept {
  state.q_m = sensors.q_m;
  for (int i = 0; i < n_m_; ++i) {
    state.link[i].q = sensors.q_m[i];
    if (sensors.theta_m.size() == n_m_) {
      state.motor[i].theta = unwrapped(n_p_ + i, sensors.theta_m[i], sensors.q_m[i]);
    }
  }
  for (int i = 0; i < n_p_; ++i) state.gantry[i].q = sensors.q_p[i];
  state.is_started = true;
}

// Returns what the encoders show, unwrapped.
VectorM Estimation::observe_joints(const SensorFrame& sensors, const VectorM& ddq_m_reference,
                                   EstimationState& state, RobotState& robot) const noexcept {
  VectorM measured(n_m_);
  robot.q_m = sensors.q_m;
  robot.dq_m = sensors.dq_m;
  robot.tau_m = sensors.tau_m;
  const bool has_motor_encoders = sensors.theta_m.size() == n_m_;
  if (has_motor_encoders) robot.theta_m = robot.dtheta_m = sensors.theta_m;
  for (int i = 0; i < n_m_; ++i) {
    robot.q_m[i] = measured[i] = unwrapped(n_p_ + i, sensors.q_m[i], state.q_m[i]);
    if (!has_motor_encoders) continue;

    LinkObserver& link = state.link[i];
    observe(link_pole_, dt_, ddq_m_reference[i], robot.q_m[i], link);
    robot.q_m[i] = link.q;
    robot.dq_m[i] = link.dq;

    MotorObserver& motor = state.motor[i];
    const double theta = unwrapped(n_p_ + i, sensors.theta_m[i], link.q);
    observe(motor_pole_, dt_, theta, motor);
    robot.theta_m[i] = motor.theta;
    robot.dtheta_m[i] = motor.dtheta;
  }
  state.q_m = robot.q_m;
  return measured;
}

// Observes the gantry. Returns what its encoders show, unwrapped.
VectorP Estimation::observe_gantry(const SensorFrame& sensors, const VectorP& dq_p_cmd,
                                   EstimationState& state, RobotState& robot) const noexcept {
  VectorP measured(n_p_);
  robot.q_p.resize(n_p_);
  robot.dq_p.resize(n_p_);
  robot.ddq_p.resize(n_p_);
  for (int i = 0; i < n_p_; ++i) {
    GantryObserver& axis = state.gantry[i];
    measured[i] = unwrapped(i, sensors.q_p[i], axis.q);
    observe(drive_, gantry_gains_, dt_, measured[i], axis.delay.shift(dq_p_cmd[i], dead_periods_),
            axis);
    robot.q_p[i] = axis.q;
    robot.dq_p[i] = axis.dq;
    robot.ddq_p[i] = axis.ddq;
  }
  return measured;
}

VectorP Estimation::gantry_disturbance(const EstimationState& state) const noexcept {
  VectorP ddq(n_p_);
  for (int i = 0; i < n_p_; ++i) ddq[i] = state.gantry[i].disturbance;
  return ddq;
}

// A hand that leans on the handle trembles less than the tare itself can see.
void Estimation::take_tare(const SensorFrame& sensors, const Eigen::Matrix3d& R_B_S,
                           const RobotState& robot, EstimationState& state) const noexcept {
  TareState& tare = state.wrench.tare;
  const Vector6 offset = tare.offset;
  const bool was_valid = tare.is_valid;
  advance(config_.wrench.tare, dt_, without_weight(config_.wrench, sensors, R_B_S),
          sensors.dead_man, robot.q_m, robot.q_p, tare);
  if (tare.status != TareStatus::kDone) return;
  if (trembles(dt_, config_.wrench.tare.noise_force, state.rest)) {
    tare.status = TareStatus::kRefusedUnsteady;
    tare.offset = offset;
    tare.is_valid = was_valid;
  } else {
    state.rest = {};
  }
}

void Estimation::observe_wrench(const SensorFrame& sensors, EstimationState& state,
                                RobotState& robot) noexcept {
  chain_.update_poses(stacked(robot.q_p, robot.q_m));
  const Eigen::Matrix3d& R_B_H = chain_.pose(handle_).R;
  const Eigen::Matrix3d R_B_S = R_B_H * T_H_S_.R;
  see_noise(dt_, sensors.w_S, state.rest);
  if (state.wrench.tare.status == TareStatus::kUnderWay) take_tare(sensors, R_B_S, robot, state);
  estimate(config_.wrench, dt_, sensors, R_B_S, state.wrench);

  // the sensor measures in S; the law needs the same wrench about H, resolved in B
  const Vector6 w_S = state.wrench.w_S - state.rest.zero;
  const Eigen::Vector3d f_H = T_H_S_.R * w_S.head<3>();
  const Eigen::Vector3d n_H = T_H_S_.R * w_S.tail<3>() + T_H_S_.p.cross(f_H);
  robot.w_H << R_B_H * f_H, R_B_H * n_H;
}

}  // namespace hg::estimation
