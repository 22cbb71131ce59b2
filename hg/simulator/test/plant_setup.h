/// The plants that the tests of the plant share.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "hg/model/chain_model.h"
#include "hg/signals/test/reference_actuators.h"
#include "hg/simulator/plant/plant.h"

namespace hg::simulator {

inline model::ChainModel haptic_giant(bool gravity = true) {
  return model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf",
                                           {.gravity = gravity});
}

/// At home: q_m = (0, pi/2, -atan(0.53/0.67), pi/2, 0, 0).
inline PlantConfig reference_config() {
  PlantConfig config;
  config.gantry = {0, 1};
  config.manipulator = {2, 3, 4, 5, 6, 7};
  config.actuators = reference_actuators();
  config.q_p_start = VectorP::Zero(2);
  config.q_m_start = VectorM::Zero(6);
  config.q_m_start << 0.0, 0.5 * std::numbers::pi, -std::atan(0.53 / 0.67), 0.5 * std::numbers::pi,
      0.0, 0.0;
  return config;
}

/// Motors without torque, gantry commanded to stand.
inline PlantInput idle(const PlantConfig& config, bool brakes_closed) {
  PlantInput input;
  input.tau_command = VectorM::Zero(config.q_m_start.size());
  input.dq_p_command = VectorP::Zero(config.q_p_start.size());
  input.brakes_closed = brakes_closed;
  return input;
}

/// An actuator without friction, and with torque to spare.
inline ActuatorModel bare_actuator(double rotor_inertia, double stiffness) {
  return {.rotor_inertia = rotor_inertia,
          .stiffness = stiffness,
          .load_friction = 0.0,
          .stiction = 1.0,
          .torque_max = 1e3,
          .torque_rated = 1e3,
          .speed_full_torque = 100.0,
          .speed_no_load = 200.0};
}

inline std::string body(const std::string& name, double mass, double inertia) {
  const std::string i = std::to_string(inertia);
  return "<link name='" + name + "'><inertial><mass value='" + std::to_string(mass) +
         "'/><inertia ixx='" + i + "' iyy='" + i + "' izz='" + i +
         "' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& axis, const std::string& xyz = "0 0 0") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "'/><axis xyz='" + axis +
         "'/><limit lower='-9' upper='9' effort='9' velocity='9'/></joint>";
}

inline model::ChainModel chain_of(const std::string& parts, bool gravity) {
  return model::ChainModel::from_urdf_text(
      "<robot name='bench'><link name='base'/>" + parts + "</robot>", "bench",
      {.gravity = gravity});
}

/// One joint about z with the inertia `inertia` behind it, frame "tip".
inline model::ChainModel one_joint(double inertia) {
  return chain_of(joint("turn", "continuous", "base", "tip", "0 0 1") + body("tip", 1.0, inertia),
                  false);
}

inline PlantConfig one_joint_config(const ActuatorModel& actuator) {
  PlantConfig config;
  config.manipulator = {0};
  config.actuators = {actuator};
  config.current_lag = 0.0;
  config.q_m_start = VectorM::Zero(1);
  return config;
}

}  // namespace hg::simulator
