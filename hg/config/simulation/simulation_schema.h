/// Description of simulation.yaml.
#pragma once

#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/device_schema.h"
#include "hg/config/schema.h"
#include "hg/config/simulation/simulation.h"
#include "hg/simulator/sensors/sensors.h"

namespace hg::config {

// ---- sensors of joints ----

template <class V>
void describe_joint_encoder(V& v, simulator::EncoderConfig& encoder) {
  v.number("resolution_rad", encoder.resolution, kNotNegative,
           "one step on its own shaft; of a prismatic joint in m, as all that follows");
  v.number("offset_rad", encoder.offset, kNotNegative,
           "standard deviation of what is left of the mounting offset, at the joint");
  v.number("error_1_rad", encoder.error_1, kNotNegative,
           "amplitude of the error once per turn of its shaft, at the joint");
  v.number("error_2_rad", encoder.error_2, kNotNegative,
           "the same twice per turn; of a motor also the kinematic error of its gear");
}

template <class V>
void describe_gantry_encoder(V& v, simulator::EncoderConfig& encoder) {
  v.number("resolution_m", encoder.resolution, kNotNegative,
           "one step; of a revolute axis in rad, as all that follows");
  v.number("offset_m", encoder.offset, kNotNegative, "standard deviation of the offset");
  v.number("error_1_m", encoder.error_1, kNotNegative, "amplitude of the error once per period");
  v.number("error_2_m", encoder.error_2, kNotNegative, "the same twice per period");
  v.number("period_m", encoder.period, kPositive, "length over which these errors repeat");
}

template <class V>
void describe(V& v, simulator::TorqueSensorConfig& sensor) {
  v.number("noise", sensor.noise, kShare,
           "standard deviation of a sample, like all here a share of the full scale, which is the "
           "peak torque of the joint");
  v.number("gain_error", sensor.gain_error, kShare, "standard deviation");
  v.number("offset", sensor.offset, kShare, "standard deviation");
  v.number("ripple", sensor.ripple, kShare,
           "amplitude of the ripple of the gear, twice per turn of the motor");
  v.number("range", sensor.range, kShareOrNone, "where the reading ends");
  v.number("resolution", sensor.resolution, kShare, "one step");
}

// ---- other sensors ----

/// Keys of corresponding values of gyroscope and accelerometer.
struct InertialKeys {
  const char *noise, *bias_instability, *random_walk, *bias, *temperature_drift, *range,
      *resolution;
};

inline constexpr InertialKeys kGyroscopeKeys = {"noise_rad_per_s_per_sqrt_Hz",
                                                "bias_instability_rad_per_s",
                                                "random_walk_rad_per_s2_per_sqrt_Hz",
                                                "bias_rad_per_s",
                                                "temperature_drift_rad_per_s_per_K",
                                                "range_rad_per_s",
                                                "resolution_rad_per_s"};
inline constexpr InertialKeys kAccelerometerKeys = {"noise_m_per_s2_per_sqrt_Hz",
                                                    "bias_instability_m_per_s2",
                                                    "random_walk_m_per_s3_per_sqrt_Hz",
                                                    "bias_m_per_s2",
                                                    "temperature_drift_m_per_s2_per_K",
                                                    "range_m_per_s2",
                                                    "resolution_m_per_s2"};

template <class V>
void describe(V& v, simulator::SensorFilterConfig& filter) {
  v.number("average_s", filter.average, kNotNegative, "window of the mean");
  v.number("delay_s", filter.delay, kNotNegative, "further delay, in steps of the plant");
}

template <class V>
void describe(V& v, simulator::WrenchSensorConfig& sensor) {
  Eigen::Vector3d force = sensor.full_scale.head<3>(), torque = sensor.full_scale.tail<3>();
  v.vector("force_N", force, kPositive, "full scale of the axes of S");
  v.vector("torque_Nm", torque, kPositive, "full scale of the axes of S");
  sensor.full_scale << force, torque;
  v.number("noise_N_per_sqrt_Hz", sensor.force_noise, kNotNegative,
           "random-walk coefficient: after a mean over T the deviation is noise / sqrt(T)");
  v.number("noise_Nm_per_sqrt_Hz", sensor.torque_noise, kNotNegative, "the same of torques");
  v.number("gain_error", sensor.gain_error, kShare, "standard deviation");
  v.number("shunt", sensor.shunt, {.lb = 0.0, .ub = 0.9},
           "share of every wrench that a cable or cover carries past the sensor");
  v.number("cross_talk", sensor.cross_talk, kShare,
           "standard deviation, full scale of one axis on full scale of another");
  v.number("bias", sensor.bias, kShare,
           "when switched on: standard deviation, share of full scale");
  v.number("bias_walk_1_per_sqrt_s", sensor.bias_walk, kNotNegative, "share of full scale");
  v.number("temperature_drift_1_per_K", sensor.temperature_drift, kNotNegative,
           "standard deviation, share of full scale");
  v.number("range", sensor.range, kShareOrNone, "where an axis ends, share of full scale");
  v.number("resolution", sensor.resolution, kShare, "one step, share of full scale");
  v.group(
      "filter", [&](auto& child) { describe(child, sensor.filter); }, "of the digital output");
}

template <class V>
void describe(V& v, simulator::InertialSensorConfig& sensor, const InertialKeys& keys) {
  v.number(keys.noise, sensor.noise, kNotNegative,
           "random-walk coefficient: after a mean over T the deviation is noise / sqrt(T)");
  v.number(keys.bias_instability, sensor.bias_instability, kNotNegative,
           "flicker: the floor of the Allan deviation is 0.664 of it");
  v.number(keys.random_walk, sensor.random_walk, kNotNegative,
           "rate random walk: its Allan deviation after T is this times sqrt(T / 3)");
  v.number(keys.bias, sensor.bias, kNotNegative, "when switched on: standard deviation");
  v.number(keys.temperature_drift, sensor.temperature_drift, kNotNegative, "standard deviation");
  v.number("scale_error", sensor.scale_error, kShare, "standard deviation");
  v.number("misalignment_rad", sensor.misalignment, kNotNegative,
           "standard deviation of the mounting about each axis");
  v.number(keys.range, sensor.range, kPositiveOrNone, "where an axis ends");
  v.number(keys.resolution, sensor.resolution, kNotNegative, "one step");
}

template <class V>
void describe(V& v, simulator::TorqueEstimateConfig& estimate) {
  v.number("friction", estimate.friction, kShare,
           "that the arm does not compensate, share of each joint's peak torque");
  v.number("offset", estimate.offset, kShare, "standard deviation, share of the peak torque");
  v.number("weight", estimate.weight, kShare,
           "share of the torques that carry the arm by which its model is wrong");
}

template <class V>
void describe(V& v, simulator::LinkUnitConfig& unit) {
  v.number("place_m", unit.place, kNotNegative,
           "standard deviation of each coordinate of a unit in its link");
  v.flag("turned", unit.is_turned, "true: anyhow; false: its axes are those of the link");
  v.group(
      "accelerometer",
      [&](auto& child) { describe(child, unit.accelerometer, kAccelerometerKeys); }, "of a unit");
  v.group(
      "gyroscope", [&](auto& child) { describe(child, unit.gyroscope, kGyroscopeKeys); },
      "of a unit");
  v.group(
      "filter", [&](auto& child) { describe(child, unit.filter); }, "of its digital output");
}

template <class V>
void describe(V& v, simulator::TemperatureConfig& temperature) {
  v.number("environment_K", temperature.environment, kAnyNumber,
           "room minus temperature of the calibration");
  v.number("self_heating_K", temperature.self_heating, kNotNegative, "in the long run");
  v.number("time_constant_s", temperature.time_constant, kPositive, "of warming up");
  v.number("fluctuation_K_per_sqrt_s", temperature.fluctuation, kNotNegative, "random");
  v.number("time_on_s", temperature.time_on, kNotNegative,
           "for how long the sensor has been on when the run starts");
}

template <class V>
void describe(V& v, simulator::SensorsConfig& sensors) {
  bool is_ideal = false;
  v.flag("ideal", is_ideal, "true: no error, noise or delay but those given below");
  if (is_ideal) sensors = simulator::ideal_sensors();
  v.group(
      "link_encoder", [&](auto& child) { describe_joint_encoder(child, sensors.link_encoder); },
      "of each joint, behind the gear");
  v.flag("differenced_velocity", sensors.has_differenced_velocity,
         "true: the drives report the difference of the link encoder; false: the true velocity");
  v.group(
      "motor_encoder", [&](auto& child) { describe_joint_encoder(child, sensors.motor_encoder); },
      "of each motor, before the gear");
  v.group(
      "gantry_encoder",
      [&](auto& child) { describe_gantry_encoder(child, sensors.gantry_encoder); },
      "of each axis of the gantry");
  v.group(
      "torque_sensor", [&](auto& child) { describe(child, sensors.torque); }, "of each joint");
  v.group(
      "wrench_sensor", [&](auto& child) { describe(child, sensors.wrench); },
      "force/torque sensor at S");
  v.group(
      "torque_estimate", [&](auto& child) { describe(child, sensors.torque_estimate); },
      "of an arm that estimates the user's wrench from its joint torques instead of measuring it; "
      "noise, filter and range are those of wrench_sensor");
  if (v.is_given("torque_estimate")) sensors.torque_estimate.is_used = true;
  v.group(
      "accelerometer",
      [&](auto& child) { describe(child, sensors.accelerometer, kAccelerometerKeys); },
      "in the force/torque sensor");
  v.group(
      "gyroscope", [&](auto& child) { describe(child, sensors.gyroscope, kGyroscopeKeys); },
      "in the force/torque sensor");
  v.group(
      "imu_filter", [&](auto& child) { describe(child, sensors.imu_filter); },
      "of accelerometer and gyroscope; best the same as that of the wrench");
  v.group(
      "inertial_unit", [&](auto& child) { describe(child, sensors.link_unit); },
      "on each link that device.yaml names in estimation.inertial_units");
  v.group(
      "temperature", [&](auto& child) { describe(child, sensors.temperature); },
      "of the force/torque sensor");
}

// ---- plant ----

inline constexpr Range kShareOfOne = {.lb = 0.0, .ub = 1.0};
inline constexpr Range kPeriods = {.lb = 0.0, .ub = 1e4};

struct FlexibleDraft {
  JointUnit unit = JointUnit::kEither;
  double stiffness = 0.0, damping = 0.0;
};

struct StructureDraft {
  double frequency_Hz = 0.0, damping_ratio = 0.02;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  bool has_axis = false;
};

/// Content of simulation.yaml, before it becomes a Simulation.
struct SimulationDraft {
  SimulationConfig simulation;
  double seed = 1.0;
  std::filesystem::path base, urdf;
  /// Structure per joint of the device, where given
  std::vector<std::optional<StructureDraft>> structure;
  std::vector<std::string> joint_names;  ///< joint names of that URDF
  std::vector<JointUnit> joint_units;    ///< joint units of that URDF
  /// Flexibility per joint of that URDF, where given
  std::vector<std::optional<FlexibleDraft>> flexible;
};

template <class V>
void describe(V& v, RealityFactors& factors) {
  v.number("stiffness", factors.stiffness, kFactor, "of the joints");
  v.number("damping", factors.damping, kFactor, "parallel to the stiffness");
  v.number("friction", factors.friction, kFactor, "Coulomb, viscous and load-dependent");
  v.number("rotor_inertia", factors.rotor_inertia, kFactor, "of the motors");
  v.number("mass", factors.mass, kFactor, "of all links, with their inertia");
  v.number(
      "payload", factors.payload, kFactor,
      "mass and inertia of what hangs beyond the force/torque sensor, as that sensor feels it");
  v.number("latency", factors.latency, kFactor, "of the torque loop");
  v.number("current_lag", factors.current_lag, kFactor, "of the motors");
  v.number("gantry_lag", factors.gantry_lag, kFactor, "of the drives of the gantry");
}

template <class V>
void describe_end_stops(V& v, SimulationConfig& simulation) {
  v.number("beyond_rad", simulation.stop_distance_angle, kNotNegative,
           "beyond the limits of revolute joints");
  v.number("beyond_m", simulation.stop_distance_length, kNotNegative,
           "beyond the limits of prismatic joints, the gantry's too");
  v.number("stiffness_Nm_per_rad", simulation.end_stop.stiffness, kPositive,
           "of a prismatic joint in N/m; the manipulator's");
  v.number("damping_ratio", simulation.end_stop.damping_ratio, kShare,
           "with the joint's own inertia; 5 throws back 1 % of the energy");
}

template <class V>
void describe(V& v, simulator::SafetyPlcConfig& safety) {
  v.number("discrepancy_s", safety.discrepancy, kPositive,
           "that the two channels of an input may differ");
  v.number("response_s", safety.response, kNotNegative, "to switches");
  v.number("scanner_response_s", safety.scanner_response, kNotNegative, "to a person in a field");
  v.number("stop_time_s", safety.stop_time, kPositive,
           "that a controlled stop may take before the power goes");
  v.number("safe_speed_m_per_s", safety.safe_speed, kPositive,
           "of handle and gantry while the handle is not held; beyond it the scanner's large "
           "field counts");
  v.number("standstill_m_per_s", safety.standstill, kPositive,
           "of handle and gantry while motion is not permitted");
}

template <class V>
void describe(V& v, MotorEffects& motors) {
  v.number("cogging", motors.cogging, kShareOfOne,
           "amplitude of the torque between magnets and iron, share of the joint's peak torque");
  v.number("cogging_per_turn", motors.cogging_per_turn, kPeriods,
           "its periods per turn of a motor");
  v.number("ripple", motors.ripple, kShareOfOne, "amplitude, share of the torque of the moment");
  v.number("ripple_per_turn", motors.ripple_per_turn, kPeriods, "its periods per turn of a motor");
}

template <class V>
void describe(V& v, GearEffects& gears) {
  v.number("presliding_rad", gears.presliding, kNotNegative,
           "way of the motor, at the output of its gear, until all of its Coulomb friction slips: "
           "before that friction is a spring; 0 = it is rigid");
  v.number("presliding_damping_ratio", gears.presliding_damping_ratio, kShare,
           "of the rotor on that spring");
  v.number("presliding_elements", gears.presliding_elements,
           {.lb = 1.0, .ub = simulator::kMaxBristles},
           "of equal friction that slip one after the other (Maxwell slip), a whole number");
  v.rule(gears.presliding_elements == std::floor(gears.presliding_elements), "presliding_elements",
         "must be a whole number", model::to_text(gears.presliding_elements));
  v.number("backlash_rad", gears.backlash, kNotNegative, "from flank to flank, at the output");
  v.number("hysteresis", gears.hysteresis, kShareOfOne,
           "friction parallel to the spring of the joint, share of its peak torque");
  v.number("hysteresis_rad", gears.hysteresis_angle, kPositive,
           "twist of the spring at which that friction slips");
}

template <class V>
void describe(V& v, StructureDraft& joint) {
  v.number("frequency_Hz", joint.frequency_Hz, kNotNegative,
           "at which all that this joint carries swings, all joints at 0; 0 = rigid");
  v.rule(joint.frequency_Hz == 0.0 || joint.frequency_Hz >= 1.0, "frequency_Hz",
         "must be 0 or at least 1: what is softer sags without end",
         model::to_text(joint.frequency_Hz));
  v.number("damping_ratio", joint.damping_ratio, kShare, "of that oscillation");
  joint.has_axis = v.vector("axis", joint.axis, {.lb = -1e3, .ub = 1e3},
                            "of the yielding, in the link that the joint carries; without it the "
                            "axis of the joint itself");
  v.rule(!joint.has_axis || joint.axis.norm() > 1e-6, "axis", "must have a direction");
}

template <class V>
void describe(V& v, simulator::Waviness& wave) {
  v.number("amplitude_m", wave.amplitude, kNotNegative,
           "of the axis beside where its drive and encoder are; of a revolute axis in rad");
  v.number("period_m", wave.period, kPositive, "of travel, more than 2 pi amplitudes");
  v.rule(wave.period > 2.0 * std::numbers::pi * wave.amplitude, "period_m",
         "must exceed 2 pi amplitudes: the axis never turns back", model::to_text(wave.period));
}

template <class V>
void describe(V& v, FlexibleDraft& joint) {
  v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, joint.unit, joint.stiffness,
                 kNotNegative, "towards position 0; 0 = it moves freely");
  v.joint_number({"damping_Nms_per_rad", "damping_Ns_per_m"}, joint.unit, joint.damping,
                 kNotNegative, "viscous");
}

