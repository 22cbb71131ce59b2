#include "hg/handle_loop/handle_loop.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/twin.h"
#include "hg/controller/estimation/low_pass.h"
#include "hg/controller/rendering/twin_forces.h"
#include "hg/controller/tracking/sampled_arm.h"
#include "hg/core/cross.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/model/chain_data.h"

namespace hg::handle_loop {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kGroup = 4;  // steps of the plant whose wrenches are one mean: half a period
constexpr int kGroups = tracking::kPlantSteps / kGroup;
constexpr int kNoises = 6 * kGroups;  // the wrench of each mean of a period; joints come behind
constexpr int kMostStates = 600;
constexpr double kSlowestIntegral = 1.0;  // 1/s; a slower one would be the slowest motion of all

// Offsets of the parts of the loop in its state.
class Layout {
 public:
  Layout(int joints, int latencies, int halves) : n(joints), slots(latencies), groups(halves) {
    theta = take(n);
    dtheta = take(n);
    q = take(n);
    dq = take(n);
    current = take(n);
    hand = take(3);
    dhand = take(3);
    observers = take(4 * n);
    ddq_last = take(n);
    wrench = take(6);
    twin = take(6);
    dtwin = take(6);
    integral = take(n);
    tau_r = take(n);
    dtau_r = take(n);
    w_last = take(6);
    dw = take(6);
    stiff = take(n);
    commands = take(slots * n);
    means = take(groups * 6);
  }

  int n, slots, groups;
  int theta, dtheta, q, dq, current;               // of tracking::plant_with_input()
  int hand, dhand;                                 // joins the plant
  int observers, ddq_last;                         // of tracking::LinearObservers
  int wrench;                                      // low-passed
  int twin, dtwin;                                 // body
  int integral, tau_r, dtau_r, w_last, dw, stiff;  // control
  int commands;                                    // the oldest first
  int means;                                       // likewise, of the wrench
  int size = 0;

  int plant_size() const { return 5 * n + 6; }

 private:
  int take(int count) {
    const int first = size;
    size += count;
    return first;
  }
};

// The hand on the handle, resolved in B.
struct HandMatrices {
  Eigen::Matrix3d mass_inverse, stiffness, damping;  // of the arm
  Eigen::Matrix3d angular_stiffness, angular_damping;
  double grip = 0.0, grip_damping = 0.0;
};

HandMatrices matrices_of(const person::HandImpedance& hand, const Eigen::Matrix3d& R_B_H) {
  // the person stands along the horizontal heading of the handle
  const double heading = config::hand_of({.R = R_B_H}).azimuth;
  const Eigen::Matrix3d P = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto turned = [](const Eigen::Matrix3d& R, const Eigen::Vector3d& values) {
    return Eigen::Matrix3d(R * values.asDiagonal() * R.transpose());
  };
  return {.mass_inverse = turned(P, hand.mass.cwiseInverse()),
          .stiffness = turned(P, hand.stiffness),
          .damping = turned(P, hand.damping),
          .angular_stiffness = turned(R_B_H, hand.angular_stiffness),
          .angular_damping = turned(R_B_H, hand.angular_damping),
          .grip = hand.grip_stiffness,
          .grip_damping = hand.grip_damping};
}

// Damping of a free body, as in the law: the Cholesky factor of its mass, and its dampers.
struct Dampers {
  rendering::MatrixA L = rendering::MatrixA::Zero(6, 6);
  rendering::TwinValues values;
};

Dampers dampers_of(const Body& body) {
  Dampers dampers;
  for (int i = 0; i < 6; ++i) {
    dampers.L(i, i) = std::sqrt(i < 3 ? body.mass : body.inertia);
    dampers.values.dofs[i].damping = i < 3 ? body.damping : body.angular_damping;
  }
  return dampers;
}

// Everything that one period needs, column by column.
class Period {
 public:
  Period(const LoopDevice& device, const tracking::TruePlant& plant, const Body& body,
         const person::HandImpedance& hand, const VectorXd& q)
      : body_(body),
        dampers_(dampers_of(body)),
        config_(device.loop.config),
        model_(without_friction(device.loop.device)),
        plant_(plant),
        dt_(model_.dt()),
        command_delay_(plant.loop.latency, dt_),
        observers_(device.loop.filters, dt_),
        average_(std::max(1, rounded_groups(device.wrench.average_s))),
        delay_(rounded_groups(device.wrench.delay_s)),
        layout_(model_.n_m, command_delay_.slots(), average_ + delay_),
        control_(config_, model_) {
    if (layout_.size > kMostStates) {
      throw SetupError("the loop around the handle has " + std::to_string(layout_.size) +
                       " states with this rate, latency and delay of the wrench, at most " +
                       std::to_string(kMostStates) + " are computed");
    }
    model::ChainData chain(model_.chain);
    const VectorXd at_rest = VectorXd::Zero(q.size());
    chain.update(q, at_rest);
    const int n = layout_.n;
    J_ = chain.jacobian(model_.handle).rightCols(n);
    to_joints_ = LeastSquares(J_).pseudo_inverse();
    R_B_H_ = chain.pose(model_.handle).R;
    hand_ = matrices_of(hand, R_B_H_);
    K_.resize(n);
    D_.resize(n);
    for (int i = 0; i < n; ++i) {
      const ActuatorModel& actuator = plant.actuators[i];
      K_[i] = actuator.stiffness;
      D_[i] = actuator.damping;
    }
    make_plant(plant.link_mass * chain.M().bottomRightCorner(n, n));
    sensed_ = grip_ - inertia_of(device.wrench.felt) * J_ * plant_rows_;
    wrench_pole_ = estimation::low_pass_pole(device.wrench.low_pass_Hz, dt_);
    start_control(q, chain.c().tail(n));
  }

