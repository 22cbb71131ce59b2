#include "hg/rendering/rendering.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/rendering/test/test_models.h"

namespace hg::rendering {
namespace {

const VectorM kPosture = posture({0.3, 1.5, -0.6, 1.3, 0.2, 2.1});
const Eigen::Vector2d kGantryAtHome = Eigen::Vector2d::Zero();

// the twin of [HANDBOOK] 12.1: 6 kg, centre of mass off the handle, inertia about it
TwinModel golden_twin() {
  model::FreeBody body;
  body.mass = 6.0;
  body.p_handle_com = {0.1, 0.05, 0.1};
  body.inertia = Eigen::Vector3d(0.08, 0.1, 0.12).asDiagonal();
  return unlimited_twin(model::Chain::free_body(body, {.gravity = false}), "handle");
}

// the acceleration that no limit disturbs
VectorA free_acceleration(const TwinModel& twin, const VectorA& tau) {
  return twin.chain.M().llt().solve(tau);
}

TEST(Rendering, GoldenCaseOfTheHandbookJoint6AtItsUpperLimit) {
  DeviceModel device = unlimited_device();
  device.joint_limits[5].q_max = 2.1;
  Rendering rendering(device, golden_twin(), without_synchronisation());
  State state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);

  ASSERT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);
  const double expected[] = {1.2663, -1.8867, 0.1771, -0.1169, 0.0455, 15.4167};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(record.twin.ddq_a[i], expected[i], 5e-5) << i;
  EXPECT_EQ(record.limits[5].state, LimitState::kUpper);
  EXPECT_LT(record.limits[5].reaction, 0.0);
  EXPECT_NEAR(record.reference.ddq_m[5], 0.0, 1e-12);
  EXPECT_EQ(record.felt_limit, 5);
}

TEST(Rendering, WithoutLimitsTheTwinMovesAsNewtonSays) {
  Rendering rendering(unlimited_device(), golden_twin(), without_synchronisation());
  State state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);
  rendering.step(state, 0.0, record);
  const VectorA expected = free_acceleration(rendering.twin(), record.tau_a);
  EXPECT_LT((record.twin.ddq_a - expected).norm(), 1e-12);
  EXPECT_NEAR(record.reference.ddq_m[5], 1.16142, 5e-6);  // free value of the golden case
  EXPECT_EQ(record.felt_limit, -1);
}

TEST(Rendering, ASlowSolveIsKeptAndGivesTheSameAgain) {
  DeviceModel device = unlimited_device();
  device.joint_limits[5].q_max = 2.1;
  Options options = without_synchronisation();
  options.slow_solve = 1;
  Rendering rendering(device, golden_twin(), options);
  State state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);
  record.cycle = 77;
  rendering.step(state, 0.0, record);

  ASSERT_EQ(rendering.kept_problems().size(), 1U);
  const hqp::KeptProblem& kept = rendering.kept_problems()[0];
  EXPECT_EQ(kept.cycle, 77U);
  EXPECT_EQ(kept.iterations, record.solver_iterations);
  EXPECT_GT(kept.iterations, 1);  // the guess was not yet right
  hqp::Solver solver(kept.problem.capacity());
  hqp::Solution solution(kept.problem.capacity());
  hqp::ActiveSet active = kept.guess;
  EXPECT_EQ(solver.solve(kept.problem, kept.options, active, solution), hqp::Status::kSolved);
  EXPECT_EQ(solution.iterations, kept.iterations);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(solution.x[static_cast<std::size_t>(i)], record.reference.ddq_m[i]) << i;
    EXPECT_EQ(solution.x[static_cast<std::size_t>(6 + i)], record.twin.ddq_a[i]) << i;
  }
}

TEST(Rendering, AnOrdinarySolveIsNotKeptUnlessAskedFor) {
  Rendering rendering(unlimited_device(), golden_twin(), without_synchronisation());
  State state = rendering.start(kPosture);
  CycleRecord record = record_with(kGantryAtHome, kPosture, Vector6::Zero());
  rendering.keep_problem(record.cycle);  // nothing has been solved
  record.cycle = 5;
  rendering.step(state, 0.0, record);
  rendering.keep_problem(6);  // not that cycle's
  EXPECT_EQ(rendering.kept_problems().size(), 0U);
  EXPECT_EQ(rendering.kept_problems().count(), 0U);
  rendering.keep_problem(5);
  ASSERT_EQ(rendering.kept_problems().size(), 1U);
  EXPECT_EQ(rendering.kept_problems()[0].cycle, 5U);
}