template <class V>
void describe_base(V& v, SimulationDraft& draft) {
  v.path("base", draft.base, "another simulation file, with the values that are not given here");
}

/// The first part, which defines the joint names that the second uses.
template <class V>
void describe_plant(V& v, SimulationDraft& draft) {
  constexpr double kLargestSeed = 9007199254740992.0;  // 2^53: a number of YAML is exact so far
  v.number("step_s", draft.simulation.step_s, {.lb = 1e-5, .ub = 2e-3},
           "largest step of the plant; a period is divided into equal steps");
  v.number("seed", draft.seed, {.lb = 0.0, .ub = kLargestSeed},
           "of everything random: the same seed gives the same run");
  v.rule(draft.seed == std::floor(draft.seed), "seed", "must be a whole number",
         model::to_text(draft.seed));
  v.path("urdf", draft.urdf,
         "of a plant with more joints than the controller models; without it that of the device");
}

template <class V>
void describe_effects(V& v, SimulationDraft& draft, const std::vector<std::string>& gantry,
                      const std::vector<std::string>& manipulator) {
  v.group(
      "motors", [&](auto& child) { describe(child, draft.simulation.motors); },
      "of the manipulator: what the controller does not model");
  v.group(
      "gears", [&](auto& child) { describe(child, draft.simulation.gears); },
      "of the manipulator, likewise");
  std::vector<std::string> joints = gantry;
  joints.insert(joints.end(), manipulator.begin(), manipulator.end());
  draft.structure.resize(joints.size());
  v.groups_by_name(
      "structure", joints, "a joint of the device",
      [&](auto& child, int index) {
        auto& joint = draft.structure[index];
        if (!joint) joint.emplace();
        describe(child, *joint);
      },
      "what yields behind a joint, seen by no encoder: belt and frame of a gantry axis, a link");
  const bool yields =
      std::ranges::any_of(draft.structure, [](const auto& joint) { return joint.has_value(); });
  v.rule(!yields || draft.urdf.empty(), v.is_given("structure") ? "structure" : "urdf",
         "'structure' and 'urdf' exclude each other, also in a base: put the joints into that URDF "
         "and 'flexible'");
  v.groups_by_name(
      "waviness", gantry, "an axis of the gantry",
      [&](auto& child, int index) {
        draft.simulation.waviness.resize(gantry.size());
        describe(child, draft.simulation.waviness[index]);
      },
      "how belt, wheels and rail lead the gantry astray");
}

