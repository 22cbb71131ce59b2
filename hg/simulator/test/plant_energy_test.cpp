#include <gtest/gtest.h>

#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

constexpr double kPi = std::numbers::pi;

struct Balance {
  double put_in, change, error;
};

// One second of work by motors, a user and the gantry.
Balance balance_of(double step) {
  PlantConfig config = reference_config();
  config.step = step;
  config.drive.dead_time = 0.0;
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  const double energy = plant.energy().sum();
  PlantInput input = idle(config, false);
  const VectorM weight = plant.truth().tau_J;
  Balance balance = {0.0, 0.0, 0.0};
  double taken = 0.0;
  const int steps = static_cast<int>(std::lround(1.0 / step));
  for (int k = 0; k < steps; ++k) {
    const double t = k * step;
    for (int i = 0; i < 6; ++i) {
      const double rated = config.actuators[i].torque_rated;
      input.tau_command[i] = weight[i] + 0.4 * rated * std::sin(2.0 * kPi * (0.7 + 0.3 * i) * t);
    }
    input.dq_p_command << 0.5 * std::sin(4.0 * t), 0.3 * std::sin(3.0 * t);
    input.w_H << 15.0 * std::sin(9.0 * t), 10.0, 12.0 * std::cos(7.0 * t), 0.5, 0.3, -0.2;
    plant.step(input);
    balance.put_in += step * plant.power().put_in();
    taken += step * plant.power().taken();
  }
  balance.change = plant.energy().sum() - energy;
  balance.error = balance.change - (balance.put_in - taken);
  return balance;
}

TEST(PlantEnergy, ChangesByWhatIsPutInLessWhatIsLost) {
  const Balance coarse = balance_of(0.4e-3), middle = balance_of(0.2e-3), fine = balance_of(0.1e-3);
  EXPECT_GT(std::abs(fine.put_in), 20.0);
  EXPECT_LT(std::abs(fine.error), 0.01 * std::abs(fine.put_in));
  // of first order in the step
  EXPECT_NEAR(coarse.error / middle.error, 2.0, 0.2);
  EXPECT_NEAR(middle.error / fine.error, 2.0, 0.1);
}

// Of the plant and of what its end stops have stored.
double energy_of(const Plant& plant) {
  double energy = plant.energy().sum();
  for (int i = 0; i < 6; ++i) {
    const Interval& travel = plant.config().end_stops[i];
    const double q = plant.truth().q_m[i];
    const double depth = q - std::clamp(q, travel.lb, travel.ub);
    energy += 0.5 * plant.config().end_stop.stiffness * depth * depth;
  }
  return energy;
}

TEST(PlantEnergy, NeverGrowsWithoutInput) {
  const model::ChainModel chain = haptic_giant();
  for (const bool brakes_closed : {false, true}) {
    PlantConfig config = reference_config();
    for (const double q : config.q_m_start) config.end_stops.push_back({q - 0.3, q + 0.3});
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, false);
    input.w_H << 40.0, 30.0, -20.0, 2.0, 1.0, 1.0;  // sets it in motion
    for (int k = 0; k < 400; ++k) plant.step(input);
    input = idle(config, brakes_closed);
    for (int k = 0; k < 4; ++k) plant.step(input);  // currents
    double energy = energy_of(plant);
    for (int k = 0; k < 8000; ++k) {
      plant.step(input);
      const double next = energy_of(plant);
      ASSERT_LE(next, energy + 1e-12) << "step " << k;  // J, rounding
      energy = next;
      ASSERT_GE(plant.power().coulomb_friction, 0.0);
      ASSERT_GE(plant.power().joint_damping, 0.0);
    }
    EXPECT_LT(plant.energy().kinetic, 1e-3);
  }
}

TEST(PlantEnergy, AHeavierArmWeighsMoreAndFallsAsFast) {
  PlantConfig config = reference_config();
  for (ActuatorModel& a : config.actuators) {
    a.coulomb_friction = a.load_friction = a.viscous_friction = 0.0;
    a.rotor_inertia *= 1e-3;
  }
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  config.mass = 1.3;
  Plant heavy(config, chain, chain.frame("handle"));
  EXPECT_LT((heavy.truth().tau_J - 1.3 * plant.truth().tau_J).norm(), 1e-9);
  EXPECT_NEAR(heavy.energy().potential, 1.3 * plant.energy().potential, 1e-9);
  for (int k = 0; k < 800; ++k) {
    plant.step(idle(config, false));
    heavy.step(idle(config, false));
    ASSERT_LT(heavy.residual(), 1e-12);
  }
  EXPECT_GT(plant.truth().twist.norm(), 1.0);
  EXPECT_LT((heavy.truth().twist - plant.truth().twist).norm(), 0.02 * plant.truth().twist.norm());
}

// A gantry that nothing drives: joints that move freely.
TEST(PlantEnergy, WithoutHorizontalForcesTheHorizontalMomentumStays) {
  const model::ChainModel chain = haptic_giant();
  model::ChainData judge(chain);
  const auto drift_of = [&](double step) {
    PlantConfig config = reference_config();
    config.step = step;
    config.flexible = {{.joint = 0}, {.joint = 1}};
    config.gantry = {};
    config.q_p_start = {};
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, false);
    input.tau_command << 30.0, -20.0, 10.0, 40.0, 4.0, 2.0;
    double fastest = 0.0;
    for (int k = 0; k < static_cast<int>(0.3 / step); ++k) {
      plant.step(input);
      fastest = std::max(fastest, plant.dq().head<2>().norm());
    }
    EXPECT_GT(fastest, 0.02);
    judge.update(plant.q(), plant.dq());
    return (judge.M().topRows<2>() * plant.dq()).norm();  // kg m/s
  };
  const double coarse = drift_of(0.2e-3), fine = drift_of(0.1e-3);
  EXPECT_LT(fine, 2e-2);
  EXPECT_NEAR(coarse / fine, 2.0, 0.2);
}

TEST(PlantEnergy, GantryForcesMakeTheMomentum) {
  const model::ChainModel chain = haptic_giant();
  model::ChainData judge(chain);
  PlantConfig config = reference_config();
  config.step = 0.05e-3;
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, false);
  input.tau_command << 30.0, -20.0, 10.0, 40.0, 4.0, 2.0;
  input.w_H << 20.0, -10.0, 5.0, 0.0, 0.0, 0.0;
  input.dq_p_command << 0.5, -0.3;
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  for (int k = 0; k < 6000; ++k) {
    plant.step(input);
    impulse += config.step * (plant.forces().f_p + input.w_H.head<2>());
  }
  judge.update(plant.q(), plant.dq());
  const Eigen::Vector2d momentum = judge.M().topRows<2>() * plant.dq();
  EXPECT_GT(momentum.norm(), 20.0);
  EXPECT_LT((momentum - impulse).norm(), 1e-3 * momentum.norm());
}

}  // namespace
}  // namespace hg::simulator
