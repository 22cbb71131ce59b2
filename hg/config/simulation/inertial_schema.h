/// Description of force/torque and inertial sensors in simulation.yaml.
#pragma once

#include "hg/config/schema.h"
#include "hg/simulator/sensors/sensors.h"

namespace hg::config {

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

}  // namespace hg::config
