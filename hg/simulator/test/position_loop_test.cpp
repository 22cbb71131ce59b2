#include "hg/simulator/plant/position_loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/simulator/test/plant_setup.h"
#include "hg/simulator/test/simulation_setup.h"

namespace hg::simulator {
namespace {

constexpr double kStep = 0.25e-3;

ActuatorModel joint_with_friction() {
  ActuatorModel actuator = bare_actuator(0.5, 20e3);
  actuator.damping = 10.0;
  actuator.coulomb_friction = 5.0;
  actuator.viscous_friction = 3.0;
  return actuator;
}

Plant position_drive(const ActuatorModel& actuator) {
  PlantConfig config = one_joint_config(actuator);
  config.position_loop = PositionLoopConfig{.position_Hz = 10.0, .speed_Hz = 50.0};
  const model::ChainModel chain = one_joint(1.0);
  return {config, chain, chain.frame("tip")};
}

DriveReference at(double q, double dq, double ddq) {
  return {VectorM::Constant(1, q), VectorM::Constant(1, dq), VectorM::Constant(1, ddq)};
}

PlantInput towards(const DriveReference& reference, double torque = 0.0) {
  PlantInput input;
  input.tau_command = VectorM::Zero(1);
  input.reference = reference;
  input.brakes_closed = false;
  input.w_H[5] = torque;  // about the axis of the joint
  return input;
}

TEST(PositionLoop, FollowsASineWithTheErrorThatFrictionLeaves) {
  Plant plant = position_drive(joint_with_friction());
  double worst = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double w = 2.0 * M_PI, t = k * kStep;
    plant.step(towards(at(0.2 * (1.0 - std::cos(w * t)), 0.2 * w * std::sin(w * t),
                          0.2 * w * w * std::cos(w * t))));
    const double now = (k + 1) * kStep;
    worst = std::max(worst, std::abs(plant.truth().q_m[0] - 0.2 * (1.0 - std::cos(w * now))));
  }
  EXPECT_LT(worst, 5e-3);
  EXPECT_GT(worst, 1e-4) << "a real drive has an error";
}

TEST(PositionLoop, AHandTwistsTheGearAndNotTheMotor) {
  Plant plant = position_drive(bare_actuator(0.5, 20e3));
  for (int k = 0; k < 20000; ++k) plant.step(towards(at(0.0, 0.0, 0.0), 10.0));
  EXPECT_NEAR(plant.truth().theta_m[0], 0.0, 1e-5);
  EXPECT_NEAR(plant.truth().q_m[0], 10.0 / 20e3, 1e-5);
}

TEST(PositionLoop, ItsTorqueEndsAtThatOfTheMotor) {
  ActuatorModel weak = bare_actuator(0.5, 20e3);
  weak.torque_max = 8.0;
  Plant plant = position_drive(weak);
  for (int k = 0; k < 4000; ++k) plant.step(towards(at(0.0, 0.0, 0.0), 10.0));
  EXPECT_NEAR(plant.truth().tau_motor[0], -8.0, 1e-9);
  EXPECT_GT(plant.truth().q_m[0], 0.1) << "the hand is stronger and pushes it away";
}

TEST(DriveInterpolator, ReachesACommandAPeriodAfterItsArrivalAndContinuesIt) {
  DriveInterpolator drive(1e-3);
  drive.take(at(1.0, 2.0, 4.0));
  EXPECT_NEAR(drive.advance(0.5e-3).dq[0], 2.0 - 2e-3, 1e-12);
  EXPECT_NEAR(drive.advance(0.5e-3).q[0], 1.0, 1e-12);
  EXPECT_NEAR(drive.advance(2e-3).q[0], 1.0 + 4e-3 + 8e-6, 1e-12) << "no successor";
}

// A sine whose commands stay away for up to 8 ms, at the worst moment: its acceleration turns.
TEST(DriveInterpolator, AGapInTheCommandsStepsNeitherPositionNorSpeed) {
  constexpr double kPeriod = 1e-3, w = 40.0, kMost = 0.2 * w * w;
  for (const int periods : {1, 2, 5, 8}) {
    DriveInterpolator drive(kPeriod);
    DriveReference before;
    for (int k = 0; k < 400; ++k) {
      const double t = (k + 1) * kPeriod;
      const bool is_lost = k >= 150 && k < 150 + periods;
      if (!is_lost) {
        drive.take(at(0.2 * std::sin(w * t), 0.2 * w * std::cos(w * t), -kMost * std::sin(w * t)));
      }
      const DriveReference now = drive.advance(kPeriod);
      if (k > 0) {
        EXPECT_LT(std::abs(now.dq[0] - before.dq[0]), 1.3 * kMost * kPeriod) << periods << " " << k;
        EXPECT_LT(std::abs(now.q[0] - before.q[0] - kPeriod * now.dq[0]),
                  kMost * kPeriod * kPeriod);
      }
      before = now;
      const bool has_caught_up = k > 151 + periods + 100;
      if (k < 150 || has_caught_up) {
        EXPECT_NEAR(now.q[0], 0.2 * std::sin(w * t), 1e-9);
      }
    }
  }
}

TEST(DriveInterpolator, WithoutPowerTheNextCommandIsTakenAsItIs) {
  DriveInterpolator drive(1e-3);
  drive.take(at(1.0, 0.0, 0.0));
  drive.advance(20e-3);
  drive.rest();
  EXPECT_FALSE(drive.has_command());
  drive.take(at(2.0, 0.0, 0.0));
  EXPECT_DOUBLE_EQ(drive.advance(1e-3).q[0], 2.0);
}

TEST(Simulation, PositionDrivesReportTheirMotorsAndNoTorques) {
  SimulatorConfig config = elastic_world();
  elastic(config).position_loop = PositionLoopConfig{};
  config.sensed.has_position_drives = true;
  config.sensors = ideal_sensors();
  Simulation device = make(config);
  for (int k = 0; k < 200; ++k) device.step(hold(device));
  const SensorFrame& sensors = device.sensors();
  EXPECT_EQ(sensors.theta_m.size(), 0);
  EXPECT_EQ(sensors.tau_m.size(), 0);
  EXPECT_EQ(sensors.temperature_m.size(), 0);
  const Truth& truth = device.truth();
  EXPECT_NEAR(sensors.q_m[1], truth.theta_m[1], 1e-12);
  EXPECT_GT((truth.theta_m - truth.q_m).lpNorm<Eigen::Infinity>(), 1e-4)
      << "the weight twists the gear";
}

TEST(Simulation, PositionDrivesAreAsLateAsTheirCommands) {
  const auto moved_after = [](double latency) {
    SimulatorConfig config = elastic_world();
    elastic(config).position_loop = PositionLoopConfig{};
    config.sensed.has_position_drives = true;
    config.latency = latency;
    Simulation device = make(config);
    const double start = device.truth().q_m[0];
    for (int k = 0; k < 100; ++k) {
      CommandFrame command = hold(device);
      command.q_m[0] = start + 0.01;
      device.step(command);
      if (std::abs(device.truth().q_m[0] - start) > 1e-4) return k;
    }
    return 100;
  };
  EXPECT_EQ(moved_after(8e-3) - moved_after(0.0), 8);
}

// A joint without ends where its encoder begins a new turn: the answer to what it shows holds it.
TEST(Simulation, PositionDrivesGoTheShortWayToWhatEncodersShow) {
  SimulatorConfig config = elastic_world();
  elastic(config).position_loop = PositionLoopConfig{};
  elastic(config).q_m_start[0] = M_PI + 1e-4;
  config.sensed.has_position_drives = true;
  Simulation device = make(config);
  EXPECT_NEAR(device.sensors().q_m[0], -M_PI, 1e-3);
  for (int k = 0; k < 200; ++k) {
    CommandFrame command = hold(device);
    command.q_m = device.sensors().q_m;
    device.step(command);
  }
  EXPECT_NEAR(device.truth().q_m[0], M_PI, 1e-3);
}

}  // namespace
}  // namespace hg::simulator
