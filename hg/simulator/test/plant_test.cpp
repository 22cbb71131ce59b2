#include "hg/simulator/plant/plant.h"

#include <gtest/gtest.h>

#include <random>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

constexpr double kResidual = 1e-12;  // Nm, of sums of some 100 Nm

// Everything at once: motors, brakes, a user who pulls, a gantry that drives, stops that are hit.
PlantInput random_input(const PlantConfig& config, std::mt19937& random) {
  std::normal_distribution<double> normal;
  PlantInput input = idle(config, std::uniform_int_distribution(0, 9)(random) == 0);
  for (int i = 0; i < input.tau_command.size(); ++i) {
    input.tau_command[i] = config.actuators[i].torque_rated * normal(random);
  }
  for (double& dq : input.dq_p_command) dq = normal(random);
  for (double& w : input.w_H) w = 10.0 * normal(random);
  return input;
}

PlantConfig narrow_config() {
  PlantConfig config = reference_config();
  for (const double q : config.q_m_start) config.end_stops.push_back({q - 0.05, q + 0.05});
  return config;
}

TEST(Plant, HoldsItsWeightInItsSpringsAtRest) {
  // [HANDBOOK] 1.4, golden gravity torques at home and at the test state
  struct Golden {
    VectorM q, tau;
  };
  PlantConfig config = reference_config();
  Golden home{config.q_m_start, VectorM::Zero(6)};
  home.tau << 0.0, 0.0, 0.0, 30.67587, 2.12877, 0.0;
  Golden slanted{VectorM(6), VectorM(6)};
  slanted.q << 0.4, 1.2, -0.5, 1.1, 0.3, -0.7;
  slanted.tau << 0.0, 0.0, 0.0, 27.53918, 2.0978, 0.0;
  const model::ChainModel chain = haptic_giant();
  for (const Golden& golden : {home, slanted}) {
    config.q_m_start = golden.q;
    Plant plant(config, chain, chain.frame("handle"));
    const PlantInput input = idle(config, true);
    for (int k = 0; k < 4000; ++k) plant.step(input);
    EXPECT_LT((plant.truth().tau_J - golden.tau).lpNorm<Eigen::Infinity>(), 1e-5);
    EXPECT_LT((plant.truth().q_m - golden.q).lpNorm<Eigen::Infinity>(), 1e-13);
    EXPECT_LT(plant.truth().acceleration.norm(), 1e-10);
  }
}

TEST(Plant, MotorsHoldTheWeightWithOpenBrakes) {
  PlantConfig config = reference_config();
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, true);
  input.tau_command = plant.truth().tau_J;
  for (int k = 0; k < 40; ++k) plant.step(input);
  input.brakes_closed = false;
  for (int k = 0; k < 4000; ++k) plant.step(input);
  EXPECT_LT((plant.truth().q_m - config.q_m_start).lpNorm<Eigen::Infinity>(), 1e-10);
  EXPECT_LT(plant.forces().tau_friction.lpNorm<Eigen::Infinity>(), 1e-5);
}

