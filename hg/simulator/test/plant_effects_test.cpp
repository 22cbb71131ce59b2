// What real motors, gears and gantries do beside the textbook: cogging, presliding, hysteresis,
// backlash, waviness, a structure that yields.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

constexpr double kPi = std::numbers::pi;

PlantConfig config_with(const JointEffects& effects, double coulomb_friction = 0.0) {
  ActuatorModel actuator = bare_actuator(0.5, 1e4);
  actuator.damping = 20.0;
  actuator.coulomb_friction = coulomb_friction;
  PlantConfig config = one_joint_config(actuator);
  config.effects = {effects};
  return config;
}

Plant plant_of(const PlantConfig& config) {
  const model::ChainModel chain = one_joint(0.1);
  return Plant(config, chain, chain.frame("tip"));
}

// Moves on for `duration`, s, with these torques on motor and link.
void hold(Plant& plant, double motor, double link, double duration, bool brakes_closed = false) {
  PlantInput input = idle(plant.config(), brakes_closed);
  input.tau_command[0] = motor;
  input.w_H[5] = link;
  for (int k = 0; k < std::lround(duration / plant.config().step); ++k) plant.step(input);
}

// Leads the torque of the motor slowly from one value to another and waits.
void lead(Plant& plant, double from, double to) {
  constexpr int kSteps = 4000;
  for (int k = 1; k <= kSteps; ++k) {
    hold(plant, from + (to - from) * k / kSteps, 0.0, plant.config().step);
  }
  hold(plant, to, 0.0, 1.0);
}

// Of a force over a way, positive when work is lost.
struct Loop {
  double area = 0.0, before = 0.0;

  void add(double force, double way) {
    area += force * (way - before);
    before = way;
  }
};

TEST(PlantEffects, CoggingHasItsAmplitudeAndPeriodOfTheMotorAngle) {
  const PlantConfig config = config_with({.cogging = 0.3, .cogging_wave = 240.0});
  Plant plant = plant_of(config);
  hold(plant, 20.0, 0.0, 0.02);
  double largest = 0.0;
  int changes = 0;
  double first = 0.0, last = 0.0, before = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double theta = plant.truth().theta_m[0];
    plant.step(idle(config, false));
    const double torque = plant.truth().tau_motor[0];
    largest = std::max(largest, std::abs(torque));
    if (k > 0 && torque * before < 0.0) {
      ++changes;
      if (changes == 1) first = theta;
      last = theta;
    }
    before = torque;
  }
  EXPECT_NEAR(largest, 0.3, 1e-3);
  ASSERT_GT(changes, 40);
  EXPECT_NEAR((last - first) / (changes - 1), kPi / 240.0, 1e-4);
}

TEST(PlantEffects, CoggingActsOnAMotorWithoutCurrentAndRippleDoesNot) {
  Plant cogs = plant_of(config_with({.cogging = 0.3, .cogging_wave = 240.0}));
  hold(cogs, 0.0, 0.0, 0.001);
  EXPECT_GT(std::abs(cogs.truth().tau_motor[0]), 0.01);
  Plant ripples = plant_of(config_with({.ripple = 0.02, .ripple_wave = 700.0}));
  hold(ripples, 0.0, 0.0, 0.001);
  EXPECT_EQ(ripples.truth().tau_motor[0], 0.0);
  double least = 1e9, most = 0.0;
  for (int k = 0; k < 2000; ++k) {
    hold(ripples, 5.0, 0.0, ripples.config().step);
    least = std::min(least, ripples.truth().tau_motor[0]);
    most = std::max(most, ripples.truth().tau_motor[0]);
  }
  EXPECT_NEAR(least, 5.0 * 0.98, 5e-3);
  EXPECT_NEAR(most, 5.0 * 1.02, 5e-3);
}