  const Layout& layout() const { return layout_; }
  const Eigen::Matrix3d& R_B_H() const { return R_B_H_; }
  const MatrixXd& J() const { return J_; }
  // force of the hand on the handle of a state of the plant (6 x plant)
  const MatrixXd& grip() const { return grip_; }

  // Disturbances of one sample, in B.
  struct Disturbance {
    Eigen::Vector3d push = Eigen::Vector3d::Zero();  // on the hand
    VectorXd motor;                                  // torques on the motors; empty = none
    Eigen::Matrix<double, 6, kGroups> wrench =
        Eigen::Matrix<double, 6, kGroups>::Zero();  // of means
    VectorXd tau, q, theta;                         // of sensors; empty = none
  };

  VectorXd advance(const VectorXd& now, const Disturbance& disturbance) {
    VectorXd next = now;
    const Estimated estimated = estimate(now, disturbance, next);
    const VectorXd ddq_r = move_twin(now, estimated.w, next);
    const VectorXd tau_command = control(now, estimated, ddq_r, next);
    move_arm(now, tau_command, disturbance, next);
    return next;
  }

 private:
  // what the estimation adds to the robot at rest; q and the speeds stand in its observers
  struct Estimated {
    VectorXd theta, tau;
    Vector6 w;
  };

  VectorXd part(const VectorXd& x, int first) const { return x.segment(first, layout_.n); }

  Estimated estimate(const VectorXd& now, const Disturbance& disturbance, VectorXd& next) const {
    const Layout& at = layout_;
    const auto plus = [](VectorXd x, const VectorXd& more) {
      if (more.size() > 0) x += more;
      return x;
    };
    const VectorXd theta = plus(part(now, at.theta), disturbance.theta);
    const VectorXd q = plus(part(now, at.q), disturbance.q);
    observers_.advance(theta, q, part(now, at.ddq_last), next.segment(at.observers, 4 * at.n));
    const VectorXd tau = plus(K_.cwiseProduct(part(now, at.theta) - part(now, at.q)) +
                                  D_.cwiseProduct(part(now, at.dtheta) - part(now, at.dq)),
                              disturbance.tau);
    Vector6 mean = Vector6::Zero();
    for (int i = 0; i < average_; ++i) mean += now.segment<6>(at.means + 6 * i);
    Vector6 w = now.segment<6>(at.wrench);
    estimation::low_pass(wrench_pole_, mean / average_, w);
    next.segment<6>(at.wrench) = w;
    return {theta, tau, w};
  }

