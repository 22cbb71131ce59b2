#include "hg/controller/rendering/rendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hg/controller/rendering/test/playing.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"

namespace hg::rendering {
namespace {

// the twin of [HANDBOOK] 12.1: 6 kg, centre of mass off the handle, inertia about it
TwinModel golden_twin() {
  model::FreeBody body;
  body.mass = 6.0;
  body.p_handle_com = {0.1, 0.05, 0.1};
  body.inertia = Eigen::Vector3d(0.08, 0.1, 0.12).asDiagonal();
  return unlimited_twin(model::ChainModel::free_body(body, {.gravity = false}), "handle");
}

// the acceleration that no limit disturbs
VectorA free_acceleration(const model::ChainData& twin, const VectorA& tau) {
  return LeastSquares(twin.M()).solve(tau);
}

TEST(Rendering, GoldenCaseOfTheHandbookJoint6AtItsUpperLimit) {
  DeviceModel device = unlimited_device();
  device.joint_limits[5].q_max = 2.1;
  Rendering rendering(device, golden_twin(), without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;

  ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
  const double expected[] = {1.2663, -1.8867, 0.1771, -0.1169, 0.0455, 15.4167};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(result.ddq_a[i], expected[i], 5e-5) << i;
  EXPECT_EQ(result.limits[5].state, LimitState::kUpper);
  EXPECT_LT(result.limits[5].reaction, 0.0);
  EXPECT_NEAR(result.ddq_m[5], 0.0, 1e-12);
  EXPECT_EQ(result.felt_limit, 5);
}

TEST(Rendering, WithoutLimitsTheTwinMovesAsNewtonsLaw) {
  Rendering rendering(unlimited_device(), golden_twin(), without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  rendering.step({.robot = robot}, state, result);
  const VectorA expected = free_acceleration(rendering.twin_chain(), result.tau_a);
  EXPECT_LT((result.ddq_a - expected).norm(), 1e-12);
  EXPECT_NEAR(result.ddq_m[5], 1.16142, 5e-6);  // free value of the golden case
  EXPECT_EQ(result.felt_limit, -1);
}

TEST(Rendering, ASlowSolveIsKeptAndGivesTheSameAgain) {
  DeviceModel device = unlimited_device();
  device.joint_limits[5].q_max = 2.1;
  RenderingOptions options = without_synchronisation();
  options.slow_solve = 1;
  Rendering rendering(device, golden_twin(), options);
  RenderingState state = rendering.start(kPosture);
  Vector6 w;
  w << 3, -2, 1, 0.2, 0.1, 1.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  rendering.step({.robot = robot, .cycle = 77}, state, result);

  ASSERT_EQ(rendering.kept_problems().size(), 1U);
  const hqp::CapturedProblem& kept = rendering.kept_problems()[0];
  EXPECT_EQ(kept.cycle, 77U);
  EXPECT_EQ(kept.iterations, result.solver_iterations);
  EXPECT_GT(kept.iterations, 1);  // the guess was not yet right
  hqp::Solver solver(kept.problem.capacity());
  hqp::Solution solution(kept.problem.capacity());
  hqp::ActiveSet active = kept.guess;
  EXPECT_EQ(solver.solve(kept.problem, kept.options, active, solution), hqp::Status::kSolved);
  EXPECT_EQ(solution.iterations, kept.iterations);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(solution.x[i], result.ddq_m[i]) << i;
    EXPECT_EQ(solution.x[6 + i], result.ddq_a[i]) << i;
  }
}

// Joint 3 is at its end and the hand pushes on: the gantry takes over what it may. Without a limit
// it follows its aim, and the twin feels nothing of it.
TEST(Rendering, TheGantryHelpsWhereALimitActsAndFollowsItsAimElsewhere) {
  DeviceModel device = unlimited_device();
  Eigen::VectorXd q(8);
  q << kGantryAtHome, kPosture;
  model::ChainData chain(device.chain);
  chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
  Vector6 w = Vector6::Zero();
  w.head<3>() = 20.0 * chain.jacobian(device.handle).col(4).head<3>().normalized();
  const VectorP aim = Eigen::Vector2d(0.2, -0.1);
  GantryTask task = {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, 0.5), aim,
                     Eigen::Vector2d::Zero()};
  RenderingOptions options = without_synchronisation();
  options.gantry = Gantry::kLaw;
  const auto play = [&](const GantryTask& gantry, VectorP& ddq_p) {
    Rendering rendering(device, golden_twin(), options);
    RenderingState state = rendering.start(kPosture);
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    LawResult result;
    EXPECT_EQ(rendering.step({.robot = robot, .gantry = gantry}, state, result),
              SolverStatus::kSolved);
    ddq_p = state.ddq_p;
    const VectorA missing = result.ddq_a - free_acceleration(rendering.twin_chain(), result.tau_a);
    return std::sqrt(missing.dot(rendering.twin_chain().M() * missing));
  };
  VectorP ddq_p;
  EXPECT_LT(play(task, ddq_p), 1e-10);
  EXPECT_LT((ddq_p - aim).norm(), 1e-12);

  device.joint_limits[2].q_max = kPosture[2];
  device.joint_limits[2].ddq_max = 10.0;
  const double alone = play({}, ddq_p);
  EXPECT_GT(alone, 1.0);
  EXPECT_EQ(ddq_p.size(), 0);
  const double helped = play(task, ddq_p);
  EXPECT_LT(helped, 0.95 * alone);
  EXPECT_GT((ddq_p - aim).norm(), 0.1);
  EXPECT_LE(ddq_p.cwiseAbs().maxCoeff(), 0.5 + 1e-12);

  task = {aim, aim, aim, Eigen::Vector2d(0.3, 0.3)};  // it does more than commanded
  Rendering rendering(device, golden_twin(), options);
  RenderingState state = rendering.start(kPosture);
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  rendering.step({.robot = robot, .gantry = task}, state, result);
  Eigen::VectorXd ddq(8);
  ddq << aim + task.unexplained, result.ddq_m;
  const Vector6 a_H = rendering.device_chain().jacobian(device.handle) * ddq;
  EXPECT_LT((a_H.head<3>() - result.a_H).norm(), 1e-9);
}

// level 0 couples, 1 to 3 are those of the device, the twin's follow
TEST(Tasks, ASolutionKeepsLimitsOfTheDeviceThatAreMetOrCompleted) {
  DeviceModel device = unlimited_device();
  device.virtual_joints = {
      {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {0.26, 2.88, 4, 40}}};
  device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 5e-3}};
  device.cartesian_limits[0].axes.fill({-1.5, 1.5, 1.5, 5.0});
  const Tasks tasks(device, golden_twin(), {});
  hqp::Solution solution(tasks.problem().capacity());
  solution.slack.assign(tasks.problem().rows(), 0.0);
  EXPECT_TRUE(tasks.keeps_limits_of_device(solution));
  const std::size_t of_hand = tasks.first_limit_row() + 6 + 1;
  solution.slack[of_hand] = -0.01;
  EXPECT_FALSE(tasks.keeps_limits_of_device(solution));
  EXPECT_TRUE(tasks.keeps_joints(solution));
  solution.completed_levels = 3;
  EXPECT_FALSE(tasks.keeps_limits_of_device(solution));
  solution.completed_levels = 4;
  EXPECT_TRUE(tasks.keeps_limits_of_device(solution));
  solution.completed_levels = 0;
  solution.slack[of_hand] = 0.0;
  solution.slack[of_hand + 3] = 1.0;  // of the twin
  EXPECT_TRUE(tasks.keeps_limits_of_device(solution));
  solution.slack[of_hand - 1 - 6] = -2e-3;  // of joint 1
  EXPECT_FALSE(tasks.keeps_joints(solution));
}

