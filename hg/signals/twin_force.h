/// Force on the twin from outside the law: that of a remote machine,
/// docs/concepts/teleoperation.md.
#pragma once

#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg {

struct TwinForce {
  Vector6 w_E = Vector6::Zero();
  VectorA tau;

  bool is_zero() const noexcept { return w_E.isZero(0.0) && tau.isZero(0.0); }
};

template <typename Archive, Is<TwinForce> T>
void fields(Archive& a, T& force) {
  a("w_e", force.w_E, "on the end effector of the twin, in the base frame: force, torque",
    unit::kWrench);
  a("tau", force.tau, "on the joints of the twin; empty = none", unit::kJointTorque);
}

}  // namespace hg
