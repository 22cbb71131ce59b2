#include "hg/controller/tracking/joint_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "hg/controller/estimation/low_pass.h"
#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/model/urdf.h"

namespace hg::tracking {
namespace {

constexpr double kLatencyMemory = 0.05;    // share of the newest sample in the mean
constexpr double kLatencyMargin = 0.5;     // periods; with gains for one period two are unstable
constexpr double kLateFor = 0.05;          // s; time-out of a device without commands, too
constexpr double kCutFor = 0.01;           // s; longer than drives should continue by themselves
constexpr double kCutPeriods = 2.5;        // at least: one command may be lost at any rate
constexpr double kDisturbedFor = 0.005;    // s; three frames that were filled in are less
constexpr double kFeedforwardShare = 0.7;  // of the peak torque, the rest is for feedback
constexpr double kUnexplained_s = 0.1;     // averaging time of unexplained torques
const double kFastestFilter = std::sqrt(5.0) - 1.0;  // rad per period, see largest_flatness_Hz()
constexpr double kSlides = 0.5;          // share of friction_speed's tanh from which a joint slides
constexpr double kSlips = 0.999;         // share of all bristles that slip, up to rounding
constexpr int kSweepsAtStart = 12;       // far more than any matrix of seven rows needs
constexpr double kMotorPdDamping = 1.4;  // [C] 1: K_d = 1.4 sqrt(K Jm)

// drives that follow positions need no more
void fill(const ReferenceState& reference, CommandFrame& command) noexcept {
  command.q_m = reference.q_m;
  command.dq_m = reference.dq_m;
  command.ddq_m = reference.ddq_m;
}

// periods since the command that is at work; < 0: none was answered, or one that never was
double age_of(const SensorFrame& sensors) noexcept {
  if (sensors.answered_sequence == 0 || sensors.answered_sequence > sensors.sequence) return -1.0;
  return static_cast<double>(sensors.sequence - sensors.answered_sequence);
}

}  // namespace

// The eigenvalues of the filter in follow_torque() with z = 2 pi flatness / rate have the product 1
// - z and the sum 2 - z - z^2: within the unit circle while 4 - 2 z - z^2 > 0.
double largest_flatness_Hz(double rate_Hz) noexcept {
  return kFastestFilter * rate_Hz / (2.0 * std::numbers::pi);
}

void check_control_config(const ControlConfig& config, double rate_Hz) {
  if (config.method == Method::kDrives) return;
  const double longest = kMostLatency * (1.0 / rate_Hz);
  if (!(config.loop.latency <= longest)) {
    throw SetupError("control.latency_s: must be at most " + std::to_string(kMostLatency) +
                     " periods, at " + model::to_text(rate_Hz) + " Hz " + model::to_text(longest) +
                     " s, got " + model::to_text(config.loop.latency));
  }
  const double most = largest_flatness_Hz(rate_Hz);
  if (config.flatness_Hz < most) return;
  throw SetupError("control.flatness_Hz: at " + model::to_text(rate_Hz) + " Hz it must be below " +
                   model::to_text(std::floor(10.0 * most) / 10.0) +
                   ", or the torques fed forward oscillate, got " +
                   model::to_text(config.flatness_Hz) + ": lower it, or raise the rate");
}

JointControl::JointControl(const ControlConfig& config, const DeviceModel& device)
    : config_(config),
      chain_(device.chain),
      n_p_(device.n_p),
      n_m_(device.n_m),
      handle_(device.handle),
      dt_(device.dt()),
      actuators_(device.actuators) {
  check_control_config(config_, device.rate_Hz);
  if (config_.method == Method::kDrives) return;
  if (static_cast<int>(actuators_.size()) != n_m_) {
    throw SetupError("control: " + std::to_string(n_m_) + " actuators expected, got " +
                     std::to_string(actuators_.size()));
  }
  lead_pole_ = estimation::low_pass_pole(config_.lead_low_pass_Hz, dt_);
  stiff_pole_ = estimation::low_pass_pole(config_.stiff_low_pass_Hz, dt_);
  K_.resize(n_m_);
  J_m_.resize(n_m_);
  feed_max_.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    K_[i] = actuators_[i].stiffness;
    J_m_[i] = actuators_[i].rotor_inertia;
    feed_max_[i] = kFeedforwardShare * actuators_[i].torque_max;
  }
  sqrt_K_ = K_.cwiseSqrt();
  has_feet_ = std::ranges::any_of(actuators_, has_presliding);
}