// Independent oracle, [HANDBOOK] 12.2: minimise 1/2 (a - a_free)^T M (a - a_free) under
// lb <= G a + g <= ub, by coordinate ascent on the dual.
VectorA box_qp_oracle(const Eigen::MatrixXd& M, const VectorA& a_free, const Eigen::MatrixXd& G,
                      const Eigen::VectorXd& lb, const Eigen::VectorXd& ub) {
  const Eigen::MatrixXd M_inv = M.inverse();
  const Eigen::MatrixXd GMG = G * M_inv * G.transpose();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(G.rows());
  Eigen::VectorXd y = G * a_free;
  for (int sweep = 0; sweep < 200'000; ++sweep) {
    double change = 0.0;
    for (int i = 0; i < G.rows(); ++i) {
      // the force that brings row i to the nearest point of its interval
      const double without = y[i] - GMG(i, i) * lambda[i];
      const double wanted = (std::clamp(without, lb[i], ub[i]) - without) / GMG(i, i);
      y += GMG.col(i) * (wanted - lambda[i]);
      change = std::max(change, std::abs(wanted - lambda[i]) * GMG(i, i));
      lambda[i] = wanted;
    }
    if (change < 1e-13) break;
  }
  return a_free + VectorA(M_inv * G.transpose() * lambda);
}

TEST(Rendering, EqualsTheBoxQpForAnyNumberOfCompatibleJointLimits) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int with_two_or_more = 0;
  for (int trial = 0; trial < 300; ++trial) {
    DeviceModel device = unlimited_device();
    VectorM q =
        posture({3 * uniform(random), 1.5 + 0.8 * uniform(random), uniform(random),
                 1.3 + 0.6 * uniform(random), 0.2 + 0.3 * uniform(random), uniform(random)});
    for (int i = 0; i < 6; ++i) {
      // at its upper limit, at its lower limit, or free
      const double where = uniform(random);
      limits::JointLimits& limits = device.joint_limits[static_cast<std::size_t>(i)];
      if (where > 0.4) limits.q_max = q[i];
      if (where < -0.4) limits.q_min = q[i];
    }
    Rendering rendering(device, golden_twin(), without_synchronisation());
    State state = rendering.start(q);
    Vector6 w;
    for (double& value : w) value = 20 * uniform(random);
    CycleRecord record = record_with(kGantryAtHome, q, w);
    ASSERT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);

    // ddq_m = J_m^-1 J_a ddq_a, everything at rest
    model::Chain chain = device.chain;
    Eigen::VectorXd q_all(8);
    q_all << kGantryAtHome, q;
    chain.update_kinematics(q_all, Eigen::VectorXd::Zero(8));
    const Eigen::MatrixXd J_m = chain.jacobian(device.handle).rightCols(6);
    const Eigen::MatrixXd G = J_m.fullPivLu().solve(
        Eigen::MatrixXd(rendering.twin().chain.jacobian(rendering.twin().end_effector)));
    Eigen::VectorXd lb(6), ub(6);
    for (int i = 0; i < 6; ++i) {
      const auto& limits = device.joint_limits[static_cast<std::size_t>(i)];
      lb[i] = limits.q_min == q[i] ? 0.0 : -kInfinity;
      ub[i] = limits.q_max == q[i] ? 0.0 : kInfinity;
    }
    const VectorA a_free = free_acceleration(rendering.twin(), record.tau_a);
    const VectorA expected = box_qp_oracle(rendering.twin().chain.M(), a_free, G, lb, ub);
    const double scale = 1.0 + a_free.norm();
    ASSERT_LT((record.twin.ddq_a - expected).norm(), 1e-7 * scale) << "trial " << trial;
    int active = 0;
    for (int i = 0; i < 6; ++i) {
      const LimitReport& limit = record.limits[static_cast<std::size_t>(i)];
      if (limit.state == LimitState::kInactive) continue;
      ++active;
      // a limit only pushes inwards
      EXPECT_GE(limit.reaction * (limit.state == LimitState::kLower ? 1.0 : -1.0), -1e-9);
    }
    if (active >= 2) ++with_two_or_more;
  }
  EXPECT_GT(with_two_or_more, 100);
}