  // moves the twin under the wrench; accelerations of the reference
  VectorXd move_twin(const VectorXd& now, const Vector6& w, VectorXd& next) const {
    const Layout& at = layout_;
    Vector6 ddE =
        w - rendering::damping_torque(dampers_.L, now.segment<6>(at.dtwin), dt_, dampers_.values);
    ddE.head<3>() /= body_.mass;
    ddE.tail<3>() /= body_.inertia;
    next.segment<6>(at.twin) += dt_ * now.segment<6>(at.dtwin) + 0.5 * dt_ * dt_ * ddE;
    next.segment<6>(at.dtwin) += dt_ * ddE;
    const VectorXd ddq_r = to_joints_ * ddE;
    next.segment(at.ddq_last, at.n) = ddq_r;
    return ddq_r;
  }

  // joint torques beyond those at rest
  VectorXd control(const VectorXd& now, const Estimated& estimated, const VectorXd& ddq_r,
                   VectorXd& next) {
    const Layout& at = layout_;
    const int n = at.n;
    tracking::ControlState state = state_of(now);
    const ReferenceState here = {.q_m = q_m_ + to_joints_ * now.segment<6>(at.twin),
                                 .dq_m = to_joints_ * now.segment<6>(at.dtwin),
                                 .ddq_m = ddq_r};
    const ReferenceState there = {.q_m = q_m_ + to_joints_ * next.segment<6>(at.twin),
                                  .dq_m = to_joints_ * next.segment<6>(at.dtwin),
                                  .ddq_m = ddq_r};
    RobotState robot = robot_;
    robot.theta_m += estimated.theta;
    robot.dtheta_m = part(next, at.observers + n);
    robot.q_m += part(next, at.observers + 2 * n);
    robot.dq_m = part(next, at.observers + 3 * n);
    robot.tau_m += estimated.tau;
    robot.w_H = estimated.w;
    CommandFrame command;
    TrackingReport report;
    control_.step(here, there, robot, state, command, report);
    if (config_.integral_rate >= kSlowestIntegral) {
      next.segment(at.integral, n) = state.integral - started_.integral;
    }
    next.segment(at.tau_r, n) = state.tau_r - started_.tau_r;
    next.segment(at.dtau_r, n) = state.dtau_r;
    next.segment<6>(at.w_last) = state.w_H;
    next.segment<6>(at.dw) = state.dw_H;
    next.segment(at.stiff, n) = state.stiff - started_.stiff;
    return command.tau_m - at_rest_;
  }

  // arm and hand under the commands that arrive during this period
  void move_arm(const VectorXd& now, const VectorXd& tau_command, const Disturbance& disturbance,
                VectorXd& next) const {
    const Layout& at = layout_;
    const int n = at.n;
    VectorXd commands((at.slots + 1) * n);
    commands << now.segment(at.commands, at.slots * n), tau_command;
    const int size = at.plant_size();
    VectorXd x = VectorXd::Zero(size + 2 * n + 3);
    x.head(size) = now.head(size);
    x.segment<3>(size + n) = disturbance.push;
    if (disturbance.motor.size() > 0) x.tail(n) = disturbance.motor;
    std::vector<Vector6> means;
    for (int group = 0; group < kGroups; ++group) {
      Vector6 sum = Vector6::Zero();
      for (int i = 0; i < kGroup; ++i) {
        const int age = command_delay_.age(group * kGroup + i);
        x.segment(size, n) = commands.segment((at.slots - age) * n, n);
        x = (step_ * x).eval();
        sum += sensed_ * x.head(size);
      }
      means.push_back(sum / kGroup);
    }
    for (int group = 0; group < kGroups; ++group) {
      means[group] += disturbance.wrench.col(group);
    }
    next.head(size) = x.head(size);
    next.segment(at.commands, at.slots * n) = commands.tail(at.slots * n);
    // the oldest go
    for (int i = 0; i < at.groups; ++i) {
      const int from = i + kGroups;
      const Vector6 value =
          from < at.groups ? Vector6(now.segment<6>(at.means + 6 * from)) : means[from - at.groups];
      next.segment<6>(at.means + 6 * i) = value;
    }
  }