ControlState JointControl::start() const noexcept {
  ControlState state;
  state.latency = config_.loop.latency / dt_;
  state.modes = Modes(n_m_);
  state.integral = VectorM::Zero(n_m_);
  state.friction = VectorM::Constant(n_m_, config_.friction_share);
  state.tau_r = state.dtau_r = state.ddtau_r = state.stiff = VectorM::Zero(n_m_);
  if (has_feet_) state.feet = BristleFeet::Zero(n_m_, kSlipElements);
  return state;
}

void JointControl::restart(ControlState& state) const noexcept {
  const double latency = state.latency;
  const int answers = state.answers;
  state = start();
  state.latency = latency;
  state.answers = answers;
}

void JointControl::listen(const SensorFrame& sensors, bool on, ControlState& state) const noexcept {
  const double age = age_of(sensors);
  if (on) {
    // drives that follow positions need not answer, and may be on before their latency is known
    if (state.answers < kAnswersNeeded) return;
    const bool is_late = age < 0.0 || age > state.latency + kLatencyMargin;
    state.late = std::max(0, state.late + (is_late ? 1 : -1));
    return;
  }
  state.late = 0;
  if (age < 0.0) return;
  state.answers = std::min(state.answers + 1, kAnswersNeeded);
  state.latency += kLatencyMemory * (age - state.latency);
}

Fault JointControl::check_latency(const SensorFrame& sensors,
                                  const ControlState& state) const noexcept {
  const bool is_known = state.answers >= kAnswersNeeded;
  const double age = age_of(sensors);
  const double most = state.latency * dt_ + std::max(kCutFor, kCutPeriods * dt_);
  if (is_known && age * dt_ > most && age >= state.late) {
    return {FaultCode::kCommandsLost, -1, age * dt_, most};
  }
  if (config_.method == Method::kDrives) return {};
  return state.late * dt_ < kLateFor ? Fault{} : link_fault(sensors, state);
}

Fault JointControl::link_disturbance(const SensorFrame& sensors,
                                     const ControlState& state) const noexcept {
  return state.late * dt_ < kDisturbedFor ? Fault{} : link_fault(sensors, state);
}

// Commands are lost when the command at work dates from before it became late: none has arrived
// since. Where it is younger they arrive late; where it is not late at all they arrive again.
Fault JointControl::link_fault(const SensorFrame& sensors,
                               const ControlState& state) const noexcept {
  const double age = age_of(sensors), most = state.latency + kLatencyMargin;
  const bool has_grown = age < 0.0 || (age > most && age < state.late);
  if (has_grown) return {FaultCode::kLatencyGrew, -1, age * dt_, most * dt_};
  return {FaultCode::kCommandsLost, -1, std::max<double>(age, state.late) * dt_, most * dt_};
}

void JointControl::rest(const ReferenceState& reference, ControlState& state,
                        CommandFrame& command) const noexcept {
  fill(reference, command);
  state.is_started = false;
  if (config_.method != Method::kDrives) command.tau_m = VectorM::Zero(n_m_);
}