// sum of all parts of the budget minus J_a^T w
double budget_gap(const CycleRecord& record) {
  const Budget& b = record.budget;
  return (b.inertia + b.damping + b.friction + b.spring + b.surface + b.limits + b.conflict -
          record.tau_a)
      .norm();
}

TwinModel door_twin(const Pose& T_B_root) {
  TwinModel twin =
      unlimited_twin(model::Chain::from_urdf_file("models/twins/door/door.urdf",
                                                  {.T_B_root = T_B_root, .gravity = false}),
                     "handle");
  twin.dofs[0].limits = {0.0, 1.75, 1.2, 25.0};
  twin.dofs[1].limits = {0.0, 0.80, 6.0, 200.0};
  twin.dofs[0].stiffness = 4.0;
  twin.dofs[0].preload = 3.0;
  twin.dofs[1].stiffness = 1.2;
  twin.dofs[1].preload = 0.6;
  twin.dofs[0].damping = 2.0;
  twin.dofs[1].damping = 0.05;
  return twin;
}

TEST(Rendering, TheBudgetClosesAndTheBearingsCarryTheRest) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  DeviceModel device = unlimited_device();
  for (auto& limits : device.joint_limits) limits = {-10.0, 10.0, 2.0, 12.0};
  for (int trial = 0; trial < 200; ++trial) {
    TwinModel twin = door_twin({});
    twin.dofs[0].friction = 0.5;
    Rendering rendering(device, twin, without_synchronisation());
    State state = rendering.start(kPosture);
    state.twin.q_a[0] = std::max(0.0, uniform(random));
    state.twin.q_a[1] = std::max(0.0, 0.8 * uniform(random));
    state.twin.dq_a[0] = uniform(random) * (state.twin.q_a[0] > 0.0);
    Vector6 w;
    for (double& value : w) value = 30 * uniform(random);
    CycleRecord record = record_with(kGantryAtHome, kPosture, w);
    rendering.step(state, 0.0, record);
    ASSERT_LT(budget_gap(record), 1e-9) << "trial " << trial;

    // the part called structure moves no joint, the rest reaches all of them
    const auto J_a = rendering.twin().chain.jacobian(rendering.twin().end_effector);
    ASSERT_LT((J_a.transpose() * record.budget.structure).norm(), 1e-9);
    const Vector6 rest = record.robot.w_H - record.budget.structure;
    ASSERT_LT((J_a.transpose() * rest - record.tau_a).norm(), 1e-9);
  }
}

TEST(Rendering, AtAHeldLimitTheOtherJointsMoveLikeTheReducedModel) {
  TwinModel twin = unlimited_twin(
      model::Chain::from_urdf_file("models/twins/excavator/excavator.urdf", {.gravity = false}),
      "handle");
  twin.q_start << 0.2, 0.3, 0.9, 1.0;
  twin.dofs[3].limits = {0.0, 1.0, 3.0, 20.0};  // bucket, at its upper end
  Rendering rendering(unlimited_device(), twin, without_synchronisation());
  State state = rendering.start(kPosture);
  state.twin.dq_a << 0.3, -0.2, 0.4, 0.0;
  Vector6 w;
  w << 5, 3, 4, 2, 6, -1;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);
  rendering.step(state, 0.0, record);
  if (record.limits[9].state == LimitState::kInactive) {  // 6 device joints before the twin
    record = record_with(kGantryAtHome, kPosture, -w);
    rendering.step(state, 0.0, record);
  }
  ASSERT_EQ(record.limits[9].state, LimitState::kUpper);

  const Eigen::MatrixXd M = rendering.twin().chain.M();
  const Eigen::VectorXd c = rendering.twin().chain.c();
  const Eigen::Vector3d expected =
      M.topLeftCorner<3, 3>().llt().solve(record.tau_a.head<3>() - c.head<3>());
  EXPECT_LT((record.twin.ddq_a.head<3>() - expected).norm(), 1e-9);
  EXPECT_NEAR(record.twin.ddq_a[3], 0.0, 1e-9);
  // what the limit pushes with is what the equation of the held joint lacks
  EXPECT_NEAR(record.limits[9].reaction, M.row(3).head<3>().dot(expected) + c[3] - record.tau_a[3],
              1e-9);
}

// Plays `seconds` of a twin on its own: the device has no limits and no synchronisation.
struct Playing {
  Rendering rendering;
  State state;
  CycleRecord record;

