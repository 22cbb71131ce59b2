/// Law paper beside law gauss, and both kinds of bounds.

#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <random>
#include <sstream>

#include "hg/controller/rendering/test/playing.h"
#include "hg/controller/rendering/test/test_models.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"

namespace hg::rendering {
namespace {

RenderingOptions with(Law law, Bounds bounds) {
  RenderingOptions options = without_synchronisation();
  options.law = law;
  options.bounds = bounds;
  return options;
}

// Steps law paper on the same state until the active limits are those of the cycle before.
LawResult settled(Rendering& rendering, RenderingState state, const RobotState& robot) {
  LawResult result;
  for (int k = 0; k < 10; ++k) {
    const TouchedEnds before = state.touched;
    EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    if (state.touched.lower == before.lower && state.touched.upper == before.upper) return result;
  }
  ADD_FAILURE() << "the active limits do not settle";
  return result;
}

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double number() { return uniform_(random_); }  ///< -1..1
  int below(int count) { return static_cast<int>(0.5 * (1.0 + number()) * count) % count; }
  template <typename V>
  void fill(V& v, double largest) {
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = largest * number();
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

TwinModel random_twin(Random& random) {
  switch (random.below(3)) {
    case 0:
      return unlimited_twin(model::ChainModel::free_body({}, {.gravity = false}), "handle");
    case 1:
      return unlimited_twin(
          model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
          "handle");
    default: {
      TwinModel twin =
          unlimited_twin(model::ChainModel::from_urdf_file("models/twins/excavator/excavator.urdf",
                                                           {.gravity = false}),
                         "handle");
      twin.q_start << 0.2, 0.3, 0.9, 1.0;
      return twin;
    }
  }
}

// Puts one limit where device or twin are; its lower or its upper end.
void add_one_limit(Random& random, const RenderingState& state, DeviceModel& device,
                   TwinModel& twin) {
  limits::JointLimits limits{-20.0, 20.0, 5.0, 100.0};
  const auto end_at = [&](double q) { (random.number() > 0 ? limits.q_max : limits.q_min) = q; };
  const int kind = random.below(4);
  if (kind == 0) {
    const int i = random.below(6);
    end_at(state.reference.q_m[i]);
    device.joint_limits[i] = limits;
  } else if (kind == 1) {
    end_at(state.reference.q_m[3] + state.reference.q_m[4]);
    device.virtual_joints = {
        {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = limits}};
  } else if (kind == 2) {
    const std::size_t axis = random.below(3);
    end_at(handle_pose(device, kGantryAtHome, state.reference.q_m).p[static_cast<int>(axis)]);
    device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 0.0}};
    device.cartesian_limits[0].axes[axis] = limits;
  } else {
    const int i = random.below(twin.chain.nv());
    TwinDof& dof = twin.dofs[i];
    if (dof.q_index < 0) return;
    end_at(state.twin.q_a[dof.q_index]);
    dof.limits = limits;
  }
}

int active_limits(const LawResult& result) {
  int active = 0;
  for (const LimitReport& limit : result.limits) active += limit.state != LimitState::kInactive;
  return active;
}

TEST(Laws, AgreeWhileAtMostOneLimitActs) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  int with_a_limit = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    DeviceModel device = unlimited_device();
    TwinModel twin = random_twin(random);
    const VectorM q_m =
        posture({3 * random.number(), 1.5 + 0.8 * random.number(), random.number(),
                 1.3 + 0.6 * random.number(), 0.2 + 0.3 * random.number(), random.number()});
    RenderingState state;
    state.reference.q_m = q_m;
    state.twin.q_a = twin.q_start;
    add_one_limit(random, state, device, twin);

    const Bounds bounds = random.number() > 0 ? Bounds::kRecoverable : Bounds::kPaper;
    Rendering gauss(device, twin, with(Law::kGauss, bounds));
    Rendering paper(device, twin, with(Law::kPaper, bounds));
    state = gauss.start(q_m);
    random.fill(state.reference.dq_m, 0.1);
    random.fill(state.twin.dq_a, 0.1);
    Vector6 w;
    random.fill(w, 20.0);
    const RobotState robot = robot_with(kGantryAtHome, q_m, w);