void JointControl::step(const ReferenceState& now, const ReferenceState& next,
                        const RobotState& robot, ControlState& state, CommandFrame& command,
                        TrackingReport& report) noexcept {
  fill(next, command);
  report.error = now.q_m - robot.q_m;
  if (config_.method == Method::kDrives) return;

  if (!state.is_started) begin(next, robot, state);
  const Errors errors = {.theta = now.q_m + state.tau_r.cwiseQuotient(K_) - robot.theta_m,
                         .dtheta = now.dq_m + state.dtau_r.cwiseQuotient(K_) - robot.dtheta_m,
                         .q = report.error,
                         .dq = now.dq_m - robot.dq_m};
  const Feedforward forward = feedforward(next, robot, state);
  command.tau_m = config_.method == Method::kModal ? modal_torque(errors, robot, forward, state)
                                                   : motor_pd_torque(errors, forward);
  command.tau_m += friction(forward, state);

  state.is_saturated = false;
  report.torque_share.resize(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    double& tau = command.tau_m[i];
    const double available = tau * robot.dtheta_m[i] > 0.0
                                 ? torque_available(actuator, robot.dtheta_m[i])
                                 : actuator.torque_max;
    report.torque_share[i] = std::abs(tau) / actuator.torque_max;
    state.is_saturated = state.is_saturated || std::abs(tau) > available;
    tau = std::clamp(tau, -available, available);
  }
  report.torque_unexplained = state.unexplained;
  report.latency_s = state.latency * dt_;
}

// The reference is so near to the joints that its mass matrix is theirs.
JointControl::JointTorques JointControl::joint_torques(const RobotState& robot,
                                                       const VectorM& ddq) const noexcept {
  const VectorM ahead = ddq - ddq_r_;
  VectorM needed = link_torque_;
  needed.noalias() += chain_.M().bottomRightCorner(n_m_, n_m_).lazyProduct(ahead);
  const model::Jacobian& J = chain_.jacobian(handle_);
  const VectorM of_user = J.rightCols(n_m_).transpose().lazyProduct(robot.w_H);
  return {.external = needed - robot.tau_m,
          .motion = (needed + of_user).cwiseAbs() + of_user.cwiseAbs()};
}

// Torques of the springs that move the links along the reference, [C] 1.
VectorM JointControl::link_torque(const ReferenceState& reference,
                                  const RobotState& robot) noexcept {
  chain_.update(stacked(robot.q_p, reference.q_m), stacked(robot.dq_p, reference.dq_m));
  const auto M = chain_.M().bottomRows(n_m_);
  const model::Jacobian J = chain_.jacobian(handle_);  // a value: a block of it must not outlive it
  VectorM tau = chain_.c().tail(n_m_);
  tau.noalias() += M.rightCols(n_m_) * reference.ddq_m;
  tau.noalias() += M.leftCols(n_p_) * robot.ddq_p;
  tau.noalias() -= J.rightCols(n_m_).transpose() * robot.w_H;
  return tau;
}

// Scaled mass matrix, whose eigenvectors are the modes.
MatrixM JointControl::scaled_mass() const noexcept {
  const auto inverse_sqrt_K = sqrt_K_.cwiseInverse().asDiagonal();
  return inverse_sqrt_K * chain_.M().bottomRightCorner(n_m_, n_m_) * inverse_sqrt_K;
}

void JointControl::begin(const ReferenceState& reference, const RobotState& robot,
                         ControlState& state) noexcept {
  state.poles = poles_for(config_.poles, state.latency * dt_ + config_.loop.current_lag);
  const VectorM tau = link_torque(reference, robot);
  state.tau_r = fed(tau);
  state.unexplained = VectorM::Zero(n_m_);
  state.dtau_r.setZero();
  state.ddtau_r.setZero();
  state.integral.setZero();
  state.modes = Modes(n_m_);
  state.modes.follow(scaled_mass(), kSweepsAtStart);
  state.w_H = robot.w_H;
  state.dw_H.setZero();
  state.stiff = of_stiff_modes(tau, stiffness_shares(state), state);
  if (has_feet_) {
    state.feet.colwise() = reference.q_m + state.tau_r.cwiseQuotient(K_);
  }
  state.is_started = true;
}

