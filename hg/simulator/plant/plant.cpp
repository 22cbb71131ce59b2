#include "hg/simulator/plant/plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/simulator/plant/cholesky.h"
#include "hg/simulator/random_stream.h"

namespace hg::simulator {
namespace {

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

Plant::Plant(const PlantConfig& config, const model::ChainModel& chain, int handle)
    : config_(config), chain_(chain), handle_(handle) {
  check_plant_config(config, chain);
  n_p_ = static_cast<int>(config_.gantry.size());
  n_m_ = static_cast<int>(config_.manipulator.size());
  n_l_ = n_m_ + static_cast<int>(config_.flexible.size());
  dead_steps_ = static_cast<int>(std::lround(config_.drive.dead_time / config_.step));
  current_share_ =
      config_.current_lag > 0.0 ? -std::expm1(-config_.step / config_.current_lag) : 1.0;
  for (int i = 0; i < n_l_; ++i) {
    links_[i] = i < n_m_ ? config_.manipulator[i] : config_.flexible[i - n_m_].joint;
  }
  if (config_.end_stops.empty()) config_.end_stops.resize(n_m_);
  if (config_.effects.empty()) config_.effects.resize(n_m_);
  if (config_.waviness.empty()) config_.waviness.resize(n_p_);
  draw_phases();

  q_ = dq_ = ddq_ = tau_user_ = tau_bystander_ = VectorQ::Zero(chain.nv());
  travel_ = config_.q_p_start;
  speed_ = VectorP::Zero(n_p_);
  for (int i = 0; i < n_p_; ++i) q_[config_.gantry[i]] = strayed(i).q;
  for (int i = 0; i < n_m_; ++i) q_[links_[i]] = config_.q_m_start[i];
  current_ = VectorM::Zero(n_m_);
  if (config_.position_loop) position_loop_ = {*config_.position_loop, config_.step};
  if (config_.bystander) bystander_ = Bystander(*config_.bystander);
  start_in_balance();
}

void Plant::draw_phases() noexcept {
  const auto phase = [&](RandomEffect effect, int channel) {
    return 2.0 * std::numbers::pi * RandomStream(config_.seed, effect, channel).uniform();
  };
  for (int i = 0; i < n_m_; ++i) {
    wave_phases_[i] = {phase(RandomEffect::kCogging, i), phase(RandomEffect::kRipple, i)};
  }
  waviness_phase_.resize(n_p_);
  for (int i = 0; i < n_p_; ++i) waviness_phase_[i] = phase(RandomEffect::kWaviness, i);
}

// True position and speed of a gantry axis, its drive being at travel_ and speed_.
Plant::Motion Plant::strayed(int axis) const noexcept {
  const Waviness& wave = config_.waviness[axis];
  if (wave.amplitude == 0.0) return {travel_[axis], speed_[axis]};
  const double k = 2.0 * std::numbers::pi / wave.period;
  const double phase = k * travel_[axis] + waviness_phase_[axis];
  return {travel_[axis] + wave.amplitude * std::sin(phase),
          speed_[axis] * (1.0 + wave.amplitude * k * std::cos(phase))};
}

model::Loads Plant::loads() const noexcept {
  model::Loads loads = chain_.model().default_loads();
  loads.mass = config_.mass;
  return loads;
}

// Starts at rest with the springs carrying the weight.
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
  flanks_ = friction_lost_ = hysteresis_lost_ = VectorM::Zero(n_m_);
  for (int i = 0; i < n_l_; ++i) forces_.tau_links[i] = chain_.c()[links_[i]];
  truth_.is_known = true;
  truth_.tau_motor = truth_.dtheta_m = VectorM::Zero(n_m_);
  truth_.theta_m.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const double tau = forces_.tau_links[i];
    const double twist = tau / config_.actuators[i].stiffness;
    const double play = 0.5 * config_.effects[i].backlash;
    truth_.theta_m[i] = q_[links_[i]] + twist + (tau < 0.0 ? -play : play);
  }
  truth_.ddq_p = VectorP::Zero(n_p_);
  observe();
}

void Plant::step(const PlantInput& input) noexcept {
  move_motors(config_.position_loop ? follow(input) : input.tau_command);
  const VectorP ddq_p = move_gantry(input.dq_p_command);
  truth_.w_H = input.w_H;
  tau_user_.noalias() = J_H_.transpose().lazyProduct(input.w_H);
  if (config_.bystander) meet_bystander();

  Equations eq = equations(ddq_p);
  const Rows felt = rows(input);
  resist(eq, felt);
  accelerate(eq, felt);
  integrate(ddq_p);
  chain_.update(q_, dq_, loads());
  observe();
}

