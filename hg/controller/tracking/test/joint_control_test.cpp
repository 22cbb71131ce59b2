#include "hg/controller/tracking/joint_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hg/controller/tracking/test/control_setup.h"
#include "hg/core/error.h"

namespace hg::tracking {
namespace {

constexpr double kDigits = 1e-5;  // [HANDBOOK] 1.4 gives five decimals

struct Answer {
  CommandFrame command;
  TrackingReport report;
};

Answer answer(JointControl& control, ControlState& state, const ReferenceState& reference,
              const RobotState& robot) {
  Answer result;
  control.step(reference, reference, robot, state, result.command, result.report);
  return result;
}

Answer first_answer(const ControlledArm& config, const ReferenceState& reference,
                    const RobotState& robot) {
  JointControl control = control_of(config);
  ControlState state = control.start();
  return answer(control, state, reference, robot);
}

double largest(const VectorM& v) { return v.lpNorm<Eigen::Infinity>(); }

class BothMethods : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Torque, BothMethods, ::testing::Values(Method::kModal, Method::kMotorPd),
                         [](const auto& test) {
                           return test.param == Method::kModal ? "Modal" : "MotorPd";
                         });

TEST_P(BothMethods, AtRestTheMotorsCarryTheWeightAndTheSpringsAreTwistedByIt) {
  const VectorM weight = joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0);  // [HANDBOOK] 1.4
  const ReferenceState reference = at_rest(home());
  const Answer held =
      first_answer(reference_config(GetParam()), reference, following(reference, weight));
  // an error of the digits twists the springs of m1 by 1e-5 / K, which the feedback answers
  EXPECT_LT(largest(held.command.tau_m - weight), 20.0 * kDigits);

  // without the twist the feedback of the motors pulls it up
  RobotState robot = following(reference, weight);
  robot.theta_m = reference.q_m;
  const Answer untwisted = first_answer(reference_config(GetParam()), reference, robot);
  EXPECT_GT(untwisted.command.tau_m[3] - weight[3], 10.0);
}

// [HANDBOOK] 1.4: all at once, weight, inertia, Coriolis forces, gantry and user
TEST_P(BothMethods, InMotionTheFeedforwardIsTheInverseDynamicsOfTheHandbook) {
  const ReferenceState reference = {.q_m = joints(0.4, 1.2, -0.5, 1.1, 0.3, -0.7),
                                    .dq_m = joints(0.5, -0.6, 0.7, 0.8, -0.9, 1.0),
                                    .ddq_m = joints(-0.3, 0.4, -0.5, 0.6, -0.7, 0.8)};
  struct Golden {
    Vector6 w_H;
    VectorM tau;
  };
  const Golden free = {Vector6::Zero(),
                       joints(0.24974, -0.38784, -0.02738, 28.11989, 2.15888, 0.00097)};
  const Golden pulled = {(Vector6() << 10.0, -20.0, 30.0, 1.0, 2.0, -3.0).finished(),
                         joints(12.52455, 0.05981, -5.8856, 10.52451, -1.67575, 1.69455)};
  for (const Golden& golden : {free, pulled}) {
    RobotState robot = following(reference, golden.tau);
    robot.q_p << 0.3, -0.2;
    robot.dq_p << 0.2, -0.1;
    robot.ddq_p << 0.1, 0.2;
    robot.w_H = golden.w_H;
    const Answer moved = first_answer(frictionless_config(GetParam()), reference, robot);
    const VectorM expected = golden.tau + rotor_inertia().cwiseProduct(reference.ddq_m);
    EXPECT_LT(largest(moved.command.tau_m - expected), 20.0 * kDigits);
    EXPECT_LT(largest(moved.report.error), 1e-15);
  }
}

TEST_P(BothMethods, UnexplainedTorqueIsReportedAsAMovingMean) {
  const VectorM weight = joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0);
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, weight);
  robot.tau_m = weight + joints(0.0, 0.0, -3.0, 5.0, 0.0, 0.0);
  JointControl control = control_of(reference_config(GetParam()));
  ControlState state = control.start();
  TrackingReport report;
  for (int k = 0; k <= 100; ++k) report = answer(control, state, reference, robot).report;
  EXPECT_NEAR(report.torque_unexplained[3], 5.0 * (1.0 - std::exp(-1.0)), 0.05);
  for (int k = 0; k < 2000; ++k) report = answer(control, state, reference, robot).report;
  EXPECT_LT(largest(report.torque_unexplained - joints(0.0, 0.0, -3.0, 5.0, 0.0, 0.0)), 1e-3);
}

