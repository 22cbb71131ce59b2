#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

const SimulationTarget kDevice = {
    .gantry = {"slide"}, .manipulator = {"turn", "lift"}, .handle = "hand", .chain = {}};

// base - slide - [bend, where there is one] - turn - lift - hand
std::string urdf(const std::string& bend) {
  const std::string mass =
      "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
      "</inertial></link>";
  const auto joint = [&](const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' " +
           "velocity='1' effort='1'/></joint><link name='" + child + "'>" + mass;
  };
  std::string text =
      "<robot name='arm'><link name='base'/>" + joint("slide", "prismatic", "base", "trolley");
  if (!bend.empty()) text += joint("bend", bend, "trolley", "frame");
  text += joint("turn", "continuous", bend.empty() ? "trolley" : "frame", "arm");
  return text + joint("lift", "prismatic", "arm", "hand") + "</robot>";
}

SimulationConfig load(const std::string& yaml, const SimulationTarget& device = kDevice) {
  SourceReader reader({{"simulation.yaml", yaml},
                       {"base.yaml",
                        "seed: 5\ngear_ratio: {lift: 50}\nfactors: {mass: 2}\n"
                        "motors: {cogging: 0.01, ripple: 0.02}\n"
                        "sensors: {ideal: true, torque_sensor: {noise: 0.1}}\n"},
                       {"second.yaml", "base: base.yaml\n"},
                       {"plain.yaml", "urdf: plain.urdf\n"},
                       {"yielding.yaml", "structure: {slide: {frequency_Hz: 9}}\n"},
                       {"bent.urdf", urdf("revolute")},
                       {"slid.urdf", urdf("prismatic")},
                       {"free.urdf", urdf("floating")},
                       {"plain.urdf", urdf("")}});
  return load_simulation("simulation.yaml", reader, device);
}

// What is wrong with the file; the text starts in line 2.
std::string message(const std::string& yaml, const SimulationTarget& device = kDevice) {
  return message_of([&] { load("sensors: {}\n" + yaml, device); });
}

constexpr const char* kDrives =
    "drives:\n"
    "  position_Hz: 8\n"
    "  latency_s: 0.003\n"
    "  actuators:\n"
    "    turn: &drive {rotor_inertia_kg_m2: 1, stiffness_Nm_per_rad: 9000, torque_max_Nm: 50, "
    "torque_rated_Nm: 20, full_torque_to_rad_per_s: 2, no_load_rad_per_s: 4}\n";

TEST(SimulationFile, DrivesThatFollowPositionsHaveMotors) {
  const SimulationConfig simulation =
      load(std::string("sensors: {}\n") + kDrives + "    lift: *drive\n");
  ASSERT_EQ(simulation.drives.actuators.size(), 2u);
  EXPECT_EQ(simulation.drives.actuators[1].torque_max, 50.0);
  EXPECT_EQ(simulation.drives.loop.position_Hz, 8.0);
  EXPECT_EQ(simulation.drives.latency, 0.003);
}

TEST(SimulationFile, DrivesNeedAMotorForEveryJointAndLoopsApart) {
  EXPECT_NE(message(kDrives).find("all joints of the manipulator need one"), std::string::npos);
  EXPECT_NE(message("drives: {position_Hz: 30, speed_Hz: 50}\n").find("at least twice position_Hz"),
            std::string::npos);
}

TEST(SimulationFile, ADeviceWithActuatorsOfItsOwnNeedsNoOthers) {
  SimulationTarget device = kDevice;
  device.has_actuators = true;
  EXPECT_NE(message(std::string(kDrives) + "    lift: *drive\n", device)
                .find("the 'actuators' of this device stand in device.yaml"),
            std::string::npos);
}

TEST(SimulationFile, AnotherUrdfThanThatOfItsBaseHasItsOwnJoints) {
  const SimulationConfig simulation = load(
      "base: plain.yaml\nurdf: bent.urdf\n"
      "flexible: {bend: {stiffness_Nm_per_rad: 10, damping_Nms_per_rad: 1}}\n");
  ASSERT_EQ(simulation.flexible.size(), 1u);
  EXPECT_EQ(simulation.flexible[0].stiffness, 10.0);
}