    const LawResult expected = settled(gauss, state, robot);
    const LawResult result = settled(paper, state, robot);
    const int active = active_limits(expected);
    ASSERT_LE(active, 1);
    with_a_limit += active;
    const double scale = 1.0 + std::max(expected.ddq_a.norm(), expected.ddq_m.norm());
    ASSERT_LT((result.ddq_a - expected.ddq_a).norm(), 1e-9 * scale);
    ASSERT_LT((result.ddq_m - expected.ddq_m).norm(), 1e-9 * scale);
    for (int i = 0; i < expected.limit_count; ++i) {
      ASSERT_NEAR(result.limits[i].reaction, expected.limits[i].reaction, 1e-6) << i;
    }
  }
  EXPECT_GT(with_a_limit, 100);
}

// Two links, folded, with M^-1 = [[1, .8], [.8, 1]] at q = 0.
TwinModel two_coupled_joints() {
  const double length = std::sqrt(9.5), com = 5.0 / length;
  const double I2 = 1.0 / 0.36 - com * com;
  std::ostringstream urdf;
  const auto inertial = [](double x, double inertia) {
    std::ostringstream text;
    text << std::setprecision(17) << "<inertial><origin xyz='" << x
         << " 0 0'/><mass value='1'/><inertia ixx='" << inertia << "' iyy='" << inertia << "' izz='"
         << inertia << "' ixy='0' ixz='0' iyz='0'/></inertial>";
    return text.str();
  };
  urdf << std::setprecision(17) << "<robot name='folded'><link name='base'/><link name='first'>"
       << inertial(0.0, 0.5) << "</link><link name='handle'>" << inertial(-com, I2)
       << "</link><joint name='a1' type='continuous'><parent link='base'/><child link='first'/>"
       << "<axis xyz='0 0 1'/></joint><joint name='a2' type='continuous'><parent link='first'/>"
       << "<child link='handle'/><origin xyz='" << length
       << " 0 0'/><axis xyz='0 0 1'/></joint></robot>";
  return unlimited_twin(
      model::ChainModel::from_urdf_text(urdf.str(), "folded.urdf", {.gravity = false}), "handle");
}

// docs/concepts/law.md: with a_free = 0 and a <= (-1, -0.9), Gauss leaves the second row alone:
// pushing the first joint takes the second one along by 0.8. Law paper, once both limits have been
// touched, minimises |alpha| and pushes with the second one, too, although nothing touches it.
TEST(Laws, DifferWithTwoCoupledLimits) {
  TwinModel twin = two_coupled_joints();
  for (TwinDof& dof : twin.dofs) dof.limits.dq_max = 1.0;
  for (const Law law : {Law::kGauss, Law::kPaper}) {
    const RenderingOptions options = with(law, Bounds::kRecoverable);
    Rendering rendering(unlimited_device(), twin, options);
    RenderingState state = rendering.start(kPosture);
    state.twin.dq_a << 1.0 + 1.0e-3, 1.0 + 0.9e-3;
    int changes = 0;
    for (int cycle = 0; cycle < 12; ++cycle) {
      const TouchedEnds before = state.touched;
      const bool both_touched = before.upper[6] && before.upper[7];
      const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
      LawResult result;
      ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
      changes += state.touched.upper != before.upper;
      if (law == Law::kPaper && !both_touched) continue;
      EXPECT_NEAR(result.ddq_a[0], -1.0, 1e-9);
      EXPECT_NEAR(result.ddq_a[1], law == Law::kGauss ? -0.9 : -1.6 / 1.64, 1e-9);
    }
    const Eigen::Matrix2d M_inverse = inverse(rendering.twin_chain().M());
    ASSERT_NEAR(M_inverse(0, 1), 0.8, 1e-9);
    ASSERT_NEAR(M_inverse(1, 1), 1.0, 1e-9);
    if (law == Law::kGauss) {
      EXPECT_EQ(changes, 0);
    } else {
      EXPECT_GT(changes, 6);  // its flags never settle
    }
  }
}

// A door with a hinge limit on a device that has limits of its own.
struct Crowded {
  DeviceModel device = unlimited_device();
  TwinModel twin = unlimited_twin(
      model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
      "handle");

