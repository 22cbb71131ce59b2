/// Ground truth of a simulation: for evaluating a run, never for control.
#pragma once

#include "hg/core/fields.h"
#include "hg/core/types.h"
#include "hg/signals/touch.h"

namespace hg {

/// The simulated person on foot, in the base frame; hg/simulator/person/walker.h.
struct WalkerReport {
  bool is_walking = false;
  double x = 0.0, y = 0.0;
  double heading = 0.0;
  double hold = 0.0;
};

template <typename Archive, Is<WalkerReport> T>
void fields(Archive& a, T& walker) {
  a("is_walking", walker.is_walking,
    "the person walks and has grasped the handle; otherwise all other fields are invalid");
  a("x", walker.x, "x of the body", unit::kM);
  a("y", walker.y, "y of the body", unit::kM);
  a("heading", walker.heading, "direction the body faces, from the x axis", unit::kRad);
  a("hold", walker.hold, "grip on the handle, 0 to 1: 0 once the hand has let go of a door",
    unit::kNone);
}

/// True state at the time of a SensorFrame. Wrenches act on the handle, at H, resolved in B, force
/// first.
struct Truth {
  bool is_known = false;
  VectorM q_m, dq_m, theta_m, dtheta_m;
  VectorM tau_J, tau_motor;
  VectorP q_p, dq_p, ddq_p;  ///< Gantry, at its drives and encoders
  Pose T_B_H;
  Vector6 twist = Vector6::Zero();
  Vector6 acceleration = Vector6::Zero();
  Vector6 w_H = Vector6::Zero();
  BystanderReport bystander;
  WalkerReport walker;
};

template <typename Archive, Is<Truth> T>
void fields(Archive& a, T& truth) {
  a("is_known", truth.is_known,
    "true for a simulated device; otherwise all other fields are invalid");
  a("q_m", truth.q_m, "link-side positions of the manipulator, not wrapped", unit::kJointPosition);
  a("dq_m", truth.dq_m, "link-side velocities of the manipulator", unit::kJointSpeed);
  a("theta_m", truth.theta_m, "motor-side positions at the output of the gear",
    unit::kJointPosition);
  a("dtheta_m", truth.dtheta_m, "motor-side velocities at the output of the gear",
    unit::kJointSpeed);
  a("tau_j", truth.tau_J, "torques transmitted by the springs", unit::kJointTorque);
  a("tau_motor", truth.tau_motor, "motor torques", unit::kJointTorque);
  a("q_p", truth.q_p, "gantry positions", unit::kJointPosition);
  a("dq_p", truth.dq_p, "gantry velocities", unit::kJointSpeed);
  a("ddq_p", truth.ddq_p, "gantry accelerations", unit::kJointAcceleration);
  a("handle", truth.T_B_H, "handle in the base frame");
  a("twist", truth.twist, "twist of the handle: velocity, angular velocity", unit::kTwist);
  a("acceleration", truth.acceleration,
    "classical acceleration of the handle, then its angular acceleration", unit::kAcceleration);
  a("w_h", truth.w_H, "wrench of the user at the handle: force, torque", unit::kWrench);
  a("bystander", truth.bystander, "load on a simulated bystander");
  a("walker", truth.walker, "body of the simulated person who walks");
}

}  // namespace hg
