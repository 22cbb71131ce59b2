/// Ground truth of a simulation: for evaluating a run, never for control.
#pragma once

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

}  // namespace hg