  Crowded() {
    for (auto& limits : device.joint_limits) limits = {-10.0, 10.0, 2.0, 12.0};
    device.joint_limits[5].q_max = 2.1;
    device.virtual_joints = {
        {.name = "q4+q5", .weights = posture({0, 0, 0, 1, 1, 0}), .limits = {1.5, 2.88, 4, 40}}};
    const Eigen::Vector3d p = handle_pose(device, kGantryAtHome, kPosture).p;
    device.cartesian_limits = {{.name = "hand", .frame = device.handle, .axes = {}, .margin = 0.0}};
    for (int i = 0; i < 3; ++i) {
      device.cartesian_limits[0].axes[i] = {p[i] - 1.0, p[i], 1.5, 5.0};
    }
    twin.dofs[0].limits = {0.0, 1.75, 1.2, 25.0};
    twin.dofs[1].limits = {0.0, 0.80, 6.0, 200.0};
    twin.dofs[0].friction = 0.5;
    twin.locks = {{.name = "bolt",
                   .dof = 0,
                   .position = 0.0,
                   .engaged_while = {{.dof = 1, .range = {-kInfinity, 0.5}}}}};
  }
};

class EveryVariant : public testing::TestWithParam<std::tuple<Law, Bounds>> {
 protected:
  RenderingOptions options() const {
    return with(std::get<0>(GetParam()), std::get<1>(GetParam()));
  }
};

INSTANTIATE_TEST_SUITE_P(, EveryVariant,
                         testing::Combine(testing::Values(Law::kGauss, Law::kPaper),
                                          testing::Values(Bounds::kRecoverable, Bounds::kPaper)),
                         [](const auto& test) {
                           return std::string(to_string(std::get<0>(test.param))) + "_" +
                                  std::string(to_string(std::get<1>(test.param)));
                         });

TEST_P(EveryVariant, ClosesTheBudgetWithoutAllocation) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  const Crowded crowded;
  Rendering rendering(crowded.device, crowded.twin, options());
  RenderingState state = rendering.start(kPosture);
  std::uint64_t allocations = 0;
  for (int k = 0; k < 200; ++k) {
    state.twin.q_a[0] = k % 2 == 0 ? 0.0 : 0.4;
    state.twin.q_a[1] = 0.4 + 0.3 * random.number();
    random.fill(state.twin.dq_a, 0.2);
    Vector6 w;
    random.fill(w, 30.0);
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    LawResult result;
    const AllocationCounter counter;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    allocations += counter.count();
    const Budget& b = result.budget;
    const VectorA rest = b.inertia + b.damping + b.friction + b.spring + b.surface + b.limits +
                         b.conflict - result.tau_a;
    ASSERT_LT(rest.norm(), 1e-8 * (1.0 + b.limits.norm() + b.conflict.norm())) << k;
  }
  EXPECT_EQ(allocations, 0u);
}

// Plays a door on its own, with a torque on the hinge.
class Door {
 public:
  Door(const RenderingOptions& options, double friction, bool has_bolt)
      : rendering_(unlimited_device(), twin(friction, has_bolt), options),
        state_(rendering_.start(kPosture)) {}

  void run(double seconds, double torque) {
    for (int k = 0; k < static_cast<int>(1000 * seconds); ++k) {
      state_.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
      model::ChainData chain(rendering_.twin().chain);
      chain.update_kinematics(state_.twin.q_a, state_.twin.dq_a);
      const Eigen::MatrixXd J_T = chain.jacobian(rendering_.twin().end_effector).transpose();
      const Eigen::VectorXd tau = torque * Eigen::Vector2d::UnitX();
      const Vector6 w = J_T.completeOrthogonalDecomposition().solve(tau);
      const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
      ASSERT_EQ(rendering_.step({.robot = robot}, state_, result), SolverStatus::kSolved);
      rendering_.integrate(state_);
    }
  }

  double hinge() const { return state_.twin.q_a[0]; }
  double hinge_speed() const { return state_.twin.dq_a[0]; }
  double inertia() const { return rendering_.twin_chain().M()(0, 0); }
  const LimitReport& limit() const { return result.limits[6]; }
  RenderingState& state() { return state_; }

  LawResult result;