SimulationConfig shipped_simulation() {
  SourceReader disk;
  return load_simulation("models/haptic_giant/simulation.yaml", disk,
                         {.gantry = {"ppu1", "ppu2"},
                          .manipulator = {"m1", "m2", "m3", "m4", "m5", "m6"},
                          .handle = "handle",
                          .chain = {}});
}

TEST(SimulationFile, TheShippedOneHasTheNumbersOfTheHandbook) {
  const SimulationConfig shipped = shipped_simulation();
  EXPECT_EQ(shipped.step_s, 0.25e-3);
  EXPECT_NEAR(1.0 / shipped.factors.stiffness, 1.1, 1e-3);  // [C] 0: the controller's model
  EXPECT_NEAR(1.0 / shipped.factors.friction, 0.75, 1e-3);
  EXPECT_NEAR(1.0 / shipped.factors.mass, 0.95, 1e-3);
  EXPECT_EQ(shipped.gear_ratio[0], 121.0);
  EXPECT_EQ(shipped.gear_ratio[5], 101.0);
  EXPECT_FALSE(shipped.chain);
}

// tests and other devices start from the sensors of the code
TEST(SimulationFile, TheShippedEncodersAndInertialSensorsAreThoseOfTheCode) {
  const simulator::SensorsConfig sensors = shipped_simulation().sensors;
  const simulator::SensorsConfig standard;
  for (auto encoder :
       {&simulator::SensorsConfig::link_encoder, &simulator::SensorsConfig::motor_encoder,
        &simulator::SensorsConfig::gantry_encoder}) {
    EXPECT_DOUBLE_EQ((sensors.*encoder).resolution, (standard.*encoder).resolution);
    EXPECT_DOUBLE_EQ((sensors.*encoder).offset, (standard.*encoder).offset);
    EXPECT_DOUBLE_EQ((sensors.*encoder).error_1, (standard.*encoder).error_1);
    EXPECT_DOUBLE_EQ((sensors.*encoder).error_2, (standard.*encoder).error_2);
    EXPECT_DOUBLE_EQ((sensors.*encoder).period, (standard.*encoder).period);
  }
  for (auto part :
       {&simulator::SensorsConfig::accelerometer, &simulator::SensorsConfig::gyroscope}) {
    EXPECT_DOUBLE_EQ((sensors.*part).noise, (standard.*part).noise);
    EXPECT_DOUBLE_EQ((sensors.*part).bias_instability, (standard.*part).bias_instability);
    EXPECT_DOUBLE_EQ((sensors.*part).random_walk, (standard.*part).random_walk);
    EXPECT_DOUBLE_EQ((sensors.*part).bias, (standard.*part).bias);
    EXPECT_DOUBLE_EQ((sensors.*part).temperature_drift, (standard.*part).temperature_drift);
    EXPECT_DOUBLE_EQ((sensors.*part).scale_error, (standard.*part).scale_error);
    EXPECT_DOUBLE_EQ((sensors.*part).misalignment, (standard.*part).misalignment);
    EXPECT_DOUBLE_EQ((sensors.*part).range, (standard.*part).range);
    EXPECT_DOUBLE_EQ((sensors.*part).resolution, (standard.*part).resolution);
  }
}

