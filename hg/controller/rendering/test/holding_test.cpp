// The weight that motors hold, and that the law keeps the device where they can.

#include "hg/controller/rendering/holding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/controller/rendering/motor_torque.h"
#include "hg/controller/rendering/rendering.h"
#include "hg/controller/rendering/test/playing.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::rendering {
namespace {

VectorM weight_in(const DeviceModel& device, const VectorM& q_m) {
  model::ChainData chain(device.chain);
  const VectorPM q = stacked(kGantryAtHome, q_m);
  chain.update(q, VectorPM::Zero(q.size()));
  return chain.gravity().tail(device.n_m);
}

TEST(Holding, IsTheChangeOfTheWeightOnAMotorWithEveryJoint) {
  constexpr double kStep = 1e-4;
  const DeviceModel device = unlimited_device();
  Holding holding(device);
  model::ChainData now(device.chain);
  const VectorPM q = stacked(kGantryAtHome, kPosture);
  now.update(q, VectorPM::Zero(q.size()));
  for (int motor = 0; motor < device.n_m; ++motor) {
    const VectorM gradient = holding.gradient(q, now, motor);
    for (int joint = 0; joint < device.n_m; ++joint) {
      VectorM up = kPosture, down = kPosture;
      up[joint] += kStep;
      down[joint] -= kStep;
      const double change = weight_in(device, up)[motor] - weight_in(device, down)[motor];
      EXPECT_NEAR(gradient[joint], change / (2.0 * kStep), 0.02) << motor << joint;
    }
  }
}

// A device of which one motor already carries all of the weight that it may.
struct HeavyPosture {
  DeviceModel device = unlimited_device();
  int heavy = 0;
  VectorM outward;  ///< Change of the weight on that motor with the joints, away from zero

  HeavyPosture() {
    const VectorM weight = weight_in(device, kPosture);
    weight.cwiseAbs().maxCoeff(&heavy);
    for (ActuatorModel motor : reference_actuators()) device.actuators.push_back(motor);
    device.actuators[heavy].torque_max = std::abs(weight[heavy]) / (0.7 * kTorqueShare);
    device.has_torque_limits = true;
    Holding holding(device);
    model::ChainData now(device.chain);
    const VectorPM q = stacked(kGantryAtHome, kPosture);
    now.update(q, VectorPM::Zero(q.size()));
    outward = std::copysign(1.0, weight[heavy]) * holding.gradient(q, now, heavy);
  }

  /// Acceleration with which the weight on the motor grows where a hand begins to pull, Nm/s^2.
  double growth(const Eigen::Vector3d& force, Braking braking) {
    TwinModel twin =
        unlimited_twin(model::ChainModel::free_body({.mass = 5.0}, {.gravity = false}), "handle");
    twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
    Rendering rendering(device, twin, {.braking = braking});
    RenderingState state = rendering.start(kPosture);
    LawResult result;
    Vector6 pull = Vector6::Zero();
    pull.head<3>() = force;
    const RobotState robot = robot_with(kGantryAtHome, kPosture, pull);
    rendering.step({.robot = robot}, state, result);
    return outward.dot(result.ddq_m);
  }
};

TEST(Holding, LetsNoMotorCarryMoreThanItsShare) {
  HeavyPosture heavy;
  int outward = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double pull : {-5.0, 5.0}) {
      const Eigen::Vector3d force = pull * Eigen::Vector3d::Unit(axis);
      const double alone = heavy.growth(force, Braking::kAlone);
      const double together = heavy.growth(force, Braking::kTogether);
      EXPECT_LT(together, 1e-6) << axis << pull;
      if (alone > 1e-3) {
        ++outward;
      } else {
        EXPECT_NEAR(together, alone, 1e-6) << axis << pull;  // inward it is free
      }
    }
  }
  EXPECT_GT(outward, 0);
}

}  // namespace
}  // namespace hg::rendering
