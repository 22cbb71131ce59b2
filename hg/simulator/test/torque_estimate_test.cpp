#include "hg/simulator/sensors/torque_estimate.h"

#include <gtest/gtest.h>

#include "hg/simulator/test/simulation_setup.h"

namespace hg::simulator {
namespace {

// Estimated minus true force of an arm at rest, in S.
Vector6 mistaken(const TorqueEstimateConfig& estimate) {
  SimulatorConfig config = elastic_world();
  config.sensors = ideal_sensors();
  Simulation true_device = make(config);
  config.sensors.torque_estimate = estimate;
  Simulation device = make(config);
  for (int k = 0; k < 50; ++k) {
    true_device.step(hold(true_device));
    device.step(hold(device));
  }
  return device.sensors().w_S - true_device.sensors().w_S;
}

TEST(TorqueEstimate, WithoutErrorsItIsTheTrueWrench) {
  EXPECT_TRUE(mistaken({.is_used = true}).isZero(1e-9));
}

TEST(TorqueEstimate, AWrongWeightIsAForce) {
  const Vector6 error = mistaken({.is_used = true, .weight = 0.05});
  EXPECT_GT(error.head<3>().norm(), 0.5);
  EXPECT_LT(error.head<3>().norm(), 50.0);
}

TEST(TorqueEstimate, WhatEveryJointMistakesIsTheWrenchThatWouldCauseIt) {
  JacobianM J = JacobianM::Zero(6, 6);
  J.diagonal() << 1.0, 0.8, 0.6, 1.2, 0.9, 1.1;
  const TorqueEstimate estimate({.is_used = true, .friction = 0.01}, VectorM::Constant(6, 50.0), 1);
  const VectorM fast = VectorM::Constant(6, 1.0), none = VectorM::Zero(6);
  const Vector6 error = estimate.error(J, fast, none);
  EXPECT_TRUE((J.transpose() * error).isApprox(VectorM::Constant(6, 0.5), 0.01));
  EXPECT_TRUE(estimate.error(J, -fast, none).isApprox(-error)) << "friction turns with the motion";
  EXPECT_TRUE(estimate.error(J, none, none).isZero());
}

TEST(TorqueEstimate, NearASingularityItStaysFinite) {
  const JacobianM J = JacobianM::Zero(6, 6);
  const TorqueEstimate estimate({.is_used = true, .offset = 0.1}, VectorM::Constant(6, 50.0), 1);
  EXPECT_TRUE(estimate.error(J, VectorM::Zero(6), VectorM::Zero(6)).isZero());
}

}  // namespace
}  // namespace hg::simulator