TEST(SimulationFile, TheShippedForceAndTemperatureSensorsAreThoseOfTheCode) {
  const simulator::SensorsConfig sensors = shipped_simulation().sensors;
  const simulator::SensorsConfig standard;
  EXPECT_DOUBLE_EQ(sensors.torque.noise, standard.torque.noise);
  EXPECT_DOUBLE_EQ(sensors.torque.gain_error, standard.torque.gain_error);
  EXPECT_DOUBLE_EQ(sensors.torque.offset, standard.torque.offset);
  EXPECT_DOUBLE_EQ(sensors.torque.ripple, standard.torque.ripple);
  EXPECT_DOUBLE_EQ(sensors.torque.range, standard.torque.range);
  EXPECT_DOUBLE_EQ(sensors.torque.resolution, standard.torque.resolution);
  EXPECT_EQ(sensors.wrench.full_scale, standard.wrench.full_scale);
  EXPECT_DOUBLE_EQ(sensors.wrench.force_noise, standard.wrench.force_noise);
  EXPECT_DOUBLE_EQ(sensors.wrench.torque_noise, standard.wrench.torque_noise);
  EXPECT_DOUBLE_EQ(sensors.wrench.gain_error, standard.wrench.gain_error);
  EXPECT_DOUBLE_EQ(sensors.wrench.cross_talk, standard.wrench.cross_talk);
  EXPECT_DOUBLE_EQ(sensors.wrench.bias, standard.wrench.bias);
  EXPECT_DOUBLE_EQ(sensors.wrench.bias_walk, standard.wrench.bias_walk);
  EXPECT_DOUBLE_EQ(sensors.wrench.temperature_drift, standard.wrench.temperature_drift);
  EXPECT_DOUBLE_EQ(sensors.wrench.range, standard.wrench.range);
  EXPECT_DOUBLE_EQ(sensors.wrench.resolution, standard.wrench.resolution);
  for (auto filter : {sensors.wrench.filter, sensors.imu_filter}) {
    EXPECT_DOUBLE_EQ(filter.average, standard.imu_filter.average);
    EXPECT_DOUBLE_EQ(filter.delay, standard.imu_filter.delay);
  }
  EXPECT_DOUBLE_EQ(sensors.temperature.environment, standard.temperature.environment);
  EXPECT_DOUBLE_EQ(sensors.temperature.self_heating, standard.temperature.self_heating);
  EXPECT_DOUBLE_EQ(sensors.temperature.time_constant, standard.temperature.time_constant);
  EXPECT_DOUBLE_EQ(sensors.temperature.fluctuation, standard.temperature.fluctuation);
  EXPECT_DOUBLE_EQ(sensors.temperature.time_on, standard.temperature.time_on);
}

constexpr const char* kEverySensorKey = R"(
sensors:
  link_encoder: {resolution_rad: 1, offset_rad: 2, error_1_rad: 3, error_2_rad: 4}
  motor_encoder: {resolution_rad: 5, offset_rad: 6, error_1_rad: 7, error_2_rad: 8}
  gantry_encoder: {resolution_m: 9, offset_m: 10, error_1_m: 11, error_2_m: 12, period_m: 13}
  torque_sensor: {noise: 14, gain_error: 15, offset: 16, ripple: 17, range: .inf, resolution: 18}
  wrench_sensor: {force_N: [19, 20, 21], torque_Nm: [22, 23, 24], noise_N_per_sqrt_Hz: 25,
    noise_Nm_per_sqrt_Hz: 26, gain_error: 27, cross_talk: 28, bias: 29, bias_walk_1_per_sqrt_s: 30,
    temperature_drift_1_per_K: 31, range: 32, resolution: 33, filter: {average_s: 0.0034, delay_s: 0.0035}}
  accelerometer: {noise_m_per_s2_per_sqrt_Hz: 36, bias_instability_m_per_s2: 37,
    random_walk_m_per_s3_per_sqrt_Hz: 38, bias_m_per_s2: 39, temperature_drift_m_per_s2_per_K: 40,
    scale_error: 41, misalignment_rad: 42, range_m_per_s2: 43, resolution_m_per_s2: 44}
  gyroscope: {noise_rad_per_s_per_sqrt_Hz: 45, bias_instability_rad_per_s: 46,
    random_walk_rad_per_s2_per_sqrt_Hz: 47, bias_rad_per_s: 48,
    temperature_drift_rad_per_s_per_K: 49, scale_error: 50, misalignment_rad: 51,
    range_rad_per_s: 52, resolution_rad_per_s: 53}
  imu_filter: {average_s: 0.0054, delay_s: 0.0055}
  temperature: {environment_K: 56, self_heating_K: 57, time_constant_s: 58,
    fluctuation_K_per_sqrt_s: 59, time_on_s: 60}
  inertial_unit:
    place_m: 61
    turned: false
    filter: {average_s: 0.0062, delay_s: 0.0063}
    accelerometer: {noise_m_per_s2_per_sqrt_Hz: 64}
    gyroscope: {range_rad_per_s: 65}
)";

