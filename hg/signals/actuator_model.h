/// A joint with a series elastic actuator: motor and gear, spring with torque sensor, link. Shared
/// by its simulation and by the controller that works against it.
///
/// Everything is referred to the output of the gear. [HANDBOOK] 1.2, 4.2:
///   Jm theta'' = tau_motor - tau_J - tau_friction,  tau_J = K (theta - q) + D (theta' - q')
/// Revolute joints; for a prismatic one read N for Nm and m for rad.
#pragma once

#include <algorithm>
#include <cmath>

namespace hg {

/// Set-up data.
struct ActuatorModel {
  double rotor_inertia = 0.0;      ///< Jm, kg m^2, > 0
  double stiffness = 0.0;          ///< K, Nm/rad, > 0
  double damping = 0.0;            ///< D, Nms/rad, >= 0
  double coulomb_friction = 0;     ///< Nm, >= 0, on the motor side like all friction
  double viscous_friction = 0;     ///< Nms/rad, >= 0
  double load_friction = 0.06;     ///< further Coulomb friction per |tau_J|, >= 0
  double stiction = 1.2;           ///< break-away torque over Coulomb friction, >= 1
  double stribeck_speed = 0.05;    ///< at which stiction has mostly gone, rad/s, > 0
  double presliding = 0.0;         ///< way until dry friction slips, rad, >= 0; 0 = it does at once
  double presliding_elements = 3;  ///< in which it begins to, 1..kSlipElements of presliding.h
  double torque_max = 0.0;         ///< peak torque of the motor, Nm, > 0
  double torque_rated = 0.0;       ///< that it can give for ever, Nm, > 0
  double speed_full_torque = 0;    ///< up to which the peak torque is available, rad/s, > 0
  double speed_no_load = 0.0;      ///< at which no torque is left, rad/s, > speed_full_torque
};

/// Largest motor torque in the direction of its motion at speed `dtheta`; braking has all of it.
inline double torque_available(const ActuatorModel& actuator, double dtheta) noexcept {
  const double used = (std::abs(dtheta) - actuator.speed_full_torque) /
                      (actuator.speed_no_load - actuator.speed_full_torque);
  return actuator.torque_max * (1.0 - std::clamp(used, 0.0, 1.0));
}

/// Largest torque of the dry friction at speed `dtheta` under the torque `tau_J` of the spring:
/// stiction at rest, of which less and less is left with the speed; [HANDBOOK] 4.3.
inline double coulomb_torque(const ActuatorModel& actuator, double dtheta, double tau_J) noexcept {
  const double share = dtheta / actuator.stribeck_speed;
  const double stribeck = 1.0 + (actuator.stiction - 1.0) * std::exp(-share * share);
  return (actuator.coulomb_friction + actuator.load_friction * std::abs(tau_J)) * stribeck;
}

/// From a torque command to the torque of the motors.
struct TorqueLoop {
  double latency = 1e-3;        ///< from the sensor sample to the command at the drive, s, >= 0
  double current_lag = 0.5e-3;  ///< first-order time constant of the current, s, >= 0
};

}  // namespace hg
