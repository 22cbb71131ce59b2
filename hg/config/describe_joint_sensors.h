/// Description of the sensors in simulation.yaml, first part: those of joints and gantry.
#pragma once

#include "hg/config/describe_common.h"
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

}  // namespace hg::config