TEST(SimulationFile, EveryKeyOfASensorReachesItsField) {
  const simulator::SensorsConfig sensors = load(kEverySensorKey).sensors;
  std::vector<double> values;
  for (const auto& encoder : {sensors.link_encoder, sensors.motor_encoder}) {
    for (double value : {encoder.resolution, encoder.offset, encoder.error_1, encoder.error_2})
      values.push_back(value);
  }
  const simulator::EncoderConfig& gantry = sensors.gantry_encoder;
  const simulator::TorqueSensorConfig& torque = sensors.torque;
  EXPECT_EQ(torque.range, kInfinity);
  const simulator::WrenchSensorConfig& wrench = sensors.wrench;
  for (double value :
       {gantry.resolution, gantry.offset, gantry.error_1, gantry.error_2, gantry.period,
        torque.noise, torque.gain_error, torque.offset, torque.ripple, torque.resolution})
    values.push_back(value);
  for (double value : wrench.full_scale) values.push_back(value);
  for (double value :
       {wrench.force_noise, wrench.torque_noise, wrench.gain_error, wrench.cross_talk, wrench.bias,
        wrench.bias_walk, wrench.temperature_drift, wrench.range, wrench.resolution,
        1e4 * wrench.filter.average, 1e4 * wrench.filter.delay})
    values.push_back(value);
  for (const auto& part : {sensors.accelerometer, sensors.gyroscope}) {
    for (double value :
         {part.noise, part.bias_instability, part.random_walk, part.bias, part.temperature_drift,
          part.scale_error, part.misalignment, part.range, part.resolution})
      values.push_back(value);
  }
  const simulator::TemperatureConfig& temperature = sensors.temperature;
  for (double value : {1e4 * sensors.imu_filter.average, 1e4 * sensors.imu_filter.delay,
                       temperature.environment, temperature.self_heating, temperature.time_constant,
                       temperature.fluctuation, temperature.time_on})
    values.push_back(value);
  const simulator::LinkUnitConfig& unit = sensors.link_unit;
  EXPECT_FALSE(unit.is_turned);
  for (double value : {unit.place, 1e4 * unit.filter.average, 1e4 * unit.filter.delay,
                       unit.accelerometer.noise, unit.gyroscope.range})
    values.push_back(value);
  ASSERT_EQ(values.size(), 65u);
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k], static_cast<double>(k + 1));
}

TEST(SimulationFile, IdealSensorsKeepWhatIsGiven) {
  const simulator::SensorsConfig sensors =
      load("sensors: {torque_sensor: {noise: 0.1}, ideal: true}\n").sensors;
  EXPECT_EQ(sensors.torque.noise, 0.1);
  EXPECT_EQ(sensors.torque.ripple, 0.0);
  EXPECT_EQ(sensors.wrench.range, kInfinity);
  EXPECT_FALSE(sensors.has_differenced_velocity);
}

