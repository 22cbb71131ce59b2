/// A manipulator with a joint to spare, and without a gantry.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <sstream>

#include "hg/controller/rendering/rendering.h"
#include "hg/controller/rendering/stop_path.h"
#include "hg/controller/rendering/test/test_models.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"

namespace hg::rendering {
namespace {

// seven joints as many arms have them: shoulder, elbow and wrist with offsets
std::string seven_joint_urdf() {
  struct Row {
    const char *origin, *axis;
  };
  const Row rows[] = {{"0 0 0.333", "0 0 1"},       {"0 0 0", "0 1 0"},
                      {"0 0 0.316", "0 0 1"},       {"0.0825 0 0", "0 -1 0"},
                      {"-0.0825 0 0.384", "0 0 1"}, {"0 0 0", "0 -1 0"},
                      {"0.088 0 0", "0 0 -1"}};
  std::ostringstream urdf;
  urdf << "<robot name='seven'><link name='l0'/>";
  for (int i = 0; i < 7; ++i) {
    urdf << "<link name='l" << i + 1 << "'><inertial><mass value='1'/><inertia ixx='0.01' "
         << "iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j"
         << i + 1 << "' type='continuous'><parent link='l" << i << "'/><child link='l" << i + 1
         << "'/><origin xyz='" << rows[i].origin << "'/><axis xyz='" << rows[i].axis
         << "'/></joint>";
  }
  urdf << "<link name='handle'/><joint name='grip' type='fixed'><parent link='l7'/>"
       << "<child link='handle'/><origin xyz='0 0 -0.2'/></joint></robot>";
  return urdf.str();
}

DeviceModel seven_joint_device() {
  DeviceModel device{.chain = model::ChainModel::from_urdf_text(seven_joint_urdf(), "seven.urdf"),
                     .n_p = 0,
                     .n_m = 7};
  device.handle = device.chain.frame("handle");
  device.joint_limits.assign(7, {});
  return device;
}

TwinModel free_body() {
  TwinModel twin = unlimited_twin(model::ChainModel::free_body({}, {.gravity = false}), "handle");
  for (TwinDof& dof : twin.dofs) dof.damping = 5.0;
  return twin;
}

// two degrees of freedom: more limits can act than the twin has torques, and only idle motion of
// the manipulator shows their shares separately
TwinModel door() {
  return unlimited_twin(
      model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
      "handle");
}

const VectorM kSevenJointPosture = posture({0.2, 0.5, -0.3, 1.9, 0.4, 2.2, 0.6});

RobotState robot_at(const VectorM& q_m, const Vector6& w) {
  RobotState robot;
  robot.q_m = q_m;
  robot.dq_m = VectorM::Zero(7);
  robot.q_p = robot.dq_p = robot.ddq_p = VectorP::Zero(0);
  robot.w_H = w;
  return robot;
}

Eigen::MatrixXd handle_jacobian(const DeviceModel& device, const VectorM& q) {
  model::ChainData chain(device.chain);
  chain.update_kinematics(q, VectorM::Zero(7));
  return chain.jacobian(device.handle);
}

Pose pose_of(const DeviceModel& device, const VectorM& q) {
  model::ChainData chain(device.chain);
  chain.update_kinematics(q, VectorM::Zero(7));
  return chain.pose(device.handle);
}

// The motion of the joints that leaves the handle at rest.
Eigen::VectorXd idle_motion(const DeviceModel& device, const VectorM& q) {
  return Eigen::FullPivLU<Eigen::MatrixXd>(handle_jacobian(device, q)).kernel().col(0).normalized();
}

struct Pushes {
  double idle = 0.0;     // sum along the idle motion
  double largest = 0.0;  // part of one joint
  int active = 0;        // reactions
};

// Reactions push inwards, where a joint rests on its limit.
void check_reactions(const DeviceModel& device, const VectorM& q, const LawResult& result,
                     const Eigen::VectorXd& idle, Pushes& pushes) {
  for (int i = 0; i < 7; ++i) {
    const LimitReport& limit = result.limits[i];
    const auto& limits = device.joint_limits[i];
    const double ddq = result.ddq_m[i];
    if (limits.q_max == q[i]) {
      ASSERT_LE(ddq, 1e-9);
    }
    if (limits.q_min == q[i]) {
      ASSERT_GE(ddq, -1e-9);
    }
    if (limit.state == LimitState::kUpper) {
      ASSERT_LE(limit.reaction, 1e-9);
    }
    if (limit.state == LimitState::kLower) {
      ASSERT_GE(limit.reaction, -1e-9);
    }
    if (std::abs(limit.reaction) > 1e-9) {
      ASSERT_NEAR(ddq, 0.0, 1e-9);
    }
    pushes.idle += limit.reaction * idle[i];
    pushes.largest = std::max(pushes.largest, std::abs(limit.reaction * idle[i]));
    pushes.active += std::abs(limit.reaction) > 1e-6;
  }
}

// The conditions of Karush, Kuhn and Tucker of Gauss' principle: they are sufficient.
TEST(SevenJoints, ReactionsPushInwardsAddUpAndLeaveIdleMotionAlone) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int with_two_or_more = 0, with_idle_share = 0;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    DeviceModel device = seven_joint_device();
    VectorM q = kSevenJointPosture;
    for (double& value : q) value += 0.3 * uniform(random);
    for (int i = 0; i < 7; ++i) {
      const double where = uniform(random);
      limits::JointLimits& limits = device.joint_limits[i];
      if (where > 0.3) limits.q_max = q[i];
      if (where < -0.3) limits.q_min = q[i];
    }
    Rendering rendering(device, trial % 2 == 0 ? free_body() : door(), without_synchronisation());
    RenderingState state = rendering.start(q);
    Vector6 w;
    for (double& value : w) value = 20 * uniform(random);
    const RobotState robot = robot_at(q, w);
    LawResult result;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);

