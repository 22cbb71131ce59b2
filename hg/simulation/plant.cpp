#include "hg/simulation/plant.h"

#include <algorithm>
#include <cmath>

#include "hg/simulation/cholesky.h"

namespace hg::simulation {
namespace {

std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

// Acceleration of an axis of the gantry, `ddq` by its drive, against buffers that never pull and
// are critically damped with the mass of the axis: 1.5 m/s end 9 mm beyond.
double stopped(const Interval& travel, double q, double dq, double ddq) noexcept {
  constexpr double kOmega = 60.0;  // rad/s
  const auto push = [&](double depth, double speed) {
    return kOmega * kOmega * depth + 2.0 * kOmega * speed;
  };
  if (q > travel.ub) return std::min(ddq, -std::max(0.0, push(q - travel.ub, dq)));
  if (q < travel.lb) return std::max(ddq, std::max(0.0, push(travel.lb - q, -dq)));
  return ddq;
}

}  // namespace

Plant::Plant(const PlantConfig& config, const model::Chain& chain, int handle)
    : config_(config), chain_(chain), handle_(handle) {
  check(config, chain);
  n_p_ = static_cast<int>(config_.gantry.size());
  n_m_ = static_cast<int>(config_.manipulator.size());
  n_l_ = n_m_ + static_cast<int>(config_.flexible.size());
  dead_steps_ = static_cast<int>(std::lround(config_.drive.dead_time / config_.step));
  current_share_ =
      config_.current_lag > 0.0 ? -std::expm1(-config_.step / config_.current_lag) : 1.0;
  for (int i = 0; i < n_l_; ++i) {
    links_[at(i)] = i < n_m_ ? config_.manipulator[at(i)] : config_.flexible[at(i - n_m_)].joint;
  }
  if (config_.end_stops.empty()) config_.end_stops.resize(at(n_m_));

  q_ = dq_ = ddq_ = tau_user_ = tau_bystander_ = VectorQ::Zero(chain.nv());
  for (int i = 0; i < n_p_; ++i) q_[config_.gantry[at(i)]] = config_.q_p_start[i];
  for (int i = 0; i < n_m_; ++i) q_[links_[at(i)]] = config_.q_m_start[i];
  current_ = VectorM::Zero(n_m_);
  if (config_.bystander) bystander_ = Bystander(*config_.bystander);
  start_in_balance();
}

model::Loads Plant::loads() const noexcept {
  model::Loads loads = chain_.default_loads();
  loads.mass = config_.mass;
  return loads;
}

// The springs carry the weight.
void Plant::start_in_balance() noexcept {
  constexpr int kRounds = 50;  // the sag of a flexible joint changes its load but little
  for (int round = 0; round < kRounds; ++round) {
    chain_.update(q_, dq_, loads());
    for (const FlexibleJoint& joint : config_.flexible) {
      if (joint.stiffness > 0.0) q_[joint.joint] = -chain_.c()[joint.joint] / joint.stiffness;
    }
  }
  chain_.update(q_, dq_, loads());
  q_before_ = q_;
  dq_before_ = dq_;

  forces_.ddq = forces_.tau_links = VectorL::Zero(n_l_);
  forces_.ddtheta = forces_.tau_friction = forces_.tau_stop = VectorM::Zero(n_m_);
  forces_.f_p = VectorP::Zero(n_p_);
  for (int i = 0; i < n_l_; ++i) forces_.tau_links[i] = chain_.c()[links_[at(i)]];
  truth_.is_known = true;
  truth_.tau_motor = truth_.dtheta_m = VectorM::Zero(n_m_);
  truth_.theta_m.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    truth_.theta_m[i] =
        q_[links_[at(i)]] + forces_.tau_links[i] / config_.actuators[at(i)].stiffness;
  }
  truth_.ddq_p = VectorP::Zero(n_p_);
  observe();
}

