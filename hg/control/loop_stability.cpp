#include "hg/control/loop_stability.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hg/core/linear_algebra.h"
#include "hg/estimation/joint_observer.h"

namespace hg::control {
namespace {

constexpr int kSteps = 8;  // per period: latencies are rounded to them

// Where the parts of the sampled loop stand in its state.
struct Layout {
  int n, slots;
  int theta() const { return 0; }
  int dtheta() const { return n; }
  int q() const { return 2 * n; }
  int dq() const { return 3 * n; }
  int tau() const { return 4 * n; }
  int theta_last() const { return 5 * n; }
  int dtheta_filtered() const { return 6 * n; }
  int q_observed() const { return 7 * n; }
  int dq_observed() const { return 8 * n; }
  int commands() const { return 9 * n; }  // the oldest first
  int size() const { return (9 + slots) * n; }
};

// d/dt (theta, theta', q, q', tau) for a constant command: A x + B tau_command
Eigen::MatrixXd plant_with_input(const Config& config, const MatrixM& M) {
  const int n = static_cast<int>(M.rows());
  Eigen::VectorXd Jm(n), K(n), D(n), viscous(n);
  for (int i = 0; i < n; ++i) {
    const ActuatorModel& actuator = config.actuators[static_cast<std::size_t>(i)];
    Jm[i] = actuator.rotor_inertia;
    K[i] = actuator.stiffness;
    D[i] = actuator.damping;
    viscous[i] = actuator.viscous_friction;
  }
  const Eigen::MatrixXd M_inverse = inverse(M);
  const Eigen::VectorXd Jm_inverse = Jm.cwiseInverse();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  const auto block = [&](int row, int column) { return A.block(row * n, column * n, n, n); };
  block(0, 1).setIdentity();
  block(2, 3).setIdentity();
  block(1, 0) = (-Jm_inverse.cwiseProduct(K)).asDiagonal();
  block(1, 1) = (-Jm_inverse.cwiseProduct(D + viscous)).asDiagonal();
  block(1, 2) = Jm_inverse.cwiseProduct(K).asDiagonal();
  block(1, 3) = Jm_inverse.cwiseProduct(D).asDiagonal();
  block(1, 4) = Jm_inverse.asDiagonal();
  block(3, 0) = M_inverse * K.asDiagonal();
  block(3, 1) = M_inverse * D.asDiagonal();
  block(3, 2) = -(M_inverse * K.asDiagonal());
  block(3, 3) = -(M_inverse * D.asDiagonal());
  const double rate = 1.0 / std::max(config.loop.current_lag, 1e-6);
  block(4, 4) = -rate * Eigen::MatrixXd::Identity(n, n);
  block(4, 5) = rate * Eigen::MatrixXd::Identity(n, n);
  return A;
}

// Torques that the controller answers with to unit errors of theta, theta', q, q' and tau_J.
// `weight` holds the links in posture `q`.
Eigen::MatrixXd feedback(const Loop& loop, const Eigen::VectorXd& q, const VectorM& weight,
                         double latency) {
  constexpr double kError = 1e-7;  // small against every limit of the controller
  const int n = loop.n_m;
  JointControl control(loop.config, loop.chain, loop.n_p, n, loop.handle);
  State at_start = control.start();
  at_start.latency = latency / loop.config.dt;
  const VectorM at_rest = VectorM::Zero(n);
  const ReferenceState reference = {.q_m = q.tail(n), .dq_m = at_rest, .ddq_m = at_rest};
  RobotState robot;
  robot.q_m = q.tail(n);
  robot.tau_m = weight;
  robot.theta_m = robot.q_m;
  for (int i = 0; i < n; ++i) {
    robot.theta_m[i] +=
        robot.tau_m[i] / loop.config.actuators[static_cast<std::size_t>(i)].stiffness;
  }
  robot.dq_m = robot.dtheta_m = at_rest;
  robot.q_p = q.head(loop.n_p);
  robot.dq_p = robot.ddq_p = VectorP::Zero(loop.n_p);
  const auto torque = [&](const RobotState& seen) -> Eigen::VectorXd {
    State state = at_start;
    CommandFrame command;
    TrackingReport report;
    control.step(reference, reference, seen, state, command, report);
    return command.tau_m;
  };
  const Eigen::VectorXd undisturbed = torque(robot);
  Eigen::MatrixXd answers(n, 5 * n);
  int column = 0;
  for (VectorM RobotState::*part : {&RobotState::theta_m, &RobotState::dtheta_m, &RobotState::q_m,
                                    &RobotState::dq_m, &RobotState::tau_m}) {
    for (int i = 0; i < n; ++i) {
      RobotState disturbed = robot;
      (disturbed.*part)[i] += kError;
      answers.col(column++) = (torque(disturbed) - undisturbed) / kError;
    }
  }
  return answers;
}

Config with(Config config, const Reality& reality) {
  config.actuators = reality.actuators;
  config.loop = reality.loop;
  return config;
}

// One period of the loop as a matrix, column by column.
class SampledLoop {
 public:
  SampledLoop(const Loop& loop, const Eigen::VectorXd& q, double latency, const Reality& reality)
      : config_(with(loop.config, reality)),
        layout_{loop.n_m, static_cast<int>(std::ceil(config_.loop.latency / config_.dt - 1e-9))},
        latency_steps_(static_cast<int>(std::lround(config_.loop.latency / config_.dt * kSteps))) {
    model::Chain chain = loop.chain;
    chain.update(q, Eigen::VectorXd::Zero(q.size()));
    const MatrixM M = reality.link_mass * chain.M().bottomRightCorner(loop.n_m, loop.n_m);
    step_ = matrix_exponential(plant_with_input(config_, M) * (config_.dt / kSteps));
    feedback_ = feedback(loop, q, chain.c().tail(loop.n_m), latency);
    link_pole_ = estimation::low_pass_pole(loop.filters.link_pole_Hz, config_.dt);
    motor_pole_ = estimation::low_pass_pole(loop.filters.motor_low_pass_Hz, config_.dt);
  }