TEST_P(BothMethods, OnTheWayTheSpringsAreTwistedAheadOfTheTorqueTheyWillCarry) {
  // a force of the user that grows with 100 N/s: theta_r' = tau_r' / K
  ControlledArm config = frictionless_config(GetParam());
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  for (int k = 0; k < 300; ++k) {
    robot.w_H[2] = 0.1 * k;
    answer(control, state, reference, robot);
  }
  model::ChainData chain(arm());
  chain.update(posture(home()), Eigen::VectorXd::Zero(8));
  Eigen::Matrix<double, 6, 8> J = chain.jacobian(chain.model().frame("handle"));
  const VectorM dtau = -100.0 * J.rightCols(6).row(2).transpose();
  EXPECT_LT(largest(state.dtau_r - dtau), 1e-6 * largest(dtau));
}

// The torques fed forward for a wrench of the user that grows with 100 `direction` per second.
VectorM fed_for_growing(const ControlledArm& config, const Vector6& direction) {
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  for (int k = 0; k < 300; ++k) {
    robot.w_H = 0.1 * k * direction;
    answer(control, state, reference, robot);
  }
  return state.tau_r;
}

TEST(ModalControl, AForceThatGrowsIsFedForwardAsItWillBe) {
  ControlledArm config = frictionless_config();
  const VectorM late = fed_for_growing(config, Vector6::Unit(1));
  config.wrench_lead = 4e-3;
  const VectorM early = fed_for_growing(config, Vector6::Unit(1));
  model::ChainData chain(arm());
  chain.update(posture(home()), Eigen::VectorXd::Zero(8));
  const Eigen::Matrix<double, 6, 8> J = chain.jacobian(chain.model().frame("handle"));
  const VectorM in_4_ms = -0.4 * J.rightCols(6).row(1).transpose();
  // along y the weak modes carry nearly everything
  EXPECT_LT(largest(early - late - in_4_ms), 0.05 * largest(in_4_ms));
}

// who holds the handle when the drives come on is no force that grows
TEST(ModalControl, AForceThatWasThereBeforeIsNotLed) {
  ControlledArm config = frictionless_config();
  config.wrench_lead = 4e-3;
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  robot.w_H[1] = 50.0;
  answer(control, state, reference, robot);
  const VectorM at_once = state.tau_r;
  for (int k = 0; k < 300; ++k) answer(control, state, reference, robot);
  EXPECT_LT(largest(state.tau_r - at_once), 1e-6);
  EXPECT_EQ(state.dw_H, Vector6::Zero());
}

// A torque about the axis of m6 bends a stiff mode alone.
TEST(ModalControl, StiffModesGetTheWrenchWithoutLead) {
  model::ChainData chain(arm());
  chain.update(posture(home()), Eigen::VectorXd::Zero(8));
  const Eigen::Matrix<double, 6, 8> J = chain.jacobian(chain.model().frame("handle"));
  Vector6 torque = Vector6::Zero();
  torque.tail<3>() = J.col(7).tail<3>();
  ControlledArm config = frictionless_config();
  const VectorM late = fed_for_growing(config, torque);
  config.wrench_lead = 4e-3;
  const VectorM early = fed_for_growing(config, torque);
  EXPECT_LT(std::abs(early[5] - late[5]), 0.05 * 0.4);  // of 0.4 Nm in 4 ms
}

// rms of the feedforward of a joint whose reference shakes with 60 Hz and 10 rad/s^2
double fed_for_shaking(const ControlledArm& config, int joint) {
  JointControl control = control_of(config);
  ControlState state = control.start();
  ReferenceState reference = at_rest(home());
  const RobotState robot = following(reference, VectorM::Zero(6));
  double sum = 0.0;
  for (int k = 0; k < 400; ++k) {
    reference.ddq_m[joint] = 10.0 * std::sin(2.0 * std::numbers::pi * 60.0 * 1e-3 * k);
    const double before = state.tau_r[joint];
    answer(control, state, reference, robot);
    if (k >= 200) sum += std::pow(state.tau_r[joint] - before, 2);
  }
  return std::sqrt(sum);
}

