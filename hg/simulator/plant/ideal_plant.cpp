#include "hg/simulator/plant/ideal_plant.h"

#include <cmath>

#include "hg/core/stacked.h"

namespace hg::simulator {

IdealPlant::IdealPlant(const IdealPlantConfig& config, const model::ChainModel& chain, int handle)
    : config_(config),
      chain_(chain),
      handle_(handle),
      dead_periods_(static_cast<int>(std::lround(config.drive.dead_time / config.period))) {
  const auto n_p = config_.q_p_start.size(), n_m = config_.q_m_start.size();
  truth_.is_known = true;
  truth_.q_m = config_.q_m_start;
  truth_.dq_m = VectorM::Zero(n_m);
  truth_.q_p = config_.q_p_start;
  truth_.dq_p = truth_.ddq_p = VectorP::Zero(n_p);
  observe(VectorM::Zero(n_m));
}

void IdealPlant::step(const CommandFrame& command, bool is_on) noexcept {
  const double dt = config_.period;
  if (is_on) {
    truth_.q_m = command.q_m;
    truth_.dq_m = command.dq_m;
  } else {
    truth_.dq_m.setZero();
  }
  for (int i = 0; i < truth_.q_p.size(); ++i) {
    const double dq_cmd = is_on ? command.dq_p[i] : 0.0;
    CommandDelay& delay = delays_[i];
    truth_.ddq_p[i] =
        drive_acceleration(config_.drive, truth_.dq_p[i], delay.shift(dq_cmd, dead_periods_));
    truth_.q_p[i] += dt * truth_.dq_p[i] + 0.5 * dt * dt * truth_.ddq_p[i];
    truth_.dq_p[i] += dt * truth_.ddq_p[i];
  }
  const VectorM at_rest = VectorM::Zero(truth_.q_m.size());
  observe(is_on ? command.ddq_m : at_rest);
}

void IdealPlant::observe(const VectorM& ddq_m) noexcept {
  chain_.update_kinematics(stacked(truth_.q_p, truth_.q_m), stacked(truth_.dq_p, truth_.dq_m));
  truth_.T_B_H = chain_.pose(handle_);
  truth_.twist = chain_.twist(handle_);
  truth_.acceleration = chain_.bias_acceleration(handle_);
  ddq_ = stacked(truth_.ddq_p, ddq_m);
  truth_.acceleration.noalias() += chain_.jacobian(handle_) * ddq_;
}

}  // namespace hg::simulator
