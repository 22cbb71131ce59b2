/// Model of a joint with a series elastic actuator: motor, gear, spring with torque sensor, link.
/// Shared by the simulation and the controller.
///
/// Everything is referred to the output of the gear. [HANDBOOK] 1.2, 4.2:
///   Jm theta'' = tau_motor - tau_J - tau_friction,  tau_J = K (theta - q) + D (theta' - q')
/// Revolute joints; for a prismatic one read N for Nm and m for rad.
#pragma once

#include <algorithm>
#include <cmath>

namespace hg {

/// Parameters of one actuator; set-up data.
struct ActuatorModel {
  double rotor_inertia = 0.0;      ///< Rotor inertia Jm, kg m^2, > 0
  double stiffness = 0.0;          ///< Spring stiffness K, Nm/rad, > 0
  double damping = 0.0;            ///< Spring damping D, Nms/rad, >= 0
  double coulomb_friction = 0;     ///< Nm, >= 0; all friction is on the motor side
  double viscous_friction = 0;     ///< Viscous friction, Nms/rad, >= 0
  double load_friction = 0.06;     ///< Additional Coulomb friction per |tau_J|, >= 0
  double stiction = 1.2;           ///< Break-away torque over Coulomb friction, >= 1
  double stribeck_speed = 0.05;    ///< Speed at which stiction has mostly vanished, rad/s, > 0
  double presliding = 0.0;         ///< Presliding distance, rad, >= 0; 0 = slips at once
  double presliding_elements = 3;  ///< Slip elements, 1..kSlipElements of presliding.h
  double torque_max = 0.0;         ///< Peak torque of the motor, Nm, > 0
  double torque_rated = 0.0;       ///< Continuous torque of the motor, Nm, > 0
  double speed_full_torque = 0;    ///< Largest speed with full peak torque, rad/s, > 0
  double speed_no_load = 0.0;      ///< Speed with zero torque, rad/s, > speed_full_torque
};

/// Largest motor torque in the direction of motion at speed `dtheta`, Nm; braking has the full
/// peak torque.
inline double torque_available(const ActuatorModel& actuator, double dtheta) noexcept {
  const double used = (std::abs(dtheta) - actuator.speed_full_torque) /
                      (actuator.speed_no_load - actuator.speed_full_torque);
  return actuator.torque_max * (1.0 - std::clamp(used, 0.0, 1.0));
}

/// Largest dry friction torque at speed `dtheta` and spring torque `tau_J`, Nm: stiction at rest,
/// decreasing with speed (Stribeck); [HANDBOOK] 4.3.
inline double coulomb_torque(const ActuatorModel& actuator, double dtheta, double tau_J) noexcept {
  const double share = dtheta / actuator.stribeck_speed;
  const double stribeck = 1.0 + (actuator.stiction - 1.0) * std::exp(-share * share);
  return (actuator.coulomb_friction + actuator.load_friction * std::abs(tau_J)) * stribeck;
}

/// Delays between a torque command and the motor torque.
struct TorqueLoop {
  double latency = 1e-3;        ///< Delay from sensor sample to command at the drive, s, >= 0
  double current_lag = 0.5e-3;  ///< First-order time constant of the current, s, >= 0
};

}  // namespace hg