template <class V>
void describe(V& v, PositionDrives& drives, const std::vector<std::string>& manipulator) {
  v.number("position_Hz", drives.loop.position_Hz, {.lb = 0.1, .ub = 200.0},
           "bandwidth of the position loop: how fast an error vanishes");
  v.number("speed_Hz", drives.loop.speed_Hz, {.lb = 1.0, .ub = 500.0},
           "bandwidth of the speed loop inside it");
  v.rule(drives.loop.speed_Hz >= 2.0 * drives.loop.position_Hz, "speed_Hz",
         "must be at least twice position_Hz, or the two loops oscillate",
         model::to_text(drives.loop.speed_Hz));
  v.number("latency_s", drives.latency, {.lb = 0.0, .ub = 0.1},
           "from a sample to the arrival of its answer at the drives");
  v.number("current_lag_s", drives.current_lag, kNotNegative, "time constant of the current");
  v.groups_by_name(
      "actuators", manipulator, "a joint of the manipulator",
      [&](auto& child, int index) {
        drives.actuators.resize(manipulator.size());
        describe(child, drives.actuators[index]);
      },
      "motor and gear of each joint, for all or none; without them the drives are perfect");
  const bool is_incomplete = std::ranges::any_of(
      drives.actuators, [](const ActuatorModel& a) { return a.torque_max == 0.0; });
  v.rule(!is_incomplete, "actuators", "all joints of the manipulator need one");
}