JacobianM Plant::handle_jacobian() const noexcept {
  JacobianM J(6, n_m_);
  for (int i = 0; i < n_m_; ++i) J.col(i) = J_H_.col(links_[i]);
  return J;
}

VectorM Plant::carrying_torques() const noexcept {
  VectorM carrying(n_m_);
  for (int i = 0; i < n_m_; ++i) carrying[i] = chain_.c()[links_[i]];
  return carrying;
}

void Plant::meet_bystander() noexcept {
  const int frame = config_.bystander->frame;
  const Eigen::Vector3d force = bystander_.step(config_.step, chain_.pose(frame).p);
  const model::Jacobian J = chain_.jacobian(frame);
  tau_bystander_.noalias() = J.topRows<3>().transpose().lazyProduct(force);
}

// Torques of drives that follow positions; they know the arm as its maker does.
VectorM Plant::follow(const PlantInput& input) noexcept {
  if (input.brakes_closed) {
    position_loop_.rest();
    return input.tau_command;
  }
  VectorM inertia(n_m_), tau_known(n_m_), torque_max(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const int joint = links_[i];
    const ActuatorModel& a = config_.actuators[i];
    inertia[i] = a.rotor_inertia + chain_.M()(joint, joint) / config_.mass;
    tau_known[i] = chain_.c()[joint] / config_.mass;
    torque_max[i] = a.torque_max;
  }
  return position_loop_.torque(input.reference, truth_.theta_m, truth_.dtheta_m, inertia, tau_known,
                               torque_max);
}

// Currents with their lag; a moving motor is limited to the torque available at its speed. Ripple
// and cogging are added on top.
void Plant::move_motors(const VectorM& tau_command) noexcept {
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[i];
    const double command = std::clamp(tau_command[i], -a.torque_max, a.torque_max);
    current_[i] += current_share_ * (command - current_[i]);
    const double dtheta = truth_.dtheta_m[i];
    const double driving = torque_available(a, dtheta);
    truth_.tau_motor[i] = std::clamp(current_[i], dtheta < 0.0 ? -driving : -a.torque_max,
                                     dtheta > 0.0 ? driving : a.torque_max);

    const JointEffects& e = config_.effects[i];
    const double theta = truth_.theta_m[i];
    if (e.ripple > 0.0) {
      truth_.tau_motor[i] *=
          1.0 + e.ripple * std::sin(e.ripple_wave * theta + wave_phases_[i].ripple);
    }
    if (e.cogging > 0.0) {
      truth_.tau_motor[i] += e.cogging * std::sin(e.cogging_wave * theta + wave_phases_[i].cogging);
    }
  }
}

// One step of the drives; returns the accelerations of the axes themselves.
VectorP Plant::move_gantry(const VectorP& dq_p_command) noexcept {
  const double h = config_.step;
  VectorP ddq_p(n_p_);
  for (int i = 0; i < n_p_; ++i) {
    const double command = delays_[i].shift(dq_p_command[i], dead_steps_);
    double ddq = drive_acceleration(config_.drive, speed_[i], command);
    if (!config_.gantry_stops.empty()) {
      ddq = stopped(config_.gantry_stops[i], travel_[i], speed_[i], ddq);
    }
    const double before = strayed(i).dq;
    truth_.ddq_p[i] = ddq;
    travel_[i] += h * (speed_[i] + 0.5 * h * ddq);
    speed_[i] += h * ddq;
    const bool is_true = config_.waviness[i].amplitude == 0.0;
    ddq_p[i] = is_true ? ddq : (strayed(i).dq - before) / h;
  }
  return ddq_p;
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
    const int joint = links_[j];
    eq.tau[j] = tau_user_[joint] + tau_bystander_[joint] - chain_.c()[joint];
    for (int i = 0; i < n_p_; ++i) eq.tau[j] -= M(joint, config_.gantry[i]) * ddq_p[i];
    for (int i = j; i < n_l_; ++i) eq.L(i, j) = M(links_[i], joint);
  }
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& a = config_.actuators[i];
    const int joint = links_[i];
    const double dtheta = truth_.dtheta_m[i], slip = dtheta - dq_[joint];
    const bool has_flanks = config_.effects[i].backlash > 0.0;  // rows instead of a spring
    const double b = has_flanks ? 0.0 : h * (h * a.stiffness + a.damping);
    const double own = a.rotor_inertia + h * a.viscous_friction;
    eq.spring[i] =
        has_flanks ? 0.0
                   : a.stiffness * (truth_.theta_m[i] - q_[joint] + h * slip) + a.damping * slip;
    eq.motor[i] = truth_.tau_motor[i] - eq.spring[i] - a.viscous_friction * dtheta;
    eq.inertia[i] = own + b;
    eq.coupling[i] = b;
    eq.tau[i] += eq.spring[i] + b / eq.inertia[i] * eq.motor[i];
    eq.L(i, i) += b * own / eq.inertia[i];
  }
  for (int i = n_m_; i < n_l_; ++i) {
    const FlexibleJoint& f = config_.flexible[i - n_m_];
    eq.spring[i] = -f.stiffness * (q_[f.joint] + h * dq_[f.joint]) - f.damping * dq_[f.joint];
    eq.tau[i] += eq.spring[i];
    eq.L(i, i) += h * (h * f.stiffness + f.damping);
  }
  factorise(eq.L);
  return eq;
}