TEST(SimulationFile, TheRestReachesItsFields) {
  const SimulationConfig simulation = load(
      "step_s: 0.0001\nseed: 77\ngear_ratio: {lift: 50}\n"
      "factors: {stiffness: 2, damping: 3, friction: 4, rotor_inertia: 5, mass: 6, payload: 7, "
      "latency: 8, current_lag: 9, gantry_lag: 10}\n"
      "end_stops: {beyond_rad: 0.1, beyond_m: 0.2, stiffness_Nm_per_rad: 3, damping_ratio: 4}\n"
      "sensors: {differenced_velocity: false}\n");
  EXPECT_EQ(simulation.step_s, 1e-4);
  EXPECT_EQ(simulation.seed, 77u);
  EXPECT_EQ(simulation.sensors.seed, 77u);
  EXPECT_FALSE(simulation.sensors.has_differenced_velocity);
  EXPECT_EQ(simulation.gear_ratio.size(), 2);
  EXPECT_EQ(simulation.gear_ratio[0], 1.0);
  EXPECT_EQ(simulation.gear_ratio[1], 50.0);
  EXPECT_EQ(simulation.stop_distance_angle, 0.1);
  EXPECT_EQ(simulation.stop_distance_length, 0.2);
  EXPECT_EQ(simulation.end_stop.stiffness, 3.0);
  EXPECT_EQ(simulation.end_stop.damping_ratio, 4.0);
  EXPECT_EQ(simulation.factors.mass, 6.0);

  const ActuatorModel nominal = {.rotor_inertia = 1.0,
                                 .stiffness = 1.0,
                                 .damping = 1.0,
                                 .coulomb_friction = 1.0,
                                 .viscous_friction = 1.0,
                                 .load_friction = 1.0,
                                 .stiction = 1.0,
                                 .torque_max = 1.0};
  const ActuatorModel real = actual(nominal, simulation.factors);
  EXPECT_EQ(real.stiffness, 2.0);
  EXPECT_EQ(real.damping, 3.0);
  EXPECT_EQ(real.coulomb_friction, 4.0);
  EXPECT_EQ(real.viscous_friction, 4.0);
  EXPECT_EQ(real.load_friction, 4.0);
  EXPECT_EQ(real.rotor_inertia, 5.0);
  EXPECT_EQ(real.stiction, 1.0);
  EXPECT_EQ(real.torque_max, 1.0);
  const Payload payload =
      actual(Payload{.mass = 1.0, .com = {1, 1, 1}, .inertia = Eigen::Matrix3d::Identity()},
             simulation.factors);
  EXPECT_EQ(payload.mass, 7.0);
  EXPECT_EQ(payload.com.x(), 1.0);
  EXPECT_EQ(payload.inertia(0, 0), 7.0);
  EXPECT_EQ(actual(TorqueLoop{.latency = 1.0, .current_lag = 1.0}, simulation.factors).latency,
            8.0);
  EXPECT_EQ(actual(TorqueLoop{.latency = 1.0, .current_lag = 1.0}, simulation.factors).current_lag,
            9.0);
  EXPECT_EQ(actual(DriveModel{.lag = 1.0}, simulation.factors).lag, 10.0);
}

TEST(SimulationFile, AUrdfMayHaveFurtherJointsThatBend) {
  const SimulationConfig bent = load(
      "urdf: bent.urdf\nflexible: {bend: {stiffness_Nm_per_rad: 9000, damping_Nms_per_rad: 12}}\n"
      "sensors: {}\n");
  ASSERT_TRUE(bent.chain);
  EXPECT_EQ(bent.chain->joints().size(), 4u);
  EXPECT_EQ(bent.gantry, std::vector<int>{0});
  EXPECT_EQ(bent.manipulator, (std::vector<int>{2, 3}));
  ASSERT_EQ(bent.flexible.size(), 1u);
  EXPECT_EQ(bent.flexible[0].joint, 1);
  EXPECT_EQ(bent.flexible[0].stiffness, 9000.0);
  EXPECT_EQ(bent.flexible[0].damping, 12.0);
  EXPECT_EQ(message("urdf: slid.urdf\nflexible: {bend: {stiffness_N_per_m: 9000}}\n"), "no error");
  EXPECT_EQ(message("urdf: plain.urdf\n"), "no error");
}

TEST(SimulationFile, MissingKeysHaveTheValuesOfItsBase) {
  const SimulationConfig simulation = load(
      "base: base.yaml\nfactors: {friction: 3}\nmotors: {ripple: 0}\n"
      "sensors: {torque_sensor: {offset: 0.2}}\n");
  EXPECT_EQ(simulation.seed, 5u);
  EXPECT_EQ(simulation.gear_ratio[1], 50.0);
  EXPECT_EQ(simulation.factors.mass, 2.0);
  EXPECT_EQ(simulation.factors.friction, 3.0);
  EXPECT_EQ(simulation.motors.cogging, 0.01);
  EXPECT_EQ(simulation.motors.ripple, 0.0);
  EXPECT_EQ(simulation.sensors.torque.noise, 0.1);
  EXPECT_EQ(simulation.sensors.torque.offset, 0.2);
  EXPECT_EQ(simulation.sensors.wrench.force_noise, 0.0);
  EXPECT_EQ(load("base: base.yaml\n").sensors.torque.noise, 0.1);
}