  // friction is removed, and presliding friction does not slip, its stiffness being the same
  static DeviceModel without_friction(DeviceModel device) {
    constexpr double kFar = 1e3;
    for (ActuatorModel& actuator : device.actuators) {
      actuator.presliding *= kFar;
      actuator.coulomb_friction *= has_presliding(actuator) ? kFar : 0.0;
      actuator.load_friction = 0.0;
    }
    return device;
  }

  int rounded_groups(double seconds) const {
    return static_cast<int>(std::lround(seconds / dt_ * kGroups));
  }

  // Wrench at H per acceleration of H (6 x 6) that moves a payload, resolved in B.
  Eigen::Matrix<double, 6, 6> inertia_of(const Payload& payload) const {
    const Eigen::Matrix3d R_B_S = R_B_H_ * model_.T_H_S.R;
    const Eigen::Matrix3d to_com =
        cross_matrix(R_B_H_ * (model_.T_H_S.p + model_.T_H_S.R * payload.com));
    Eigen::Matrix<double, 6, 6> inertia;
    inertia << payload.mass * Eigen::Matrix3d::Identity(), -payload.mass * to_com,
        payload.mass * to_com,
        R_B_S * payload.inertia * R_B_S.transpose() - payload.mass * to_com * to_com;
    return inertia;
  }

  // d/dt (theta, theta', q, q', current, hand, hand') and what one step makes of it with
  // constant inputs
  void make_plant(const MatrixXd& M) {
    const Layout& at = layout_;
    const int n = at.n, size = at.plant_size();
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    // the hand's wrench on the handle
    grip_ = MatrixXd::Zero(6, size);
    const auto J_v = J_.topRows<3>(), J_w = J_.bottomRows<3>();
    grip_.block(0, at.hand, 3, 3) = hand_.grip * I;
    grip_.block(0, at.dhand, 3, 3) = hand_.grip_damping * I;
    grip_.block(0, at.q, 3, n) = -hand_.grip * J_v;
    grip_.block(0, at.dq, 3, n) = -hand_.grip_damping * J_v;
    grip_.block(3, at.q, 3, n) = -hand_.angular_stiffness * J_w;
    grip_.block(3, at.dq, 3, n) = -hand_.angular_damping * J_w;

    const int inputs = 2 * n + 3;  // commands, push, torques on the motors
    MatrixXd A = MatrixXd::Zero(size + inputs, size + inputs);
    const MatrixXd arm = tracking::plant_with_input(plant_, M);
    A.topLeftCorner(5 * n, 5 * n) = arm.topLeftCorner(5 * n, 5 * n);
    A.block(0, size, 5 * n, n) = arm.topRightCorner(5 * n, n);
    for (int i = 0; i < n; ++i) {
      A(at.dtheta + i, size + n + 3 + i) = 1.0 / plant_.actuators[i].rotor_inertia;
    }
    A.block(at.dq, 0, n, size) += inverse(M) * J_.transpose() * grip_;
    A.block(at.hand, at.dhand, 3, 3) = I;
    A.block(at.dhand, 0, 3, size) = -hand_.mass_inverse * grip_.topRows<3>();
    A.block(at.dhand, at.hand, 3, 3) -= hand_.mass_inverse * hand_.stiffness;
    A.block(at.dhand, at.dhand, 3, 3) -= hand_.mass_inverse * hand_.damping;
    A.block(at.dhand, size + n, 3, 3) = hand_.mass_inverse;
    plant_rows_ = A.block(at.dq, 0, n, size);
    step_ = matrix_exponential(A * (dt_ / tracking::kPlantSteps));
  }

  // The controller at rest, the springs carrying `weight`.
  void start_control(const VectorXd& q, const VectorM& weight) {
    robot_ = tracking::standing(model_.actuators, q, weight);
    q_m_ = robot_.q_m;
    const ReferenceState rest = tracking::standing_reference(robot_);
    started_ = control_.start();
    CommandFrame command;
    TrackingReport report;
    control_.step(rest, rest, robot_, started_, command, report);
    at_rest_ = command.tau_m;
  }

