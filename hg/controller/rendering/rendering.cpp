#include "hg/controller/rendering/rendering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hg/controller/rendering/integration.h"
#include "hg/controller/rendering/lost_directions.h"
#include "hg/controller/rendering/shortest_velocity.h"
#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/core/stacked.h"

namespace hg::rendering {
namespace {

// Distance outside `range` that a frame at `q` with `dq` reaches within kLookAhead; 0 inside, and
// on its way back. Infinite where either is not a number.
double passing(const Interval& range, double q, double dq) noexcept {
  constexpr double kReturning = 0.02;  // m/s
  if (!std::isfinite(q + dq)) return kInfinity;
  const double outside = std::max(q - range.ub, range.lb - q);
  const double speed = q > range.ub ? dq : -dq;
  if (outside <= 0.0 || speed < -kReturning) return 0.0;
  return outside + kLookAhead * std::max(speed, 0.0);
}

// slower than this a joint with Coulomb friction stands still, rad/s or m/s
constexpr double kStandstill = 1e-9;

// Largest number of active sets of one solve: the larger of the two. A warm start mostly needs one;
// a new contact needed at worst 17, a twin of 30 joints that meets many limits at once 38
constexpr int kActiveSets = 200;
constexpr int kActiveSetsPerRow = 4;

// share of the twin's mobility below which it cannot move in a direction
constexpr double kStuck = 1e-6;

constexpr int kAlignIterations = 10;
constexpr double kAligned = 1e-12;  // m and rad

// A solve that ran out of active sets must keep all limits of the device. One that completed all
// levels but lacks the proof of optimality is exact to rounding: joints must be kept, conflicting
// motors and walls cannot be met better.
SolverStatus solver_status(const Tasks& tasks, const hqp::SolverOptions& options,
                           const hqp::Solution& solution) noexcept {
  if (solution.status == hqp::Status::kSolved) return SolverStatus::kSolved;
  if (solution.status != hqp::Status::kIterationLimit) return SolverStatus::kFailed;
  const bool ran_out = options.budget > 0 || solution.iterations >= options.max_iterations;
  const bool is_usable =
      ran_out ? tasks.keeps_limits_of_device(solution) : tasks.keeps_joints(solution);
  return is_usable ? SolverStatus::kBudgetSpent : SolverStatus::kFailed;
}

// the smaller of two budgets of active sets, of which 0 is none
int smaller_budget(int a, int b) noexcept {
  return a == 0 || b == 0 ? std::max(a, b) : std::min(a, b);
}

// torque of Coulomb friction while slipping, as part of tau_dis
VectorA slip_torque(const TwinModel& twin, const TwinState& state, TwinInnerState& inner) noexcept {
  const VectorA& dq_a = state.dq_a;
  VectorA torque = VectorA::Zero(dq_a.size());
  for (int i = 0; i < dq_a.size(); ++i) {
    const double friction = friction_of(twin, i, state.q_a, inner.parameters);
    bool& sticks = inner.sticks[i];
    if (friction <= 0.0) continue;
    if (std::abs(dq_a[i]) <= kStandstill) sticks = true;
    if (!sticks) torque[i] = std::copysign(friction, dq_a[i]);
  }
  return torque;
}

// a slipping joint that would turn round within the sample sticks from the next one on
void catch_reversals(const TwinModel& twin, const TwinState& state, double dt,
                     TwinInnerState& inner) noexcept {
  for (int i = 0; i < state.dq_a.size(); ++i) {
    if (friction_of(twin, i, state.q_a, inner.parameters) <= 0.0) continue;
    if (state.dq_a[i] * (state.dq_a[i] + dt * state.ddq_a[i]) < 0.0) {
      inner.sticks[i] = true;
    }
  }
}

using RowStates = std::array<hqp::RowState, hqp::kMaxRows>;

// the first rows only: an active set has room for many more than a problem has
void copy(const RowStates& from, int rows, RowStates& to) noexcept {
  std::copy_n(from.begin(), rows, to.begin());
}

// rows that begin or cease to act; a lock whose reaction changes its sign does neither
int changed_rows(const RowStates& a, const RowStates& b, int first, int count) noexcept {
  int changes = 0;
  for (int i = first; i < first + count; ++i) {
    const bool acted = a[i] != hqp::RowState::kInactive;
    if (acted != (b[i] != hqp::RowState::kInactive)) ++changes;
  }
  return changes;
}

}  // namespace

void check_rendering(const DeviceModel& device, const TwinModel& twin,
                     const RenderingOptions& options) {
  const auto require = [](bool ok, const std::string& text) {
    if (!ok) throw SetupError(text);
  };
  require(options.slow_solve > 0, "rendering: slow_solve must be positive");
  require(options.solver_budget >= 0, "rendering: solver_budget must not be negative");
  const bool is_paper = options.law == Law::kPaper;
  hg::check_device_model(device);
  require(!is_paper || device.n_m == 6, "device: law paper needs six manipulator joints, got " +
                                            std::to_string(device.n_m) +
                                            "; law gauss takes seven as well");
  require(device.n_m == 6 || device.n_m == 7,
          "device: six or seven manipulator joints are needed, got " + std::to_string(device.n_m));
  require(device.posture.size() == 0 || device.posture.size() == device.n_m,
          "device: one posture goal per manipulator joint is needed, or none");
  require(options.bounds != Bounds::kPaper || options.T_C >= device.dt(),
          "rendering: T_C must not be below the period");
  require(device.handle >= 0, "device: a handle frame is needed");
  for (int i = 0; i < device.n_m; ++i) {
    limits::check_joint_limits(device.joint_limits[i], "joint " + device.manipulator_joint(i));
  }
  for (const VirtualJoint& joint : device.virtual_joints) {
    require(joint.weights.size() == device.n_m, joint.name + ": one weight per manipulator joint");
    limits::check_joint_limits(joint.limits, joint.name);
  }
  for (const CartesianLimit& frame : device.cartesian_limits) {
    for (const limits::JointLimits& axis : frame.axes) limits::check_joint_limits(axis, frame.name);
  }

  check_twin_model(twin);
}

namespace {

void check_stops(const DeviceModel& device, const TwinModel& twin, const RenderingOptions& options,
                 const surfaces::Environment& environment) {
  if (options.law != Law::kGauss || options.bounds != Bounds::kRecoverable) {
    throw SetupError("surfaces with 'contact: stop' need law gauss with bounds recoverable");
  }
  if (!std::isfinite(stop_rating(device))) {
    throw SetupError(
        "surfaces with 'contact: stop' need a Cartesian limit of the handle with ddq_max in "
        "device.yaml: with it the handle brakes before them");
  }
  const std::size_t most = surfaces::kMaxStopSearches / (1 + twin.spheres.size());
  if (environment.stop_triangles() > most) {
    throw SetupError("surfaces that are stops: at most " + std::to_string(most) +
                     " triangles in all with " + std::to_string(twin.spheres.size()) +
                     " collision spheres of the twin, got " +
                     std::to_string(environment.stop_triangles()));
  }
}

// A sphere inside of a stop may ask for any turn of a free body where its lever is short and the
// device holds the end effector back. The limit is beyond what a hand does.
TwinModel with_turning_limit(TwinModel twin, const surfaces::Environment& environment) {
  constexpr double kFastest = 500.0;  // rad/s^2
  if (twin.spheres.empty() || !environment.has_stops()) return twin;
  for (TwinDof& dof : twin.dofs) {
    const bool turns_freely = dof.q_index < 0 && dof.is_angle;
    if (turns_freely) dof.limits.ddq_max = std::min(dof.limits.ddq_max, kFastest);
  }
  return twin;
}

}  // namespace

Rendering::Rendering(DeviceModel device, TwinModel twin, const RenderingOptions& options,
                     surfaces::Environment environment)
    : device_((check_rendering(device, twin, options), std::move(device))),
      twin_(with_turning_limit(std::move(twin), environment)),
      device_now_(device_.chain),
      twin_now_(twin_.chain),
      options_(options),
      dt_(device_.dt()),
      environment_(std::move(environment)),
      stop_rating_(stop_rating(device_)),
      tasks_(device_, twin_, options_, stop_count(environment_, twin_)),
      reactions_(device_, twin_, tasks_.stop_count()),
      L_(twin_.chain.nv(), twin_.chain.nv()),
      J_H_(6, device_.chain.nv()),
      J_a_(6, twin_.chain.nv()),
      solver_(tasks_.problem().capacity()),
      solution_(tasks_.problem().capacity()),
      kept_problems_(std::make_unique<hqp::ProblemCapture>(tasks_.problem().capacity())) {
  if (environment_.has_stops()) check_stops(device_, twin_, options_, environment_);
  solver_options_.max_iterations =
      std::max(kActiveSets, kActiveSetsPerRow * tasks_.problem().rows());
}

RenderingState Rendering::start(const VectorM& q_m) const noexcept {
  RenderingState state;
  state.reference = {q_m, VectorM::Zero(q_m.size()), VectorM::Zero(q_m.size())};
  const int n_a = twin_.chain.nv();
  state.twin = {twin_.q_start, VectorA::Zero(n_a), VectorA::Zero(n_a)};
  state.inner.parameters = initial_parameters(twin_);
  return state;
}

ChangeStatus Rendering::change(const ParameterChange& change,
                               RenderingState& state) const noexcept {
  return apply(twin_, change, state.inner.parameters);
}

void Rendering::update_device(const RobotState& robot, const ReferenceState& reference) noexcept {
  const VectorPM q = stacked(robot.q_p, reference.q_m), dq = stacked(robot.dq_p, reference.dq_m);
  if (device_.motors().empty()) {
    device_now_.update_kinematics(q, dq);
  } else {
    device_now_.update(q, dq);
  }
}

// Advances the values of the twin, and updates its chain. While they change, what the user feels of
// that follows from the masses before.
void Rendering::update_twin(const Vector6& w_H, RenderingState& state) noexcept {
  TwinParameters& parameters = state.inner.parameters;
  const TwinState& twin = state.twin;
  const double inertia = state.added.inertia;
  FeltBy felt;
  if (is_changing(twin_, parameters)) {
    twin_now_.update(twin.q_a, twin.dq_a, {parameters.now.loads.mass * inertia, 1.0 / inertia});
    felt = {.J_a = twin_now_.jacobian(twin_.end_effector),
            .motion = twin_now_.c() - twin_now_.gravity(),
            .weight = twin_now_.gravity(),
            .w_H = w_H};
    felt.motion += twin_now_.M().lazyProduct(twin.ddq_a);
  }
  advance_parameters(twin_, twin, dt_, felt, parameters);
  const model::Loads& loads = parameters.now.loads;
  twin_now_.update(twin.q_a, twin.dq_a, {loads.mass * inertia, loads.gravity / inertia});
}

SolverStatus Rendering::step(const LawInput& input, RenderingState& state,
                             LawResult& result) noexcept {
  update_device(input.robot, state.reference);
  update_twin(input.robot.w_H, state);
  factor_mass(twin_now_.M(), L_);
  J_H_ = device_now_.jacobian(device_.handle);
  J_a_ = twin_now_.jacobian(twin_.end_effector);
  carried_twist_ = twin_now_.carried_twist(twin_.end_effector);
  reactions_.update(J_H_, J_a_);
  advance_locks(twin_, options_.bounds, state.twin.q_a, state.inner);

  const bool is_released = input.braking_rate > 0.0 && input.force_share == 0.0;
  add_torques(input, is_released, state, result);
  feel_surfaces(input, state, result);
  slow_lost_directions(is_released, state, result);

  RowStates previous;
  copy(state.active_set.state, tasks_.problem().rows(), previous);
  solve(input, state, result);
  result.active_set_changes = changed_rows(previous, state.active_set.state,
                                           tasks_.first_limit_row(), tasks_.limit_row_count());
  if (!is_released) catch_reversals(twin_, state.twin, dt_, state.inner);
  give_way(result.contact, state);
  if (environment_.has_stops()) add_stops(result.contact);
  to_hand(state, result);
  find_kinematics(state, result);
  follow_device(input.robot, state.reference.q_m, result);
  ended_(Stage::kReactions);
  return result.solver_status;
}

// Torques on the twin that are no constraints: the user's, and the parts of the budget that balance
// it.
void Rendering::add_torques(const LawInput& input, bool is_released, RenderingState& state,
                            LawResult& result) const noexcept {
  const int n_a = twin_.chain.nv();
  const double share = input.force_share;
  const TwinValues& values = state.inner.parameters.now;
  Budget& budget = result.budget;
  if (is_released) {
    state.inner.sticks.fill(false);
    result.tau_a = VectorA::Zero(n_a);
    budget.spring = -twin_now_.gravity();
    budget.damping = VectorA::Zero(n_a);
    budget.friction = VectorA::Zero(n_a);
    budget.surface = VectorA::Zero(n_a);
  } else {
    result.tau_a = J_a_.transpose() * (share * values.felt_scale.cwiseProduct(input.robot.w_H));
    budget.spring = share * spring_torque(twin_, state.twin, dt_, state.inner.parameters);
    if (share < 1.0) budget.spring -= (1.0 - share) * twin_now_.gravity();
    budget.damping = damping_torque(L_, state.twin.dq_a, dt_, values);
    if (state.added.damping > 0.0) {
      const Eigen::Vector3d v_E = J_a_.topRows<3>() * state.twin.dq_a;
      const Eigen::Vector3d force = values.felt_scale.head<3>().cwiseProduct(v_E);
      budget.damping.noalias() += J_a_.topRows<3>().transpose() * (state.added.damping * force);
    }
    budget.friction = slip_torque(twin_, state.twin, state.inner);
    budget.surface = J_a_.transpose() * (share * values.w_ref);
    if (input.twin_force != nullptr) {
      budget.surface.noalias() -= J_a_.transpose() * (share * input.twin_force->w_E);
      if (input.twin_force->tau.size() > 0) budget.surface -= share * input.twin_force->tau;
    }
  }
  if (input.braking_rate > 0.0) {
    const VectorA braking = input.braking_rate * state.twin.dq_a;
    budget.damping.noalias() += twin_now_.M() * braking;
  }
  if (!state.touch.isZero(0.0)) {
    budget.surface.noalias() -= J_a_.transpose() * values.felt_scale.cwiseProduct(state.touch);
  }
}

// The force on the end effector that accelerates it as springs, weight and reference wrench of the
// twin do; none in directions in which the twin cannot move.
Eigen::Vector3d Rendering::push_of_twin(const Budget& budget) const noexcept {
  const auto factor = L_.triangularView<Eigen::Lower>();
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMaxTwin, 3> root =
      J_a_.topRows<3>().transpose();
  VectorA torque = -budget.spring - budget.surface - twin_now_.gravity();
  if (torque.isZero(0.0)) return Eigen::Vector3d::Zero();
  factor.solveInPlace(root);
  factor.solveInPlace(torque);
  Eigen::Matrix3d mobility = root.transpose() * root;
  mobility.diagonal().array() += kStuck * mobility.trace();
  return mobility.ldlt().solve(Eigen::Vector3d(root.transpose() * torque));
}

// Updates the proxy even while no surface is felt.
void Rendering::feel_surfaces(const LawInput& input, RenderingState& state,
                              LawResult& result) noexcept {
  const Eigen::Vector3d p_E = twin_now_.pose(twin_.end_effector).p;
  const Eigen::Vector3d v_E = J_a_.topRows<3>() * state.twin.dq_a + carried_twist_.head<3>();
  if (environment_.has_stops()) {
    const VectorA& dq = state.twin.dq_a;
    VectorA ddq_max(dq.size());
    for (int i = 0; i < dq.size(); ++i) {
      ddq_max[i] = effective_limits(twin_, i, dq[i], state.inner).limits.ddq_max;
    }
    stops_ = find_stops(environment_, {twin_, twin_now_, L_, dq, ddq_max}, stop_rating_);
  }
  const TwinValues& values = state.inner.parameters.now;
  Eigen::Vector3d push = values.felt_scale.head<3>().cwiseProduct(input.robot.w_H.head<3>());
  if (!environment_.surfaces().empty()) push += push_of_twin(result.budget);
  const double mass_scale = values.loads.mass * state.added.inertia / twin_.mass_scale;
  result.contact = environment_.step(p_E, v_E, push, state.contact, mass_scale);
  if (result.contact.surface < 0) return;
  result.contact.force *= input.force_share;
  result.budget.surface.noalias() -= J_a_.topRows<3>().transpose() * result.contact.force;
}

// The reactions of stops are forces of their surfaces, and those in front of the end effector are
// on the handle.
void Rendering::add_stops(ContactReport& contact) const noexcept {
  const int first = device_.limit_count() + twin_.chain.nv();
  double most = contact.force.norm();
  for (int i = 0; i < tasks_.stop_count(); ++i) {
    const Stop& stop = stops_[i];
    const double force = reactions_.of(first + i);
    if (stop.surface < 0 || force == 0.0) continue;
    if (i < surfaces::kMostFacing) contact.force += force * stop.normal;
    if (force <= most) continue;
    most = force;
    contact.surface = stop.surface;
  }
}

// A surface does not push with the part of its force that limits of the device take.
void Rendering::give_way(const ContactReport& contact, RenderingState& state) const noexcept {
  const double force = contact.force.norm();
  if (contact.surface < 0 || force == 0.0) return;
  const auto factor = L_.triangularView<Eigen::Lower>();
  VectorA along = J_a_.topRows<3>().transpose() * (contact.force / force);
  VectorA limits = reactions_.torque_of_device();
  factor.solveInPlace(along);
  factor.solveInPlace(limits);
  const double missing = -along.dot(limits) / along.squaredNorm();
  const Eigen::Vector3d v_E = J_a_.topRows<3>() * (state.twin.dq_a + 0.5 * dt_ * state.twin.ddq_a) +
                              carried_twist_.head<3>();
  environment_.give_way(contact, std::clamp(missing, 0.0, force), v_E, state.contact);
}

void Rendering::move_base(const TwinBase& base) noexcept {
  twin_now_.move_base(base.T_B_A, base.twist, base.acceleration);
}

void Rendering::align(const RobotState& robot, RenderingState& state) noexcept {
  update_device(robot, state.reference);
  const Pose T_B_H = device_now_.pose(device_.handle);
  const VectorA at_rest = VectorA::Zero(twin_.chain.nv());
  for (int iteration = 0; iteration < kAlignIterations; ++iteration) {
    twin_now_.update_kinematics(state.twin.q_a, at_rest);
    const Pose T_B_E = twin_now_.pose(twin_.end_effector);
    Vector6 error;
    error << T_B_H.p - T_B_E.p, rotation_between(T_B_E.R, T_B_H.R);
    if (error.norm() < kAligned) return;
    const model::Jacobian J_a = twin_now_.jacobian(twin_.end_effector);
    const VectorA step = shortest_velocity(J_a, error);
    state.twin.q_a = twin_.chain.integrate(state.twin.q_a, step);
    for (std::size_t i = 0; i < twin_.dofs.size(); ++i) {
      if (twin_.dofs[i].q_index < 0) continue;
      const Interval& range = state.inner.parameters.moving[i].q;
      double& q = state.twin.q_a[twin_.dofs[i].q_index];
      q = std::clamp(q, range.lb, range.ub);
    }
  }
}

bool Rendering::clamp_reference(const RobotState& robot, double largest,
                                RenderingState& state) noexcept {
  bool is_far = false;
  for (int i = 0; i < device_.n_m; ++i) {
    double& q = state.reference.q_m[i];
    const double nearest = std::clamp(q, robot.q_m[i] - largest, robot.q_m[i] + largest);
    if (nearest == q) continue;
    q = nearest;
    state.reference.dq_m[i] = robot.dq_m[i];
    is_far = true;
  }
  if (!is_far) return false;
  align(robot, state);
  twin_now_.update_kinematics(state.twin.q_a, state.twin.dq_a);
  const model::Jacobian J_a = twin_now_.jacobian(twin_.end_effector);
  const Vector6 carried = twin_now_.carried_twist(twin_.end_effector);
  const Vector6 twist = device_now_.twist(device_.handle) - carried;
  state.twin.dq_a = shortest_velocity(J_a, twist);
  return true;
}

// The paper's law has no such damping.
void Rendering::slow_lost_directions(bool is_released, const RenderingState& state,
                                     LawResult& result) noexcept {
  lost_.clear();
  if (is_released || options_.law == Law::kPaper) return;
  const int count = device_.n_m + (leads_gantry() ? device_.n_p : 0);
  lost_.find(J_H_.rightCols(count), J_a_, L_, state.twin.dq_a, dt_);
  if (lost_.empty()) return;
  result.budget.damping += lost_.torque(state.twin.dq_a);
  lost_.add_to(L_);
}

// Solves, and lets those joints slip whose friction cannot hold them: at most n_a solves more.
void Rendering::solve(const LawInput& input, RenderingState& state, LawResult& result) noexcept {
  const int n_m = device_.n_m, n_a = twin_.chain.nv();
  solver_options_.budget = smaller_budget(static_cast<int>(options_.solver_budget),
                                          static_cast<int>(input.most_active_sets));
  result.solver_iterations = 0;
  bool was_spent = false;  // a solve of this cycle has spent its budget
  for (int attempt = 0; attempt <= n_a; ++attempt) {
    Budget& budget = result.budget;
    const VectorA tau =
        result.tau_a - budget.damping - budget.friction - budget.spring - budget.surface;
    fill_tasks(input, tau, state);
    ended_(Stage::kRenderingSetUp);
    solve_once(input, state, result);
    was_spent = was_spent || result.solver_status == SolverStatus::kBudgetSpent;
    ended_(Stage::kSolver);

    const Eigen::Map<const Eigen::VectorXd> x(solution_.x.data(), n_m + n_a);
    state.reference.ddq_m = x.head(n_m);
    state.twin.ddq_a = x.tail(n_a);
    budget.inertia = twin_now_.c();
    budget.inertia += twin_now_.M().lazyProduct(state.twin.ddq_a);
    VectorA tau_constraint = budget.inertia - tau;
    if (!lost_.empty()) tau_constraint += lost_.torque(dt_ * state.twin.ddq_a);
    reactions_.split(tasks_, solution_, tau_constraint);
    ended_(Stage::kReactions);
    if (!release(state, budget)) break;
  }
  if (!lost_.empty()) result.budget.damping += lost_.torque(dt_ * state.twin.ddq_a);
  if (was_spent && result.solver_status == SolverStatus::kSolved) {
    result.solver_status = SolverStatus::kBudgetSpent;
  }
  tasks_.find_motor_torques(solution_);
  state.motor_torque = tasks_.motor_torque();
  state.ddq_p.resize(0);
  if (input.gantry.ddq.size() > 0) state.ddq_p = tasks_.gantry_acceleration(solution_);
  if (options_.law == Law::kPaper) state.touched = tasks_.touched_ends(solution_);
  result.ddq_m = state.reference.ddq_m;
  result.ddq_a = state.twin.ddq_a;
  const Vector6 w = state.inner.parameters.now.felt_scale.cwiseProduct(input.robot.w_H);
  reactions_.report(tasks_, solution_, {.L = L_, .J_a = J_a_, .w = w, .dt = dt_}, result);
}

void Rendering::fill_tasks(const LawInput& input, const VectorA& tau,
                           const RenderingState& state) noexcept {
  tasks_.fill(device_, twin_,
              {.device_chain = device_now_,
               .twin_chain = twin_now_,
               .robot = input.robot,
               .reference = state.reference,
               .twin = state.twin,
               .inner = state.inner,
               .motor_torque = state.motor_torque,
               .gantry = input.gantry,
               .touched = state.touched,
               .L = L_,
               .J_H = J_H_,
               .J_a = J_a_,
               .directions = reactions_.directions(),
               .stops = stops_,
               .tau = tau,
               .handle_speed = input.handle_speed_max,
               .joint_braking_rate = input.joint_braking_rate,
               .kept_acceleration = input.kept_acceleration,
               .is_braked = input.braking_rate > 0.0,
               .has_surfaces = !environment_.surfaces().empty(),
               .collision = input.collision});
}

// Solves the problem, and keeps it where that fails or is slow.
void Rendering::solve_once(const LawInput& input, RenderingState& state,
                           LawResult& result) noexcept {
  copy(state.active_set.state, tasks_.problem().rows(), guess_.state);
  copy(state.active_set.before, tasks_.problem().rows(), guess_.before);
  solved_cycle_ = input.cycle;
  solver_.solve(tasks_.problem(), solver_options_, state.active_set, solution_);
  result.solver_status = solver_status(tasks_, solver_options_, solution_);
  result.solver_iterations += solution_.iterations;
  const bool has_budget = solver_options_.budget > 0;
  if ((solution_.status != hqp::Status::kSolved && !has_budget) ||
      result.solver_status == SolverStatus::kFailed ||
      solution_.iterations >= options_.slow_solve) {
    keep_problem(input.cycle);
  }
}

// Lets joints slip whose friction cannot hold them. False: none.
bool Rendering::release(RenderingState& state, Budget& budget) const noexcept {
  const int first_twin_limit = device_.limit_count();
  bool is_released = false;
  for (int i = 0; i < twin_.chain.nv(); ++i) {
    bool& sticks = state.inner.sticks[i];
    const std::size_t limit = first_twin_limit + i;
    const double holding = reactions_.of(first_twin_limit + i);
    const double most = friction_of(twin_, i, state.twin.q_a, state.inner.parameters);
    if (!sticks || std::abs(holding) <= most) continue;
    sticks = false;
    budget.friction[i] = -std::copysign(most, holding);
    state.touched.lower[limit] = state.touched.upper[limit] = false;
    is_released = true;
  }
  return is_released;
}

void Rendering::keep_problem(std::uint64_t cycle, double cycle_time_us) noexcept {
  if (solved_cycle_ != cycle) return;
  kept_problems_->capture(tasks_.problem(), solver_options_, guess_, solution_, cycle,
                          cycle_time_us);
}

bool Rendering::is_blocked() const noexcept {
  const int count = device_.n_m + static_cast<int>(device_.virtual_joints.size());
  for (int i = 0; i < count; ++i) {
    const std::size_t row = tasks_.limit_rows()[i].row;
    if (hqp::is_violated(solution_.state[row])) return true;
  }
  return false;
}

void Rendering::gantry_room(VectorP& down, VectorP& up) const noexcept {
  down = up = VectorP::Constant(device_.n_p, kInfinity);
  // The law leads the handle. Where limits brake together, the gantry has to stop it as far as the
  // arm cannot: the handle's room is multiplied by what the arm has beyond the least reserve.
  const double arm = brakes_together(device_, options_)
                         ? std::max(1.0, tasks_.braking_reserve() / kLeastReserve)
                         : kInfinity;
  for (const CartesianLimit& frame : device_.cartesian_limits) {
    const double share = frame.frame == device_.handle ? arm : 1.0;
    if (!std::isfinite(share)) continue;
    const model::Jacobian& J = device_now_.jacobian(frame.frame);
    const Eigen::Vector3d position = device_now_.pose(frame.frame).p;
    for (int axis = 0; axis < 3; ++axis) {
      const limits::JointLimits& range = frame.axes[axis];
      const double to_lower = share * (position[axis] - range.q_min);
      const double to_upper = share * (range.q_max - position[axis]);
      for (int i = 0; i < device_.n_p; ++i) {
        const double per = J(axis, i);  // of the frame, per motion of the gantry
        if (std::abs(per) < 1e-3) continue;
        down[i] = std::min(down[i], (per > 0.0 ? to_lower : to_upper) / std::abs(per));
        up[i] = std::min(up[i], (per > 0.0 ? to_upper : to_lower) / std::abs(per));
      }
    }
  }
}

Vector6 Rendering::handle_twist(const RobotState& robot) const noexcept {
  return J_H_.lazyProduct(stacked(robot.dq_p, robot.dq_m));
}

Vector6 Rendering::end_effector_twist(const RenderingState& state) const noexcept {
  return J_a_.lazyProduct(state.twin.dq_a);
}

double Rendering::apparent_mass(const RenderingState& state) const noexcept {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMaxTwin, 3> root =
      J_a_.topRows<3>().transpose();
  L_.triangularView<Eigen::Lower>().solveInPlace(root);
  root *= state.inner.parameters.now.felt_scale.head<3>().cwiseSqrt().asDiagonal();
  return 1.0 / (state.added.inertia * root.colwise().squaredNorm().maxCoeff());
}

// What the twin does to the hand, as the hand feels it.
void Rendering::to_hand(const RenderingState& state, LawResult& result) const noexcept {
  const Vector6& scale = state.inner.parameters.now.felt_scale;
  result.felt_scale = scale;
  result.w_felt.array() /= scale.array();
  result.budget.structure.array() /= scale.array();
  result.contact.force.array() /= scale.head<3>().array();
}

// The rows of the law hold the reference. Where drives lag and motors are overpowered, the device
// leaves walls that its reference keeps.
void Rendering::follow_device(const RobotState& robot, const VectorM& q_m,
                              LawResult& result) const noexcept {
  const VectorM lag = robot.q_m - q_m;
  const VectorPM dq = stacked(robot.dq_p, robot.dq_m);
  int limit = device_.first_cartesian();
  for (const CartesianLimit& frame : device_.cartesian_limits) {
    const model::Jacobian& J = device_now_.jacobian(frame.frame);
    const Eigen::Vector3d p = device_now_.pose(frame.frame).p;
    for (int axis = 0; axis < 3; ++axis, ++limit) {
      const double q = p[axis] + J.row(axis).tail(device_.n_m).dot(lag);
      const double reached = passing(tasks_.limit_rows()[limit].range, q, J.row(axis).dot(dq));
      result.passing[limit] = std::max(result.passing[limit], reached);
    }
  }
}

void Rendering::find_kinematics(const RenderingState& state, LawResult& result) const noexcept {
  result.T_B_H = device_now_.pose(device_.handle);
  result.v_H = device_now_.twist(device_.handle).head<3>();
  result.a_H =
      (J_a_ * state.twin.ddq_a + twin_now_.bias_acceleration(twin_.end_effector)).head<3>();
  if (device_.elbow >= 0) result.p_B_elbow = device_now_.pose(device_.elbow).p;
  result.T_B_E = twin_now_.pose(twin_.end_effector);
  result.sync_error = (result.T_B_E.p - result.T_B_H.p).norm();
  result.sync_error_angle = angle_between(result.T_B_H.R, result.T_B_E.R);
}

void Rendering::integrate(RenderingState& state) const noexcept {
  rendering::integrate(state.reference, dt_);
  rendering::integrate(twin_.chain, state.twin, dt_);
}

}  // namespace hg::rendering