TEST(Rendering, AnOrdinarySolveIsNotKeptUnlessRequested) {
  Rendering rendering(unlimited_device(), golden_twin(), without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
  LawResult result;
  rendering.keep_problem(0);  // nothing has been solved
  rendering.step({.robot = robot, .cycle = 5}, state, result);
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
  const Eigen::MatrixXd M_inv = inverse(M);
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
      limits::JointLimits& limits = device.joint_limits[i];
      if (where > 0.4) limits.q_max = q[i];
      if (where < -0.4) limits.q_min = q[i];
    }
    Rendering rendering(device, golden_twin(), without_synchronisation());
    RenderingState state = rendering.start(q);
    Vector6 w;
    for (double& value : w) value = 20 * uniform(random);
    const RobotState robot = robot_with(kGantryAtHome, q, w);
    LawResult result;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);

    // ddq_m = J_m^-1 J_a ddq_a, everything at rest
    model::ChainData chain(device.chain);
    Eigen::VectorXd q_all(8);
    q_all << kGantryAtHome, q;
    chain.update_kinematics(q_all, Eigen::VectorXd::Zero(8));
    const Eigen::MatrixXd J_m = chain.jacobian(device.handle).rightCols(6);
    const Eigen::MatrixXd J_a = rendering.twin_chain().jacobian(rendering.twin().end_effector);
    const Eigen::MatrixXd G = inverse(J_m) * J_a;
    Eigen::VectorXd lb(6), ub(6);
    for (int i = 0; i < 6; ++i) {
      const auto& limits = device.joint_limits[i];
      lb[i] = limits.q_min == q[i] ? 0.0 : -kInfinity;
      ub[i] = limits.q_max == q[i] ? 0.0 : kInfinity;
    }
    const VectorA a_free = free_acceleration(rendering.twin_chain(), result.tau_a);
    const VectorA expected = box_qp_oracle(rendering.twin_chain().M(), a_free, G, lb, ub);
    const double scale = 1.0 + a_free.norm();
    ASSERT_LT((result.ddq_a - expected).norm(), 1e-7 * scale) << "trial " << trial;
    int active = 0;
    for (int i = 0; i < 6; ++i) {
      const LimitReport& limit = result.limits[i];
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
double budget_gap(const LawResult& result) {
  const Budget& b = result.budget;
  return (b.inertia + b.damping + b.friction + b.spring + b.surface + b.limits + b.conflict -
          result.tau_a)
      .norm();
}

TEST(Rendering, TheBudgetClosesAndTheBearingsCarryTheRest) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  DeviceModel device = unlimited_device();
  for (auto& limits : device.joint_limits) limits = {-10.0, 10.0, 2.0, 12.0};
  for (int trial = 0; trial < 200; ++trial) {
    TwinModel twin = door_with_closer();
    twin.dofs[0].friction = 0.5;
    Rendering rendering(device, twin, without_synchronisation());
    RenderingState state = rendering.start(kPosture);
    state.twin.q_a[0] = std::max(0.0, uniform(random));
    state.twin.q_a[1] = std::max(0.0, 0.8 * uniform(random));
    state.twin.dq_a[0] = uniform(random) * (state.twin.q_a[0] > 0.0);
    Vector6 w;
    for (double& value : w) value = 30 * uniform(random);
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    LawResult result;
    rendering.step({.robot = robot}, state, result);
    ASSERT_LT(budget_gap(result), 1e-9) << "trial " << trial;

    // the part called structure moves no joint, the rest reaches all of them
    const auto J_a = rendering.twin_chain().jacobian(rendering.twin().end_effector);
    ASSERT_LT((J_a.transpose() * result.budget.structure).norm(), 1e-9);
    const Vector6 rest = robot.w_H - result.budget.structure;
    ASSERT_LT((J_a.transpose() * rest - result.tau_a).norm(), 1e-9);
  }
}

