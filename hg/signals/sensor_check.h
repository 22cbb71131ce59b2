/// Checks of one sample before anything is computed from it: sizes and finite values.
#pragma once

#include <cstdint>
#include <string_view>

#include "hg/core/types.h"
#include "hg/signals/fault.h"
#include "hg/signals/frames.h"

namespace hg {

/// What a device has to measure.
struct RequiredSensors {
  int n_p = 0;                   ///< Gantry axes
  int n_m = 0;                   ///< Manipulator joints
  bool has_torque_loop = false;  ///< Motor encoders and joint torque sensors are needed
  bool has_imu = false;          ///< Accelerometer and gyroscope at the handle count
};

/// What a sensor has one value for.
enum class ValuePer : std::uint8_t { kJoint, kAxis, kComponent };

/// When a sensor may have no values at all.
enum class MayLack : std::uint8_t { kNever, kWithoutTorqueLoop, kAlways };

/// A kind of sensor.
struct SensorKind {
  std::string_view name;
  ValuePer per = ValuePer::kComponent;
  MayLack may_lack = MayLack::kNever;
};

/// Calls visit(kind, values) for each kind of sensor of a frame, in the order in which
/// FaultCode::kSensorNotFinite counts the values and FaultCode::kSensorIncomplete the kinds.
template <typename Visit>
void for_each_sensor(const SensorFrame& sensors, Visit&& visit) {
  using enum ValuePer;
  visit(SensorKind{"link encoder", kJoint}, sensors.q_m);
  visit(SensorKind{"speed", kJoint}, sensors.dq_m);
  visit(SensorKind{"gantry encoder", kAxis}, sensors.q_p);
  visit(SensorKind{"force/torque sensor"}, sensors.w_S);
  visit(SensorKind{"motor encoder", kJoint, MayLack::kWithoutTorqueLoop}, sensors.theta_m);
  visit(SensorKind{"torque sensor", kJoint, MayLack::kWithoutTorqueLoop}, sensors.tau_m);
  visit(SensorKind{"accelerometer"}, sensors.a_S);
  visit(SensorKind{"gyroscope"}, sensors.omega_S);
  visit(SensorKind{"temperature", kJoint, MayLack::kAlways}, sensors.temperature_m);
  visit(SensorKind{"clock"}, Eigen::Matrix<double, 1, 1>(sensors.time_s));
}

/// First sensor with the wrong number of values or with a value that is not finite, as
/// kSensorIncomplete or kSensorNotFinite; kNone if all can be computed with. Inertial units on the
/// links do not count: the estimation leaves out those without readings.
Fault check_values(const SensorFrame& sensors, const RequiredSensors& required) noexcept;

}  // namespace hg