void Plant::step(const PlantInput& input) noexcept {
  move_motors(input.tau_command);
  truth_.ddq_p = gantry_acceleration(input.dq_p_command);
  truth_.w_H = input.w_H;
  tau_user_.noalias() = J_H_.transpose().lazyProduct(input.w_H);
  if (config_.bystander) meet_bystander();

  Equations eq = equations(truth_.ddq_p);
  const Contacts contacts = near_stops();
  resist(eq, contacts, input);
  accelerate(eq, contacts);
  integrate(truth_.ddq_p);
  chain_.update(q_, dq_, loads());
  observe();
}

void Plant::meet_bystander() noexcept {
  const int frame = config_.bystander->frame;
  const Eigen::Vector3d force = bystander_.step(config_.step, chain_.pose(frame).p);
  const model::Jacobian J = chain_.jacobian(frame);
  tau_bystander_.noalias() = J.topRows<3>().transpose().lazyProduct(force);
}

// Currents with their lag; a motor in motion has no more torque than its speed leaves.
void Plant::move_motors(const VectorM& tau_command) noexcept {
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[at(i)];
    const double command = std::clamp(tau_command[i], -a.torque_max, a.torque_max);
    current_[i] += current_share_ * (command - current_[i]);
    const double dtheta = truth_.dtheta_m[i];
    const double driving = torque_available(a, dtheta);
    truth_.tau_motor[i] = std::clamp(current_[i], dtheta < 0.0 ? -driving : -a.torque_max,
                                     dtheta > 0.0 ? driving : a.torque_max);
  }
}

VectorP Plant::gantry_acceleration(const VectorP& dq_p_command) noexcept {
  VectorP ddq_p(n_p_);
  for (int i = 0; i < n_p_; ++i) {
    const double command = delays_[at(i)].shift(dq_p_command[i], dead_steps_);
    const int joint = config_.gantry[at(i)];
    ddq_p[i] = drive_acceleration(config_.drive, dq_[joint], command);
    if (!config_.gantry_stops.empty()) {
      ddq_p[i] = stopped(config_.gantry_stops[at(i)], q_[joint], dq_[joint], ddq_p[i]);
    }
  }
  return ddq_p;
}

// Stops that a link can be at when the step ends. Of the damper only the way inside counts, so that
// a link pays for all that a stop stores.
Plant::Contacts Plant::near_stops() const noexcept {
  constexpr double kSpeedGained = 1.0;  // rad/s, at most in one step
  const double h = config_.step;
  const EndStopModel& stop = config_.end_stop;
  Contacts contacts;
  for (int i = 0; i < n_m_; ++i) {
    const int joint = links_[at(i)];
    const Interval& travel = config_.end_stops[at(i)];
    const double below = travel.lb - q_[joint], above = q_[joint] - travel.ub;
    const double depth = std::max(below, above);
    if (depth < -h * (std::abs(dq_[joint]) + kSpeedGained)) continue;
    const double give =
        h * stop.stiffness +
        2.0 * stop.damping_ratio * std::sqrt(stop.stiffness * chain_.M()(joint, joint));
    const double rest = depth > 0.0 ? stop.stiffness * depth / give : depth / h;
    contacts.at[at(contacts.count++)] = {i, below > above ? 1.0 : -1.0, give, rest};
  }
  return contacts;
}