TEST(Plant, EquationsOfMotionHoldToRounding) {
  const PlantConfig config = narrow_config();
  model::ChainData chain(haptic_giant());
  const int handle = chain.model().frame("handle");
  bool has_touched_stop = false;
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    Plant plant(config, chain.model(), handle);
    PlantInput input;
    for (int k = 0; k < 1000; ++k) {
      if (k % 40 == 0) input = random_input(config, random);
      const Truth before = plant.truth();
      const VectorQ q = plant.q(), dq = plant.dq();
      plant.step(input);
      const Truth& after = plant.truth();
      const PlantForces& forces = plant.forces();

      // links and gantry, by inverse dynamics
      VectorQ ddq(8), tau(8);
      ddq << after.ddq_p, forces.ddq;
      tau << forces.f_p, after.tau_J + forces.tau_stop;
      chain.update(q, dq);
      const VectorQ expected = chain.inverse_dynamics(q, dq, ddq) -
                               VectorQ(chain.jacobian(handle).transpose() * input.w_H);
      // [HANDBOOK] 4.1
      const double terms = (chain.M().cwiseAbs() * ddq.cwiseAbs()).maxCoeff();
      const double rounding = kResidual + 1e-14 * terms;  // 1e4 Nm where a stop catches a joint
      ASSERT_LT((expected - tau).lpNorm<Eigen::Infinity>(), rounding);
      ASSERT_LT(plant.residual(), rounding);

      // motors and springs, [HANDBOOK] 4.2
      for (int i = 0; i < 6; ++i) {
        const ActuatorModel& a = config.actuators[i];
        ASSERT_NEAR(a.rotor_inertia * forces.ddtheta[i],
                    after.tau_motor[i] - after.tau_J[i] - a.viscous_friction * after.dtheta_m[i] +
                        forces.tau_friction[i],
                    1e-11);  // of up to 1e4 Nm when a brake closes on a turning motor
        ASSERT_NEAR(after.tau_J[i],
                    a.stiffness * (after.theta_m[i] - after.q_m[i]) +
                        a.damping * (after.dtheta_m[i] - after.dq_m[i]),
                    1e-10);  // stiffness times the rounding of an angle
        ASSERT_EQ(after.theta_m[i], before.theta_m[i] + config.step * after.dtheta_m[i]);
      }
      has_touched_stop = has_touched_stop || !forces.tau_stop.isZero();
    }
  }
  EXPECT_TRUE(has_touched_stop);
}

TEST(Plant, ResidualOfOrdinaryMotionIsBelowThatOfTheHandbook) {
  const PlantConfig config = reference_config();
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  const VectorM weight = plant.truth().tau_J;
  PlantInput input = idle(config, false);
  input.dq_p_command << 0.6, -0.4;
  for (int k = 0; k < 4000; ++k) {
    const double swing = std::sin(5.0 * k * config.step);
    for (int i = 0; i < 6; ++i) {
      const double rated = config.actuators[i].torque_rated;
      input.tau_command[i] = weight[i] + 0.2 * rated * swing;
    }
    input.w_H << 10.0 * swing, -5.0, 8.0, 1.0, 0.5, -0.4;
    plant.step(input);
    ASSERT_LT(plant.residual(), kResidual) << "step " << k;
  }
  EXPECT_GT(plant.dq().norm(), 0.2);
}

TEST(Plant, TruthIsTheMotionOfTheHandle) {
  PlantConfig config = reference_config();
  config.step = 1e-5;
  config.drive.dead_time = 0.0;
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, false);
  input.dq_p_command << 0.6, -0.4;
  input.tau_command << 60.0, -40.0, 20.0, 50.0, 5.0, 3.0;
  input.w_H << 10.0, -5.0, 8.0, 1.0, 0.5, -0.4;
  for (int k = 0; k < 40'000; ++k) plant.step(input);
  const Truth before = plant.truth();
  plant.step(input);
  const Truth& after = plant.truth();
  ASSERT_TRUE(after.is_known);
  EXPECT_GT(after.twist.head<3>().norm(), 0.1);
  EXPECT_EQ(after.w_H, input.w_H);
  EXPECT_LT(((after.T_B_H.p - before.T_B_H.p) / config.step - after.twist.head<3>()).norm(), 1e-4);
  const Eigen::AngleAxisd turn(after.T_B_H.R * before.T_B_H.R.transpose());
  EXPECT_LT((turn.angle() / config.step * turn.axis() - after.twist.tail<3>()).norm(), 1e-4);
  EXPECT_GT(after.acceleration.norm(), 1.0);
  EXPECT_LT(((after.twist - before.twist) / config.step - after.acceleration).norm(),
            2e-3 * after.acceleration.norm());
}