JointControl::Feedforward JointControl::feedforward(const ReferenceState& reference,
                                                    const RobotState& robot,
                                                    ControlState& state) noexcept {
  const VectorM tau = link_torque(reference, robot);
  link_torque_ = tau;
  ddq_r_ = reference.ddq_m;
  state.unexplained += dt_ / kUnexplained_s * (robot.tau_m - tau - state.unexplained);
  follow_torque(fed(config_.method == Method::kModal ? timely(tau, robot, state) : tau), state);
  Feedforward forward = {.tau = state.tau_r,
                         .dtheta = reference.dq_m + state.dtau_r.cwiseQuotient(K_),
                         .ddtheta = reference.ddq_m + state.ddtau_r.cwiseQuotient(K_),
                         .dry = VectorM(n_m_),
                         .along = VectorM(n_m_)};
  dry_friction(reference, state, forward);
  return forward;
}

// How stiff each mode is.
VectorM JointControl::stiffness_shares(const ControlState& state) const noexcept {
  VectorM shares(n_m_);
  for (int i = 0; i < n_m_; ++i) shares[i] = stiffness_share(state.poles, state.modes.mu()[i]);
  return shares;
}

// Torques on the joints from what acts on the modes.
VectorM JointControl::of_modes(const VectorM& in_modes, const ControlState& state) const noexcept {
  const VectorM back = state.modes.Q() * in_modes;
  return sqrt_K_.cwiseProduct(back);
}

// The part of torques on the joints that bends stiff modes.
VectorM JointControl::of_stiff_modes(const VectorM& tau, const VectorM& shares,
                                     const ControlState& state) const noexcept {
  const VectorM scaled = tau.cwiseQuotient(sqrt_K_);
  const VectorM in_modes = state.modes.Q().transpose() * scaled;
  return of_modes(in_modes.cwiseProduct(shares), state);
}

// Compensates the delay of the user's wrench by sensor, filter and springs with its rate of change.
// Stiff modes are fast enough without, and would pass the sensor's noise on to the handle: they get
// the low-passed part.
VectorM JointControl::timely(const VectorM& tau, const RobotState& robot,
                             ControlState& state) const noexcept {
  const Vector6 rate = (robot.w_H - state.w_H) / dt_;
  estimation::low_pass(lead_pole_, rate, state.dw_H);
  state.w_H = robot.w_H;
  const model::Jacobian& J = chain_.jacobian(handle_);
  const Vector6 to_come = config_.wrench_lead * state.dw_H;
  const VectorM lead = J.rightCols(n_m_).transpose().lazyProduct(to_come);
  const VectorM shares = stiffness_shares(state);
  const VectorM stiff = of_stiff_modes(tau, shares, state);
  estimation::low_pass(stiff_pole_, stiff, state.stiff);
  return tau - stiff + state.stiff - lead + of_stiff_modes(lead, shares, state);
}

// The springs cannot take a torque at once: their motors have to twist them. What is fed forward
// follows as fast as the peak torque lets a rotor turn, so that nothing saturates at a stop.
void JointControl::follow_torque(const VectorM& tau, ControlState& state) const noexcept {
  const double w = 2.0 * std::numbers::pi * config_.flatness_Hz;
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    const double peak = feed_max_[i];
    const double per_torque = actuator.stiffness / actuator.rotor_inertia;
    const double braking = 0.5 * peak * per_torque;
    const double error = tau[i] - state.tau_r[i];
    const double distance = std::abs(error);
    const double linear = braking / (w * w);  // up to which the approach is exponential
    const double speed =
        distance < linear ? w * distance : std::sqrt(braking * (2.0 * distance - linear));
    const double wanted = w * (std::copysign(speed, error) - state.dtau_r[i]);
    state.ddtau_r[i] = std::clamp(wanted, (-peak - state.tau_r[i]) * per_torque,
                                  (peak - state.tau_r[i]) * per_torque);
    state.dtau_r[i] += dt_ * state.ddtau_r[i];
    state.tau_r[i] += dt_ * state.dtau_r[i];
  }
}

// While a motor is saturated, the integral may only shrink.
void JointControl::integrate(const VectorM& error, ControlState& state) const noexcept {
  for (int i = 0; i < n_m_; ++i) {
    double& integral = state.integral[i];
    if (state.is_saturated && error[i] * integral >= 0.0) continue;
    integral = std::clamp(integral + dt_ * error[i], -config_.integral_max, config_.integral_max);
  }
}