// [HANDBOOK] 4.4 (b), for accelerations instead of velocities: M times a velocity would be rounded
// too coarsely. Motors are eliminated: theta'' = (motor + friction + coupling ddq) / inertia.
Plant::Equations Plant::equations(const VectorP& ddq_p) const noexcept {
  const double h = config_.step;
  const Eigen::MatrixXd& M = chain_.M();
  Equations eq;
  eq.L.resize(n_l_, n_l_);
  eq.tau.resize(n_l_);
  eq.spring.resize(n_l_);
  eq.motor.resize(n_m_);
  eq.inertia.resize(n_m_);
  eq.coupling.resize(n_m_);
  for (int j = 0; j < n_l_; ++j) {
    const int joint = links_[at(j)];
    eq.tau[j] = tau_user_[joint] + tau_bystander_[joint] - chain_.c()[joint];
    for (int i = 0; i < n_p_; ++i) eq.tau[j] -= M(joint, config_.gantry[at(i)]) * ddq_p[i];
    for (int i = j; i < n_l_; ++i) eq.L(i, j) = M(links_[at(i)], joint);
  }
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[at(i)];
    const int joint = links_[at(i)];
    const double dtheta = truth_.dtheta_m[i], slip = dtheta - dq_[joint];
    const double b = h * (h * a.stiffness + a.damping);
    const double own = a.rotor_inertia + h * a.viscous_friction;
    eq.spring[i] = a.stiffness * (truth_.theta_m[i] - q_[joint] + h * slip) + a.damping * slip;
    eq.motor[i] = truth_.tau_motor[i] - eq.spring[i] - a.viscous_friction * dtheta;
    eq.inertia[i] = own + b;
    eq.coupling[i] = b;
    eq.tau[i] += eq.spring[i] + b / eq.inertia[i] * eq.motor[i];
    eq.L(i, i) += b * own / eq.inertia[i];
  }
  for (int i = n_m_; i < n_l_; ++i) {
    const FlexibleJoint& f = config_.flexible[at(i - n_m_)];
    eq.spring[i] = -f.stiffness * (q_[f.joint] + h * dq_[f.joint]) - f.damping * dq_[f.joint];
    eq.tau[i] += eq.spring[i];
    eq.L(i, i) += h * (h * f.stiffness + f.damping);
  }
  factorise(eq.L);
  return eq;
}

namespace {

bool is_held(const PlantInput& input, int joint) noexcept {
  if (has_bit(input.faults.closed_brakes, joint)) return true;
  return input.brakes_closed && !has_bit(input.faults.weak_brakes, joint);
}

}  // namespace

double Plant::friction_bound(int joint) const noexcept {
  return coulomb_torque(config_.actuators[at(joint)], truth_.dtheta_m[joint],
                        forces_.tau_links[joint]);
}

// Friction, brakes and stops as one box problem in the speeds at the end of the step.
void Plant::resist(const Equations& eq, const Contacts& contacts,
                   const PlantInput& input) noexcept {
  const double h = config_.step;
  const int n = n_m_ + contacts.count;
  MatrixUpTo<kMaxLinks, kMaxBoxRows> G = MatrixUpTo<kMaxLinks, kMaxBoxRows>::Zero(n_l_, n);
  box_.w_free.resize(n);
  box_.lb.resize(n);
  box_.ub.resize(n);
  VectorL ddq_free = eq.tau;
  solve_lower(eq.L, ddq_free);
  for (int i = 0; i < n_m_; ++i) {
    box_.ub[i] = is_held(input, i) ? kInfinity : friction_bound(i);
    box_.lb[i] = -box_.ub[i];
    box_solution_.state[at(i)] = friction_states_[at(i)];
    G(i, i) = eq.coupling[i] / eq.inertia[i];
    box_.w_free[i] = truth_.dtheta_m[i] + h * eq.motor[i] / eq.inertia[i];
  }
  for (int k = 0; k < contacts.count; ++k) {
    const Contact& contact = contacts.at[at(k)];
    box_.lb[n_m_ + k] = 0.0;
    box_.ub[n_m_ + k] = kInfinity;
    box_solution_.state[at(n_m_ + k)] = stop_states_[at(contact.joint)];
    G(contact.joint, n_m_ + k) = contact.side;
    box_.w_free[n_m_ + k] = contact.side * dq_[links_[at(contact.joint)]] - contact.rest;
  }
  for (int k = 0; k < n; ++k) {
    solve_lower(eq.L, G.col(k), k < n_m_ ? k : contacts.at[at(k - n_m_)].joint);
  }
  box_.A.noalias() = h * G.transpose().lazyProduct(G);
  box_.w_free += h * G.transpose().lazyProduct(ddq_free);
  for (int i = 0; i < n_m_; ++i) box_.A(i, i) += h / eq.inertia[i];
  for (int k = 0; k < contacts.count; ++k) {
    box_.A(n_m_ + k, n_m_ + k) += 1.0 / contacts.at[at(k)].give;
  }
  solve(box_, box_solution_);
}