TEST(PlantEffects, PhasesBelongToTheSeed) {
  PlantConfig config = config_with({.cogging = 0.3, .cogging_wave = 240.0});
  std::vector<double> torques;
  for (const std::uint64_t seed : {1U, 1U, 2U}) {
    config.seed = seed;
    Plant plant = plant_of(config);
    hold(plant, 0.0, 0.0, 0.00025);
    torques.push_back(plant.truth().tau_motor[0]);
  }
  EXPECT_EQ(torques[0], torques[1]);
  EXPECT_NE(torques[0], torques[2]);
}

TEST(PlantEffects, FrictionIsASpringBeforeItSlips) {
  Plant plant = plant_of(config_with({.bristle_stiffness = 4e4, .bristle_damping = 50.0}, 4.0));
  double before = 0.0;
  for (const double torque : {1.0, 3.0, -3.9, 2.0}) {
    lead(plant, before, torque);
    before = torque;
    EXPECT_NEAR(plant.truth().theta_m[0], torque / 4e4, 1e-9);
    EXPECT_NEAR(plant.truth().dtheta_m[0], 0.0, 1e-9);
  }
  lead(plant, before, 0.0);
  EXPECT_NEAR(plant.truth().theta_m[0], 0.0, 1e-9);
  hold(plant, 4.5, 0.0, 1.0);
  EXPECT_GT(plant.truth().theta_m[0], 0.1);
}

TEST(PlantEffects, FrictionDoesNotCreepUnderALoadThatItHolds) {
  // where LuGre drifts: a load below break-away that trembles
  Plant plant = plant_of(config_with({.bristle_stiffness = 4e4, .bristle_damping = 50.0}, 4.0));
  const PlantInput still = idle(plant.config(), false);
  lead(plant, 0.0, 2.5);
  for (int k = 0; k < 80'000; ++k) {
    PlantInput input = still;
    input.tau_command[0] = 2.5 + std::sin(2.0 * kPi * 20.0 * k * plant.config().step);
    plant.step(input);
  }
  hold(plant, 2.5, 0.0, 1.0);
  EXPECT_NEAR(plant.truth().theta_m[0], 2.5 / 4e4, 1e-9);
}

TEST(PlantEffects, ElementsSlipOneAfterTheOther) {
  Plant plant = plant_of(
      config_with({.bristle_stiffness = 2e4, .bristle_damping = 60.0, .bristles = 3}, 3.0));
  // stiffness / 1, / 2, / 3 with 1 Nm each: they slip at 50, 100 and 150 urad
  struct Point {
    double torque, way;
  };
  double before = 0.0;
  for (const Point& point :
       {Point{1.0 + 0.5 + 1.0 / 3.0, 50e-6}, Point{1.0 + 1.0 + 2.0 / 3.0, 100e-6}}) {
    lead(plant, before, point.torque);
    before = point.torque;
    EXPECT_NEAR(plant.truth().theta_m[0], point.way, 5e-7);  // swings a little where one slips
  }
  lead(plant, before, 2.99);
  EXPECT_NEAR(plant.truth().theta_m[0], 150e-6, 2e-6);
  lead(plant, 2.99, 0.0);  // and leaves some of the way behind
  EXPECT_GT(plant.truth().theta_m[0], 20e-6);
  EXPECT_LT(plant.truth().theta_m[0], 100e-6);
}