  tracking::ControlState state_of(const VectorXd& x) const {
    const Layout& at = layout_;
    tracking::ControlState state = started_;
    state.integral += x.segment(at.integral, at.n);
    state.tau_r += x.segment(at.tau_r, at.n);
    state.dtau_r = x.segment(at.dtau_r, at.n);
    state.w_H = x.segment<6>(at.w_last);
    state.dw_H = x.segment<6>(at.dw);
    state.stiff += x.segment(at.stiff, at.n);
    return state;
  }

  Body body_;
  Dampers dampers_;
  tracking::ControlConfig config_;
  DeviceModel model_;
  tracking::TruePlant plant_;
  double dt_;
  tracking::DiscreteDelay command_delay_;
  tracking::LinearObservers observers_;
  int average_, delay_;  // of the wrench, half periods
  Layout layout_;
  tracking::JointControl control_;
  MatrixXd J_, to_joints_, grip_, step_;
  MatrixXd plant_rows_;  // accelerations of the links of a state of the plant
  MatrixXd sensed_;      // wrench of such a state on the sensor, but for what is known
  Eigen::Matrix3d R_B_H_;
  HandMatrices hand_;
  VectorXd K_, D_, q_m_, at_rest_;
  double wrench_pole_ = 0.0;
  RobotState robot_;
  tracking::ControlState started_;
};

}  // namespace

HandleLoop linearise(const LoopDevice& device, const tracking::TruePlant& plant, const Body& body,
                     const person::HandImpedance& hand, const Noise& noise, const VectorXd& q) {
  // small against every limit of the controller, large against its rounding
  constexpr double kUnit = 1e-6, kTorque = 1e-3, kTorqueRate = 0.1;
  Period period(device, plant, body, hand, q);
  const Layout& at = period.layout();
  const int n = at.n;
  VectorXd unit_of = VectorXd::Constant(at.size, kUnit);
  for (const int first : {at.current, at.tau_r, at.stiff}) unit_of.segment(first, n).fill(kTorque);
  for (const int first : {at.wrench, at.w_last}) unit_of.segment(first, 6).fill(kTorque);
  unit_of.segment(at.dtau_r, n).fill(kTorqueRate);
  unit_of.segment(at.dw, 6).fill(kTorqueRate);
  unit_of.tail(at.size - at.commands).fill(kTorque);
  using Disturbance = Period::Disturbance;
  const VectorXd nothing = VectorXd::Zero(at.size);
  const VectorXd rest = period.advance(nothing, {});
  const auto answer = [&](const VectorXd& x, const Disturbance& disturbance) -> VectorXd {
    return (period.advance(x, disturbance) - rest) / kUnit;
  };
  HandleLoop loop = {.A = MatrixXd(at.size, at.size),
                     .B_push = MatrixXd(at.size, 3),
                     .B_motor = MatrixXd(at.size, n),
                     .B_noise = MatrixXd(at.size, kNoises + 3 * n),
                     .C = MatrixXd::Zero(12, at.size),
                     .period_s = device.loop.device.dt()};
  for (int i = 0; i < at.size; ++i) {
    const VectorXd one = unit_of[i] * VectorXd::Unit(at.size, i);
    loop.A.col(i) = (period.advance(one, {}) - rest) / unit_of[i];
  }
  for (int i = 0; i < 3; ++i) {
    loop.B_push.col(i) = answer(nothing, {.push = kUnit * period.R_B_H().col(i)});
  }
  const double per_root_s = std::sqrt(kGroups / loop.period_s);
  for (int i = 0; i < kNoises; ++i) {
    Disturbance disturbance;
    disturbance.wrench(i % 6, i / 6) = kUnit;
    const double deviation = per_root_s * (i % 6 < 3 ? noise.force : noise.torque);
    loop.B_noise.col(i) = deviation * answer(nothing, disturbance);
  }
  for (int i = 0; i < n; ++i) {
    const VectorXd unit = kUnit * VectorXd::Unit(n, i);
    loop.B_motor.col(i) = answer(nothing, {.motor = unit});
    const double joint = noise.joint.size() > 0 ? noise.joint[i] : 0.0;
    loop.B_noise.col(kNoises + i) = joint * answer(nothing, {.tau = unit});
    loop.B_noise.col(kNoises + n + i) = noise.link_encoder * answer(nothing, {.q = unit});
    loop.B_noise.col(kNoises + 2 * n + i) = noise.motor_encoder * answer(nothing, {.theta = unit});
  }
  const Eigen::Matrix3d R = period.R_B_H().transpose();
  loop.C.block(0, at.dq, 3, n) = R * period.J().topRows<3>();
  loop.C.block(3, 0, 3, at.plant_size()) = R * period.grip().topRows<3>();
  loop.C.block(6, at.q, 3, n) = R * period.J().topRows<3>();
  loop.C.block(9, at.twin, 3, 3) = R;
  return loop;
}