template <class V>
void describe_rest(V& v, SimulationDraft& draft, const std::vector<std::string>& gantry,
                   const std::vector<std::string>& manipulator) {
  v.groups_by_name(
      "flexible", draft.joint_names, "a joint of the URDF",
      [&](auto& child, int index) {
        FlexibleDraft& joint = draft.flexible[index].emplace();
        joint.unit = draft.joint_units[index];
        describe(child, joint);
      },
      "joints of 'urdf' without a drive: bending links or frames");
  v.rule(v.is_given("urdf") || !draft.urdf.empty() || !v.is_given("flexible"), "flexible",
         "needs 'urdf': the device has no joints but those that are driven");
  v.group(
      "factors", [&](auto& child) { describe(child, draft.simulation.factors); },
      "true values over those of the device file and its URDF");
  v.group(
      "drives", [&](auto& child) { describe(child, draft.simulation.drives, manipulator); },
      "of a device without 'actuators': how they follow positions");
  v.group(
      "safety", [&](auto& child) { describe(child, draft.simulation.safety); },
      "the safety controller, docs/concepts/safety.md");
  v.group(
      "end_stops", [&](auto& child) { describe_end_stops(child, draft.simulation); },
      "buffers at the ends of all joints");
  describe_effects(v, draft, gantry, manipulator);
  VectorM& ratios = draft.simulation.gear_ratio;  // a base has given some
  if (ratios.size() != std::ssize(manipulator)) {
    ratios = per_joint(manipulator.size(), 1.0);
  }
  v.numbers_by_name(
      "gear_ratio", manipulator, "a joint of the manipulator", {.lb = 1e-3, .ub = 1e5},
      [&](int index, double ratio) { set_joint(draft.simulation.gear_ratio, index, ratio); },
      "turns of the motor per turn of the joint, 1 where not given");
  v.group(
      "sensors", [&](auto& child) { describe(child, draft.simulation.sensors); },
      "of the device; each 0 switches an effect off, and so does .inf as a range; a 'base' may "
      "have them",
      draft.base.empty() ? Need::kRequired : Need::kOptional);
}

}  // namespace hg::config