  explicit Playing(const TwinModel& twin)
      : rendering(unlimited_device(), twin, without_synchronisation()),
        state(rendering.start(kPosture)) {}

  // torque at the twin's joint `dof`, made by a wrench on E
  void run(double seconds, int dof, double torque) {
    for (int k = 0; k < static_cast<int>(1000 * seconds); ++k) {
      state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
      record = record_with(kGantryAtHome, kPosture, wrench_for(dof, torque));
      ASSERT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);
      rendering.integrate(state);
      changes += record.active_set_changes;
    }
  }

  Vector6 wrench_for(int dof, double torque) {
    model::Chain chain = rendering.twin().chain;
    chain.update_kinematics(state.twin.q_a, state.twin.dq_a);
    const Eigen::MatrixXd J_a_T = chain.jacobian(rendering.twin().end_effector).transpose();
    const Eigen::VectorXd tau = torque * Eigen::VectorXd::Unit(J_a_T.rows(), dof);
    return J_a_T.completeOrthogonalDecomposition().solve(tau);
  }

  int changes = 0;
};

TEST(Rendering, NothingChattersAtAHeldLimit) {
  Playing door(door_twin({}));
  door.run(4.0, 0, 20.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 1.75, 1e-6);
  door.changes = 0;
  door.run(1.0, 0, 20.0);
  EXPECT_EQ(door.changes, 0);
  EXPECT_LE(door.state.twin.q_a[0], 1.75);
  EXPECT_NEAR(door.record.limits[6].reaction, -(20.0 - 3.0 - 4.0 * 1.75), 1e-3);
}

TEST(Rendering, AStopThatOnlyCarriesASpringIsNotFelt) {
  Playing door(door_twin({}));
  door.run(0.1, 0, 0.0);
  EXPECT_EQ(door.record.limits[6].state, LimitState::kLower);
  EXPECT_NEAR(door.record.limits[6].reaction, 3.0, 1e-6);  // of the closer
  EXPECT_EQ(door.record.felt_limit, -1);
  door.run(0.1, 0, -5.0);  // pulled against the stop
  EXPECT_EQ(door.record.felt_limit, 6);
}

TEST(Rendering, CoulombFrictionHoldsUpToItsTorqueAndSlipsBeyond) {
  TwinModel twin = door_twin({});
  for (TwinDof& dof : twin.dofs) dof.stiffness = dof.preload = dof.damping = 0.0;
  twin.dofs[0].friction = 4.0;
  twin.q_start[0] = 0.5;
  Playing door(twin);
  door.run(0.5, 0, 3.9);
  EXPECT_EQ(door.state.twin.q_a[0], 0.5);
  EXPECT_EQ(door.record.limits[6].cause, LimitCause::kFriction);
  door.run(0.2, 0, 5.0);
  const double inertia = door.rendering.twin().chain.M()(0, 0);
  EXPECT_NEAR(door.state.twin.dq_a[0], (5.0 - 4.0) * 0.2 / inertia, 1e-3);
  // let go: it brakes with the friction torque, stops, and stays
  door.run(0.1, 0, 0.0);
  const double stopped = door.state.twin.q_a[0];
  EXPECT_NEAR(door.state.twin.dq_a[0], 0.0, 1e-9);
  door.run(0.5, 0, 0.0);
  EXPECT_NEAR(door.state.twin.q_a[0], stopped, 1e-9);
}

Lock door_lock() {
  return {.name = "bolt",
          .dof = 0,
          .position = 0.0,
          .engaged_while = {{.dof = 0, .range = {-kInfinity, 0.03}},
                            {.dof = 1, .range = {-kInfinity, 0.50}}}};
}

TEST(Rendering, ALockHoldsUntilTheHandleIsPressed) {
  TwinModel twin = door_twin({});
  twin.locks = {door_lock()};
  twin.dofs[1].stiffness = twin.dofs[1].preload = 0.0;  // the handle stays where it is put
  Playing door(twin);
  door.run(0.5, 0, 30.0);
  EXPECT_LT(std::abs(door.state.twin.q_a[0]), 1e-4);
  EXPECT_EQ(door.record.limits[6].cause, LimitCause::kLock);
  EXPECT_NEAR(door.record.limits[6].reaction, -(30.0 - 3.0), 0.1);
  door.state.twin.q_a[1] = 0.6;
  door.run(0.1, 0, 30.0);
  EXPECT_GT(door.state.twin.q_a[0], 0.03);
}

