/// Ground truth of a simulation: for evaluating a run, never for control.
#pragma once

#include "hg/core/fields.h"
#include "hg/core/types.h"
#include "hg/signals/touch.h"

namespace hg {

/// True state at the time of a SensorFrame. Wrenches act on the handle, at H, resolved in B, force
/// first.
struct Truth {
  bool is_known = false;            ///< false: the device is real, all other members are invalid
  VectorM q_m, dq_m;                ///< Link side, not wrapped
  VectorM theta_m, dtheta_m;        ///< Motor side at the output of the gear
  VectorM tau_J;                    ///< Torques transmitted by the springs, Nm
  VectorM tau_motor;                ///< Motor torques, Nm
  VectorP q_p, dq_p, ddq_p;         ///< Gantry, at its drives and encoders
  Pose T_B_H;                       ///< Pose of the handle
  Vector6 twist = Vector6::Zero();  ///< Twist (v; omega) of H
  Vector6 acceleration = Vector6::Zero();  ///< (Classical acceleration of H; d omega/dt)
  Vector6 w_H = Vector6::Zero();           ///< Wrench of the user
  BystanderReport bystander;
};

template <typename Archive, Is<Truth> T>
void fields(Archive& a, T& truth) {
  a("is_known", truth.is_known,
    "true for a simulated device; otherwise all other fields are invalid");
  a("q_m", truth.q_m, "link-side positions of the manipulator, rad");
  a("dq_m", truth.dq_m, "link-side velocities of the manipulator, rad/s");
  a("theta_m", truth.theta_m, "motor-side positions at the output of the gear, rad");
  a("dtheta_m", truth.dtheta_m, "motor-side velocities, rad/s");
  a("tau_j", truth.tau_J, "torques transmitted by the springs, Nm");
  a("tau_motor", truth.tau_motor, "motor torques, Nm");
  a("q_p", truth.q_p, "gantry positions, m");
  a("dq_p", truth.dq_p, "gantry velocities, m/s");
  a("ddq_p", truth.ddq_p, "gantry accelerations, m/s^2");
  a("handle", truth.T_B_H, "handle in the base frame");
  a("twist", truth.twist, "twist of the handle: m/s, rad/s");
  a("acceleration", truth.acceleration, "acceleration of the handle: m/s^2, rad/s^2");
  a("w_h", truth.w_H, "wrench of the user at the handle: force N, torque Nm");
  a("bystander", truth.bystander, "load on a simulated bystander");
}

}  // namespace hg