// Around a loop of +-way the friction takes 4 friction (way - way to slip).
TEST(PlantEffects, PreslidingLosesTheAreaOfItsLoop) {
  PlantConfig config = config_with({.bristle_stiffness = 4e4, .bristle_damping = 1.0}, 4.0);
  Plant plant = plant_of(config);
  Loop loop;
  double lost = 0.0;
  const double period = 8.0;
  const int steps = static_cast<int>(std::lround(period / config.step));
  for (int k = 0; k < 2 * steps; ++k) {
    // a stiff servo leads the motor along a triangle of +-1 mrad
    const double share = std::fmod(k * config.step / period + 0.25, 1.0);
    const double goal = 1e-3 * (1.0 - 4.0 * std::abs(share - 0.5));
    PlantInput input = idle(config, false);
    input.tau_command[0] =
        5e5 * (goal - plant.truth().theta_m[0]) - 500.0 * plant.truth().dtheta_m[0];
    plant.step(input);
    if (k == steps) loop.area = lost = 0.0;
    loop.add(-plant.forces().tau_friction[0], plant.truth().theta_m[0]);
    lost += config.step * plant.power().coulomb_friction;
    ASSERT_GE(plant.power().coulomb_friction, 0.0);
  }
  const double expected = 4.0 * 4.0 * (1e-3 - 4.0 / 4e4);
  EXPECT_NEAR(loop.area, expected, 0.02 * expected);
  EXPECT_NEAR(lost, expected, 0.02 * expected);
}

TEST(PlantEffects, BacklashLetsTheLinkMoveFreelyBetweenItsFlanks) {
  const double play = 2e-3;
  Plant plant = plant_of(config_with({.backlash = play}));
  hold(plant, 0.0, 2.0, 3.0, true);
  const double ahead = plant.truth().q_m[0];
  EXPECT_NEAR(plant.truth().tau_J[0], -2.0, 1e-6);
  hold(plant, 0.0, -2.0, 3.0, true);
  const double behind = plant.truth().q_m[0];
  EXPECT_NEAR(ahead - behind, play + 2.0 * 2.0 / 1e4, 1e-8);

  // in between nothing is transmitted
  double torque = 0.0;
  int free = 0;
  hold(plant, 0.0, -0.02, 3.0, true);
  PlantInput input = idle(plant.config(), true);
  input.w_H[5] = 0.02;
  while (plant.truth().q_m[0] < behind + 0.5 * play) {
    plant.step(input);
    if (plant.truth().q_m[0] < behind + 2.0 / 1e4 + 1e-5) continue;
    torque = std::max(torque, std::abs(plant.truth().tau_J[0]));
    ++free;
  }
  EXPECT_GT(free, 10);
  EXPECT_EQ(torque, 0.0);
}

