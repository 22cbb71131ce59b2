/// Inertial unit on a link of a simulated machine, mounted at a random place and orientation.
#pragma once

#include "hg/core/types.h"
#include "hg/simulator/plant/body_motion.h"
#include "hg/simulator/sensors/imu.h"

namespace hg::simulator {

/// Set-up data of all inertial units.
struct LinkUnitConfig {
  double place = 0.1;     ///< standard deviation of each coordinate of a unit in its link, m, >= 0
  bool is_turned = true;  ///< random orientation; false: the axes of unit and link are parallel
  InertialSensorConfig accelerometer = mems_accelerometer();
  InertialSensorConfig gyroscope = mems_gyroscope();
  /// [A] faster than the sensor inside the force/torque sensor, 1 ms in all: a chip with a
  /// bandwidth of 1 kHz on a bus of its own.
  SensorFilterConfig filter = {.average = 0.5e-3, .delay = 0.75e-3};
};

class LinkUnit {
 public:
  /// `unit` counts from 0: each has errors of its own. Throws SetupError when a filter is too long.
  LinkUnit(const LinkUnitConfig& config, double step, double period, std::uint64_t seed, int unit);

  /// Takes the motion of the link, once per step of the plant.
  void observe(const BodyMotion& link) noexcept;
  /// Reading, once per period: accelerometer (m/s^2), then gyroscope (rad/s), in the axes of the
  /// unit.
  Vector6 sample(double warmer) noexcept;

 private:
  Pose T_L_U_;  ///< pose of the unit in its link
  InertialSensor accelerometer_, gyroscope_;
};

}  // namespace hg::simulator
