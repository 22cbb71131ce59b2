// Limits of a twin that move, contradict each other or appear: no joint gets lost beyond them.

#include <gtest/gtest.h>

#include "hg/controller/rendering/test/playing.h"

namespace hg::rendering {
namespace {

RenderingOptions with_bounds(Law law, Bounds bounds) {
  RenderingOptions options = without_synchronisation();
  options.law = law;
  options.bounds = bounds;
  return options;
}

// The hinge stands at `q` and is pushed; the lever is pressed, which makes conditions true.
TwinModel pressed_door(double q) {
  TwinModel twin = door();
  twin.q_start << q, 0.7;
  twin.dofs[1].limits.q_min = twin.dofs[1].limits.q_max = 0.7;
  return twin;
}

std::vector<JointCondition> while_pressed() { return {{.dof = 1, .range = {0.5, kInfinity}}}; }

double worst_excess(Playing& playing, double seconds, double torque) {
  double worst = 0.0;
  for (int k = 0; k < static_cast<int>(seconds / kDt); ++k) {
    playing.step(playing.wrench_for(0, torque));
    if (testing::Test::HasFatalFailure()) return kInfinity;
    worst = std::max(worst, playing.limit(0).excess);
  }
  return worst;
}

// max(v_rec tau_rec, v_rec^2 / A) + v_rec dt, moving_limits.h, with v_rec = 0.1 / 4 and A = 6
constexpr double kSlowOverrun = 0.025 * (20e-3 + kDt) + 1e-6;
// the same with v_rec = 0.5
constexpr double kFastOverrun = 0.25 / 6.0 + 0.5 * kDt + 1e-6;

TEST(MovingLimit, WaitsForAJointWhoseCloserIsSlow) {
  TwinModel twin = pressed_door(0.8);
  twin.dofs[0].limits.q_max = 0.8;
  twin.dofs[0].closer.speed = 0.1;
  Playing playing(twin);
  ASSERT_EQ(playing.change(Parameter::kUpperLimit, 0, 0.6), ChangeStatus::kTaken);
  EXPECT_LT(worst_excess(playing, 10.0, 5.0), kSlowOverrun);
  EXPECT_NEAR(playing.q(0), 0.6, 1e-4);
}

TEST(MovingLimit, WaitsForAJointThatAConditionSlowsDown) {
  TwinModel twin = pressed_door(0.8);
  twin.dofs[0].limits.q_max = 0.8;
  twin.conditional_limits = {{.name = "narrow",
                              .dof = 0,
                              .limits = {.q_max = 0.6, .dq_max = 0.1},
                              .conditions = while_pressed()}};
  Playing playing(twin);
  EXPECT_LT(worst_excess(playing, 10.0, 5.0), kSlowOverrun);
  EXPECT_NEAR(playing.q(0), 0.6, 1e-4);
}

class LimitsOfEveryVariant : public testing::TestWithParam<std::tuple<Law, Bounds>> {
 public:
  static RenderingOptions options() {
    return with_bounds(std::get<0>(GetParam()), std::get<1>(GetParam()));
  }
};

INSTANTIATE_TEST_SUITE_P(All, LimitsOfEveryVariant,
                         testing::Combine(testing::Values(Law::kGauss, Law::kPaper),
                                          testing::Values(Bounds::kRecoverable, Bounds::kPaper)),
                         [](const auto& test) {
                           return std::string(to_string(std::get<0>(test.param))) + "_" +
                                  std::string(to_string(std::get<1>(test.param)));
                         });

TEST_P(LimitsOfEveryVariant, CarryAPushedJointBackWithItsLimit) {
  Playing playing(pressed_door(1.2), options());
  ASSERT_EQ(playing.change(Parameter::kUpperLimit, 0, 0.6), ChangeStatus::kTaken);
  EXPECT_LT(worst_excess(playing, 3.0, 5.0), kFastOverrun);
  EXPECT_NEAR(playing.q(0), 0.6, 1e-3);
  // and where the limit was in the beginning, too
  ASSERT_EQ(playing.change(Parameter::kUpperLimit, 0, 2.0), ChangeStatus::kTaken);
  playing.run(3.0, 0, 5.0);
  ASSERT_EQ(playing.change(Parameter::kUpperLimit, 0, 1.75), ChangeStatus::kTaken);
  EXPECT_LT(worst_excess(playing, 2.0, 5.0), kFastOverrun);
  EXPECT_NEAR(playing.q(0), 1.75, 1e-3);
}

TEST_P(LimitsOfEveryVariant, BrakeToASpeedLimitThatAppears) {
  TwinModel twin = pressed_door(0.2);
  twin.conditional_limits = {
      {.name = "slow", .dof = 0, .limits = {.dq_max = 0.3}, .conditions = while_pressed()}};
  twin.conditional_limits[0].conditions.push_back({.dof = 0, .range = {0.6, kInfinity}});
  Playing playing(twin, options());
  playing.state.twin.dq_a[0] = 1.0;
  playing.run(0.8, 0, 3.0);
  EXPECT_GT(playing.q(0), 0.6);
  EXPECT_LT(playing.dq(0), 0.3 + 1e-9);
}

TEST_P(LimitsOfEveryVariant, HoldALockThatEngagesAtSpeed) {
  TwinModel twin = pressed_door(0.8);
  twin.locks = {{.name = "bolt", .dof = 0, .position = 0.5, .engaged_while = while_pressed()}};
  Playing playing(twin, options());
  playing.state.twin.dq_a[0] = 0.3;
  playing.run(0.3, 0, 3.0);
  if (options().bounds == Bounds::kPaper) {
    // [HG] (31): at rest after the way of braking, whatever pushes
    EXPECT_NEAR(playing.q(0), 0.8 + 0.5 * 0.3 * 0.3 / twin.dofs[0].limits.ddq_max, 1e-9);
    EXPECT_EQ(playing.limit(0).cause, LimitCause::kLock);
    return;
  }
  // back from the way of braking; a latch follows a joint that comes back too fast to stop there
  EXPECT_LT(playing.q(0), 0.8 + 1e-3);
  EXPECT_GT(playing.q(0), 0.8 - 0.02);
  EXPECT_EQ(playing.limit(0).cause, LimitCause::kLatch);
}

TEST_P(LimitsOfEveryVariant, LetALockWinThatIsOutsideAChangedRange) {
  const bool stops_in_place = options().bounds == Bounds::kPaper;
  TwinModel twin = pressed_door(0.8);
  twin.locks = {{.name = "bolt", .dof = 0, .position = 0.5, .engaged_while = while_pressed()}};
  Playing playing(twin, options());
  ASSERT_EQ(playing.change(Parameter::kUpperLimit, 0, 0.3), ChangeStatus::kTaken);
  bool is_reported = false;
  for (int k = 0; k < 4000; ++k) {
    playing.step(playing.wrench_for(0, 2.0));
    ASSERT_GE(playing.limit(0).to_lower + playing.limit(0).to_upper, 0.0) << k;
    is_reported = is_reported || playing.limit(0).cause == LimitCause::kContradiction;
  }
  const double held_at = stops_in_place ? 0.8 : 0.5;
  EXPECT_NEAR(playing.q(0), held_at, 2.0 * kLockReached);
  EXPECT_EQ(is_reported, !stops_in_place);
  EXPECT_EQ(playing.limit(0).cause, LimitCause::kLock);
  EXPECT_NEAR(playing.limit(0).excess, held_at - 0.3, 1e-3);  // of the requested range
}

TEST_P(LimitsOfEveryVariant, HoldAJointBetweenCrossedLimitsAndReportIt) {
  TwinModel twin = pressed_door(0.8);
  twin.conditional_limits = {
      {.name = "low", .dof = 0, .limits = {.q_max = 0.4}, .conditions = while_pressed()},
      {.name = "high", .dof = 0, .limits = {.q_min = 0.8}, .conditions = while_pressed()}};
  Playing playing(twin, options());
  playing.run(3.0, 0, 3.0);
  EXPECT_NEAR(playing.q(0), 0.6, 1e-3);
  EXPECT_EQ(playing.limit(0).cause, LimitCause::kContradiction);
}

TEST(Closer, MeasuresFromTheLowerLimitThatHoldsNow) {
  TwinModel twin = pressed_door(1.0);
  twin.dofs[0].closer = {.torque = 3.0, .stiffness = 4.0};
  Playing playing(twin);
  EXPECT_EQ(playing.change(Parameter::kLowerLimit, 0, -kInfinity), ChangeStatus::kRefused);
  ASSERT_EQ(playing.change(Parameter::kLowerLimit, 0, 0.4), ChangeStatus::kTaken);
  playing.run(4.0, 0, 0.0);
  EXPECT_NEAR(playing.q(0), 0.4, 1e-4);
  EXPECT_NEAR(playing.result.budget.spring[0], 3.0, 1e-3);
}

TEST(Stopping, IgnoresFriction) {
  TwinModel twin = pressed_door(0.8);
  twin.dofs[0].friction = 4.0;
  Playing playing(twin);
  playing.run(0.01, 0, 1.0);
  ASSERT_EQ(playing.limit(0).cause, LimitCause::kFriction);
  playing.state.twin.dq_a[0] = 0.1;
  const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
  playing.rendering.step({.robot = robot, .braking_rate = 20.0, .force_share = 0.0}, playing.state,
                         playing.result);
  EXPECT_EQ(playing.result.budget.friction[0], 0.0);
  EXPECT_NEAR(playing.state.twin.ddq_a[0], -2.0, 1e-6);
  EXPECT_NE(playing.limit(0).cause, LimitCause::kFriction);
}

// --- a twin of 30 joints in the hand of a device -----------------------------------------------

TEST(LargeTwin, OfThirtyJointsWithLimitsStaysSolvedInsideAndAttached) {
  DeviceModel device = unlimited_device();
  for (limits::JointLimits& joint : device.joint_limits) joint = {-10.0, 10.0, 8.0, 400.0};
  model::ChainOptions placed = {.gravity = false};
  const model::ChainModel at_origin =
      model::ChainModel::from_urdf_text(snake(30, 1.0), "snake.urdf", placed);
  TwinModel twin = unlimited_twin(at_origin, "l30");
  ConfigurationA q_start(30);
  for (int i = 0; i < 30; ++i) q_start[i] = i % 5 == 4 ? 0.0 : 0.3 * std::sin(2.0 * i);
  model::ChainData chain(at_origin);
  chain.update_kinematics(q_start, VectorA::Zero(30));
  placed.T_B_root =
      handle_pose(device, kGantryAtHome, kPosture) * inverse(chain.pose(twin.end_effector));
  twin = unlimited_twin(model::ChainModel::from_urdf_text(snake(30, 1.0), "snake.urdf", placed),
                        "l30");
  twin.q_start = q_start;
  for (std::size_t i = 0; i < 30; ++i) {
    const double q = q_start[i];
    twin.dofs[i].limits = {q - 0.002, q + 0.002, 2.0, 20.0};
    twin.dofs[i].damping = 0.5;
  }
  Rendering rendering(device, twin, {});
  RenderingState state = rendering.start(kPosture);
  int most_at_limits = 0;
  for (int k = 0; k < 1200; ++k) {
    const double t = kDt * k;
    // a hand that jerks to and fro: many limits are met and left in one cycle
    Vector6 w;
    w << 40, -30, 30, 3, -3, 2;
    for (int i = 0; i < 6; ++i) w[i] *= std::sin((30.0 + 7.0 * i) * t) > 0.0 ? 4.0 : -4.0;
    if (k % 20 == 0) state.active_set = {};  // the solver starts without the cycle before
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    LawResult result;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved) << k;
    ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-8) << k;
    ASSERT_LT(result.sync_error, 1e-4) << k;
    int at_limits = 0;
    for (int i = 0; i < 30; ++i) {
      const LimitReport& limit = result.limits[kFirstTwinLimit + i];
      ASSERT_LT(limit.excess, 1e-6) << k << " " << i;
      at_limits += limit.state != LimitState::kInactive;
    }
    most_at_limits = std::max(most_at_limits, at_limits);
    rendering.integrate(state);
  }
  EXPECT_GE(most_at_limits, 8);
}

}  // namespace
}  // namespace hg::rendering