namespace {

constexpr int kStopSlot = kRowsPerJoint - 1;

bool is_held(const PlantInput& input, int joint) noexcept {
  if (has_bit(input.faults.closed_brakes, joint)) return true;
  return input.brakes_closed && !has_bit(input.faults.weak_brakes, joint);
}

}  // namespace

double Plant::friction_bound(int joint) const noexcept {
  return coulomb_torque(config_.actuators[joint], truth_.dtheta_m[joint], forces_.tau_links[joint]);
}

// Friction of the motors comes first, so that row i is the only or first one of motor i.
Plant::Rows Plant::rows(const PlantInput& input) const noexcept {
  Rows rows;
  for (int i = 0; i < n_m_; ++i) add_friction(i, 0, input, rows);
  for (int i = 0; i < n_m_; ++i) {
    const JointEffects& e = config_.effects[i];
    const bool yields = e.bristle_stiffness > 0.0 && !is_held(input, i);
    for (int k = 1; yields && k < e.bristles; ++k) add_friction(i, k, input, rows);
  }
  for (int i = 0; i < n_m_; ++i) add_gear(i, rows);
  for (int i = 0; i < n_m_; ++i) add_stop(i, rows);
  return rows;
}

// An element of the dry friction: it slips at its bound; below that its bristle deflects. A closed
// brake holds the motor itself.
void Plant::add_friction(int joint, int element, const PlantInput& input,
                         Rows& rows) const noexcept {
  const JointEffects& e = config_.effects[joint];
  Row row = {.joint = joint, .slot = joint * kRowsPerJoint + element, .motor = 1.0};
  row.ub = is_held(input, joint) ? kInfinity : friction_bound(joint);
  if (e.bristle_stiffness > 0.0 && !is_held(input, joint)) {
    row.ub /= e.bristles;
    row.stiffness = e.bristle_stiffness / (element + 1);
    row.give = 1.0 / (config_.step * row.stiffness + e.bristle_damping / e.bristles);
    row.offset = row.give * row.stiffness * bristles_[row.slot];
  }
  row.lb = -row.ub;
  rows.add(row);
}

// Between motor and link: hysteresis, and with backlash the flanks of the teeth that may touch when
// the step ends. A flank's damper acts only over its penetration, so that it never pulls.
void Plant::add_gear(int joint, Rows& rows) const noexcept {
  constexpr int kHysteresisSlot = kMaxBristles, kFlankSlot = kMaxBristles + 1;
  const JointEffects& e = config_.effects[joint];
  const int slot = joint * kRowsPerJoint;
  if (e.hysteresis > 0.0) {
    const double h = config_.step;
    const double way = bristles_[slot + kHysteresisSlot];
    rows.add({.joint = joint,
              .slot = slot + kHysteresisSlot,
              .motor = 1.0,
              .link = -1.0,
              .stiffness = e.hysteresis_stiffness,
              .give = 1.0 / (h * e.hysteresis_stiffness),
              .offset = way / h,
              .lb = -e.hysteresis,
              .ub = e.hysteresis});
  }
  if (e.backlash == 0.0) return;
  const ActuatorModel& a = config_.actuators[joint];
  const double twist = truth_.theta_m[joint] - q_[links_[joint]];
  const double slip = truth_.dtheta_m[joint] - dq_[links_[joint]];
  for (const int flank : {0, 1}) {
    const double side = flank == 0 ? 1.0 : -1.0;
    add_touch({.joint = joint, .slot = slot + kFlankSlot + flank, .motor = -side, .link = side},
              side * twist - 0.5 * e.backlash, slip, a.stiffness, a.damping, rows);
  }
}

