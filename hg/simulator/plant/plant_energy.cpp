#include <algorithm>

#include "hg/simulator/plant/plant.h"

// Diagnostics of a plant: energy, power and the residual of its equations.

namespace hg::simulator {
namespace {

double square(double x) noexcept { return x * x; }

}  // namespace

// Twist of the spring of a joint, rad; 0 between the flanks of its gear.
double Plant::twist_beyond_play(int joint) const noexcept {
  const double twist = truth_.theta_m[joint] - truth_.q_m[joint];
  const double play = 0.5 * config_.effects[joint].backlash;
  return twist - std::clamp(twist, -play, play);
}

PlantEnergy Plant::energy() const noexcept {
  PlantEnergy energy;
  energy.potential = config_.mass * chain_.potential_energy();
  for (int i = 0; i < dq_.size(); ++i) {
    energy.kinetic += 0.5 * dq_[i] * chain_.M().col(i).dot(dq_);
  }
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[i];
    energy.kinetic += 0.5 * a.rotor_inertia * square(truth_.dtheta_m[i]);
    energy.spring += 0.5 * a.stiffness * square(twist_beyond_play(i));
    const JointEffects& e = config_.effects[i];
    const double* way = bristles_.data() + i * kRowsPerJoint;
    for (int k = 0; k < e.bristles; ++k) {
      energy.bristle += 0.5 * e.bristle_stiffness / (k + 1) * square(way[k]);
    }
    energy.bristle += 0.5 * e.hysteresis_stiffness * square(way[kMaxBristles]);
  }
  for (const FlexibleJoint& flexible : config_.flexible) {
    energy.spring += 0.5 * flexible.stiffness * square(q_[flexible.joint]);
  }
  return energy;
}

PlantPower Plant::power() const noexcept {
  PlantPower power;
  power.motors = truth_.tau_motor.dot(truth_.dtheta_m);
  power.user = tau_user_.dot(dq_);
  power.bystander = -tau_bystander_.dot(dq_);
  for (int i = 0; i < n_p_; ++i) {
    power.gantry += forces_.f_p[i] * dq_[config_.gantry[i]];
  }
  power.coulomb_friction = friction_lost_.sum();
  power.hysteresis = hysteresis_lost_.sum();
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[i];
    power.viscous_friction += a.viscous_friction * square(truth_.dtheta_m[i]);
    const double slip = truth_.dtheta_m[i] - truth_.dq_m[i];
    const bool has_flanks = config_.effects[i].backlash > 0.0;
    power.joint_damping += has_flanks ? (flanks_[i] - a.stiffness * twist_beyond_play(i)) * slip
                                      : a.damping * square(slip);
    power.end_stops -= forces_.tau_stop[i] * truth_.dq_m[i];
  }
  for (const FlexibleJoint& flexible : config_.flexible) {
    power.flexible_damping += flexible.damping * square(dq_[flexible.joint]);
  }
  return power;
}

double Plant::residual() noexcept {
  const VectorA tau = config_.mass * chain_.inverse_dynamics(q_before_, dq_before_, ddq_);
  double worst = 0.0;
  for (int i = 0; i < n_l_; ++i) {
    const int joint = links_[i];
    double error = tau[joint] - tau_user_[joint] - tau_bystander_[joint] - forces_.tau_links[i];
    if (i < n_m_) error -= forces_.tau_stop[i];
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

}  // namespace hg::simulator