 private:
  static TwinModel twin(double friction, bool has_bolt) {
    TwinModel twin = unlimited_twin(
        model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
        "handle");
    twin.dofs[0].limits = {0.0, 1.0, 1.2, 6.0};
    twin.dofs[0].friction = friction;
    if (has_bolt) {
      twin.locks = {{.name = "bolt",
                     .dof = 0,
                     .position = 0.0,
                     .engaged_while = {{.dof = 1, .range = {-kInfinity, 0.5}}}}};
    }
    return twin;
  }

  Rendering rendering_;
  RenderingState state_;
};

TEST_P(EveryVariant, FrictionHoldsUpToItsTorqueAndSlipsBeyond) {
  Door door(options(), 4.0, false);
  door.state().twin.q_a[0] = 0.5;
  door.run(0.2, 3.9);
  EXPECT_NEAR(door.hinge(), 0.5, 1e-12);
  EXPECT_EQ(door.limit().cause, LimitCause::kFriction);
  EXPECT_NEAR(door.limit().reaction, -3.9, 1e-6);
  door.run(0.2, 5.0);
  EXPECT_NEAR(door.hinge_speed(), (5.0 - 4.0) * 0.2 / door.inertia(), 1e-3);
}

TEST_P(EveryVariant, ALockHoldsAndOpens) {
  Door door(options(), 0.0, true);
  door.run(0.2, 30.0);
  EXPECT_LT(std::abs(door.hinge()), kLockReached);
  EXPECT_EQ(door.limit().cause, LimitCause::kLock);
  EXPECT_NEAR(door.limit().reaction, -30.0, 0.1);
  door.state().twin.q_a[1] = 0.6;
  door.run(0.2, 30.0);
  EXPECT_GT(door.hinge(), 0.05);
}

TEST_P(EveryVariant, AJointComesToRestAtItsLimit) {
  Door door(options(), 0.0, false);
  door.state().twin.q_a[0] = 0.9;
  door.run(2.0, 20.0);
  EXPECT_NEAR(door.hinge(), 1.0, 1e-3);
  // bounds paper ring at a held limit, with the acceleration rating of 6 rad/s^2 for two samples
  const bool rings = options().bounds == Bounds::kPaper;
  EXPECT_NEAR(door.hinge_speed(), 0.0, rings ? 0.012 : 1e-3);
  EXPECT_EQ(door.limit().state, LimitState::kUpper);
  EXPECT_EQ(door.limit().cause, LimitCause::kPosition);
}

int limits_with_reaction(const LawResult& result) {
  return static_cast<int>(std::count_if(result.limits.begin(), result.limits.end(),
                                        [](auto& l) { return std::abs(l.reaction) > 1e-9; }));
}

// [HG] VI-C8: the flags are those of the last result. In the cycle that meets a limit no alpha is
// in its range, and all of them share what level 9 needs.
TEST(PaperLaw, SeesALimitOneCycleLater) {
  Door door(with(Law::kPaper, Bounds::kPaper), 0.0, false);
  door.state().twin.q_a[0] = 1.0;
  door.run(0.001, 20.0);
  EXPECT_GT(limits_with_reaction(door.result), 1);
  EXPECT_TRUE(door.state().touched.upper[6]);
  EXPECT_FALSE(door.state().touched.lower[6]);
  door.run(0.001, 20.0);
  EXPECT_EQ(limits_with_reaction(door.result), 1);
  EXPECT_LT(door.limit().reaction, -1.0);
}

TEST(PaperBounds, ShowTheRatingThatActs) {
  DeviceModel device = unlimited_device();
  TwinModel twin = unlimited_twin(model::ChainModel::free_body({}, {.gravity = false}), "handle");
  device.joint_limits[5] = {-10.0, 10.0, 2.0, 1.0};
  Rendering rendering(device, twin, with(Law::kGauss, Bounds::kPaper));
  RenderingState state = rendering.start(kPosture);
  Vector6 w;
  w << 30, -20, 10, 2, 1, 1.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
  LawResult result;
  rendering.step({.robot = robot}, state, result);
  EXPECT_EQ(result.limits[5].cause, LimitCause::kAcceleration);
  EXPECT_NEAR(std::abs(result.ddq_m[5]), 1.0, 1e-9);
  state.reference.dq_m[5] = std::copysign(2.0, result.ddq_m[5]);
  rendering.step({.robot = robot}, state, result);
  EXPECT_EQ(result.limits[5].cause, LimitCause::kVelocity);
  EXPECT_NEAR(result.ddq_m[5], 0.0, 1e-9);
}