    // the hand moves with the twin
    const Eigen::MatrixXd J = handle_jacobian(device, q);
    const Vector6 a_H = J * result.ddq_m;
    const int E = rendering.twin().end_effector;
    const Vector6 a_E = rendering.twin_chain().jacobian(E) * result.ddq_a;
    ASSERT_LT((a_H - a_E).norm(), 1e-9 * (1.0 + a_E.norm()));

    Pushes pushes;
    check_reactions(device, q, result, idle_motion(device, q), pushes);
    if (testing::Test::HasFatalFailure()) return;
    ASSERT_NEAR(pushes.idle, 0.0, 1e-9 * (1.0 + pushes.largest));
    with_two_or_more += pushes.active >= 2;
    with_idle_share += pushes.largest > 1e-3;

    const Budget& b = result.budget;
    const VectorA rest = b.inertia + b.damping + b.friction + b.spring + b.surface + b.limits +
                         b.conflict - result.tau_a;
    ASSERT_LT(rest.norm(), 1e-9 * (1.0 + b.limits.norm()));
    ASSERT_EQ(b.conflict.norm(), 0.0);
  }
  EXPECT_GT(with_two_or_more, 50);
  EXPECT_GT(with_idle_share, 50);
}

// Plays one second without a wrench; the handle has to stay.
void play_at_rest(Rendering& rendering, RenderingState& state, double seconds,
                  double braking_rate = 0.0) {
  const Pose start = pose_of(rendering.device(), state.reference.q_m);
  state.twin.q_a = floating_at(start);
  for (int k = 0; k < static_cast<int>(1000 * seconds); ++k) {
    const RobotState robot = robot_at(state.reference.q_m, Vector6::Zero());
    LawResult result;
    const LawInput input{.robot = robot, .braking_rate = braking_rate};
    ASSERT_EQ(rendering.step(input, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
  }
  EXPECT_LT((pose_of(rendering.device(), state.reference.q_m).p - start.p).norm(), 1e-6);
}

// A posture that idle motion reaches from kSevenJointPosture.
VectorM reachable_goal(const DeviceModel& device) {
  VectorM goal = kSevenJointPosture;
  for (int k = 0; k < 400; ++k) goal += 1e-3 * idle_motion(device, goal);
  return goal;
}

TEST(SevenJoints, TheOneToSpareGoesToItsGoalAndTheHandStays) {
  DeviceModel device = seven_joint_device();
  const VectorM goal = device.posture = reachable_goal(device);
  Rendering rendering(device, free_body(), {});
  RenderingState state = rendering.start(kSevenJointPosture);
  const double before = (goal - kSevenJointPosture).norm();
  play_at_rest(rendering, state, 3.0);
  EXPECT_GT(before, 0.1);
  EXPECT_LT((goal - state.reference.q_m).norm(), 0.1 * before);
  EXPECT_LT(state.reference.dq_m.norm(), 1e-3);
}

TEST(SevenJoints, TheOneToSpareKeepsAJointFromItsEndWhateverItsGoals) {
  DeviceModel device = seven_joint_device();
  VectorM goal = reachable_goal(device);
  Eigen::Index joint = 0;
  (goal - kSevenJointPosture).cwiseAbs().maxCoeff(&joint);
  const double side = goal[joint] > kSevenJointPosture[joint] ? 1.0 : -1.0;
  const double end = goal[joint] + 0.05 * side;  // 0.2 rad before it is short of the goal
  ASSERT_GT(std::abs(end - kSevenJointPosture[joint]), 0.2);
  limits::JointLimits& limits = device.joint_limits[joint];
  limits = {.q_min = end, .q_max = end, .dq_max = 2.0, .ddq_max = 10.0};
  (side > 0.0 ? limits.q_min : limits.q_max) -= 4.0 * side;
  goal[joint] = std::numeric_limits<double>::quiet_NaN();
  device.posture = goal;
  Rendering rendering(device, free_body(), {});
  RenderingState state = rendering.start(kSevenJointPosture);
  play_at_rest(rendering, state, 3.0);
  EXPECT_NEAR(std::abs(end - state.reference.q_m[joint]), 0.2, 2e-3);
  EXPECT_LT(state.reference.dq_m.norm(), 1e-3);
}

TEST(SevenJoints, InAStopIdleMotionComesToRestShortOfItsGoal) {
  DeviceModel device = seven_joint_device();
  const VectorM goal = device.posture = reachable_goal(device);
  Rendering rendering(device, free_body(), {});
  RenderingState state = rendering.start(kSevenJointPosture);
  play_at_rest(rendering, state, 0.2);
  EXPECT_GT(state.reference.dq_m.norm(), 0.1);
  play_at_rest(rendering, state, 0.8, 10.0);
  EXPECT_LT(state.reference.dq_m.norm(), 1e-3);
  EXPECT_GT((goal - state.reference.q_m).norm(), 0.05);
}

TEST(SevenJoints, WithoutAGoalIdleMotionComesToRest) {
  for (const bool has_empty_posture : {true, false}) {
    DeviceModel device = seven_joint_device();
    if (!has_empty_posture) {
      device.posture = VectorM::Constant(7, std::numeric_limits<double>::quiet_NaN());
    }
    Rendering rendering(device, free_body(), {});
    RenderingState state = rendering.start(kSevenJointPosture);
    state.reference.dq_m = 0.3 * idle_motion(device, kSevenJointPosture);
    play_at_rest(rendering, state, 2.0);
    EXPECT_LT(state.reference.dq_m.norm(), 1e-5);
    EXPECT_GT((state.reference.q_m - kSevenJointPosture).norm(), 0.01);
  }
}

TEST(SevenJoints, LawPaperRequiresSix) {
  RenderingOptions options;
  options.law = Law::kPaper;
  try {
    Rendering(seven_joint_device(), free_body(), options);
    FAIL() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(),
                 "device: law paper needs six manipulator joints, got 7; law gauss takes seven as "
                 "well");
  }
}

// The seven joints with motors of `torque` Nm, moving at random speeds.
struct Stopping {
  DeviceModel device = seven_joint_device();
  ReferenceState reference;
  std::vector<LimitRow> motors = std::vector<LimitRow>(7);
  VectorM known;
  std::mt19937 random{31};

  explicit Stopping(double strength) {
    for (LimitRow& motor : motors) motor.torque = {-strength, strength};
    device.joint_limits.assign(7, {.ddq_max = 10.0});
    device.actuators.assign(7, {.rotor_inertia = 0.2, .torque_max = strength});
    device.has_torque_limits = true;
    reference.q_m = kSevenJointPosture;
    reference.dq_m = reference.ddq_m = known = VectorM::Zero(7);
    for (int i = 0; i < 7; ++i) {
      reference.dq_m[i] = uniform(1.0);
      known[i] = uniform(0.5 * strength);
    }
  }

  double uniform(double most) {
    return std::uniform_real_distribution<double>(-most, most)(random);
  }

  StopPath path() const {
    StopPath path(device);
    model::ChainData now(device.chain);
    now.update(kSevenJointPosture, reference.dq_m);
    path.update(device, now, reference, motors, known);
    path.find_rest(reference);
    return path;
  }
};

TEST(StopPath, TakesAsLongAsTheSlowestJointOrMotor) {
  Stopping strong(1000.0);
  strong.reference.dq_m *= 0.1;
  strong.reference.dq_m[4] = 2.0;
  EXPECT_NEAR(strong.path().time(), 2.0 / 6.0, 0.005);
  Stopping weak(20.0);
  weak.reference.dq_m *= 0.1;
  weak.reference.dq_m[4] = 2.0;
  weak.known.setZero();
  weak.known[4] = -15.0;  // of -20: 5 Nm are left to brake with
  EXPECT_GT(weak.path().time(), 2.0 * 0.2 / 5.0);
  weak.reference.dq_m = -weak.reference.dq_m;  // gravity brakes it
  EXPECT_NEAR(weak.path().time(), 2.0 / 6.0, 0.05);
}

TEST(StopPath, RowIsTheChangeOfThePlaceAtRest) {
  constexpr double kStep = 1e-6;  // s
  for (const double strength : {1000.0, 12.0}) {
    Stopping stopping(strength);
    const int handle = stopping.device.handle;
    const StopPath path = stopping.path();
    VectorM ddq(7);
    for (double& value : ddq) value = stopping.uniform(10.0);
    Stopping later = stopping;
    later.reference.q_m += kStep * stopping.reference.dq_m;
    later.reference.dq_m += kStep * ddq;
    const Eigen::Vector3d change = (later.path().place(handle) - path.place(handle)) / kStep;
    for (int axis = 0; axis < 3; ++axis) {
      VectorM row(7);
      const double x = path.place(handle)[axis];
      const Interval bound = path.bound(handle, axis, {x, x}, stopping.reference,
                                        {row.data(), static_cast<std::size_t>(row.size())});
      // at the end itself nothing is left: what changes the place by nothing is the bound
      EXPECT_NEAR(bound.lb, bound.ub, 1e-9);
      EXPECT_NEAR(change[axis], path.reach() * (row.dot(ddq) - bound.ub), 1e-4) << strength;
    }
  }
}

TEST(StopPath, AllocatesNothing) {
  const Stopping stopping(12.0);
  StopPath path = stopping.path();
  model::ChainData now(stopping.device.chain);
  now.update(kSevenJointPosture, stopping.reference.dq_m);
  VectorM row(7);
  const AllocationCounter allocations;
  path.update(stopping.device, now, stopping.reference, stopping.motors, stopping.known);
  path.find_rest(stopping.reference);
  path.bound(stopping.device.handle, 0, {-1.0, 1.0}, stopping.reference,
             {row.data(), static_cast<std::size_t>(row.size())});
  EXPECT_EQ(allocations.count(), 0U);
}

// Braking in one proportion leaves the place at rest where it is, up to the reaction time in which
// it is not yet possible: all rows can be met at once.
TEST(StopPath, BrakingInOneProportionMeetsAllBounds) {
  for (const double strength : {1000.0, 12.0}) {
    Stopping stopping(strength);
    const StopPath path = stopping.path();
    const VectorM braking = -stopping.reference.dq_m / path.time();
    for (int axis = 0; axis < 3; ++axis) {
      VectorM row(7);
      const double x = path.place(stopping.device.handle)[axis];
      for (const Interval& range : {Interval{.lb = x}, Interval{.ub = x}}) {
        const double outward = std::isfinite(range.ub) ? 1.0 : -1.0;
        const Interval bound = path.bound(stopping.device.handle, axis, range, stopping.reference,
                                          {row.data(), static_cast<std::size_t>(row.size())});
        const double moving = outward * (row.dot(braking) - (outward > 0.0 ? bound.ub : bound.lb));
        const double speed = outward * (row.dot(stopping.reference.dq_m));
        if (speed > 0.0) {
          EXPECT_LT(moving, 1e-9) << strength << " axis " << axis;
        }
      }
    }
  }
}

}  // namespace
}  // namespace hg::rendering