VectorM JointControl::modal_torque(const Errors& errors, const RobotState& robot,
                                   const Feedforward& forward, ControlState& state) const noexcept {
  integrate(errors.q, state);
  state.modes.follow(scaled_mass());
  const auto in_modes = [&](const VectorM& x) noexcept -> VectorM {
    const VectorM scaled = sqrt_K_.cwiseProduct(x);
    return state.modes.Q().transpose() * scaled;
  };
  const VectorM e = in_modes(errors.theta), de = in_modes(errors.dtheta);
  const VectorM f = in_modes(errors.q), df = in_modes(errors.dq);
  const VectorM f_integral = in_modes(state.integral);
  VectorM v(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const ModeGains gains = gains_of(state.poles, state.modes.mu()[i]);
    v[i] = gains.motor * e[i] + gains.motor_rate * de[i] + gains.link * f[i] +
           gains.link_rate * df[i] +
           config_.integral_rate * (gains.motor + gains.link) * f_integral[i];
  }
  const double w0_2 = state.poles.w0 * state.poles.w0;
  const VectorM J_t = K_ / w0_2;
  const VectorM feedback = of_modes(v, state);
  const VectorM share = J_m_.cwiseQuotient(J_t);  // of a torque on rotors that look like J_t
  learn_friction(forward, share.cwiseProduct(feedback), robot, state);
  const VectorM u = forward.tau + J_t.cwiseProduct(forward.ddtheta) + feedback;
  // the measured torque makes the rotor look like one of inertia J_t
  return share.cwiseProduct(u - robot.tau_m) + robot.tau_m;
}

VectorM JointControl::motor_pd_torque(const Errors& errors,
                                      const Feedforward& forward) const noexcept {
  const VectorM K_d = kMotorPdDamping * K_.cwiseProduct(J_m_).cwiseSqrt();
  return forward.tau + J_m_.cwiseProduct(forward.ddtheta) + K_.cwiseProduct(errors.theta) +
         K_d.cwiseProduct(errors.dtheta);
}

// By the motion of the reference, whose sign is known before the motor turns.
void JointControl::dry_friction(const ReferenceState& reference, ControlState& state,
                                Feedforward& forward) const noexcept {
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    const double dtheta = forward.dtheta[i];
    forward.dry[i] = coulomb_torque(actuator, dtheta, forward.tau[i]);
    if (has_presliding(actuator)) {
      const double theta = reference.q_m[i] + forward.tau[i] / K_[i];
      forward.along[i] = slip(actuator, theta, forward.dry[i], i, state.feet) / forward.dry[i];
    } else {
      forward.along[i] = std::tanh(dtheta / config_.friction_speed);
    }
  }
}

VectorM JointControl::friction(const Feedforward& forward,
                               const ControlState& state) const noexcept {
  VectorM tau(n_m_);
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    tau[i] = state.friction[i] * forward.dry[i] * forward.along[i] +
             actuator.viscous_friction * forward.dtheta[i];
  }
  return tau;
}

// What the feedback has to add while a joint slides is friction that was not fed forward. Learnt as
// a factor, it changes its sign with the motion; an integrator would be wrong at every reversal.
// What is missing while a motor is saturated is torque. `feedback` are torques of the motors.
void JointControl::learn_friction(const Feedforward& forward, const VectorM& feedback,
                                  const RobotState& robot, ControlState& state) const noexcept {
  if (state.is_saturated) return;
  for (int i = 0; i < n_m_; ++i) {
    const ActuatorModel& actuator = actuators_[i];
    const double along = forward.along[i];
    const double slides = std::tanh(robot.dtheta_m[i] / config_.friction_speed) * along;
    if (!(slides >= kSlides)) continue;
    if (has_presliding(actuator) && std::abs(along) < kSlips) continue;
    const double missing = feedback[i] * along / forward.dry[i];
    state.friction[i] += dt_ * config_.friction_learning * missing;
    state.friction[i] = std::clamp(state.friction[i], 0.0, kMostFriction);
  }
}

}  // namespace hg::tracking