TEST(ModalControl, WhatIsFedForwardToStiffModesIsLowPassedAndToSoftOnesNot) {
  const ControlledArm plain = frictionless_config();
  ControlledArm config = plain;
  config.stiff_low_pass_Hz = 20.0;
  EXPECT_LT(fed_for_shaking(config, 5), 0.5 * fed_for_shaking(plain, 5));
  EXPECT_GT(fed_for_shaking(config, 0), 0.9 * fed_for_shaking(plain, 0));
}

TEST_P(BothMethods, NoTorqueIsBeyondWhatTheMotorGivesAtItsSpeed) {
  const ReferenceState reference = at_rest(home());
  const ControlledArm config = reference_config(GetParam());
  for (const double side : {-1.0, 1.0}) {
    RobotState robot = following(reference, VectorM::Zero(6));
    robot.theta_m.array() -= 0.5 * side;  // far behind
    robot.q_m = robot.theta_m;
    const Answer standing = first_answer(config, reference, robot);
    robot.dtheta_m.setConstant(side * 3.0);  // m1: half of the way to no load
    robot.theta_m[0] -= 2.0 * side;
    const Answer running = first_answer(config, reference, robot);
    robot.dtheta_m.setConstant(side * -3.0);  // brakes: all the torque
    const Answer braking = first_answer(config, reference, robot);
    EXPECT_DOUBLE_EQ(standing.command.tau_m[0], side * 176.0);
    EXPECT_DOUBLE_EQ(running.command.tau_m[0], side * 88.0);
    EXPECT_DOUBLE_EQ(braking.command.tau_m[0], side * 176.0);
    EXPECT_GT(standing.report.torque_share[0], 1.0);  // as demanded
    for (int i = 0; i < 6; ++i) {
      const double peak = config.actuators[i].torque_max;
      EXPECT_LE(std::abs(standing.command.tau_m[i]), peak);
      EXPECT_LE(std::abs(braking.command.tau_m[i]), peak);
    }
  }
}

TEST(ModalControl, TheIntegralStopsAtItsBound) {
  const ControlledArm config = reference_config();
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
  robot.q_m[5] -= 2e-3;  // far from saturation, and stays like that
  for (int k = 0; k < 20'000; ++k) answer(control, state, reference, robot);
  EXPECT_EQ(state.integral[5], config.integral_max);
}

TEST(ModalControl, TheIntegralWaitsWhileAMotorIsSaturated) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
  robot.q_m.array() -= 0.5;
  answer(control, state, reference, robot);  // reports the saturation
  ASSERT_TRUE(state.is_saturated);
  const VectorM integral = state.integral;
  for (int k = 0; k < 1000; ++k) answer(control, state, reference, robot);
  EXPECT_EQ(state.integral, integral);
}

// after a joint was held back for long: nothing may keep what was gathered
TEST(ModalControl, AFullIntegralSaturatesNoMotorAndUnwinds) {
  const ControlledArm config = reference_config();
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
  answer(control, state, reference, robot);
  state.integral.setConstant(config.integral_max);
  answer(control, state, reference, robot);
  EXPECT_FALSE(state.is_saturated);
  robot.q_m.array() += 1e-3;  // they are beyond the reference now
  const int periods = static_cast<int>(config.integral_max / (1e-3 / config.rate_Hz));
  for (int k = 0; k < periods + 10; ++k) answer(control, state, reference, robot);
  EXPECT_LT(state.integral.maxCoeff(), 0.0);
}

TEST(ModalControl, EvenASaturatedIntegralUnwinds) {
  ControlledArm config = reference_config();
  config.integral_max = 1.0;
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
  answer(control, state, reference, robot);
  state.integral.setConstant(3e-3);
  answer(control, state, reference, robot);
  ASSERT_TRUE(state.is_saturated);
  robot.q_m.array() += 1e-3;
  for (int k = 0; k < 3100; ++k) answer(control, state, reference, robot);
  EXPECT_LT(state.integral.maxCoeff(), 0.0);
}

