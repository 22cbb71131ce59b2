/// What a Plant reports about its last step: forces, energy and power.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include "hg/core/types.h"
#include "hg/simulator/plant/plant_config.h"

namespace hg::simulator {

/// Forces and accelerations of one step; they satisfy the equations of motion with the M and c of
/// its start. Links: manipulator joints, then flexible ones.
struct PlantForces {
  VectorL ddq;           ///< accelerations of the links
  VectorM ddtheta;       ///< accelerations of the motors
  VectorL tau_links;     ///< torques of springs and dampers on the links; a manipulator's are tau_J
  VectorM tau_friction;  ///< Coulomb friction with its bristles, and brakes, on the motors
  VectorM tau_stop;      ///< torques of the end stops, on the links
  VectorP f_p;           ///< drive forces on the gantry
  int tries = 0;         ///< active sets tried for the friction
  bool is_exact = true;  ///< false: no active set was found in kMaxTries
};

struct PlantEnergy {
  double kinetic = 0.0;    ///< links, gantry and rotors, J
  double potential = 0.0;  ///< potential energy in gravity, J
  double spring = 0.0;     ///< energy in the springs of joints and flexible joints, J
  double bristle = 0.0;    ///< energy in the bristles of friction and hysteresis, J

  double sum() const noexcept { return kinetic + potential + spring + bristle; }
};

/// Powers of the last step, computed with the speeds at its end, W.
struct PlantPower {
  double motors = 0.0, user = 0.0, gantry = 0.0;                               ///< supplied
  double joint_damping = 0.0, viscous_friction = 0.0, coulomb_friction = 0.0;  ///< dissipated, >= 0
  double flexible_damping = 0.0, hysteresis = 0.0;                             ///< dissipated, >= 0
  double end_stops = 0.0;  ///< absorbed by the stops; a small part of it is returned
  double bystander = 0.0;  ///< absorbed by the bystander; energy stored in the body is returned

  double put_in() const noexcept { return motors + user + gantry; }
  double taken() const noexcept {
    return joint_damping + viscous_friction + coulomb_friction + flexible_damping + hysteresis +
           end_stops + bystander;
  }
};

}  // namespace hg::simulator
