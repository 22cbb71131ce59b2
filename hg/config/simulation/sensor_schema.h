/// Description of the sensors in simulation.yaml.
#pragma once

#include <string>

#include "hg/config/schema.h"
#include "hg/config/simulation/inertial_schema.h"
#include "hg/simulator/sensors/sensors.h"

namespace hg::config {

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

}  // namespace hg::config