  Eigen::MatrixXd period() const {
    Eigen::MatrixXd matrix(layout_.size(), layout_.size());
    for (int i = 0; i < layout_.size(); ++i) {
      matrix.col(i) = advance(Eigen::VectorXd::Unit(layout_.size(), i));
    }
    return matrix;
  }

 private:
  Eigen::VectorXd advance(const Eigen::VectorXd& now) const {
    const Layout& at = layout_;
    const int n = at.n;
    Eigen::VectorXd next = now;
    const auto part = [n](auto& state, int first) { return state.segment(first, n); };

    for (int i = 0; i < n; ++i) {
      estimation::MotorObserver motor{now[at.theta_last() + i], now[at.dtheta_filtered() + i]};
      estimation::observe(motor_pole_, config_.dt, now[at.theta() + i], motor);
      next[at.theta_last() + i] = motor.theta;
      next[at.dtheta_filtered() + i] = motor.dtheta;
      estimation::LinkObserver link{now[at.q_observed() + i], now[at.dq_observed() + i]};
      estimation::observe(link_pole_, config_.dt, 0.0, now[at.q() + i], link);
      next[at.q_observed() + i] = link.q;
      next[at.dq_observed() + i] = link.dq;
    }

    Eigen::VectorXd tau_J(n);
    for (int i = 0; i < n; ++i) {
      const ActuatorModel& actuator = config_.actuators[static_cast<std::size_t>(i)];
      tau_J[i] = actuator.stiffness * (now[at.theta() + i] - now[at.q() + i]) +
                 actuator.damping * (now[at.dtheta() + i] - now[at.dq() + i]);
    }
    Eigen::VectorXd state(5 * n);
    state << part(now, at.theta()), part(next, at.dtheta_filtered()), part(next, at.q_observed()),
        part(next, at.dq_observed()), tau_J;
    const Eigen::VectorXd command = feedback_ * state;

    // the plant under the commands that arrive during this period
    std::vector<Eigen::VectorXd> commands;
    for (int slot = 0; slot < at.slots; ++slot) {
      commands.emplace_back(now.segment(at.commands() + slot * n, n));
    }
    commands.push_back(command);
    Eigen::VectorXd x(6 * n);
    x.head(5 * n) = now.head(5 * n);
    for (int i = 0; i < kSteps; ++i) {
      // the command of k periods ago has arrived when k kSteps + i >= latency_steps_
      const int age = (latency_steps_ - i + kSteps - 1) / kSteps;
      const int k = std::clamp(age, 0, at.slots);
      x.tail(n) = commands[static_cast<std::size_t>(at.slots - k)];
      x = (step_ * x).eval();
    }
    next.head(5 * n) = x.head(5 * n);
    for (int slot = 0; slot < at.slots; ++slot) {
      next.segment(at.commands() + slot * n, n) = commands[static_cast<std::size_t>(slot + 1)];
    }
    return next;
  }

  Config config_;  // of what is real
  Layout layout_;
  int latency_steps_;
  Eigen::MatrixXd step_;
  Eigen::MatrixXd feedback_;  // torques from theta, theta', q, q', tau_J
  double link_pole_ = 0.0, motor_pole_ = 0.0;
};

}  // namespace

double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency) {
  Reality as_believed = {loop.config.actuators, loop.config.loop};
  as_believed.loop.latency = latency;
  return spectral_radius(loop, q, latency, as_believed);
}

double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency,
                       const Reality& reality) {
  const Eigen::MatrixXd period = SampledLoop(loop, q, latency, reality).period();
  return hg::spectral_radius(period);
}

int longest_stable_latency(const Loop& loop, const std::vector<Eigen::VectorXd>& postures, int most,
                           int least) {
  for (int periods = least; periods <= most; ++periods) {
    for (const Eigen::VectorXd& q : postures) {
      if (spectral_radius(loop, q, periods * loop.config.dt) >= 1.0) return periods - 1;
    }
  }
  return most;
}

}  // namespace hg::control