// tests/reference/README.md: rows of levels 6 and 8 of a lock get clip(-dq / dt, +-ddq_max)
TEST(PaperBounds, ALockBrakesWithTheRatingOfItsJoint) {
  TwinModel twin = unlimited_twin(
      model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
      "handle");
  twin.dofs[0].limits = {0.0, 1.0, 1.2, 6.0};
  twin.locks = {{.name = "bolt", .dof = 0, .position = 0.0, .engaged_while = {}}};
  Rendering rendering(unlimited_device(), twin, with(Law::kPaper, Bounds::kPaper));
  RenderingState state = rendering.start(kPosture);
  state.twin.dq_a[0] = -0.5;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
  LawResult result;
  ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
  EXPECT_NEAR(result.ddq_a[0], 6.0, 1e-9);
  const int level_6 = 6 + 6, level_8 = level_6 + 2 + 6;  // rows before: coupling, joints, ...
  for (const int row : {level_6, level_8}) {
    EXPECT_EQ(rendering.problem().bounds(row).lb, 6.0) << row;
    EXPECT_EQ(rendering.problem().bounds(row).ub, 6.0) << row;
  }
}

// [HG] VII-C: the hinge is locked in place. The lock engages in motion, at q_0 with speed v_0, and
// brakes with clip(-dq / dt, +-ddq_max): from sample to sample the speed falls by dt ddq_max, the
// last step takes what is left, and the way is the sum of dt dq + dt^2 ddq / 2. The joint stays
// there, also when it is pushed, and is not drawn to the position of the lock.
TEST(PaperBounds, ALockThatEngagesInMotionStopsTheJointWhereItIs) {
  constexpr double kRating = 6.0, kTorque = 4.0, kStart = 0.4, kSpeed = -0.5;
  for (const Law law : {Law::kGauss, Law::kPaper}) {
    SCOPED_TRACE(to_string(law));
    Door door(with(law, Bounds::kPaper), 0.0, true);
    const double dt = 1e-3;
    door.state().twin.q_a << kStart, 0.6;  // the bolt is open
    door.state().twin.dq_a[0] = kSpeed;
    door.run(dt, 0.0);
    EXPECT_NE(door.limit().cause, LimitCause::kLock);
    door.state().twin.q_a[1] = 0.4;
    double q = door.hinge(), dq = door.hinge_speed();
    while (dq != 0.0) {
      const double ddq = std::clamp(-dq / dt, -kRating, kRating);
      door.run(dt, kTorque);
      ASSERT_NEAR(door.result.ddq_a[0], ddq, 1e-8);
      ASSERT_EQ(door.limit().cause, LimitCause::kLock);
      q += dt * dq + 0.5 * dt * dt * ddq;
      dq = std::abs(dq) <= dt * kRating ? 0.0 : dq + dt * ddq;
      ASSERT_NEAR(door.hinge(), q, 1e-9);
    }
    EXPECT_NEAR(q, kStart - 0.5 * kSpeed * kSpeed / kRating, 1e-3);
    door.run(0.3, kTorque);
    EXPECT_NEAR(door.hinge(), q, 1e-9);
    EXPECT_NEAR(door.limit().reaction, -kTorque, 1e-3);
    EXPECT_EQ(door.limit().excess, 0.0);
    door.state().twin.q_a[1] = 0.6;
    door.run(0.2, kTorque);
    EXPECT_GT(door.hinge(), q + 0.01);
  }
}

TEST(Laws, RefuseWhatTheyCannotRender) {
  const TwinModel twin =
      unlimited_twin(model::ChainModel::free_body({}, {.gravity = false}), "handle");
  RenderingOptions options;
  options.bounds = Bounds::kPaper;
  options.T_C = 0.5 * unlimited_device().dt();
  EXPECT_THROW(Rendering(unlimited_device(), twin, options), SetupError);
  DeviceModel device = unlimited_device();
  device.posture = posture({0, 0, 0});
  EXPECT_THROW(Rendering(device, twin, {}), SetupError);
}

}  // namespace
}  // namespace hg::rendering
