// What single joints of the plant do: friction, brakes, motors, drives, end stops.

#include <gtest/gtest.h>

#include <random>

#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

PlantInput pull(const PlantConfig& config, double torque) {
  PlantInput input = idle(config, false);
  input.w_H[5] = torque;
  return input;
}

// [HANDBOOK] 4.3, check: Jm 0.2, K 3000, Coulomb friction 8 Nm, step 1 ms
TEST(PlantJoint, FrictionHoldsALoadBelowItAndNoneAbove) {
  ActuatorModel actuator = bare_actuator(0.2, 3000.0);
  actuator.damping = 1.0;
  actuator.coulomb_friction = 8.0;
  actuator.viscous_friction = 0.5;
  PlantConfig config = one_joint_config(actuator);
  config.step = 1e-3;
  const model::ChainModel chain = one_joint(0.003);
  const auto drift_under = [&](double load) {
    Plant plant(config, chain, chain.frame("tip"));
    for (int k = 0; k < 10'000; ++k) plant.step(pull(config, load));
    const double deflection = plant.truth().q_m[0] - plant.truth().theta_m[0];
    EXPECT_NEAR(deflection, load / 3000.0, load > 8.0 ? 1e-3 : 1e-9);
    return plant.truth().theta_m[0];
  };
  EXPECT_EQ(drift_under(5.0), 0.0);
  const double overshoot = drift_under(7.9);
  EXPECT_GT(overshoot, 1e-5);
  EXPECT_LT(overshoot, 3e-4);
  EXPECT_GT(drift_under(8.5), 1.0);
}

TEST(PlantJoint, BreaksAwayAtItsStictionThenSlidesOnItsCoulombFriction) {
  ActuatorModel actuator = bare_actuator(0.5, 1e4);
  actuator.damping = 5.0;
  actuator.coulomb_friction = 4.0;
  actuator.stiction = 1.2;
  const PlantConfig config = one_joint_config(actuator);
  const model::ChainModel chain = one_joint(2.0);
  Plant plant(config, chain, chain.frame("tip"));
  PlantInput input = idle(config, false);
  double torque = 0.0;
  for (; plant.truth().dtheta_m[0] == 0.0 && torque < 10.0; torque += 1e-3) {
    input.tau_command[0] = torque;
    plant.step(input);
  }
  EXPECT_NEAR(torque, 4.8, 2e-3);

  // Stribeck: at 0.05 rad/s 1 / e of the excess is left, at 0.5 rad/s nothing
  double before = 0.0;
  while (plant.truth().dtheta_m[0] < 0.05) {
    before = plant.truth().dtheta_m[0];
    plant.step(input);
  }
  plant.step(input);
  EXPECT_NEAR(plant.forces().tau_friction[0], -(4.0 + 0.8 * std::exp(-1.0)),
              0.8 * (plant.truth().dtheta_m[0] - before) / 0.05);
  input.tau_command[0] = 10.0;
  while (plant.truth().dtheta_m[0] < 0.5) plant.step(input);
  plant.step(input);
  EXPECT_NEAR(plant.forces().tau_friction[0], -4.0, 1e-9);
}

TEST(PlantJoint, LoadMakesFriction) {
  ActuatorModel actuator = bare_actuator(0.5, 1e4);
  actuator.damping = 20.0;
  actuator.coulomb_friction = 1.0;
  actuator.load_friction = 0.06;
  const PlantConfig config = one_joint_config(actuator);
  const model::ChainModel chain = one_joint(0.1);
  Plant plant(config, chain, chain.frame("tip"));
  PlantInput input = pull(config, -50.0);
  input.brakes_closed = true;
  for (int k = 0; k < 4000; ++k) plant.step(input);
  EXPECT_NEAR(plant.truth().tau_J[0], 50.0, 1e-6);
  input.brakes_closed = false;
  input.tau_command[0] = 50.0 + 3.99;  // friction is 1 + 0.06 50 = 4 Nm
  for (int k = 0; k < 400; ++k) plant.step(input);
  EXPECT_EQ(plant.truth().dtheta_m[0], 0.0);
  input.tau_command[0] = 50.0 + 4.01;
  for (int k = 0; k < 400; ++k) plant.step(input);
  EXPECT_GT(plant.truth().dtheta_m[0], 0.0);
}

TEST(PlantJoint, FrictionStaysInItsBoxAndNeverDrives) {
  PlantConfig config = reference_config();
  for (const double q : config.q_m_start) config.end_stops.push_back({q - 0.2, q + 0.2});
  const model::ChainModel chain = haptic_giant();
  int held = 0, sliding = 0, most_tries = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Plant plant(config, chain, chain.frame("handle"));
    const VectorM weight = plant.truth().tau_J;
    PlantInput input = idle(config, false);
    for (int k = 0; k < 1000; ++k) {
      if (k % 50 == 0) {
        for (double& w : input.w_H) w = 4.0 * normal(random);
        for (int i = 0; i < 6; ++i) {
          const ActuatorModel& a = config.actuators[i];
          input.tau_command[i] = weight[i] + 2.0 * a.coulomb_friction * normal(random);
        }
      }
      const Truth before = plant.truth();
      plant.step(input);
      ASSERT_TRUE(plant.forces().is_exact);
      most_tries = std::max(most_tries, plant.forces().tries);
      for (int i = 0; i < 6; ++i) {
        const ActuatorModel& a = config.actuators[i];
        const double share = before.dtheta_m[i] / a.stribeck_speed;
        const double bound = (a.coulomb_friction + a.load_friction * std::abs(before.tau_J[i])) *
                             (1.0 + (a.stiction - 1.0) * std::exp(-share * share));
        const double friction = plant.forces().tau_friction[i];
        const double dtheta = plant.truth().dtheta_m[i];
        ASSERT_LE(std::abs(friction), bound * (1.0 + 1e-15));
        ASSERT_LE(friction * dtheta, 0.0);
        if (dtheta != 0.0) {
          ASSERT_NEAR(std::abs(friction), bound, 1e-14 * bound);
        }
        ++(dtheta == 0.0 ? held : sliding);
      }
    }
  }
  EXPECT_GT(held, 10'000);
  EXPECT_GT(sliding, 10'000);
  EXPECT_LE(most_tries, 8);
}

TEST(PlantJoint, BrakesStopMotorsAtOnceAndForGood) {
  const PlantConfig config = reference_config();
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, false);
  input.tau_command << 100.0, -60.0, 30.0, 60.0, 10.0, 5.0;
  for (int k = 0; k < 800; ++k) plant.step(input);
  ASSERT_GT(plant.truth().dtheta_m.cwiseAbs().minCoeff(), 0.1);
  input.brakes_closed = true;
  input.w_H << 200.0, 200.0, 200.0, 0.0, 0.0, 0.0;
  plant.step(input);
  const VectorM theta = plant.truth().theta_m;
  EXPECT_GT(plant.truth().dq_m.norm(), 0.1);  // the links swing on
  for (int k = 0; k < 4000; ++k) {
    plant.step(input);
    ASSERT_EQ(plant.truth().theta_m, theta);
    ASSERT_TRUE(plant.truth().dtheta_m.isZero(0.0));
  }
  input.brakes_closed = false;
  plant.step(input);
  EXPECT_GT(plant.truth().dtheta_m.norm(), 0.0);
}

TEST(PlantJoint, AClosedBrakeHoldsItsMotorAndAWeakOneHoldsNothing) {
  const PlantConfig config = reference_config();
  const model::ChainModel chain = haptic_giant();
  for (const bool brakes_closed : {false, true}) {
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, brakes_closed);
    input.faults = {.closed_brakes = 1U << 1, .weak_brakes = 1U << 2};
    input.tau_command << 100.0, -60.0, 60.0, 60.0, 10.0, 5.0;
    const VectorM theta = plant.truth().theta_m;
    for (int k = 0; k < 400; ++k) plant.step(input);
    EXPECT_EQ(plant.truth().theta_m[1], theta[1]);
    EXPECT_NE(plant.truth().theta_m[2], theta[2]);
    EXPECT_EQ(plant.truth().theta_m[0] == theta[0], brakes_closed);
  }
}

