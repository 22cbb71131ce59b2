/// All sensors of the device: from the true state of the plant to the readings of the controller.
///
/// observe() after every step of the plant, sample() at the end of a period. Each effect is a
/// parameter and can be switched off; ideal_sensors() has all off. The same seed and inputs give
/// the same bits. Copyable; no allocation and noexcept after set-up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/frames.h"
#include "hg/signals/payload.h"
#include "hg/signals/truth.h"
#include "hg/simulator/plant/motor_heat.h"
#include "hg/simulator/sensors/encoder.h"
#include "hg/simulator/sensors/imu.h"
#include "hg/simulator/sensors/link_unit.h"
#include "hg/simulator/sensors/temperature.h"
#include "hg/simulator/sensors/torque_estimate.h"
#include "hg/simulator/sensors/torque_sensor.h"
#include "hg/simulator/sensors/wrench_sensor.h"

namespace hg::simulator {

/// Set-up data of all sensors.
struct SensorsConfig {
  std::uint64_t seed = 1;
  /// [A] 1.2: 20 bit absolute; offset and errors are those left by calibration.
  EncoderConfig link_encoder{
      .resolution = 5.992e-6, .offset = 1e-4, .error_1 = 5e-5, .error_2 = 2e-5};
  /// [A] 1.2: 17 bit on the motor; error_2 also stands for the kinematic error of the gear ([C] 0),
  /// which appears in the encoder and not at the output.
  EncoderConfig motor_encoder{
      .resolution = 4.794e-5, .offset = 1e-4, .error_1 = 4e-6, .error_2 = 3e-5};
  /// [K] 1.5: 10 um, accuracy 0.15 mm + 0.02 mm/m, here for 5 m, as a smooth error.
  EncoderConfig gantry_encoder{.resolution = 1e-5, .error_1 = 2.5e-4, .period = 1.0};
  /// True: dq_m is the difference of the link encoder over a period, as a drive reports it; false:
  /// the true velocity.
  bool has_differenced_velocity = true;
  TorqueSensorConfig torque;
  WrenchSensorConfig wrench;
  TorqueEstimateConfig torque_estimate;  ///< instead of a force/torque sensor
  InertialSensorConfig accelerometer = mems_accelerometer();
  InertialSensorConfig gyroscope = mems_gyroscope();
  SensorFilterConfig imu_filter;
  LinkUnitConfig link_unit;       ///< configuration of every inertial unit on a link
  TemperatureConfig temperature;  ///< temperature of the force/torque sensor with the IMU inside
  MotorHeatConfig motor_heat;
};

/// Sensors without errors, noise or delays: they report true values.
SensorsConfig ideal_sensors();

/// Which sensors report true values, without noise, bias or resolution.
struct PerfectSensors {
  bool encoders = false;  ///< those of the manipulator, on the side that is controlled
  bool wrench = false;    ///< force/torque sensor
};
PerfectSensors perfect_sensors(const SensorsConfig& config, bool is_motor_side) noexcept;

/// Properties of the device that carries the sensors.
struct SensedDevice {
  double step = 0.25e-3;  ///< step of the plant, s
  double period = 1e-3;   ///< period of the loop, s; a whole number of steps
  std::array<bool, kMaxManipulator> is_endless{};  ///< manipulator joints without limits
  VectorM gear_ratio;                              ///< motor turns per turn of the joint
  VectorM torque_full_scale;  ///< peak torque of the joints, full scale of their torque sensors, Nm
  /// Drives that follow positions: they report the angles of their motors at the output of the
  /// gear, and neither the other side of the gear nor torques.
  bool has_position_drives = false;
  VectorM torque_rated;  ///< rated torque of the motors, Nm; empty: their heating is unknown
  Pose T_H_S;            ///< force/torque sensor in the handle frame
  Payload payload;       ///< load beyond the force/torque sensor
  int link_units = 0;    ///< inertial units on links, at most kMaxInertialUnits
};

class Sensors {
 public:
  /// Throws SetupError when a filter is too long.
  Sensors(const SensorsConfig& config, const SensedDevice& device);

  /// Call after every step of the plant; before the first call the device counts as at rest there.
  void observe(const Truth& truth) noexcept;
  /// The same for the link that carries an inertial unit.
  void observe(std::size_t unit, const BodyMotion& link) noexcept { units_[unit].observe(link); }
  /// At the end of a period, after observe() of the same `truth`: fills q_m, dq_m, theta_m, tau_m,
  /// q_p, w_S, a_S, omega_S, inertial, temperature_m and time_s of `frame`. theta_m, tau_m and
  /// temperature_m stay empty where the truth has no motors. time_s counts periods from 0 at the
  /// first call.
  void sample(const Truth& truth, SensorFrame& frame) noexcept;

 private:
  void sample_joints(const Truth& truth, SensorFrame& frame) noexcept;

  SensorsConfig config_;
  SensedDevice device_;
  std::array<Encoder, kMaxManipulator> link_encoders_, motor_encoders_;
  std::array<Encoder, kMaxGantry> gantry_encoders_;
  std::array<TorqueSensor, kMaxManipulator> torque_sensors_;
  std::array<MotorHeat, kMaxManipulator> motor_heat_;
  WrenchSensor wrench_sensor_;
  InertialSensor accelerometer_, gyroscope_;
  std::vector<LinkUnit> units_;
  Temperature temperature_;
  VectorM q_m_before_;  // readings of the link encoders a period ago; empty before the first sample
  std::uint64_t samples_ = 0;
};

}  // namespace hg::simulator