TEST(Rendering, AtAHeldLimitTheOtherJointsMoveLikeTheReducedModel) {
  TwinModel twin = unlimited_twin(model::ChainModel::from_urdf_file(
                                      "models/twins/excavator/excavator.urdf", {.gravity = false}),
                                  "handle");
  twin.q_start << 0.2, 0.3, 0.9, 1.0;
  twin.dofs[3].limits = {0.0, 1.0, 3.0, 20.0};  // bucket, at its upper end
  Rendering rendering(unlimited_device(), twin, without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  state.twin.dq_a << 0.3, -0.2, 0.4, 0.0;
  Vector6 w;
  w << 5, 3, 4, 2, 6, -1;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  rendering.step({.robot = robot}, state, result);
  if (result.limits[9].state == LimitState::kInactive) {  // 6 device joints before the twin
    const RobotState opposite = robot_with(kGantryAtHome, kPosture, -w);
    rendering.step({.robot = opposite}, state, result);
  }
  ASSERT_EQ(result.limits[9].state, LimitState::kUpper);

  const Eigen::MatrixXd M = rendering.twin_chain().M();
  const Eigen::VectorXd c = rendering.twin_chain().c();
  const Eigen::Vector3d expected =
      LeastSquares(M.topLeftCorner<3, 3>()).solve(result.tau_a.head<3>() - c.head<3>());
  EXPECT_LT((result.ddq_a.head<3>() - expected).norm(), 1e-9);
  EXPECT_NEAR(result.ddq_a[3], 0.0, 1e-9);
  // what the limit pushes with is what the equation of the held joint lacks
  EXPECT_NEAR(result.limits[9].reaction, M.row(3).head<3>().dot(expected) + c[3] - result.tau_a[3],
              1e-9);
}

// The free body at the handle, pushed by `force` along x, while the gantry accelerates by `ddq_p`.
LawResult pushed_along_x(const DeviceModel& device, double force, double ddq_p) {
  TwinModel twin = golden_twin();
  twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
  Rendering rendering(device, twin, {});
  RenderingState state = rendering.start(kPosture);
  Vector6 w = Vector6::Zero();
  w[0] = force;
  RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  robot.ddq_p[0] = ddq_p;
  EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
  return result;
}

TEST(Rendering, ACartesianLimitHoldsTheHandWhateverTheGantryDoes) {
  DeviceModel device = unlimited_device();
  const double x = handle_pose(device, kGantryAtHome, kPosture).p.x();
  device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 0.0}};
  device.cartesian_limits[0].axes[0] = {-10.0, x, 1.5, 5.0};
  for (const double ddq_p : {0.0, 2.0, -2.0}) {
    const LawResult held = pushed_along_x(device, 20.0, ddq_p);
    EXPECT_EQ(held.limits[6].state, LimitState::kUpper);
    EXPECT_NEAR(held.a_H.x(), 0.0, 1e-9) << ddq_p;
    EXPECT_NEAR(held.limits[6].reaction, held.w_felt[0], 1e-9);
    EXPECT_LT(held.limits[6].reaction, -1.0);
    EXPECT_GT(pushed_along_x(device, -20.0, ddq_p).a_H.x(), -100.0);
    EXPECT_LT(pushed_along_x(device, -20.0, ddq_p).a_H.x(), -1.0);
  }
}