TEST(ModalControl, AConstantErrorOfALinkIsAnsweredMoreAndMore) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
  robot.q_m[3] -= 1e-4;
  robot.theta_m[3] -= 1e-4;
  const double first = answer(control, state, reference, robot).command.tau_m[3];
  double last = first;
  for (int k = 0; k < 1000; ++k) last = answer(control, state, reference, robot).command.tau_m[3];
  // wi t = 2 after a second: three times what the error alone is worth
  const double proportional = first - 30.67587;
  EXPECT_GT(proportional, 0.1);
  EXPECT_NEAR((last - first) / proportional, 2.0, 0.05);
}

TEST_P(BothMethods, FrictionIsFedForwardWithTheDirectionOfTheReference) {
  const ControlledArm config = reference_config(GetParam()),
                      smooth = frictionless_config(GetParam());
  for (const double speed : {-0.3, -2e-3, 2e-3, 0.3}) {
    SCOPED_TRACE(speed);
    ReferenceState reference = at_rest(home());
    reference.dq_m[0] = speed;
    const RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
    const VectorM friction = first_answer(config, reference, robot).command.tau_m -
                             first_answer(smooth, reference, robot).command.tau_m;
    // Coulomb 4 Nm, of which 0.8; stiction adds 20 % that vanish over 0.05 rad/s; viscous 3
    const double stiction = 1.0 + 0.2 * std::exp(-std::pow(speed / 0.05, 2));
    const double load = 0.06 * std::abs(first_answer(smooth, reference, robot).command.tau_m[0]);
    const double expected = 0.8 * (4.0 + load) * stiction * std::tanh(speed / 0.01) + 3.0 * speed;
    EXPECT_NEAR(friction[0], expected, 0.02);
    EXPECT_LT(largest(friction.tail(5)), 1e-12);  // they stand
  }
}

// m4 slides, and the spring transmits less than the reference needs: the controller has to push.
ControlState after_sliding(double speed, double motor_speed, double behind, int periods) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  ReferenceState reference = at_rest(home());
  reference.dq_m[3] = speed;
  for (int k = 0; k < periods; ++k) {
    RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
    robot.theta_m[3] -= behind;
    robot.q_m[3] -= behind;
    robot.dtheta_m[3] = motor_speed;
    answer(control, state, reference, robot);
  }
  return state;
}