// Accelerations under all forces; motors that friction holds stand still exactly.
void Plant::accelerate(Equations& eq, const Contacts& contacts) noexcept {
  const double h = config_.step;
  forces_.tau_stop.setZero();
  stop_states_.fill(BoxState::kHeld);
  for (int k = 0; k < contacts.count; ++k) {
    const Contact& contact = contacts.at[at(k)];
    forces_.tau_stop[contact.joint] = contact.side * box_solution_.f[n_m_ + k];
    stop_states_[at(contact.joint)] = box_solution_.state[at(n_m_ + k)];
  }
  for (int i = 0; i < n_m_; ++i) {
    friction_states_[at(i)] = box_solution_.state[at(i)];
    forces_.tau_friction[i] = box_solution_.f[i];
    eq.tau[i] += eq.coupling[i] / eq.inertia[i] * forces_.tau_friction[i] + forces_.tau_stop[i];
  }
  forces_.ddq = eq.tau;
  solve_lower(eq.L, forces_.ddq);
  solve_upper(eq.L, forces_.ddq);
  forces_.tau_links = eq.spring;
  for (int i = 0; i < n_m_; ++i) {
    const double dtheta = truth_.dtheta_m[i];
    const bool is_held = box_solution_.w[i] == 0.0;
    forces_.ddtheta[i] =
        is_held ? -dtheta / h
                : (eq.motor[i] + forces_.tau_friction[i] + eq.coupling[i] * forces_.ddq[i]) /
                      eq.inertia[i];
    truth_.dtheta_m[i] = is_held ? 0.0 : dtheta + h * forces_.ddtheta[i];
    forces_.tau_links[i] += eq.coupling[i] * (forces_.ddtheta[i] - forces_.ddq[i]);
  }
  for (int i = n_m_; i < n_l_; ++i) {
    const FlexibleJoint& f = config_.flexible[at(i - n_m_)];
    forces_.tau_links[i] -= h * (h * f.stiffness + f.damping) * forces_.ddq[i];
  }
  forces_.tries = box_solution_.tries;
  forces_.is_exact = box_solution_.is_exact;
}

void Plant::integrate(const VectorP& ddq_p) noexcept {
  const double h = config_.step;
  q_before_ = q_;
  dq_before_ = dq_;
  for (int i = 0; i < n_p_; ++i) ddq_[config_.gantry[at(i)]] = ddq_p[i];
  for (int i = 0; i < n_l_; ++i) ddq_[links_[at(i)]] = forces_.ddq[i];
  for (int i = 0; i < n_p_; ++i) {
    const int joint = config_.gantry[at(i)];
    forces_.f_p[i] = chain_.M().row(joint).dot(ddq_) + chain_.c()[joint] - tau_user_[joint] -
                     tau_bystander_[joint];
  }
  dq_ += h * ddq_;
  for (int i = 0; i < n_p_; ++i) {
    const int joint = config_.gantry[at(i)];
    q_[joint] += h * (dq_before_[joint] + 0.5 * h * ddq_p[i]);
  }
  for (int i = 0; i < n_l_; ++i) q_[links_[at(i)]] += h * dq_[links_[at(i)]];
  truth_.theta_m += h * truth_.dtheta_m;
}

void Plant::observe() noexcept {
  truth_.q_p.resize(n_p_);
  truth_.dq_p.resize(n_p_);
  truth_.q_m.resize(n_m_);
  truth_.dq_m.resize(n_m_);
  for (int i = 0; i < n_p_; ++i) {
    truth_.q_p[i] = q_[config_.gantry[at(i)]];
    truth_.dq_p[i] = dq_[config_.gantry[at(i)]];
  }
  for (int i = 0; i < n_m_; ++i) {
    truth_.q_m[i] = q_[links_[at(i)]];
    truth_.dq_m[i] = dq_[links_[at(i)]];
  }
  truth_.tau_J = forces_.tau_links.head(n_m_);
  truth_.bystander = bystander_.report();
  truth_.T_B_H = chain_.pose(handle_);
  truth_.twist = chain_.twist(handle_);
  J_H_ = chain_.jacobian(handle_);
  truth_.acceleration.noalias() = J_H_.lazyProduct(ddq_);
  truth_.acceleration += chain_.bias_acceleration(handle_);
}

}  // namespace hg::simulation