TEST(Rendering, ReportsADeviceThatLeavesAWallWhichItsReferenceKeeps) {
  DeviceModel device = unlimited_device();
  device.virtual_joints = {
      {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {-9, 9, 4, 40}}};
  device.cartesian_limits = {{.name = "elbow", .frame = device.elbow, .axes = {}, .margin = 0.0},
                             {.name = "hand", .frame = device.handle, .axes = {}, .margin = 0.0}};
  const Eigen::Vector3d p = handle_pose(device, kGantryAtHome, kPosture).p;
  constexpr int kHand = 7 + 3;  // after the joints, their sum and the elbow
  // what is reported of the hand along `axis` with a wall `room` beyond or, negative, before it
  const auto passing = [&](int axis, double room, const VectorM& lag, const VectorM& dq,
                           const VectorP& dq_p) {
    limits::JointLimits& wall = device.cartesian_limits[1].axes[axis];
    wall = {room > 0.0 ? -10.0 : p[axis] + room, room > 0.0 ? p[axis] + room : 10.0, 1.5, 5.0};
    Rendering rendering(device, golden_twin(), without_synchronisation());
    wall = {};
    RenderingState state = rendering.start(kPosture);
    RobotState robot = robot_with(kGantryAtHome, kPosture + lag, Vector6::Zero());
    robot.dq_m = dq;
    robot.dq_p = dq_p;
    LawResult result;
    EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    for (int i = 0; i < kHand + 3; ++i) {
      EXPECT_TRUE(i == kHand + axis || result.passing[i] == 0.0) << i;
    }
    return result.passing[kHand + axis];
  };
  const VectorM still = VectorM::Zero(6);
  const VectorP at_home = VectorP::Zero(2);
  for (const int axis : {0, 1}) {
    VectorM lag = still;
    lag[0] = 0.02;
    const double moved = handle_pose(device, kGantryAtHome, kPosture + lag).p[axis] - p[axis];
    ASSERT_GT(std::abs(moved), 0.002);
    const double room = std::copysign(0.0005, moved), outside = std::abs(moved) - 0.0005;
    const double close = 0.1 * std::abs(moved);
    EXPECT_EQ(passing(axis, room, still, still, at_home), 0.0);
    EXPECT_EQ(passing(axis, room, -lag, 10.0 * lag, at_home), 0.0);
    EXPECT_NEAR(passing(axis, room, lag, still, at_home), outside, close);
    EXPECT_NEAR(passing(axis, room, lag, 10.0 * lag, at_home), outside + std::abs(moved), close);
    EXPECT_EQ(passing(axis, room, lag, -50.0 * lag, at_home), 0.0);  // on its way back
    VectorP dq_p = at_home;
    dq_p[axis] = std::copysign(0.1, moved);  // the gantry's axes are x and y
    EXPECT_NEAR(passing(axis, room, lag, still, dq_p), outside + 0.01, close);
  }
}

