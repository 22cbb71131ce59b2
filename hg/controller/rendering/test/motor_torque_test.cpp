// What motors can give as limits of the law.

#include "hg/controller/rendering/motor_torque.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/controller/rendering/catalogue.h"
#include "hg/controller/rendering/test/playing.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::rendering {
namespace {

const ActuatorModel kMotor = reference_actuators().front();  // 176 Nm, no load at 4 rad/s

TEST(AllowedTorque, IsTheShareOfTheMotorAtRest) {
  const Interval torque = allowed_torque(kMotor, 0.0);
  EXPECT_DOUBLE_EQ(torque.ub, kTorqueShare * 176.0);
  EXPECT_DOUBLE_EQ(torque.lb, -torque.ub);
}

TEST(AllowedTorque, OnwardItShrinksWithTheSpeedAndWhatFrictionTakes) {
  const Interval torque = allowed_torque(kMotor, 3.0);  // half way to no load
  EXPECT_DOUBLE_EQ(torque.ub, kTorqueShare * 88.0 - 4.0 - 9.0);
  EXPECT_DOUBLE_EQ(torque.lb, -kTorqueShare * 176.0);
  const Interval back = allowed_torque(kMotor, -3.0);
  EXPECT_EQ(back.lb, -torque.ub);
  EXPECT_EQ(back.ub, -torque.lb);
}

TEST(AllowedTorque, IsNeverEmptyHoweverFastTheMotorTurns) {
  for (double dq = -20.0; dq <= 20.0; dq += 0.01) {
    const Interval torque = allowed_torque(kMotor, dq);
    ASSERT_LT(torque.lb, torque.ub) << dq;
  }
  EXPECT_LT(allowed_torque(kMotor, 4.5).ub, 0.0);  // beyond no load it has to brake
}

TEST(ReachedTorque, TakesATimeConstantToTheBound) {
  double torque = 0.0;
  for (int k = 0; k < 20; ++k) torque = reached_torque({-100.0, 100.0}, 100.0, torque, 1e-3).ub;
  EXPECT_NEAR(torque, 100.0 * (1.0 - std::exp(-1.0)), 2.0);
  for (int k = 0; k < 200; ++k) torque = reached_torque({-100.0, 100.0}, 100.0, torque, 1e-3).ub;
  EXPECT_NEAR(torque, 100.0, 0.01);
}

TEST(ReachedTorque, BeyondALightTorqueItTakesFiveTimesAsLong) {
  double torque = 0.0, back = 0.0;
  int light = 0, all = 0;
  for (int k = 1; k <= 1000; ++k) {
    torque = reached_torque({-100.0, 100.0}, 50.0, torque, 1e-3).ub;
    back = reached_torque({-100.0, 100.0}, 50.0, back, 1e-3).lb;
    ASSERT_DOUBLE_EQ(back, -torque);
    if (light == 0 && torque > 49.0) light = k;
    if (all == 0 && torque > 99.0) all = k;
  }
  EXPECT_NEAR(light, 34, 1);  // 20 ms ln(60 / 11): both parts at once
  EXPECT_NEAR(all - light, 390, 4);
}

TEST(ReachedTorque, IsNeverEmpty) {
  for (double before = -300.0; before <= 300.0; before += 7.0) {
    for (const Interval allowed : {Interval{-150.0, -100.0}, {-100.0, 100.0}, {80.0, 100.0}}) {
      const Interval torque = reached_torque(allowed, 60.0, before, 1e-3);
      ASSERT_LE(torque.lb, torque.ub) << before;
    }
  }
}

TEST(ReachedTorque, FromBeyondABoundComesBackToIt) {
  Interval torque = {0.0, 150.0};
  for (int k = 0; k < 200; ++k) {
    const double before = torque.ub;
    torque = reached_torque({-100.0, 100.0}, 50.0, before, 1e-3);
    ASSERT_LT(torque.lb, torque.ub);
    ASSERT_LT(torque.ub, before);
  }
  EXPECT_NEAR(torque.ub, 100.0, 0.01);
}

// A free body in the hand of a device with motors; a person pulls.
struct Pulled {
  Rendering rendering;
  RenderingState state;
  LawResult result;
  VectorM dq_m;  // joint speeds in the last step

  static DeviceModel device(bool knows_motors) {
    DeviceModel device = unlimited_device();
    for (limits::JointLimits& joint : device.joint_limits) {
      joint = {.q_min = -6.0, .q_max = 6.0, .dq_max = 3.0, .ddq_max = 5.0};
    }
    device.actuators.assign(6, kMotor);
    device.has_torque_limits = knows_motors;
    return device;
  }
  static TwinModel body(const DeviceModel& device) {
    TwinModel twin =
        unlimited_twin(model::ChainModel::free_body({.mass = 1.0}, {.gravity = false}), "handle");
    twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
    return twin;
  }
  explicit Pulled(bool knows_motors)
      : rendering(device(knows_motors), body(device(false)), RenderingOptions{}),
        state(rendering.start(kPosture)) {}