TEST(SimulationFile, EffectsReachTheJointsInTheirUnits) {
  const SimulationConfig simulation = load(
      "motors: {cogging: 0.01, cogging_per_turn: 24, ripple: 0.02, ripple_per_turn: 6}\n"
      "gears: {presliding_rad: 1e-4, presliding_damping_ratio: 0.5, presliding_elements: 2, "
      "backlash_rad: 3e-4, hysteresis: 0.03, hysteresis_rad: 2e-4}\n"
      "waviness: {slide: {amplitude_m: 1e-5, period_m: 0.02}}\n"
      "sensors: {wrench_sensor: {shunt: 0.08}}\n");
  const ActuatorModel actuator = {
      .rotor_inertia = 2.0, .coulomb_friction = 4.0, .torque_max = 100.0};
  const simulator::JointEffects effects =
      effects_of(actuator, simulation.motors, simulation.gears, 50.0);
  EXPECT_DOUBLE_EQ(effects.cogging, 1.0);
  EXPECT_DOUBLE_EQ(effects.cogging_wave, 1200.0);
  EXPECT_DOUBLE_EQ(effects.ripple, 0.02);
  EXPECT_DOUBLE_EQ(effects.ripple_wave, 300.0);
  EXPECT_DOUBLE_EQ(effects.bristle_stiffness, 4e4);
  EXPECT_DOUBLE_EQ(effects.bristle_damping, std::sqrt(4e4 * 2.0));
  EXPECT_EQ(effects.bristles, 2);
  EXPECT_DOUBLE_EQ(effects.backlash, 3e-4);
  EXPECT_DOUBLE_EQ(effects.hysteresis, 3.0);
  EXPECT_DOUBLE_EQ(effects.hysteresis_stiffness, 1.5e4);
  ASSERT_EQ(simulation.waviness.size(), 1u);
  EXPECT_EQ(simulation.waviness[0].amplitude, 1e-5);
  EXPECT_EQ(simulation.waviness[0].period, 0.02);
  EXPECT_EQ(simulation.sensors.wrench.shunt, 0.08);
}

TEST(SimulationFile, WithoutThemThereAreNoEffects) {
  const SimulationConfig simulation = load("sensors: {}\n");
  const simulator::JointEffects effects =
      effects_of({.rotor_inertia = 2.0, .coulomb_friction = 4.0, .torque_max = 100.0},
                 simulation.motors, simulation.gears, 50.0);
  EXPECT_EQ(effects.cogging, 0.0);
  EXPECT_EQ(effects.ripple, 0.0);
  EXPECT_EQ(effects.bristle_stiffness, 0.0);
  EXPECT_EQ(effects.backlash, 0.0);
  EXPECT_EQ(effects.hysteresis, 0.0);
  EXPECT_TRUE(simulation.waviness.empty());
  EXPECT_EQ(simulation.sensors.wrench.shunt, 0.0);
  EXPECT_FALSE(simulation.chain);
}

TEST(SimulationFile, AStructureThatYieldsIsAPassiveJointOfItsFrequency) {
  SimulationTarget device = kDevice;
  device.urdf = "plain.urdf";
  const SimulationConfig yields = load(
      "factors: {mass: 2}\n"
      "structure: {slide: {frequency_Hz: 10, damping_ratio: 0.05}, "
      "turn: {frequency_Hz: 5, axis: [2, 0, 0]}, lift: {frequency_Hz: 0}}\nsensors: {}\n",
      device);
  ASSERT_TRUE(yields.chain);
  ASSERT_EQ(yields.chain->joints().size(), 5u);
  EXPECT_EQ(yields.chain->joints()[1].name, "slide_structure");
  EXPECT_EQ(yields.chain->joints()[3].name, "turn_structure");
  EXPECT_EQ(yields.chain->joints()[3].axis, Eigen::Vector3d::UnitX());
  EXPECT_EQ(yields.gantry, std::vector<int>{0});
  EXPECT_EQ(yields.manipulator, (std::vector<int>{2, 4}));
  ASSERT_EQ(yields.flexible.size(), 2u);
  const double omega = 2.0 * 3.14159265358979 * 10.0, mass = 2.0 * 3.0;  // trolley, arm and hand
  EXPECT_EQ(yields.flexible[0].joint, 1);
  EXPECT_NEAR(yields.flexible[0].stiffness, omega * omega * mass, 1e-4);
  EXPECT_NEAR(yields.flexible[0].damping, 2.0 * 0.05 * omega * mass, 1e-6);
  EXPECT_EQ(yields.flexible[1].joint, 3);
}

