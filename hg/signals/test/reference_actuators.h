/// The actuators of the reference device for tests: [HANDBOOK] 1.2, J1..J6.
#pragma once

#include <vector>

#include "hg/signals/actuator_model.h"

namespace hg {

inline std::vector<ActuatorModel> reference_actuators() {
  const ActuatorModel large = {.rotor_inertia = 1.46,
                               .stiffness = 12000.0,
                               .damping = 12.0,
                               .coulomb_friction = 4.0,
                               .viscous_friction = 3.0,
                               .torque_max = 176.0,
                               .torque_rated = 90.0,
                               .speed_full_torque = 2.0,
                               .speed_no_load = 4.0};
  const ActuatorModel middle = {.rotor_inertia = 0.61,
                                .stiffness = 7000.0,
                                .damping = 6.0,
                                .coulomb_friction = 2.5,
                                .viscous_friction = 1.5,
                                .torque_max = 110.0,
                                .torque_rated = 60.0,
                                .speed_full_torque = 2.6,
                                .speed_no_load = 5.2};
  const ActuatorModel small = {.rotor_inertia = 0.12,
                               .stiffness = 3000.0,
                               .damping = 2.0,
                               .coulomb_friction = 1.0,
                               .viscous_friction = 0.5,
                               .torque_max = 40.0,
                               .torque_rated = 20.0,
                               .speed_full_torque = 3.5,
                               .speed_no_load = 7.0};
  return {large, large, middle, middle, small, small};
}

}  // namespace hg
