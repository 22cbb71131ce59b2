// How hard motors can brake the handle.

#include "hg/controller/rendering/braking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hg/controller/rendering/motor_torque.h"
#include "hg/controller/rendering/test/playing.h"
#include "hg/core/stacked.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::rendering {
namespace {

struct BrakingTest : testing::Test {
  DeviceModel device = unlimited_device();
  DeviceMotion motion = {kGantryAtHome, VectorP::Zero(2), kPosture, VectorM::Zero(6)};

  BrakingTest() {
    const auto motors = reference_actuators();
    device.actuators.assign(motors.begin(), motors.end());
    device.has_torque_limits = true;
  }
  // the share that the most loaded motor gives of what it may, when the handle accelerates so
  double load(const Eigen::Vector3d& acceleration) {
    model::ChainData chain(device.chain);
    chain.update(stacked(motion.q_p, motion.q_m), stacked(motion.dq_p, motion.dq_m));
    const Eigen::MatrixXd J = chain.jacobian(device.handle).rightCols(6);
    Vector6 wanted = -chain.bias_acceleration(device.handle);
    wanted.head<3>() += acceleration;
    const Eigen::VectorXd ddq = J.fullPivLu().solve(Eigen::VectorXd(wanted));
    Eigen::VectorXd torque = chain.M().bottomRightCorner(6, 6) * ddq;
    torque += chain.c().tail(6) - J.transpose() * motion.w_H;
    double most = 0.0;
    for (int i = 0; i < 6; ++i) {
      const ActuatorModel& motor = device.actuators[i];
      const Interval allowed = allowed_torque(motor, motion.dq_m[i]);
      const double given = torque[i] + motor.rotor_inertia * ddq[i];
      most = std::max(most, given > 0.0 ? given / allowed.ub : given / allowed.lb);
    }
    return most;
  }
};

TEST_F(BrakingTest, TakesOneMotorToItsBound) {
  for (const bool moves : {false, true}) {
    if (moves) motion.dq_m = posture({0.3, -0.4, 0.2, 0.5, -0.3, 0.6});
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d along = -Eigen::Vector3d::Unit(axis);
      const double a = largest_acceleration(device, motion, along);
      EXPECT_GT(a, 1.0);
      EXPECT_NEAR(load(a * along), 1.0, 1e-6) << axis;
    }
  }
}

TEST_F(BrakingTest, IncludesTheForceOfTheHand) {
  const Eigen::Vector3d along = -Eigen::Vector3d::UnitY();
  const double free = largest_acceleration(device, motion, along);
  motion.w_H[1] = 40.0;
  const double pushed = largest_acceleration(device, motion, along);
  EXPECT_GT(std::abs(pushed - free), 0.02);
  EXPECT_NEAR(load(pushed * along), 1.0, 1e-6);
  motion.w_H[1] = 4000.0;
  EXPECT_EQ(largest_acceleration(device, motion, along), 0.0);
}

TEST_F(BrakingTest, IsTheRatingWithoutMotorModel) {
  device.has_torque_limits = false;
  EXPECT_TRUE(std::isinf(largest_acceleration(device, motion, Eigen::Vector3d::UnitX())));
  CartesianLimit limit = {.name = "handle", .frame = device.handle};
  for (limits::JointLimits& axis : limit.axes) axis.ddq_max = 3.0;
  device.cartesian_limits = {limit};
  EXPECT_EQ(largest_acceleration(device, motion, Eigen::Vector3d::UnitX()), 3.0);
  EXPECT_NEAR(largest_acceleration(device, motion, Eigen::Vector3d(0.6, 0.8, 0.0)), 3.75, 1e-9);
}

}  // namespace
}  // namespace hg::rendering
