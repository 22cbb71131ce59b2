/// What reaches the twin from outside the law: changes of its parameters, forces, motion of its
/// base.
#pragma once

#include <cstdint>

#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg {

/// Parameter of a twin that may change at run time. Numbers are recorded and never change meaning.
enum class Parameter : std::uint8_t {
  kNone = 0,
  kStiffness = 1,         ///< Nm/rad or N/m, >= 0
  kRest = 2,              ///< rad or m
  kPreload = 3,           ///< Nm or N
  kDamping = 4,           ///< Nms/rad or Ns/m, >= 0
  kQuadraticDamping = 5,  ///< Nms^2/rad^2 or Ns^2/m^2, >= 0
  kFriction = 6,          ///< Nm or N, >= 0
  kLowerLimit = 7,        ///< rad or m; may be -infinity
  kUpperLimit = 8,        ///< rad or m; may be infinity
  kSpeedLimit = 9,        ///< rad/s or m/s, > 0; may be infinity
  kReferenceWrench = 10,  ///< N or Nm; index 0..5: force x y z, torque x y z
  kGravity = 11,          ///< share of the earth's gravity, 0..1
  kMassScale = 12,        ///< factor on all masses of the twin, 0.1..10
  kFeltScale = 13,        ///< factor on the user's wrench, 0.1..10; index as of kReferenceWrench
  kMotionScale = 14,      ///< motion of a remote tool over the leader's; index 0..2: its x y z
  kForceScale = 15,       ///< force on the leader over that on a remote tool; index 0..2
};

/// New value of one parameter of the twin, approached smoothly.
struct ParameterChange {
  Parameter parameter = Parameter::kNone;
  std::int16_t index = -1;
  double value = 0.0;
};

template <typename Archive, Is<ParameterChange> T>
void fields(Archive& a, T& change) {
  a("parameter", change.parameter);
  a("index", change.index, "degree of freedom of the twin, or component of the wrench");
  a("value", change.value, "new value, in the unit of the parameter", unit::kNone);
}

/// Force of a remote machine on the twin, docs/concepts/teleoperation.md.
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

/// Motion of the place where the twin stands, for example of a ship: docs/concepts/moving_base.md.
/// Frame A is the root link of the twin.
struct TwinBase {
  bool is_moving = false;  ///< false: the root link rests where the twin's placement puts it
  Pose T_B_A;
  Vector6 twist = Vector6::Zero();         ///< Of A against B, at its origin, resolved in B
  Vector6 acceleration = Vector6::Zero();  ///< Classical one of the origin, angular one
};

template <typename Archive, Is<TwinBase> T>
void fields(Archive& a, T& base) {
  a("is_moving", base.is_moving, "the root link of the twin moves");
  a("pose", base.T_B_A, "its pose in the base frame");
  a("twist", base.twist, "its velocity in the base frame: linear, angular", unit::kTwist);
  a("acceleration", base.acceleration, "its acceleration in the base frame: linear, angular",
    unit::kAcceleration);
}

}  // namespace hg
