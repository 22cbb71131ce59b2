#include "hg/simulation/simulation.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "hg/core/stacked.h"

namespace hg::simulation {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

Simulation::Simulation(const Config& config, const model::Chain& chain, int handle,
                       user::Person person)
    : config_(config),
      chain_(chain),
      n_p_(static_cast<int>(config.q_p_start.size())),
      n_m_(static_cast<int>(config.q_m_start.size())),
      handle_(handle),
      dead_periods_(static_cast<int>(std::lround(config.drive.dead_time / config.dt))),
      person_(std::move(person)),
      q_m_(config.q_m_start),
      dq_m_(VectorM::Zero(n_m_)) {
  for (int i = 0; i < n_p_; ++i) axes_[static_cast<std::size_t>(i)].q = config.q_p_start[i];
  sensors_.tau_m = VectorM::Zero(n_m_);
  measure({});
}

void Simulation::step(const CommandFrame& command) noexcept {
  const double dt = config_.dt;
  if (command.enable) {
    q_m_ = command.q_m;
    dq_m_ = command.dq_m;
  } else {
    dq_m_.setZero();
  }
  for (int i = 0; i < n_p_; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double dq_cmd = command.enable ? command.dq_p[i] : 0.0;
    const double ddq =
        drive_acceleration(config_.drive, axis.dq, axis.delay.shift(dq_cmd, dead_periods_));
    axis.q += dt * axis.dq + 0.5 * dt * dt * ddq;
    axis.dq += dt * ddq;
  }
  ++sensors_.sequence;
  time_s_ = static_cast<double>(sensors_.sequence) * dt;
  measure(command.hand_target);
}

// An absolute encoder; of a joint that turns without end: [-pi, pi).
double Simulation::encoder(int joint, double q) const noexcept {
  const model::Joint& described = chain_.joints()[static_cast<std::size_t>(joint)];
  if (described.type != model::JointType::kContinuous) return q;
  return q - kTurn * std::floor((q + std::numbers::pi) / kTurn);
}

void Simulation::measure(const HandTarget& target) noexcept {
  VectorP q_p(n_p_), dq_p(n_p_);
  sensors_.q_p.resize(n_p_);
  for (int i = 0; i < n_p_; ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    q_p[i] = axis.q;
    dq_p[i] = axis.dq;
    sensors_.q_p[i] = encoder(i, axis.q);
  }
  chain_.update_kinematics(stacked(q_p, q_m_), stacked(dq_p, dq_m_));

  sensors_.time_s = time_s_;
  sensors_.q_m.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) sensors_.q_m[i] = encoder(n_p_ + i, q_m_[i]);
  sensors_.dq_m = dq_m_;

  sensors_.dead_man = config_.has_dead_man && person_.is_holding(time_s_);
  const user::HandleMotion handle{chain_.pose(handle_), chain_.twist(handle_)};
  const Vector6 w_H = person_.wrench(time_s_, handle, target);
  const Eigen::Matrix3d R_S_B = (handle.T_B_H.R * config_.T_H_S.R).transpose();
  const Eigen::Vector3d p_H_S_in_B = handle.T_B_H.R * config_.T_H_S.p;
  sensors_.w_S << R_S_B * w_H.head<3>(), R_S_B * (w_H.tail<3>() - p_H_S_in_B.cross(w_H.head<3>()));
}

}  // namespace hg::simulation