TEST(PlantEffects, AnArmWithBacklashHangsInItsFlanks) {
  PlantConfig config = reference_config();
  config.effects.assign(6, {.backlash = 1e-3});
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  const VectorM weight = plant.truth().tau_J;
  for (int k = 0; k < 4000; ++k) plant.step(idle(config, true));
  EXPECT_LT((plant.truth().tau_J - weight).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_LT((plant.truth().q_m - config.q_m_start).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(PlantEffects, HysteresisLosesTheAreaOfItsLoop) {
  const double friction = 1.5, stiffness = 2e4;
  Plant plant = plant_of(config_with({.hysteresis = friction, .hysteresis_stiffness = stiffness}));
  Loop loop;
  double lost = 0.0, largest = 0.0, at_zero = 0.0;
  const double period = 8.0;
  const int steps = static_cast<int>(std::lround(period / plant.config().step));
  for (int k = 0; k < 2 * steps; ++k) {
    PlantInput input = idle(plant.config(), true);
    input.w_H[5] = 12.0 * std::sin(2.0 * kPi * k / steps);
    plant.step(input);
    if (k == steps) loop.area = lost = 0.0;
    const double twist = plant.truth().theta_m[0] - plant.truth().q_m[0];
    loop.add(plant.truth().tau_J[0], twist);
    lost += plant.config().step * plant.power().hysteresis;
    if (k > steps) largest = std::max(largest, twist);
    if (k > steps && k < 1.5 * steps) at_zero = std::max(at_zero, std::abs(twist));
  }
  EXPECT_NEAR(largest, (12.0 - friction) / 1e4, 1e-6);
  const double expected = 4.0 * friction * (largest - friction / stiffness);
  EXPECT_NEAR(loop.area, expected, 0.02 * expected);
  EXPECT_NEAR(lost, expected, 0.02 * expected);
}

// All that can store or take energy.
PlantConfig rough_config() {
  PlantConfig config = reference_config();
  for (const ActuatorModel& a : config.actuators) {
    config.effects.push_back({.bristle_stiffness = a.coulomb_friction / 2e-4,
                              .bristle_damping = 5.0,
                              .bristles = 3,
                              .backlash = 4e-4,
                              .hysteresis = 0.01 * a.torque_max,
                              .hysteresis_stiffness = 0.01 * a.torque_max / 2e-4});
  }
  return config;
}

TEST(PlantEffects, NeverAddEnergy) {
  const model::ChainModel chain = haptic_giant();
  for (const bool brakes_closed : {false, true}) {
    const PlantConfig config = rough_config();
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, false);
    input.w_H << 40.0, 30.0, -20.0, 2.0, 1.0, 1.0;
    for (int k = 0; k < 400; ++k) plant.step(input);
    input = idle(config, brakes_closed);
    for (int k = 0; k < 4; ++k) plant.step(input);
    double energy = plant.energy().sum();
    for (int k = 0; k < 8000; ++k) {
      plant.step(input);
      ASSERT_TRUE(plant.forces().is_exact);
      ASSERT_LT(plant.residual(), 1e-9);
      const double next = plant.energy().sum();
      ASSERT_LE(next, energy + 1e-11) << "step " << k;  // J, rounding
      energy = next;
      ASSERT_GE(plant.power().coulomb_friction, -1e-12);
      ASSERT_GE(plant.power().hysteresis, -1e-12);
      ASSERT_GE(plant.power().joint_damping, -1e-9);
    }
  }
}

TEST(PlantEffects, BalanceOfEnergyClosesWithTheStep) {
  const auto error_of = [](double step) {
    PlantConfig config = rough_config();
    config.step = step;
    config.drive.dead_time = 0.0;
    config.waviness = {{.amplitude = 2e-5, .period = 0.02}, {.amplitude = 1e-5, .period = 0.03}};
    for (std::size_t i = 0; i < 6; ++i) {
      config.effects[i].cogging = 3e-3 * config.actuators[i].torque_max;
      config.effects[i].cogging_wave = 500.0;
      config.effects[i].ripple = 0.01;
      config.effects[i].ripple_wave = 300.0;
    }
    const model::ChainModel chain = haptic_giant();
    Plant plant(config, chain, chain.frame("handle"));
    const VectorM weight = plant.truth().tau_J;
    const double before = plant.energy().sum();
    PlantInput input = idle(config, false);
    double put_in = 0.0, taken = 0.0;
    for (int k = 0; k < std::lround(0.5 / step); ++k) {
      const double t = k * step;
      for (int i = 0; i < 6; ++i) {
        const double rated = config.actuators[i].torque_rated;
        input.tau_command[i] = weight[i] + 0.4 * rated * std::sin(2.0 * kPi * (0.7 + 0.3 * i) * t);
      }
      input.dq_p_command << 0.3 * std::sin(4.0 * t), 0.2 * std::sin(3.0 * t);
      plant.step(input);
      put_in += step * plant.power().put_in();
      taken += step * plant.power().taken();
    }
    EXPECT_GT(std::abs(put_in), 1.0);
    return (plant.energy().sum() - before - (put_in - taken)) / put_in;
  };
  const double coarse = error_of(0.1e-3), fine = error_of(0.05e-3);
  EXPECT_LT(std::abs(fine), 0.02);
  EXPECT_NEAR(coarse / fine, 2.0, 0.4);
}

TEST(PlantEffects, ZeroIsWhatItWasToTheBit) {
  PlantConfig config = reference_config();
  const model::ChainModel chain = haptic_giant();
  Plant plain(config, chain, chain.frame("handle"));
  config.effects.assign(6, JointEffects{});
  config.waviness.assign(2, Waviness{});
  config.seed = 7;
  Plant zero(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, false);
  input.w_H << 10.0, -5.0, 8.0, 1.0, 0.5, -0.4;
  input.dq_p_command << 0.3, -0.2;
  for (int k = 0; k < 2000; ++k) {
    plain.step(input);
    zero.step(input);
  }
  EXPECT_EQ(plain.q(), zero.q());
  EXPECT_EQ(plain.dq(), zero.dq());
  EXPECT_EQ(plain.truth().theta_m, zero.truth().theta_m);
}

TEST(PlantEffects, WavinessMovesTheGantryBesideItsEncoder) {
  PlantConfig config = reference_config();
  config.waviness = {{.amplitude = 1e-4, .period = 0.05}, {}};
  const model::ChainModel chain = haptic_giant();
  Plant plant(config, chain, chain.frame("handle"));
  PlantInput input = idle(config, true);
  input.dq_p_command << 0.2, 0.1;
  double least = 1.0, most = -1.0;
  for (int k = 0; k < 8000; ++k) {
    const double before = plant.dq()[0];
    plant.step(input);
    const double beside = plant.q()[0] - plant.truth().q_p[0];
    least = std::min(least, beside);
    most = std::max(most, beside);
    ASSERT_EQ(plant.q()[1], plant.truth().q_p[1]);
    ASSERT_LT(plant.residual(), 1e-10);
    ASSERT_LT(std::abs(plant.dq()[0] - before), 1.0 * config.step * 10.0);
  }
  EXPECT_NEAR(most, 1e-4, 1e-7);
  EXPECT_NEAR(least, -1e-4, 1e-7);
  EXPECT_NEAR(plant.truth().dq_p[0], 0.2, 1e-3);
}

// The whole arm on an axis that yields rings with the frequency that its stiffness was made for.
TEST(PlantEffects, AnAxisThatYieldsRingsWithItsFrequency) {
  model::ChainOptions options;
  options.gravity = false;
  options.passive = {{.behind = "ppu1", .name = "sway", .axis = {}}};
  model::ChainData chain(
      model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf", options));
  ASSERT_EQ(chain.model().joints().size(), 9u);
  EXPECT_EQ(chain.model().joint("sway"), 1);
  chain.update(Eigen::VectorXd::Zero(9), Eigen::VectorXd::Zero(9));
  EXPECT_NEAR(chain.M()(1, 1), chain.M()(0, 0), 1e-6);
  const double omega = 2.0 * kPi * 12.0, inertia = chain.M()(1, 1), ratio = 0.01;
  PlantConfig config = reference_config();
  config.step = 0.05e-3;
  config.drive.dead_time = 0.0;
  config.gantry = {0, 2};
  config.manipulator = {3, 4, 5, 6, 7, 8};
  config.flexible = {
      {.joint = 1, .stiffness = omega * omega * inertia, .damping = 2.0 * ratio * omega * inertia}};
  for (ActuatorModel& a : config.actuators) a.stiffness *= 1e4;  // the arm is one body
  Plant plant(config, chain.model(), chain.model().frame("handle"));
  PlantInput input = idle(config, true);
  input.w_H[0] = 100.0;
  for (int k = 0; k < 100; ++k) plant.step(input);
  input.w_H.setZero();
  std::vector<double> peaks, times;
  double before = 0.0, last = 0.0;
  for (int k = 0; k < 40'000; ++k) {
    plant.step(input);
    const double q = plant.q()[1];
    if (last > before && last >= q) {
      peaks.push_back(last);
      times.push_back(k * config.step);
    }
    before = last;
    last = q;
  }
  ASSERT_GT(peaks.size(), 12u);
  EXPECT_NEAR(10.0 / (times[11] - times[1]), 12.0, 0.05);
  const double step_damping = 0.5 * omega * config.step;
  EXPECT_NEAR(std::log(peaks[1] / peaks[11]) / (20.0 * kPi), ratio + step_damping, 5e-4);
  EXPECT_EQ(plant.truth().q_p[0], 0.0);
}

}  // namespace
}  // namespace hg::simulator