TEST(Rendering, AVirtualJointIsHeldAtItsEnd) {
  DeviceModel device = unlimited_device();
  const double s = kPosture[3] + kPosture[4];
  device.virtual_joints = {
      {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {s, 2.88, 4, 40}}};
  int held = 0;
  for (const double force : {20.0, -20.0}) {
    const LawResult result = pushed_along_x(device, force, 0.0);
    const double ddq_s = result.ddq_m[3] + result.ddq_m[4];
    EXPECT_GE(ddq_s, -1e-9);
    if (result.limits[6].state == LimitState::kLower) ++held;
  }
  EXPECT_EQ(held, 1);  // one way it is pushed onto its end, the other way off
}

TEST(Rendering, AGantryThatDragsJointsFromTheirLimitsBlocksTheDevice) {
  DeviceModel device = unlimited_device();
  for (int i = 0; i < 6; ++i) {
    device.joint_limits[i] = {kPosture[i], kPosture[i], 1.0, 10.0};
  }
  Rendering rendering(device, door_with_closer(), without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
  LawResult result;
  rendering.step({.robot = robot}, state, result);
  EXPECT_FALSE(rendering.is_blocked());
  // a door cannot follow in all six directions, and the hand stays on it
  robot.ddq_p[0] = 2.0;
  ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
  EXPECT_TRUE(rendering.is_blocked());
  EXPECT_LT(budget_gap(result), 1e-9);
}

TEST(Rendering, TheHandFollowsTheTwinAndTheErrorDecays) {
  const DeviceModel device = unlimited_device();
  TwinModel twin = golden_twin();
  Pose start = handle_pose(device, kGantryAtHome, kPosture);
  start.p.x() += 1e-3;
  start.R = start.R * Eigen::AngleAxisd(2e-3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  twin.q_start = floating_at(start);
  Rendering rendering(device, twin, {});
  RenderingState state = rendering.start(kPosture);
  LawResult result;
  for (int k = 0; k < 1000; ++k) {
    const RobotState robot = robot_with(kGantryAtHome, state.reference.q_m, Vector6::Zero());
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
    if (k == 0) {
      EXPECT_NEAR(result.sync_error, 1e-3, 1e-9);
      EXPECT_NEAR(result.sync_error_angle, 2e-3, 1e-9);
    }
  }
  EXPECT_LT(result.sync_error, 1e-8);
  EXPECT_LT(result.sync_error_angle, 1e-7);
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
  TwinModel twin = door_with_closer();
  twin.locks = {door_lock()};
  twin.dofs[1].friction = 0.3;
  Rendering rendering(device, twin, without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  Vector6 w;
  w << 30, -20, 10, 2, 1, 1.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  const AllocationCounter allocations;
  for (int k = 0; k < 20; ++k) {
    rendering.step(
        {.robot = robot, .braking_rate = k < 10 ? 0.0 : 20.0, .force_share = k < 10 ? 1.0 : 0.0},
        state, result);
    rendering.integrate(state);
  }
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_EQ(result.solver_status, SolverStatus::kSolved);
}

// Even joints whose motion is none of the twin's.
TEST(Rendering, SlowsDownEveryJointInAStop) {
  DeviceModel device = unlimited_device();
  for (limits::JointLimits& limits : device.joint_limits) limits.ddq_max = 20.0;
  TwinModel twin =
      unlimited_twin(model::ChainModel::free_body({.mass = 5.0}, {.gravity = false}), "handle");
  twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
  Rendering rendering(device, twin, without_synchronisation());
  RenderingState state = rendering.start(kPosture);
  state.reference.dq_m = posture({1.5, -2.0, 2.5, 1.0, -0.5, 0.0});
  LawResult result;
  for (int k = 0; k < 700; ++k) {
    const RobotState robot = robot_with(kGantryAtHome, state.reference.q_m, Vector6::Zero());
    const VectorM before = state.reference.dq_m.cwiseAbs();
    rendering.step(
        {.robot = robot, .braking_rate = 20.0, .joint_braking_rate = 20.0, .force_share = 0.0},
        state, result);
    rendering.integrate(state);
    for (int i = 0; i < 6; ++i) {
      EXPECT_LE(std::abs(state.reference.dq_m[i]), std::max(before[i], 0.02) + 1e-9) << i;
    }
  }
  EXPECT_LT(state.reference.dq_m.lpNorm<Eigen::Infinity>(), 0.03);
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