TEST(Rendering, ALatchLetsTheDoorCloseButNotOpenAgain) {
  TwinModel twin = door_twin({});
  twin.locks = {door_lock()};
  twin.q_start[0] = 0.02;
  Playing door(twin);
  door.run(0.2, 0, 10.0);  // pushes open, against the latch
  EXPECT_LE(door.state.twin.q_a[0], 0.02 + 1e-9);
  EXPECT_EQ(door.record.limits[6].cause, LimitCause::kLatch);
  door.run(1.0, 0, 0.0);  // the closer pulls it shut
  EXPECT_NEAR(door.state.twin.q_a[0], 0.0, kLockReached);
  EXPECT_EQ(door.record.limits[6].cause, LimitCause::kLock);
  door.run(0.2, 0, 30.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 0.0, kLockReached);
}

TEST(Rendering, ALatchBringsTheJointToRestAtALockInMidRange) {
  TwinModel twin = door_twin({});
  Lock lock = door_lock();
  lock.position = 0.9;
  lock.engaged_while.erase(lock.engaged_while.begin());
  twin.locks = {lock};
  twin.q_start[0] = 1.5;
  Playing door(twin);
  door.run(0.5, 0, 0.0);
  EXPECT_NE(door.record.limits[6].cause, LimitCause::kLatch);  // falls freely towards the lock
  door.run(3.0, 0, 0.0);
  EXPECT_NEAR(door.state.twin.q_a[0], 0.9, kLockReached);
  EXPECT_EQ(door.record.limits[6].cause, LimitCause::kLock);
}

TEST(Rendering, BrakingStopsATwinWithASpring) {
  Playing door(door_twin({}));
  door.state.twin.q_a[0] = 1.0;
  door.state.twin.dq_a[0] = -0.8;
  for (int k = 0; k < 600; ++k) {
    door.record = record_with(kGantryAtHome, kPosture, door.wrench_for(0, 20.0));
    door.state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    door.rendering.step(door.state, 20.0, door.record);
    door.rendering.integrate(door.state);
  }
  EXPECT_LT(std::abs(door.state.twin.dq_a[0]), 1e-3);
}

// The free body at the handle, pushed by `force` along x, while the gantry accelerates by `ddq_p`.
CycleRecord pushed_along_x(const DeviceModel& device, double force, double ddq_p) {
  TwinModel twin = golden_twin();
  twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
  Rendering rendering(device, twin, {});
  State state = rendering.start(kPosture);
  Vector6 w = Vector6::Zero();
  w[0] = force;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);
  record.robot.ddq_p[0] = ddq_p;
  EXPECT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);
  return record;
}

TEST(Rendering, ACartesianLimitHoldsTheHandWhateverTheGantryDoes) {
  DeviceModel device = unlimited_device();
  const double x = handle_pose(device, kGantryAtHome, kPosture).p.x();
  device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 0.0}};
  device.cartesian_limits[0].axes[0] = {-10.0, x, 1.5, 5.0};
  for (const double ddq_p : {0.0, 2.0, -2.0}) {
    const CycleRecord held = pushed_along_x(device, 20.0, ddq_p);
    EXPECT_EQ(held.limits[6].state, LimitState::kUpper);
    EXPECT_NEAR(held.a_H.x(), 0.0, 1e-9) << ddq_p;
    EXPECT_NEAR(held.limits[6].reaction, held.w_felt[0], 1e-9);
    EXPECT_LT(held.limits[6].reaction, -1.0);
    EXPECT_GT(pushed_along_x(device, -20.0, ddq_p).a_H.x(), -100.0);
    EXPECT_LT(pushed_along_x(device, -20.0, ddq_p).a_H.x(), -1.0);
  }
}

TEST(Rendering, AVirtualJointIsHeldAtItsEnd) {
  DeviceModel device = unlimited_device();
  const double s = kPosture[3] + kPosture[4];
  device.virtual_joints = {
      {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {s, 2.88, 4, 40}}};
  int held = 0;
  for (const double force : {20.0, -20.0}) {
    const CycleRecord record = pushed_along_x(device, force, 0.0);
    const double ddq_s = record.reference.ddq_m[3] + record.reference.ddq_m[4];
    EXPECT_GE(ddq_s, -1e-9);
    if (record.limits[6].state == LimitState::kLower) ++held;
  }
  EXPECT_EQ(held, 1);  // one way it is pushed onto its end, the other way off
}