TEST(PlantJoint, CurrentFollowsItsCommandWithItsLagUpToThePeakTorque) {
  PlantConfig config = reference_config();
  config.current_lag = 2e-3;
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, true);
  input.tau_command << 1e6, -1e6, 50.0, 0.0, 0.0, 0.0;
  for (int k = 1; k <= 8; ++k) plant.step(input);  // one lag
  const double share = 1.0 - std::exp(-1.0);
  EXPECT_NEAR(plant.truth().tau_motor[0], 176.0 * share, 1e-9);
  EXPECT_NEAR(plant.truth().tau_motor[1], -176.0 * share, 1e-9);
  EXPECT_NEAR(plant.truth().tau_motor[2], 50.0 * share, 1e-9);
}

TEST(PlantJoint, AFastMotorHasLessTorqueToDriveButAllToBrake) {
  ActuatorModel actuator = bare_actuator(1.0, 1e4);
  actuator.damping = 20.0;
  actuator.torque_max = 100.0;
  actuator.speed_full_torque = 2.0;
  actuator.speed_no_load = 4.0;
  const PlantConfig config = one_joint_config(actuator);
  const model::ChainModel chain = one_joint(2.0);
  for (const double way : {1.0, -1.0}) {
    Plant plant(config, chain, chain.frame("tip"));
    PlantInput input = idle(config, false);
    input.tau_command[0] = way * 100.0;
    double before = 0.0;
    while (std::abs(plant.truth().dtheta_m[0]) < 3.0) {
      before = way * plant.truth().dtheta_m[0];
      plant.step(input);
      const double expected = before <= 2.0 ? 100.0 : 100.0 * (1.0 - (before - 2.0) / 2.0);
      ASSERT_NEAR(way * plant.truth().tau_motor[0], expected, 1e-9);
    }
    for (int k = 0; k < 40'000; ++k) plant.step(input);
    EXPECT_NEAR(way * plant.truth().dtheta_m[0], 4.0, 1e-3);
    input.tau_command[0] = -way * 100.0;
    plant.step(input);
    EXPECT_EQ(plant.truth().tau_motor[0], -way * 100.0);
  }
}

TEST(PlantJoint, TheGantryWaitsThenFollowsWithinItsRatings) {
  const PlantConfig config = reference_config();  // dead time 4 ms, lag 40 ms, 2.5 m/s^2, 1.5 m/s
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, true);
  input.dq_p_command << 0.05, 9.0;
  for (int k = 0; k < 16; ++k) {
    plant.step(input);
    ASSERT_EQ(plant.truth().dq_p[0], 0.0);
  }
  plant.step(input);
  EXPECT_NEAR(plant.truth().ddq_p[0], 0.05 / 40e-3, 1e-12);
  EXPECT_EQ(plant.truth().ddq_p[1], 2.5);
  for (int k = 1; k < 160; ++k) plant.step(input);
  EXPECT_NEAR(plant.truth().dq_p[0], 0.05 * (1.0 - std::exp(-1.0)), 2e-4);
  EXPECT_NEAR(plant.truth().dq_p[1], 0.1, 1e-12);
  EXPECT_NEAR(plant.truth().q_p[1], 0.5 * 2.5 * 0.04 * 0.04, 1e-12);
  for (int k = 0; k < 8000; ++k) plant.step(input);
  EXPECT_NEAR(plant.truth().dq_p[1], 1.5, 1e-9);
}