// A stop that the link may reach when the step ends. Its damper acts only over the penetration, so
// that all energy stored by a stop comes from the link.
void Plant::add_stop(int joint, Rows& rows) const noexcept {
  const EndStopModel& stop = config_.end_stop;
  const int link = links_[joint];
  const Interval& travel = config_.end_stops[joint];
  const double below = travel.lb - q_[link], above = q_[link] - travel.ub;
  const double damping =
      2.0 * stop.damping_ratio * std::sqrt(stop.stiffness * chain_.M()(link, link));
  add_touch({.joint = joint,
             .slot = joint * kRowsPerJoint + kStopSlot,
             .link = below > above ? 1.0 : -1.0},
            std::max(below, above), dq_[link], stop.stiffness, damping, rows);
}

// `row` pushes by a spring compressed by `depth` that yields with `speed`; no force where the two
// cannot touch before the step ends.
void Plant::add_touch(Row row, double depth, double speed, double stiffness, double damping,
                      Rows& rows) const noexcept {
  constexpr double kSpeedGained = 1.0;  // rad/s, maximum gain in one step
  const double h = config_.step;
  if (depth < -h * (std::abs(speed) + kSpeedGained)) return;
  const double stiff = h * stiffness + damping;
  row.give = 1.0 / stiff;
  row.offset = -(depth > 0.0 ? stiffness * depth / stiff : depth / h);
  row.lb = 0.0;
  row.ub = kInfinity;
  rows.add(row);
}

// All rows as one box problem in the speeds at the end of the step.
void Plant::resist(const Equations& eq, const Rows& rows) noexcept {
  const double h = config_.step;
  const int n = rows.count;
  MatrixUpTo<kMaxLinks, kMaxBoxRows> G = MatrixUpTo<kMaxLinks, kMaxBoxRows>::Zero(n_l_, n);
  box_.w_free.resize(n);
  box_.lb.resize(n);
  box_.ub.resize(n);
  VectorL ddq_free = eq.tau;
  solve_lower(eq.L, ddq_free);
  for (int k = 0; k < n; ++k) {
    const Row& row = rows[k];
    const int i = row.joint;
    const double dtheta = truth_.dtheta_m[i] + h * eq.motor[i] / eq.inertia[i];
    box_.lb[k] = row.lb;
    box_.ub[k] = row.ub;
    box_solution_.state[k] = row_states_[row.slot];
    box_.w_free[k] = row.motor * dtheta + row.link * dq_[links_[i]] + row.offset;
    G(i, k) = row.motor * eq.coupling[i] / eq.inertia[i] + row.link;
    solve_lower(eq.L, G.col(k), i);
  }
  box_.A.noalias() = h * G.transpose().lazyProduct(G);
  box_.w_free += h * G.transpose().lazyProduct(ddq_free);
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < n; ++l) {
      if (rows[k].joint != rows[l].joint) continue;
      box_.A(k, l) += rows[k].motor * rows[l].motor * (h / eq.inertia[rows[k].joint]);
    }
    box_.A(k, k) += rows[k].give;
  }
  solve(box_, box_solution_);
}

// Advances the bristle in series with a row of this force and rate; adds the dissipation of the row
// to the losses.
void Plant::stretch(const Row& row, double force, double rate) noexcept {
  double& way = bristles_[row.slot];
  const double speed = row.stiffness > 0.0 ? -row.give * (force + row.stiffness * way) : 0.0;
  way += config_.step * speed;
  const double lost = -force * rate - (force + row.stiffness * way) * speed;
  (row.link == 0.0 ? friction_lost_ : hysteresis_lost_)[row.joint] += lost;
}

