#include "hg/simulator/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/simulator/test/simulation_setup.h"

namespace hg::simulator {
namespace {

constexpr double kPeriod = 1e-3;  // s

TEST(IdealSimulation, TheGantryWaitsForItsDeadTimeThenFollowsWithItsLag) {
  SimulatorConfig world = ideal_world();
  ideal(world).drive.ddq_max = 1e9;  // lag only
  Simulation device = make(world);
  CommandFrame command = hold(device);
  command.dq_p[0] = 1.0;
  for (int k = 0; k < 4; ++k) device.step(command);
  EXPECT_EQ(device.sensors().q_p[0], 0.0);
  double before = 0.0;
  for (int k = 0; k < 40; ++k) {
    before = device.sensors().q_p[0];
    device.step(command);
  }
  const double speed = (device.sensors().q_p[0] - before) / kPeriod;
  EXPECT_NEAR(speed, 1.0 - std::exp(-1.0), 0.02);  // one time constant later
}

TEST(IdealSimulation, TheGantryKeepsItsAccelerationAndSpeedRating) {
  SimulatorConfig world = ideal_world();
  const DriveModel& drive = ideal(world).drive;
  Simulation device = make(world);
  CommandFrame command = hold(device);
  command.dq_p[1] = 9.0;
  double q = 0.0, dq = 0.0;
  for (int k = 0; k < 2000; ++k) {
    device.step(command);
    const double speed = (device.sensors().q_p[1] - q) / kPeriod;
    ASSERT_LE(speed - dq, drive.ddq_max * kPeriod + 1e-9);
    q = device.sensors().q_p[1];
    dq = speed;
  }
  EXPECT_NEAR(dq, drive.dq_max, 1e-6);
}

TEST(IdealSimulation, TheSlipRingJointShowsItsAngleWithinOneTurn) {
  Simulation device = make(ideal_world());
  CommandFrame command = hold(device);
  command.q_m[0] = 7.0;
  command.q_m[2] = -2.5;
  device.step(command);
  EXPECT_NEAR(device.sensors().q_m[0], 7.0 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(device.sensors().q_m[2], -2.5);
  EXPECT_EQ(device.truth().q_m[0], 7.0);
  EXPECT_EQ(device.sensors().sequence, 1u);
  EXPECT_DOUBLE_EQ(device.sensors().time_s, 1e-3);
}

TEST(IdealSimulation, WithoutPowerTheJointsStayAndTheGantryBrakes) {
  SimulatorConfig world = ideal_world();
  Simulation device = make(world);
  CommandFrame command = hold(device);
  command.dq_p[0] = 1.0;
  for (int k = 0; k < 500; ++k) device.step(command);
  command.enable = false;
  command.q_m.setConstant(1.0);
  for (int k = 0; k < 1000; ++k) device.step(command);
  const double at_rest = device.sensors().q_p[0];
  device.step(command);
  EXPECT_NEAR(device.sensors().q_p[0], at_rest, 1e-9);
  EXPECT_EQ(device.sensors().q_m[1], ideal(world).q_m_start[1]);
  EXPECT_TRUE(device.sensors().dq_m.isZero());
}

TEST(IdealSimulation, HasNeitherMotorSideNorSpringTorques) {
  const Simulation device = make(ideal_world());
  EXPECT_EQ(device.sensors().theta_m.size(), 0);
  EXPECT_EQ(device.sensors().tau_m.size(), 0);
}

TEST(IdealSimulation, TheSensorShowsTheHandsWrenchInItsOwnFrame) {
  SimulatorConfig world = ideal_world();
  world.sensed.T_H_S.p = {0.0, 0.0, -0.1};
  Simulation device = make(world, mouse());
  const Pose T_B_H = device.truth().T_B_H;

  CommandFrame command = hold(device);
  command.hand_target.active = true;
  command.hand_target.p_B = T_B_H.p + Eigen::Vector3d(0.1, 0.0, 0.0);
  device.step(command);
  EXPECT_FALSE(device.sensors().dead_man);  // not held yet
  EXPECT_EQ(device.sensors().w_S.norm(), 0.0);
  for (int k = 0; k < 8000; ++k) device.step(command);
  EXPECT_TRUE(device.sensors().dead_man);
  const Eigen::Vector3d f_B(0.1 * 200.0, 0.0, 0.0);  // 250 N/m of the arm, 1000 of the grip
  EXPECT_LT((device.sensors().w_S.head<3>() - T_B_H.R.transpose() * f_B).norm(), 1e-9);
  const Eigen::Vector3d n_S = -world.sensed.T_H_S.p.cross(T_B_H.R.transpose() * f_B);
  EXPECT_LT((device.sensors().w_S.tail<3>() - n_S).norm(), 1e-9);
}

TEST(Simulation, TheTruthHasTheBodyOfAPersonWhoWalksFromTheGraspOn) {
  const model::ChainModel body = model::ChainModel::free_body({}, {.gravity = false});
  person::PersonConfig config;
  config.script.grasp_s = 0.1;
  config.script.walk.kind = person::WalkKind::kCircle;
  for (const auto kind : {person::PersonKind::kScript, person::PersonKind::kMouse}) {
    config.kind = kind;
    Simulation device = make(ideal_world(), person::Person(config, body, body.frame("handle"), {}));
    const bool walks = kind == person::PersonKind::kScript;
    for (int k = 0; k < 1000; ++k) {
      EXPECT_EQ(device.truth().walker.is_walking, walks && k >= 100) << k;
      device.step(hold(device));
    }
    const WalkerReport& truth = device.truth().walker;
    const person::Walker& walker = device.person().walker();
    EXPECT_EQ(Eigen::Vector2d(truth.x, truth.y), walker.body());
    EXPECT_EQ(truth.heading, walks ? walker.heading() : 0.0);
    EXPECT_EQ(truth.hold, walks ? 1.0 : 0.0);
    EXPECT_EQ(walker.speed() > 0.1, walks);
  }
}

// As the watchdog of real drives: that commands come again does not move it.
TEST(Simulation, WithoutNewCommandsTheDrivesStayOffUntilTheyAreCommandedOff) {
  for (const SimulatorConfig& world : {elastic_world(), ideal_world()}) {
    Simulation device = make(world);
    CommandFrame command;
    const auto play = [&](int periods, bool enable) {
      for (int k = 0; k < periods; ++k) {
        command = hold(device);
        command.enable = enable;
        command.dq_p.setConstant(0.3);
        device.step(command);
      }
      return device.sensors().driver_fault;
    };
    EXPECT_EQ(play(100, true), FaultCode::kNone);
    for (int k = 0; k < 9; ++k) device.step(command);
    EXPECT_EQ(play(100, true), FaultCode::kNone);
    EXPECT_GT(device.truth().dq_p[0], 0.2);
    for (int k = 0; k < 11; ++k) device.step(command);
    EXPECT_EQ(device.sensors().driver_fault, FaultCode::kCommandsLost);
    EXPECT_EQ(play(1000, true), FaultCode::kCommandsLost);
    EXPECT_LT(device.truth().dq_p.norm(), 1e-3);
    EXPECT_EQ(play(2, false), FaultCode::kNone);
    EXPECT_EQ(play(100, true), FaultCode::kNone);
    EXPECT_GT(device.truth().dq_p[0], 0.1);
  }
}

// A client that has gone leaves the device with commands that have no values.
TEST(Simulation, AnEmptyCommandBringsItToRest) {
  for (const SimulatorConfig& world : {elastic_world(), ideal_world()}) {
    Simulation device = make(world);
    CommandFrame command = hold(device);
    command.dq_p.setConstant(0.3);
    for (int k = 0; k < 100; ++k) {
      command.sequence = device.sensors().sequence;
      device.step(command);
    }
    EXPECT_GT(device.truth().dq_p[0], 0.1);
    for (int k = 0; k < 1000; ++k) device.step({});
    EXPECT_LT(device.truth().dq_p.norm(), 1e-3);
  }
}

TEST(Simulation, TheLatencyIsAtMostSixtyFourPeriods) {
  SimulatorConfig world = elastic_world();
  world.latency = 64e-3;
  EXPECT_NO_THROW(make(world));
  world.latency = 64.25e-3;
  EXPECT_THROW(make(world), SetupError);
}

// Steps of the plant until a torque command is felt by the motor, as whole periods show it: with a
// latency in the middle of a period the motor has had the rest of the period to move.
double speed_after_one_period(double latency, int periods) {
  SimulatorConfig world = elastic_world();
  world.latency = latency;
  elastic(world).current_lag = 0.0;
  for (ActuatorModel& actuator : elastic(world).actuators) {
    actuator.coulomb_friction = actuator.load_friction = 0.0;
  }
  Simulation device = make(world);
  for (int k = 0; k < 30; ++k) device.step(hold(device));
  const double before = device.truth().dtheta_m[0];
  for (int k = 0; k < periods; ++k) {
    CommandFrame command = hold(device);
    command.tau_m[0] += 100.0;
    device.step(command);
  }
  return device.truth().dtheta_m[0] - before;
}

TEST(Simulation, ATorqueIsFeltAfterItsLatencyInStepsOfThePlant) {
  EXPECT_LT(std::abs(speed_after_one_period(1e-3, 1)), 1e-9);
  const double all = speed_after_one_period(0.0, 1);
  EXPECT_NEAR(all, 100.0 / 1.46 * kPeriod, 0.05 * all);  // springs hardly pull yet
  for (const int quarters : {1, 2, 3}) {
    SCOPED_TRACE(quarters);
    const double share = (4.0 - quarters) / 4.0;
    EXPECT_NEAR(speed_after_one_period(quarters * 0.25e-3, 1), share * all, 0.05 * all);
  }
  EXPECT_LT(std::abs(speed_after_one_period(2e-3, 2)), 1e-9);
  EXPECT_NEAR(speed_after_one_period(2e-3, 3), all, 0.05 * all);
}

// Sample k is answered by command k, which works from the sample on that comes `latency` later.
TEST(Simulation, TheAnsweredSequenceShowsTheLatencyInPeriods) {
  for (const auto& [latency, periods] : std::vector<std::pair<double, std::uint64_t>>{
           {0.25e-3, 1}, {1e-3, 1}, {1.25e-3, 2}, {2e-3, 2}, {3e-3, 3}}) {
    SCOPED_TRACE(latency);
    SimulatorConfig world = elastic_world();
    world.latency = latency;
    Simulation device = make(world);
    for (int k = 0; k < 20; ++k) device.step(hold(device));
    EXPECT_EQ(device.sensors().sequence - device.sensors().answered_sequence, periods);
  }
}

TEST(Simulation, BrakesHoldTheMotorsOfADisabledDeviceAgainstAnyHand) {
  Simulation device = make(elastic_world(), mouse());
  CommandFrame command = hold(device);
  command.enable = false;
  command.tau_m.setConstant(30.0);
  command.hand_target.active = true;
  command.hand_target.p_B = device.truth().T_B_H.p + Eigen::Vector3d(0.5, 0.5, 0.5);  // > 60 N
  const VectorM theta = device.truth().theta_m, q = device.truth().q_m;
  for (int k = 0; k < 2000; ++k) {
    command.sequence = device.sensors().sequence;
    device.step(command);
  }
  EXPECT_GT(device.truth().w_H.head<3>().norm(), 55.0);
  EXPECT_LT((device.truth().theta_m - theta).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_GT((device.truth().q_m - q).lpNorm<Eigen::Infinity>(), 1e-3);  // the springs give way

  // without brakes and torques the forearm falls
  command.enable = true;
  command.tau_m.setZero();
  for (int k = 0; k < 200; ++k) {
    command.sequence = device.sensors().sequence;
    device.step(command);
  }
  EXPECT_GT((device.truth().theta_m - theta).lpNorm<Eigen::Infinity>(), 1e-2);
}

TEST(Simulation, TheGantryOfADisabledDeviceBrakesOnAnyCommand) {
  Simulation device = make(elastic_world());
  CommandFrame command = hold(device);
  command.dq_p[0] = 0.5;
  for (int k = 0; k < 400; ++k) device.step(command);
  EXPECT_GT(device.truth().dq_p[0], 0.4);
  command.enable = false;
  for (int k = 0; k < 600; ++k) device.step(command);
  EXPECT_NEAR(device.truth().dq_p[0], 0.0, 1e-3);
}

TEST(Simulation, TheSensorCarriesThePayloadWithItsWeightAndInertia) {
  SimulatorConfig world = elastic_world();
  world.sensed.payload.mass = 1.18;
  Simulation device = make(world);
  EXPECT_NEAR(device.sensors().w_S.head<3>().norm(), 1.18 * 9.81, 1e-6);
  const Eigen::Vector3d down_S = device.truth().T_B_H.R.transpose() * -Eigen::Vector3d::UnitZ();
  EXPECT_LT((device.sensors().w_S.head<3>() / (1.18 * 9.81) - down_S).norm(), 1e-6);
  EXPECT_LT((device.sensors().a_S + 9.81 * down_S).norm(), 1e-6);

  CommandFrame command = hold(device);
  command.dq_p[0] = 0.5;
  double most = 0.0;
  for (int k = 0; k < 60; ++k) {
    command.sequence = device.sensors().sequence;
    device.step(command);
    const Eigen::Vector3d expected = -1.18 * device.sensors().a_S;
    ASSERT_LT((device.sensors().w_S.head<3>() - expected).norm(), 1e-9);
    most = std::max(most, (device.sensors().w_S.head<3>() - 1.18 * 9.81 * down_S).norm());
  }
  EXPECT_GT(most, 1.18 * 0.5);  // the gantry accelerates with up to 2.5 m/s^2
}

// every number of a sample that sensors with noise make
std::vector<double> numbers(const SensorFrame& frame) {
  std::vector<double> all;
  const auto add = [&](const auto& v) { all.insert(all.end(), v.data(), v.data() + v.size()); };
  add(frame.q_m);
  add(frame.dq_m);
  add(frame.theta_m);
  add(frame.tau_m);
  add(frame.q_p);
  add(frame.w_S);
  add(frame.a_S);
  add(frame.omega_S);
  return all;
}

SimulatorConfig noisy_world(std::uint64_t seed) {
  SimulatorConfig world = elastic_world();
  world.sensors = SensorsConfig{.seed = seed};
  return world;
}

std::vector<double> numbers_after(Simulation device, int periods) {
  for (int k = 0; k < periods; ++k) device.step(hold(device));
  return numbers(device.sensors());
}

TEST(Simulation, TheSameSeedGivesTheSameBitsAndAnotherSeedOthers) {
  const std::vector<double> first = numbers_after(make(noisy_world(1)), 200);
  EXPECT_EQ(first, numbers_after(make(noisy_world(1)), 200));
  EXPECT_NE(first, numbers_after(make(noisy_world(2)), 200));
}

TEST(Simulation, ACopyContinuesWithTheSameBits) {
  Simulation device = make(noisy_world(3), mouse());
  CommandFrame command = hold(device);
  command.hand_target.active = true;
  command.hand_target.p_B = device.truth().T_B_H.p + Eigen::Vector3d(0.1, 0.0, 0.05);
  const auto live = [&](Simulation& simulation, int periods) {
    for (int k = 0; k < periods; ++k) {
      command.sequence = simulation.sensors().sequence;
      command.tau_m = simulation.sensors().tau_m;
      simulation.step(command);
    }
    return numbers(simulation.sensors());
  };
  live(device, 900);  // the hand pulls since 0.7 s
  Simulation copy = device;
  const std::vector<double> expected = live(device, 300);
  EXPECT_EQ(live(copy, 300), expected);
  Simulation late = make(noisy_world(3), mouse());
  EXPECT_EQ(live(late, 1200), expected);
}

TEST(Simulation, StepsWithoutAllocating) {
  Simulation device = make(noisy_world(1), mouse());
  CommandFrame command = hold(device);
  command.hand_target.active = true;
  device.step(command);
  const AllocationCounter counter;
  for (int k = 0; k < 1000; ++k) device.step(command);
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace hg::simulator