TEST(PlantJoint, EndStopsDoNotThrowBack) {
  PlantConfig config = one_joint_config(bare_actuator(1e-3, 1e4));
  config.end_stops = {{-0.1, 0.2}};
  const model::ChainModel chain = one_joint(3.0);
  for (const double way : {1.0, -1.0}) {
    for (const double torque : {0.1, 5.0, 300.0}) {
      Plant plant(config, chain, chain.frame("tip"));
      double impact = 0.0, rebound = 0.0, deepest = 0.0;
      while (plant.forces().tau_stop[0] == 0.0) {
        impact = std::abs(plant.truth().dq_m[0]);
        plant.step(pull(config, way * torque));
      }
      for (int k = 0; k < 8000; ++k) {
        plant.step(pull(config, 0.0));
        rebound = std::max(rebound, -way * plant.truth().dq_m[0]);
        const double q = plant.truth().q_m[0];
        deepest = std::max({deepest, q - 0.2, -0.1 - q});
      }
      EXPECT_GT(impact, 0.05);
      EXPECT_LT(rebound, 0.02 * impact);
      // a mass on an overdamped spring
      EXPECT_LT(deepest, 0.1 * impact * std::sqrt(3.0 / 1e5));
    }
  }
}

TEST(PlantJoint, EndStopsPushAndCarryWhatTheMotorPresses) {
  PlantConfig config = reference_config();
  config.end_stops.resize(6);
  config.end_stops[1] = {config.q_m_start[1] - 0.1, config.q_m_start[1] + 0.1};
  const model::ChainModel chain = haptic_giant(false);
  for (const double way : {1.0, -1.0}) {
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, false);
    input.tau_command[1] = way * 60.0;
    for (int k = 0; k < 20'000; ++k) {
      plant.step(input);
      ASSERT_GE(-way * plant.forces().tau_stop[1], 0.0);
      if (plant.forces().tau_stop[1] != 0.0) {  // only where it touches, and at once
        ASSERT_GT(way * (plant.truth().q_m[1] - config.q_m_start[1]), 0.1 - 1e-12);
      }
      ASSERT_EQ(plant.forces().tau_stop[0], 0.0);
    }
    const double carried = -plant.forces().tau_stop[1];
    EXPECT_NEAR(way * carried, 60.0, 10.0);  // the motor's friction holds some
    EXPECT_NEAR(carried, plant.truth().tau_J[1], 0.05);
    const double depth = way * (plant.truth().q_m[1] - config.q_m_start[1]) - 0.1;
    EXPECT_NEAR(depth, way * carried / 1e5, 1e-6);

    // lets go
    input.tau_command[1] = -way * 60.0;
    for (int k = 0; k < 400; ++k) plant.step(input);
    EXPECT_EQ(plant.forces().tau_stop[1], 0.0);
    EXPECT_LT(way * plant.truth().dq_m[1], -0.1);
  }
}

}  // namespace
}  // namespace hg::simulator
