/// Payload beyond the force/torque sensor: handle, brackets, the sensor's own free side. Shared by
/// the simulation of the sensor and the estimation of the user's wrench.
///
/// Frame S is the sensor. [HANDBOOK] 1.4, 1.6: 1.18 kg (handle and sensor 1.4 kg minus the sensor's
/// 0.22 kg).
#pragma once

#include <Eigen/Core>

#include "hg/core/types.h"

namespace hg {

/// Mass distribution of the payload; set-up data. Default: no payload.
struct Payload {
  double mass = 0.0;                                  ///< kg, >= 0
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< Centre of mass in S, m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< Inertia about the COM, axes of S, kg m^2
};

/// Wrench that the payload exerts on the sensor, at S, resolved in S, force first: its weight minus
/// its inertia. `a_S` is the acceleration of S minus gravity (at rest: g upwards), `omega_S` and
/// `alpha_S` are the angular velocity and acceleration, all resolved in S.
Vector6 payload_wrench(const Payload& payload, const Eigen::Vector3d& a_S,
                       const Eigen::Vector3d& omega_S, const Eigen::Vector3d& alpha_S) noexcept;

}  // namespace hg