TEST(Plant, CopiesContinueWithTheSameBits) {
  const PlantConfig config = narrow_config();
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  std::mt19937 random(7);
  for (int k = 0; k < 200; ++k) plant.step(random_input(config, random));
  Plant copy = plant;
  std::mt19937 random_copy = random;
  for (int k = 0; k < 200; ++k) plant.step(random_input(config, random));
  for (int k = 0; k < 200; ++k) copy.step(random_input(config, random_copy));
  EXPECT_EQ(plant.q(), copy.q());
  EXPECT_EQ(plant.dq(), copy.dq());
  EXPECT_EQ(plant.truth().theta_m, copy.truth().theta_m);
  EXPECT_EQ(plant.truth().acceleration, copy.truth().acceleration);
}

TEST(Plant, DoesNotAllocate) {
  const PlantConfig config = narrow_config();
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  std::mt19937 random(3);
  double sum = 0.0;
  AllocationCounter counter;
  for (int k = 0; k < 2000; ++k) {
    plant.step(random_input(config, random));
    sum += plant.energy().sum() + plant.power().put_in() + plant.residual();
  }
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Plant, TheGantryMeetsBuffersAtItsEnds) {
  PlantConfig config = reference_config();
  config.gantry_stops = {{-1.42, 1.42}, {-0.2, 0.1}};
  for (const double side : {1.0, -1.0}) {
    Plant plant(config, haptic_giant(), haptic_giant().frame("handle"));
    PlantInput input = idle(config, true);
    input.dq_p_command[1] = 1.5 * side;
    double farthest = 0.0, fastest = 0.0;
    for (int k = 0; k < 12000; ++k) {
      plant.step(input);
      farthest = std::max(farthest, side * plant.truth().q_p[1]);
      fastest = std::max(fastest, side * plant.truth().dq_p[1]);
    }
    const double end = side > 0.0 ? 0.1 : 0.2;
    EXPECT_GT(fastest, 0.6);
    EXPECT_GT(farthest, end + 1e-3);
    EXPECT_LT(farthest, end + 0.01);
    EXPECT_LT(std::abs(plant.truth().dq_p[1]), 1e-3);  // it leans against the buffer
    EXPECT_GT(side * plant.truth().q_p[1], end);
    input.dq_p_command[1] = -0.5 * side;  // and may leave
    for (int k = 0; k < 800; ++k) plant.step(input);
    EXPECT_LT(side * plant.truth().q_p[1], end - 0.03);
    EXPECT_EQ(plant.truth().q_p[0], 0.0);
  }
}

TEST(Plant, SetUpNamesWhatCannotBe) {
  const model::ChainModel chain = haptic_giant();
  const auto message = [&](auto&& corrupt) -> std::string {
    PlantConfig config = reference_config();
    corrupt(config);
    try {
      Plant(config, chain, chain.frame("handle"));
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([](PlantConfig&) {}), "");
  EXPECT_EQ(message([](PlantConfig& c) { c.manipulator.pop_back(); }),
            "joint m6: must be one of gantry, manipulator and flexible, once, got 0.000000");
  EXPECT_EQ(message([](PlantConfig& c) { c.gantry[0] = 9; }),
            "joint of the plant: must be an index of the chain's 8 joints, got 9.000000");
  EXPECT_EQ(message([](PlantConfig& c) { c.actuators[3].stiffness = 0.0; }),
            "joint m4 stiffness: must be positive, got 0.000000");
  EXPECT_EQ(message([](PlantConfig& c) { c.actuators.pop_back(); }),
            "actuators: must have 6 values, got 5.000000");
  EXPECT_EQ(message([](PlantConfig& c) { c.step = 1e-5, c.drive.dead_time = 5e-3; }),
            "drive dead_time: must not exceed 255 steps of the plant, got 0.005000");
  EXPECT_EQ(message([](PlantConfig& c) {
              c.end_stops = std::vector<Interval>(6, {-1.0, 1.0});
            }),
            "joint m2: must start between its end stops, got 1.570796");
}

}  // namespace
}  // namespace hg::simulator