struct Case {
  const char* name;
  const char* yaml;
  const char* message;
};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

class BadSimulation : public testing::TestWithParam<Case> {};

TEST_P(BadSimulation, IsRefusedWithPlaceRuleValueAndNearestName) {
  EXPECT_EQ(message(GetParam().yaml), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Config, BadSimulation,
    testing::Values(
        Case{"Good", "seed: 3\n", "no error"},
        Case{"UnknownKey", "sed: 3\n",
             "simulation.yaml:2:1: sed: unknown key, did you mean 'seed'?"},
        Case{"SeedWithAFraction", "seed: 1.5\n",
             "simulation.yaml:2:7: seed: must be a whole number, got 1.5"},
        Case{"NegativeSeed", "seed: -1\n",
             "simulation.yaml:2:7: seed: must be 0 .. 9007199254740992, got -1"},
        Case{"StepInMilliseconds", "step_s: 0.25\n",
             "simulation.yaml:2:9: step_s: must be 1e-05 .. 0.002, got 0.25"},
        Case{"StiffnessOfNothing", "factors: {stiffness: 0}\n",
             "simulation.yaml:2:22: factors.stiffness: must be 0.001 .. 1000, got 0"},
        Case{"UnknownFactor", "factors: {frictoin: 1}\n",
             "simulation.yaml:2:11: factors.frictoin: unknown key, did you mean 'friction'?"},
        Case{"StopInsideTheLimits", "end_stops: {beyond_m: -1}\n",
             "simulation.yaml:2:23: end_stops.beyond_m: must be 0 .. 1000, got -1"},
        Case{"RatioOfAnUnknownJoint", "gear_ratio: {lit: 5}\n",
             "simulation.yaml:2:14: gear_ratio.lit: must be a joint of the manipulator, got 'lit', "
             "did you mean 'lift'?"},
        Case{"RatioOfTheGantry", "gear_ratio: {slide: 5}\n",
             "simulation.yaml:2:14: gear_ratio.slide: must be a joint of the manipulator, got "
             "'slide', did you mean 'lift'?"},
        Case{"FlexibleWithoutUrdf", "flexible: {bend: {}}\n",
             "simulation.yaml:2:11: flexible: needs 'urdf': the device has no joints but those "
             "that are driven"},
        Case{"UrdfThatDoesNotExist", "urdf: bend.urdf\n",
             "simulation.yaml:2:7: urdf: no such file, got 'bend.urdf'"},
        Case{"JointThatIsNotFlexible", "urdf: bent.urdf\n",
             "simulation.yaml:2:7: urdf: every joint that the device does not have must be in "
             "'flexible', got 'bend'"},
        Case{"DrivenJointThatBends", "urdf: plain.urdf\nflexible: {lift: {}}\n",
             "simulation.yaml:3:11: flexible: must not be a joint that the device drives, got "
             "'lift'"},
        Case{"UnknownFlexibleJoint", "urdf: bent.urdf\nflexible: {bent: {}}\n",
             "simulation.yaml:3:12: flexible.bent: must be a joint of the URDF, got 'bent', did "
             "you mean 'bend'?"},
        Case{"StiffnessInTheWrongUnit",
             "urdf: bent.urdf\nflexible: {bend: {stiffness_N_per_m: 1}}\n",
             "simulation.yaml:3:19: flexible.bend.stiffness_N_per_m: unknown key, did you mean "
             "'stiffness_Nm_per_rad'?"},
        Case{"BaseOfABase", "base: second.yaml\n",
             "second.yaml:1:7: base: a base must not have a base itself"},
        Case{"CoggingInPercent", "motors: {cogging: 3}\n",
             "simulation.yaml:2:19: motors.cogging: must be 0 .. 1, got 3"},
        Case{"TooManyElements", "gears: {presliding_elements: 4}\n",
             "simulation.yaml:2:30: gears.presliding_elements: must be 1 .. 3, got 4"},
        Case{"ElementsWithAFraction", "gears: {presliding_elements: 1.5}\n",
             "simulation.yaml:2:30: gears.presliding_elements: must be a whole number, got 1.5"},
        Case{"StructureOfAnUnknownJoint", "structure: {slid: {frequency_Hz: 9}}\n",
             "simulation.yaml:2:13: structure.slid: must be a joint of the device, got 'slid', did "
             "you mean 'slide'?"},
        Case{
            "StructureBesideAUrdf", "urdf: plain.urdf\nstructure: {slide: {frequency_Hz: 9}}\n",
            "simulation.yaml:3:12: structure: 'structure' and 'urdf' exclude each other, also in a "
            "base: put the joints into that URDF and 'flexible'"},
        Case{
            "UrdfBesideTheStructureOfABase", "base: yielding.yaml\nurdf: plain.urdf\n",
            "simulation.yaml:3:7: urdf: 'structure' and 'urdf' exclude each other, also in a base: "
            "put the joints into that URDF and 'flexible'"},
        Case{"StructureThatSags", "structure: {slide: {frequency_Hz: 0.001}}\n",
             "simulation.yaml:2:35: structure.slide.frequency_Hz: must be 0 or at least 1: what is "
             "softer sags without end, got 0.001"},
        Case{"WavesThatTurnBack", "waviness: {slide: {amplitude_m: 0.1, period_m: 0.5}}\n",
             "simulation.yaml:2:48: waviness.slide.period_m: must exceed 2 pi amplitudes: the axis "
             "never turns back, got 0.5"},
        Case{"FloatingJoint", "urdf: free.urdf\nflexible: {bend: {}}\n",
             "simulation.yaml:2:7: urdf: a device has no floating joints, got 'bend'"}),
    name_of);

TEST(SimulationFile, AnUrdfOfAnotherDeviceIsRefused) {
  SimulationTarget other = kDevice;
  other.manipulator = {"turn", "reach"};
  EXPECT_EQ(message("urdf: plain.urdf\nflexible: {lift: {}}\n", other),
            "simulation.yaml:2:7: urdf: must have all joints of the device, there is no 'reach'");
  other = kDevice;
  other.manipulator = {"lift", "turn"};
  EXPECT_EQ(message("urdf: plain.urdf\n", other),
            "simulation.yaml:2:7: urdf: must have the joints of the device in the same order");
  other = kDevice;
  other.handle = "grip";
  EXPECT_EQ(message("urdf: plain.urdf\n", other),
            "simulation.yaml:2:7: urdf: must have the handle of the device, got no link 'grip'");
}

TEST(SimulationFile, AFilterOfMoreStepsThanTheSensorHoldsIsRefused) {
  for (const char* filter : {"imu_filter", "wrench_sensor: {filter"}) {
    const std::string closing = filter[0] == 'w' ? "}}" : "}";
    const std::string text = std::string("sensors: {") + filter + ": {average_s: 0.01, delay_s: ";
    EXPECT_EQ(message_of([&] { load(text + "0.022}" + closing); }), "no error");
    EXPECT_EQ(message_of([&] { load(text + "0.023}" + closing); }),
              "simulation.yaml:1:10: sensors: window and delay of a filter must not exceed 128 "
              "steps of the plant, 0.032 s, got 0.033");
  }
}

TEST(SimulationFile, WithoutSensorsItIsRefused) {
  EXPECT_EQ(message_of([] { load("seed: 1\n"); }), "simulation.yaml:1:1: key 'sensors' is missing");
}

TEST(SimulationFile, OfAnUnknownDeviceNoNamesAreChecked) {
  EXPECT_EQ(message("gear_ratio: {m1: 5}\nurdf: bent.urdf\n", {}), "no error");
}

}  // namespace
}  // namespace hg::config