TEST(Rendering, AGantryThatDragsJointsFromTheirLimitsBlocksTheDevice) {
  DeviceModel device = unlimited_device();
  for (int i = 0; i < 6; ++i) {
    device.joint_limits[static_cast<std::size_t>(i)] = {kPosture[i], kPosture[i], 1.0, 10.0};
  }
  Rendering rendering(device, door_twin({}), without_synchronisation());
  State state = rendering.start(kPosture);
  CycleRecord record = record_with(kGantryAtHome, kPosture, Vector6::Zero());
  rendering.step(state, 0.0, record);
  EXPECT_FALSE(rendering.is_blocked());
  // a door cannot follow in all six directions, and the hand stays on it
  record.robot.ddq_p[0] = 2.0;
  ASSERT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);
  EXPECT_TRUE(rendering.is_blocked());
  EXPECT_LT(budget_gap(record), 1e-9);
}

TEST(Rendering, TheHandFollowsTheTwinAndTheErrorDecays) {
  const DeviceModel device = unlimited_device();
  TwinModel twin = golden_twin();
  Pose start = handle_pose(device, kGantryAtHome, kPosture);
  start.p.x() += 1e-3;
  start.R = start.R * Eigen::AngleAxisd(2e-3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  twin.q_start = floating_at(start);
  Rendering rendering(device, twin, {});
  State state = rendering.start(kPosture);
  CycleRecord record;
  for (int k = 0; k < 1000; ++k) {
    record = record_with(kGantryAtHome, state.reference.q_m, Vector6::Zero());
    ASSERT_EQ(rendering.step(state, 0.0, record), SolverStatus::kSolved);
    rendering.integrate(state);
    if (k == 0) {
      EXPECT_NEAR(record.sync_error, 1e-3, 1e-9);
      EXPECT_NEAR(record.sync_error_angle, 2e-3, 1e-9);
    }
  }
  EXPECT_LT(record.sync_error, 1e-8);
  EXPECT_LT(record.sync_error_angle, 1e-7);
  EXPECT_LT((handle_pose(device, kGantryAtHome, state.reference.q_m).p - start.p).norm(), 1e-6);
}

TEST(Rendering, AStepMakesNoAllocation) {
  DeviceModel device = unlimited_device();
  for (auto& limits : device.joint_limits) limits = {-10.0, 10.0, 2.0, 12.0};
  device.joint_limits[5].q_max = 2.1;
  device.virtual_joints = {
      {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {0.26, 2.88, 4, 40}}};
  device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 5e-3}};
  device.cartesian_limits[0].axes.fill({-1.5, 1.5, 1.5, 5.0});
  TwinModel twin = door_twin({});
  twin.locks = {door_lock()};
  twin.dofs[1].friction = 0.3;
  Rendering rendering(device, twin, without_synchronisation());
  State state = rendering.start(kPosture);
  Vector6 w;
  w << 30, -20, 10, 2, 1, 1.5;
  CycleRecord record = record_with(kGantryAtHome, kPosture, w);
  const AllocationCounter allocations;
  for (int k = 0; k < 20; ++k) {
    rendering.step(state, k < 10 ? 0.0 : 20.0, record);
    rendering.integrate(state);
  }
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_EQ(record.solver_status, SolverStatus::kSolved);
}

TEST(Rendering, RefusesModelsThatDoNotFitTogether) {
  DeviceModel device = unlimited_device();
  device.joint_limits.pop_back();
  EXPECT_THROW(Rendering(device, golden_twin(), {}), SetupError);
  device = unlimited_device();
  device.joint_limits[2] = {1.0, -1.0, 1.0, 1.0};
  EXPECT_THROW(Rendering(device, golden_twin(), {}), SetupError);
  TwinModel twin = golden_twin();
  twin.dofs.pop_back();
  EXPECT_THROW(Rendering(unlimited_device(), twin, {}), SetupError);
}

TEST(Rendering, RefusesADeviceWithoutSixManipulatorJoints) {
  DeviceModel device = unlimited_device();
  device.n_p = 3;
  device.n_m = 5;
  EXPECT_THROW(Rendering(device, golden_twin(), {}), SetupError);
}

}  // namespace
}  // namespace hg::rendering