TEST(ModalControl, FrictionIsLearntWhileTheJointSlides) {
  constexpr double kStart = 0.8;
  for (const double way : {-1.0, 1.0}) {
    const ControlState more = after_sliding(0.2 * way, 0.2 * way, 1e-4 * way, 200);
    EXPECT_GT(more.friction[3], kStart + 0.01);
    EXPECT_EQ(more.friction[0], kStart);  // stands
    const ControlState less = after_sliding(0.2 * way, 0.2 * way, -1e-4 * way, 200);
    EXPECT_LT(less.friction[3], kStart - 0.01);
    // it does not slide: what the feedback adds is no friction
    EXPECT_EQ(after_sliding(0.2 * way, 0.0, 1e-4 * way, 200).friction[3], kStart);
    EXPECT_EQ(after_sliding(1e-3 * way, 1e-3 * way, 1e-4 * way, 200).friction[3], kStart);
    EXPECT_EQ(after_sliding(0.2 * way, -0.2 * way, 1e-4 * way, 200).friction[3], kStart);
    // bounds: a feedback that wants more has another reason
    EXPECT_EQ(after_sliding(0.2 * way, 0.2 * way, 3e-3 * way, 20'000).friction[3], 2.0);
    EXPECT_EQ(after_sliding(0.2 * way, 0.2 * way, -3e-3 * way, 20'000).friction[3], 0.0);
  }
}

// What the feedback adds to the torque of a motor that slides is missing friction.
TEST(ModalControl, TheRateOfLearningIsThatOfTheMissingFriction) {
  const ControlledArm config = reference_config();
  for (const int joint : {0, 3, 5}) {
    SCOPED_TRACE(joint);
    ReferenceState reference = at_rest(home());
    reference.dq_m[joint] = 0.2;
    RobotState robot = following(reference, joints(0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0));
    JointControl control = control_of(config);
    ControlState level = control.start(), behind = control.start();
    const VectorM without = answer(control, level, reference, robot).command.tau_m;
    robot.theta_m[joint] -= 1e-4;
    robot.q_m[joint] -= 1e-4;
    const VectorM with = answer(control, behind, reference, robot).command.tau_m;
    const double coulomb = coulomb_torque(config.actuators[joint], 0.2, level.tau_r[joint]);
    const double missing = (with - without)[joint] / coulomb;
    const double learnt = behind.friction[joint] - level.friction[joint];
    EXPECT_GT(missing, 0.02);
    EXPECT_NEAR(learnt, config.friction_learning / config.rate_Hz * missing, 2e-3 * learnt);
  }
}

TEST(ModalControl, NoFrictionIsLearntWhileAMotorIsSaturated) {
  const ControlState once = after_sliding(0.2, 0.2, 0.3, 1);
  ASSERT_TRUE(once.is_saturated);
  EXPECT_EQ(after_sliding(0.2, 0.2, 0.3, 100).friction, once.friction);
}

// 0.8 of the peak of m1 and m2: what is fed forward ends at its bound instead of swinging around it
TEST_P(BothMethods, ALoadBeyondWhatIsFedForwardSettlesAtTheBound) {
  const ControlledArm config = frictionless_config(GetParam());
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  model::ChainData chain(arm());
  chain.update(posture(home()), Eigen::VectorXd::Zero(8));
  Eigen::Matrix<double, 6, 8> J = chain.jacobian(chain.model().frame("handle"));
  for (const double side : {-1.0, 1.0}) {
    for (const double load : {0.5, 0.8}) {
      robot.w_H = Vector6::Zero();
      robot.w_H[5] = -side * load * 176.0 / J(5, 2);  // about the axis of m1
      for (int k = 0; k < 1000; ++k) answer(control, state, reference, robot);
      EXPECT_NEAR(state.tau_r[0], side * std::min(load, 0.7) * 176.0, 1e-6);
      EXPECT_NEAR(state.dtau_r[0], 0.0, 1e-6);
    }
  }
}

// a matrix of two states whose largest eigenvalue passes 1 at 2 pi f dt = sqrt(5) - 1
TEST(JointControl, AFeedforwardFilterBeyondItsBoundIsRefused) {
  ControlledArm config = frictionless_config();
  config.rate_Hz = 204.0;
  EXPECT_NO_THROW(check_control_config(config, config.rate_Hz));
  config.rate_Hz = 203.0;
  EXPECT_THROW(check_control_config(config, config.rate_Hz), SetupError);
  EXPECT_THROW(control_of(config), SetupError);
  config.method = Method::kDrives;
  EXPECT_NO_THROW(check_control_config(config, config.rate_Hz));

  config = frictionless_config();
  config.flatness_Hz = 0.99 * largest_flatness_Hz(1000.0);
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  answer(control, state, reference, robot);
  robot.w_H[5] = 0.01;
  double swing = 0.0;
  for (int k = 0; k < 2000; ++k) {
    answer(control, state, reference, robot);
    swing = std::abs(state.dtau_r[0]);
  }
  EXPECT_LT(swing, 1e-6);
}

TEST(Latency, IsMeasuredFromTheAnsweredCommandWhileTheDrivesAreOff) {
  for (const std::uint64_t periods : {1u, 2u, 3u}) {
    SCOPED_TRACE(periods);
    JointControl control = control_of(reference_config());
    ControlState state = control.start();
    const ReferenceState reference = at_rest(home());
    CommandFrame command;
    for (std::uint64_t k = 10; k < 510; ++k) {
      control.listen(answered(k, periods), false, state);
      control.rest(reference, state, command);
    }
    const double latency = static_cast<double>(periods) * 1e-3;
    const Answer on = answer(control, state, reference, following(reference, VectorM::Zero(6)));
    EXPECT_NEAR(on.report.latency_s, latency, 1e-9);
    EXPECT_NEAR(state.poles.w0, poles_for({}, latency + 0.5e-3).w0, 1e-4);
    EXPECT_EQ(command.tau_m, VectorM::Zero(6));
  }
}

TEST(Latency, WithoutAnAnswerItIsWhatTheConfigurationExpects) {
  ControlledArm config = reference_config();
  config.loop.latency = 2e-3;
  JointControl control = control_of(config);
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  CommandFrame command;
  SensorFrame silent;
  for (silent.sequence = 0; silent.sequence < 100; ++silent.sequence) {
    control.listen(silent, false, state);
    control.rest(reference, state, command);
  }
  const Answer on = answer(control, state, reference, following(reference, VectorM::Zero(6)));
  EXPECT_DOUBLE_EQ(on.report.latency_s, 2e-3);
  EXPECT_DOUBLE_EQ(state.poles.w0, poles_for({}, 2.5e-3).w0);
}

// Drives that follow positions may be on after a few samples: the mean still is what was expected.
TEST(Latency, IsNotJudgedBeforeItIsKnown) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  std::uint64_t k = 10;
  for (; k < 20; ++k) control.listen(answered(k, 3), false, state);
  for (; k < 120; ++k) control.listen(answered(k, 3), true, state);
  EXPECT_EQ(control.link_disturbance(answered(k, 3), state).code, FaultCode::kNone);
  // known, it is: answers that come later than it are
  for (; k < 1120; ++k) control.listen(answered(k, 3), false, state);
  for (; k < 1220; ++k) control.listen(answered(k, 6), true, state);
  EXPECT_EQ(control.link_disturbance(answered(k, 6), state).code, FaultCode::kLatencyGrew);
}

TEST(Latency, ChangesNothingWhileTheDrivesAreOn) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  answer(control, state, reference, following(reference, VectorM::Zero(6)));
  const double w0 = state.poles.w0;
  state.latency = 5.0;
  answer(control, state, reference, following(reference, VectorM::Zero(6)));
  EXPECT_EQ(state.poles.w0, w0);
}

TEST(JointControl, ARestResetsIt) {
  JointControl control = control_of(reference_config());
  ControlState state = control.start();
  const ReferenceState reference = at_rest(home());
  RobotState robot = following(reference, VectorM::Zero(6));
  const Answer first = answer(control, state, reference, robot);
  robot.q_m[0] -= 1e-3;
  for (int k = 0; k < 100; ++k) answer(control, state, reference, robot);
  CommandFrame command;
  control.rest(reference, state, command);
  robot.q_m[0] += 1e-3;
  EXPECT_EQ(answer(control, state, reference, robot).command.tau_m, first.command.tau_m);
}

TEST(JointControl, DrivesThatFollowPositionsGetTheReferenceAndNoTorques) {
  ControlledArm config;
  config.method = Method::kDrives;
  ReferenceState reference = at_rest(home());
  reference.dq_m.setConstant(0.1);
  reference.ddq_m.setConstant(-0.2);
  RobotState robot;
  robot.q_m = home();
  robot.q_m[2] -= 1e-3;
  const Answer driven = first_answer(config, reference, robot);
  EXPECT_EQ(driven.command.q_m, reference.q_m);
  EXPECT_EQ(driven.command.dq_m, reference.dq_m);
  EXPECT_EQ(driven.command.ddq_m, reference.ddq_m);
  EXPECT_EQ(driven.command.tau_m.size(), 0);
  EXPECT_EQ(driven.report.torque_share.size(), 0);
  EXPECT_NEAR(driven.report.error[2], 1e-3, 1e-15);
}

TEST(JointControl, NeedsOneActuatorPerJoint) {
  ControlledArm config = reference_config();
  config.actuators.pop_back();
  EXPECT_THROW(control_of(config), SetupError);
  config.method = Method::kDrives;
  EXPECT_NO_THROW(control_of(config));
}

TEST_P(BothMethods, StepsWithoutAllocating) {
  EXPECT_EQ(allocations_of_steps(reference_config(GetParam())), 0u);
}

}  // namespace
}  // namespace hg::tracking
