#include "hg/estimation/estimation.h"

#include <cmath>
#include <numbers>

#include "hg/core/stacked.h"
#include "hg/model/haptic_giant.h"

namespace hg::estimation {
namespace {

// [C] 2: predict with the drive model, correct position, speed and disturbance; triple pole p
void observe(const Config& config, double q_measured, double dq_cmd_delayed,
             GantryObserver& axis) noexcept {
  const double dt = config.dt;
  const double p = std::exp(-2.0 * std::numbers::pi * config.observer_pole_Hz * dt);
  axis.ddq = drive_acceleration(config.drive, axis.dq, dq_cmd_delayed) + axis.disturbance;
  axis.q += dt * axis.dq + 0.5 * dt * dt * axis.ddq;
  axis.dq += dt * axis.ddq;

  const double innovation = q_measured - axis.q;
  axis.q += (1.0 - p * p * p) * innovation;
  axis.dq += 1.5 * (1.0 - p) * (1.0 - p) * (1.0 + p) / dt * innovation;
  axis.disturbance += (1.0 - p) * (1.0 - p) * (1.0 - p) / (dt * dt) * innovation;
}

}  // namespace

Estimation::Estimation(const Config& config, const model::Chain& chain, int n_p, int n_m,
                       int handle)
    : config_(config),
      chain_(chain),
      n_p_(n_p),
      n_m_(n_m),
      handle_(handle),
      dead_periods_(static_cast<int>(std::lround(config.drive.dead_time / config.dt))) {}

bool Estimation::turns_without_end(int joint) const noexcept {
  return chain_.joints()[static_cast<std::size_t>(joint)].type == model::JointType::kContinuous;
}

RobotState Estimation::step(const SensorFrame& sensors, const VectorP& dq_p_cmd,
                            State& state) noexcept {
  if (!state.is_started) {
    state.q_m = sensors.q_m;
    for (int i = 0; i < n_p_; ++i) state.gantry[static_cast<std::size_t>(i)].q = sensors.q_p[i];
    state.is_started = true;
  }

  RobotState robot;
  robot.q_m = sensors.q_m;
  robot.dq_m = sensors.dq_m;
  for (int i = 0; i < n_m_; ++i) {
    if (turns_without_end(n_p_ + i)) {
      robot.q_m[i] = model::haptic_giant::nearest_turn(sensors.q_m[i], state.q_m[i]);
    }
  }
  state.q_m = robot.q_m;

  robot.q_p.resize(n_p_);
  robot.dq_p.resize(n_p_);
  robot.ddq_p.resize(n_p_);
  for (int i = 0; i < n_p_; ++i) {
    GantryObserver& axis = state.gantry[static_cast<std::size_t>(i)];
    const double q = turns_without_end(i)
                         ? model::haptic_giant::nearest_turn(sensors.q_p[i], axis.q)
                         : sensors.q_p[i];
    observe(config_, q, axis.delay.shift(dq_p_cmd[i], dead_periods_), axis);
    robot.q_p[i] = axis.q;
    robot.dq_p[i] = axis.dq;
    robot.ddq_p[i] = axis.ddq;
  }

  // the sensor measures in S; the law needs the same wrench about H, resolved in B
  chain_.update_poses(stacked(robot.q_p, robot.q_m));
  const Eigen::Matrix3d R_B_H = chain_.pose(handle_).R;
  const Eigen::Vector3d f_H = config_.T_H_S.R * sensors.w_S.head<3>();
  const Eigen::Vector3d n_H = config_.T_H_S.R * sensors.w_S.tail<3>() + config_.T_H_S.p.cross(f_H);
  robot.w_H << R_B_H * f_H, R_B_H * n_H;
  return robot;
}

}  // namespace hg::estimation