// Accelerations under all forces; motors held by friction stay exactly at rest.
void Plant::accelerate(Equations& eq, const Rows& rows) noexcept {
  const double h = config_.step;
  VectorM motor = VectorM::Zero(n_m_), link = VectorM::Zero(n_m_);
  std::array<bool, kMaxManipulator> stands{};
  forces_.tau_stop.setZero();
  forces_.tau_friction.setZero();
  friction_lost_.setZero();
  hysteresis_lost_.setZero();
  flanks_.setZero();
  row_states_.fill(BoxState::kHeld);
  for (int k = 0; k < rows.count; ++k) {
    const Row& row = rows[k];
    const int i = row.joint;
    const double f = box_solution_.f[k];
    row_states_[row.slot] = box_solution_.state[k];
    motor[i] += row.motor * f;
    link[i] += row.link * f;
    if (row.motor == 0.0) forces_.tau_stop[i] = row.link * f;
    if (row.link == 0.0) forces_.tau_friction[i] += f;
    if (row.motor * row.link != 0.0 && row.lb == 0.0) flanks_[i] += row.link * f;
    if (row.lb < 0.0) stretch(row, f, box_solution_.w[k]);
    if (k < n_m_) stands[i] = row.give == 0.0 && box_solution_.w[k] == 0.0;
  }
  for (int i = 0; i < n_m_; ++i) {
    eq.tau[i] += eq.coupling[i] / eq.inertia[i] * motor[i] + link[i];
  }
  forces_.ddq = eq.tau;
  solve_lower(eq.L, forces_.ddq);
  solve_upper(eq.L, forces_.ddq);
  forces_.tau_links = eq.spring;
  for (int i = 0; i < n_m_; ++i) {
    const double dtheta = truth_.dtheta_m[i];
    forces_.ddtheta[i] =
        stands[i] ? -dtheta / h
                  : (eq.motor[i] + motor[i] + eq.coupling[i] * forces_.ddq[i]) / eq.inertia[i];
    truth_.dtheta_m[i] = stands[i] ? 0.0 : dtheta + h * forces_.ddtheta[i];
    forces_.tau_links[i] +=
        eq.coupling[i] * (forces_.ddtheta[i] - forces_.ddq[i]) + (link[i] - forces_.tau_stop[i]);
  }
  for (int i = n_m_; i < n_l_; ++i) {
    const FlexibleJoint& f = config_.flexible[i - n_m_];
    forces_.tau_links[i] -= h * (h * f.stiffness + f.damping) * forces_.ddq[i];
  }
  forces_.tries = box_solution_.tries;
  forces_.is_exact = box_solution_.is_exact;
}

void Plant::integrate(const VectorP& ddq_p) noexcept {
  const double h = config_.step;
  q_before_ = q_;
  dq_before_ = dq_;
  for (int i = 0; i < n_p_; ++i) ddq_[config_.gantry[i]] = ddq_p[i];
  for (int i = 0; i < n_l_; ++i) ddq_[links_[i]] = forces_.ddq[i];
  for (int i = 0; i < n_p_; ++i) {
    const int joint = config_.gantry[i];
    forces_.f_p[i] = chain_.M().row(joint).dot(ddq_) + chain_.c()[joint] - tau_user_[joint] -
                     tau_bystander_[joint];
  }
  dq_ += h * ddq_;
  for (int i = 0; i < n_p_; ++i) {
    const Motion motion = strayed(i);
    q_[config_.gantry[i]] = motion.q;
    dq_[config_.gantry[i]] = motion.dq;
  }
  for (int i = 0; i < n_l_; ++i) q_[links_[i]] += h * dq_[links_[i]];
  truth_.theta_m += h * truth_.dtheta_m;
}

void Plant::observe() noexcept {
  truth_.q_m.resize(n_m_);
  truth_.dq_m.resize(n_m_);
  truth_.q_p = travel_;
  truth_.dq_p = speed_;
  for (int i = 0; i < n_m_; ++i) {
    truth_.q_m[i] = q_[links_[i]];
    truth_.dq_m[i] = dq_[links_[i]];
  }
  truth_.tau_J = forces_.tau_links.head(n_m_);
  truth_.bystander = bystander_.report();
  truth_.T_B_H = chain_.pose(handle_);
  truth_.twist = chain_.twist(handle_);
  J_H_ = chain_.jacobian(handle_);
  truth_.acceleration.noalias() = J_H_.lazyProduct(ddq_);
  truth_.acceleration += chain_.bias_acceleration(handle_);
}

}  // namespace hg::simulator
