/// What is really the case, as only a simulation knows it: for judging a run, never for control.
#pragma once

#include "hg/core/types.h"
#include "hg/signals/touch.h"

namespace hg {

/// At the time of a SensorFrame. Wrenches act on the handle, at H, resolved in B, force first.
struct Truth {
  bool is_known = false;            ///< false: the device is real, nothing below means anything
  VectorM q_m, dq_m;                ///< link side, not wrapped
  VectorM theta_m, dtheta_m;        ///< motor side at the output of the gear
  VectorM tau_J;                    ///< transmitted by the springs, Nm
  VectorM tau_motor;                ///< of the motors, Nm
  VectorP q_p, dq_p, ddq_p;         ///< gantry, where its drives and encoders are
  Pose T_B_H;                       ///< handle
  Vector6 twist = Vector6::Zero();  ///< (v; omega) of H
  Vector6 acceleration = Vector6::Zero();  ///< (classical acceleration of H; d omega/dt)
  Vector6 w_H = Vector6::Zero();           ///< wrench of the user
  BystanderReport bystander;
};

}  // namespace hg