  void pull(const Vector6& w) {
    const RobotState robot = robot_with(kGantryAtHome, state.reference.q_m, w);
    dq_m = state.reference.dq_m;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
  }
};

Vector6 force(double x, double y, double z) {
  Vector6 w = Vector6::Zero();
  w.head<3>() << x, y, z;
  return w;
}

TEST(MotorRows, AMotorGivesNoMoreThanItsShareAndIsNamed) {
  Pulled twin(true);
  const LimitCatalogue catalogue = make_catalogue(twin.rendering.device(), twin.rendering.twin());
  bool was_named = false;
  double largest = 0.0;
  for (int k = 0; k < 60; ++k) {
    twin.pull(force(0.0, 120.0, 0.0));
    ASSERT_FALSE(HasFatalFailure());
    const VectorM& dq = twin.dq_m;
    for (int i = 0; i < 6; ++i) {
      const double torque = twin.state.motor_torque[i];
      // a bound that has shrunk with the speed is followed with the time constant
      const Interval allowed = allowed_torque(kMotor, dq[i]);
      ASSERT_LE(torque, allowed.ub + 0.05 * kMotor.torque_max) << k << " motor " << i;
      ASSERT_GE(torque, allowed.lb - 0.05 * kMotor.torque_max) << k << " motor " << i;
      largest = std::max(largest, std::abs(torque) / kMotor.torque_max);
    }
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
      const LimitReport& limit = twin.result.limits[i];
      if (catalogue[i].kind != LimitKind::kMotor || limit.state == LimitState::kInactive) continue;
      was_named = true;
      EXPECT_EQ(limit.cause, LimitCause::kTorque) << catalogue[i].name;
      EXPECT_EQ(limit.position, twin.state.motor_torque[static_cast<int>(i) - 6]);
    }
  }
  EXPECT_TRUE(was_named);
  EXPECT_GT(largest, 0.7);
}

TEST(MotorRows, ATorqueThatBuildsUpIsNotNamedAllOfIt) {
  Pulled twin(true);
  const LimitCatalogue catalogue = make_catalogue(twin.rendering.device(), twin.rendering.twin());
  twin.pull(Vector6::Zero());
  bool was_named = false;
  for (int k = 0; k < 3; ++k) {
    twin.pull(force(0.0, 120.0, 0.0));
    ASSERT_FALSE(HasFatalFailure());
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
      const LimitReport& limit = twin.result.limits[i];
      if (catalogue[i].kind != LimitKind::kMotor || limit.state == LimitState::kInactive) continue;
      was_named = true;
      EXPECT_LT(std::abs(limit.position), 0.5 * kMotor.torque_max);
      EXPECT_EQ(limit.cause, LimitCause::kTorqueRate) << catalogue[i].name;
    }
  }
  EXPECT_TRUE(was_named);
}

TEST(MotorRows, RatingsCapAccelerationsOnlyWithoutMotorModel) {
  const auto largest_acceleration = [](bool knows_motors) {
    Pulled twin(knows_motors);
    double largest = 0.0;
    for (int k = 0; k < 60; ++k) {
      twin.pull(force(0.0, 60.0, 0.0));
      largest = std::max(largest, twin.result.ddq_m.cwiseAbs().maxCoeff());
    }
    return largest;
  };
  EXPECT_NEAR(largest_acceleration(false), 5.0, 1e-6);
  EXPECT_GT(largest_acceleration(true), 10.0);
}

TEST(MotorTorque, IsEasedOnlyWhereToYieldTakesMoreThanToStand) {
  const Interval reached = {-1.0, 6.5};
  const auto eased = [&](double held, double led) {
    return eased_torque(reached, 12.0, 12.0, held, led, 0.0, 5e-3);
  };
  EXPECT_NEAR(eased_torque(reached, 12.0, 12.0, 8.0, 10.0, 6.0, 1e-3).ub, 7.2, 1e-9);  // in time
  EXPECT_NEAR(eased_torque({-1.0, 6.1}, 12.0, 6.0, 8.0, 10.0, 6.0, 1e-3).ub, 6.24, 1e-9);  // heavy
  EXPECT_EQ(eased(8.0, 10.0).ub, 8.0);
  EXPECT_EQ(eased(8.0, 10.0).lb, -1.0);
  EXPECT_EQ(eased(8.0, 7.0).ub, 6.5);     // yields
  EXPECT_EQ(eased(6.4, 10.0).ub, 6.5);    // within reach
  EXPECT_EQ(eased(15.0, 20.0).ub, 12.0);  // no more than the motor has
  EXPECT_EQ(eased(-8.0, -10.0).lb, -8.0);
  EXPECT_EQ(eased(-8.0, -7.0).lb, -1.0);
  EXPECT_EQ(eased(-4.0, -10.0).lb, -1.0);  // a light load
  EXPECT_EQ(eased(std::nan(""), 10.0).ub, 6.5);
}

TEST(MotorRows, AReferenceThatHasJumpedIsSolvedWithoutThem) {
  Pulled twin(true);
  twin.pull(force(1.0, 0.0, 0.0));
  twin.state.reference.dq_m[2] = 400.0;
  twin.pull(force(1.0, 0.0, 0.0));
  EXPECT_EQ(twin.state.motor_torque.size(), 0);
}

TEST(MotorRows, AreNoLimitsOfADeviceWithoutMotors) {
  Pulled twin(false);
  const LimitCatalogue catalogue = make_catalogue(twin.rendering.device(), twin.rendering.twin());
  for (const LimitInfo& limit : catalogue) EXPECT_NE(limit.kind, LimitKind::kMotor);
  twin.pull(force(1.0, 0.0, 0.0));
  EXPECT_EQ(twin.state.motor_torque.size(), 0);
}

}  // namespace
}  // namespace hg::rendering