double lightest_mass(const LoopDevice& device, const tracking::TruePlant& plant, Body body,
                     const person::HandImpedance& hand, const VectorXd& q) {
  constexpr double kLeast = 0.01, kMost = 100.0, kTolerance = 1.03, kGrowing = 1.0 + 1e-6;
  const double inertia = body.inertia / body.mass;
  const auto grows = [&](double mass) {
    body.mass = mass;
    body.inertia = inertia * mass;
    return spectral_radius(linearise(device, plant, body, hand, {}, q).A) > kGrowing;
  };
  double light = kLeast, heavy = kMost;
  if (grows(heavy)) return kInfinity;
  if (!grows(light)) return 0.0;
  while (heavy > kTolerance * light) {
    const double between = std::sqrt(light * heavy);
    (grows(between) ? light : heavy) = between;
  }
  return heavy;
}

Resolvent::Resolvent(const MatrixXd& A) {
  const Eigen::HessenbergDecomposition<MatrixXd> decomposition(A);
  H_ = decomposition.matrixH();
  Q_ = decomposition.matrixQ();
}

// Gaussian elimination of a Hessenberg matrix: one row below the diagonal.
void Resolvent::at(std::complex<double> z) {
  const Eigen::Index n = H_.rows();
  U_ = -H_.cast<std::complex<double>>();
  U_.diagonal().array() += z;
  multipliers_ = Eigen::VectorXcd::Zero(n);
  is_exchanged_.assign(n, false);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const Eigen::Index rest = n - i;
    if (std::abs(U_(i + 1, i)) > std::abs(U_(i, i))) {
      U_.row(i).tail(rest).swap(U_.row(i + 1).tail(rest));
      is_exchanged_[i] = true;
    }
    const std::complex<double> multiplier = U_(i + 1, i) / U_(i, i);
    multipliers_[i] = multiplier;
    U_.row(i + 1).tail(rest) -= multiplier * U_.row(i).tail(rest);
  }
}

Eigen::MatrixXcd Resolvent::solve(const MatrixXd& B) const {
  const Eigen::Index n = H_.rows();
  Eigen::MatrixXcd X = (Q_.transpose() * B).cast<std::complex<double>>();
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    if (is_exchanged_[i]) X.row(i).swap(X.row(i + 1));
    X.row(i + 1) -= multipliers_[i] * X.row(i);
  }
  X = U_.triangularView<Eigen::Upper>().solve(X).eval();
  return Q_.cast<std::complex<double>>() * X;
}

Eigen::MatrixXcd Resolvent::solve_transposed(const MatrixXd& C) const {
  const Eigen::Index n = H_.rows();
  Eigen::MatrixXcd X = (C * Q_).transpose().cast<std::complex<double>>();
  X = U_.transpose().triangularView<Eigen::Lower>().solve(X).eval();
  for (Eigen::Index i = n - 2; i >= 0; --i) {
    X.row(i) -= multipliers_[i] * X.row(i + 1);
    if (is_exchanged_[i]) X.row(i).swap(X.row(i + 1));
  }
  return (Q_.cast<std::complex<double>>() * X).transpose();
}

}  // namespace hg::handle_loop
